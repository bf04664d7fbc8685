"""From what was seen of a page to a planar graph: one vertex per junction, one polyline per branch.

`passes` has the list of all that is done, in its order; each step has a file of its own here, what
takes away has its file in `removal`. `evidence` is what the steps know of the page.

All of it works on flat arrays, in NumPy and OpenCV only: fast enough (about 0.3 ms a junction)
without a compiled helper, which would need a wheel for every Python and platform.
"""

from __future__ import annotations

from .evidence import Evidence
from .passes import PASSES, build_graph, routed, run_passes, traced

__all__ = ["PASSES", "Evidence", "build_graph", "routed", "run_passes", "traced"]
