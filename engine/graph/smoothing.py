"""Even, smooth points along every branch.

The paper moves each point towards the middle of its neighbours, which shortens every curve by a
few per cent. We lay a parabola through five neighbours instead, again and again (Savitzky and
Golay, 1964): noise goes, bends stay.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays.ragged import offsets_of, owners, steps
from ..settings import Settings
from ..values import PlanarGraph
from .evidence import Evidence
from .limits import LIMITS

_PARABOLA = np.array([-3, 12, 17, 12, -3]) / 35
_LOOP = 3  # pieces of a line that comes back to where it began, however small it is


def space_points(graph: PlanarGraph, evidence: Evidence, settings: Settings) -> PlanarGraph:
    """Even points along every branch.

    Reads: nothing but the graph.
    Promises: points 1 px apart, a small loop's closer.
    """
    return even(graph)


def smooth_lines(graph: PlanarGraph, evidence: Evidence, settings: Settings) -> PlanarGraph:
    """Smooth every branch as much as the settings ask for; vertices stay.

    Reads: Settings.smoothing.
    Promises: points 1 px apart.
    """
    return even(smooth(even(graph), round(LIMITS.smooth_rounds * settings.smoothing)))


def even(graph: PlanarGraph, spacing: float = 1.0) -> PlanarGraph:
    """Points every `spacing` px (about; the two ends stay) along every branch."""
    if graph.branch_count == 0:
        return graph
    points = graph.points.astype(np.float64)
    arc = np.cumsum(steps(points, graph.offsets))
    starts, stops = arc[graph.offsets[:-1]], arc[graph.offsets[1:] - 1]
    # With two points a loop would be none.
    least = np.where(graph.ends[:, 0] == graph.ends[:, 1], _LOOP, 1)
    count = np.maximum(np.rint((stops - starts) / spacing).astype(np.int64), least) + 1
    offsets = offsets_of(count)
    branch = owners(offsets)
    part = (np.arange(offsets[-1]) - offsets[branch]) / (count - 1)[branch]
    # Branches follow each other on one arc; one unit between them keeps them apart.
    at = starts[branch] * (1 - part) + stops[branch] * part + branch
    arc = arc + owners(graph.offsets)
    points = np.stack([np.interp(at, arc, points[:, k]) for k in (0, 1)], -1)
    return _pinned(replace(graph, points=points, offsets=offsets.astype(np.int32)))


def smooth(graph: PlanarGraph, passes: int) -> PlanarGraph:
    """Fit a parabola to five evenly spaced points around each, `passes` times; ends stay."""
    if graph.branch_count == 0 or passes == 0:
        return graph
    points = graph.points.astype(np.float64)
    starts, stops = graph.offsets[:-1].astype(np.int64), graph.offsets[1:].astype(np.int64) - 1
    index = np.arange(len(points))
    first, last = (np.repeat(a, np.diff(graph.offsets)) for a in (starts, stops))
    ring = np.repeat(graph.ends[:, 0] == graph.ends[:, 1], np.diff(graph.offsets))
    ring &= (graph.degrees[graph.ends[:, 0]] == 2)[
        np.repeat(np.arange(len(starts)), stops - starts + 1)
    ]
    inner = (index > first) & (index < last) | ring
    inner &= last - first >= 4
    # Rings go round (their first point is their last one too); other branches go on mirrored in
    # their end point, so that they neither shrink nor bend there.
    edge = inner & ((index - first < 2) | (last - index < 2))
    within = (inner & ~edge)[2:-2, None]
    here = index[edge]
    first, last, ring = first[edge, None], last[edge, None], ring[edge, None]
    around = here[:, None] + np.arange(-2, 3)
    period = last - first
    wrapped = first + (around - first) % period
    mirror = np.where(around < first, first, last)
    outside = (around < first) | (around > last)
    reflected = np.where(outside, 2 * mirror - around, around)
    source = np.where(ring, wrapped, reflected)
    flip = (outside & ~ring)[..., None]
    for _ in range(passes):
        near = points[source]
        near = np.where(flip, 2 * points[mirror] - near, near)
        far, beside, own = _PARABOLA[:3]
        laid = own * points[2:-2]
        laid += beside * (points[1:-3] + points[3:-1])
        laid += far * (points[:-4] + points[4:])
        np.copyto(points[2:-2], laid, where=within)
        points[here] = np.einsum("k,nkd->nd", _PARABOLA, near)
    vertices = graph.vertices.copy()
    vertices[graph.ends[:, 0]] = points[starts]
    vertices[graph.ends[:, 1]] = points[stops]
    return _pinned(replace(graph, vertices=vertices, points=points))


def _pinned(graph: PlanarGraph) -> PlanarGraph:
    """The graph in single precision, the ends of its branches exactly on their vertices."""
    points = graph.points.astype(np.float32)
    vertices = graph.vertices.astype(np.float32)
    points[graph.offsets[:-1]] = vertices[graph.ends[:, 0]]
    points[graph.offsets[1:] - 1] = vertices[graph.ends[:, 1]]
    return replace(graph, vertices=vertices, points=points)
