"""Take away what the pen did not draw: spurs, and rungs between close lines.

The paper drops a loose branch shorter than 6 px when its tip is dark. Maps that say where lines end
and where they meet know better than a length: a tip where no end is seen is a spur, one where an
end is seen is a line; a fork where no junction is seen is noise at the edge of a thick line, or a
bridge of grain between two lines.
"""

from __future__ import annotations

import cv2
import numpy as np

from ...arrays.sampling import sample
from ...values import LineMaps, PlanarGraph
from ..topology import join, lengths, select

Array = np.ndarray

_NO_END, _END = 0.1, 0.5  # of the end map near a tip
_SEEN = 0.5  # of the junction map near a fork: 24 of 25 true ones have more, every other false one
_UNSEEN = 5.0  # times longer is a spur that hangs on a fork which nobody sees
_RUNG = 12.0  # px; the longest bridge between two lines that don't meet


def prune(graph: PlanarGraph, shortest: float, maps: LineMaps) -> PlanarGraph:
    """Drop the loose branches shorter than `shortest` px that hang on a junction.

    Every junction keeps its two longest branches, so that a small cross or star stays.

    Args:
        maps: their endpoints halve the limit where they see the tip and double it where they don't;
            their junctions raise it where they don't see the fork. Either may be None.
    """
    tips, forks = seen_near(maps.endpoints, 7), seen_near(maps.junctions, 5)
    for _ in range(2):
        vertex, degree = graph.half_vertex, graph.degrees
        long = np.repeat(lengths(graph), 2)
        rank = _rank(vertex, degree, long)
        tip = vertex[np.arange(len(vertex)) ^ 1]
        limit = np.full(len(vertex), shortest)
        if tips is not None:
            seen = sample(tips, graph.vertices[tip])
            limit *= np.where(seen < _NO_END, 2.0, np.where(seen > _END, 0.5, 1.0))
        if forks is not None:
            limit *= np.where(sample(forks, graph.vertices[vertex]) < _SEEN, _UNSEEN, 1.0)
        spur = (degree[tip] == 1) & (degree[vertex] >= 3) & (rank >= 2) & (long < limit)
        if not spur.any():
            break
        graph = join(select(graph, ~spur.reshape(-1, 2).any(1)))
    return graph


def unbridge(graph: PlanarGraph, value: Array, maps: LineMaps) -> PlanarGraph:
    """Drop short, faint branches between two forks at which no junction is seen.

    Args:
        value: (H, W) the smoothed centerline map.
    """
    if maps.junctions is None:
        return graph
    unseen = sample(seen_near(maps.junctions, 5), graph.vertices) < _SEEN
    unseen &= graph.degrees == 3
    short = (lengths(graph) < _RUNG) & (graph.ends[:, 0] != graph.ends[:, 1])
    dimmest = np.minimum.reduceat(sample(value, graph.points), graph.offsets[:-1])
    rank = _rank(graph.half_vertex, graph.degrees, np.repeat(dimmest, 2)).reshape(-1, 2)
    rung = unseen[graph.ends].all(1) & short & (rank == 2).all(1)
    return join(select(graph, ~rung)) if rung.any() else graph


def _rank(vertex: Array, degree: Array, worth: Array) -> Array:
    """(H,) how many half-branches at the same vertex are worth more."""
    order = np.lexsort((-worth, vertex))
    start = np.cumsum(degree) - degree
    rank = np.empty(len(order), np.int64)
    rank[order] = np.arange(len(order)) - start[vertex[order]]
    return rank


def seen_near(heat: Array | None, size: int) -> Array | None:
    """The brightest value of a map within a square of `size` px."""
    return None if heat is None else cv2.dilate(heat, np.ones((size, size), np.uint8))
