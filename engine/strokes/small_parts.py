"""The layers of a drawing: one per ink, and where it is asked for, one more for what is small.

Lettering, numbers and fragments hang together in small parts of their own. What is drawn is one
network of lines, or a few, and much larger.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..ink.ink_names import InkLayer, ink_layers

if TYPE_CHECKING:
    from ..drawing import Drawing
    from ..values import Array


def layers_of(drawing: Drawing) -> list[InkLayer]:
    """A layer per ink; small parts come to layers of their own, as the settings say."""
    return ink_layers(drawing.strokes, small_strokes(drawing).tolist())


def small_strokes(drawing: Drawing) -> Array:
    """(S,) bool: the strokes of parts of the page that are smaller than the settings say.

    A part is what hangs together; its size is the longer side of its bounding box.
    """
    small = np.zeros(len(drawing.strokes), bool)
    graph, most = drawing.graph, drawing.settings.small_parts
    if not most or graph.widths is None or not graph.branch_count:
        return small
    from ..graph.topology import connected  # brings in OpenCV

    part = connected(len(graph.vertices), graph.ends)[graph.ends[:, 0]]  # of each branch
    owner = np.repeat(part, np.diff(graph.offsets))
    low = np.full((part.max() + 1, 2), np.inf)
    high = -low
    np.minimum.at(low, owner, graph.points)
    np.maximum.at(high, owner, graph.points)
    side = (high - low).max(1)
    least = most * float(np.median(graph.widths))
    for number, stroke in enumerate(drawing.strokes):
        if len(stroke.branches):
            small[number] = side[part[stroke.branches[0] >> 1]] < least
    return small
