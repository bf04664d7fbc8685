"""Take away what the pen did not draw: spurs.

The paper drops a loose branch shorter than 6 px when its tip is dark. A map that says where lines
end knows better than a length: a tip where it sees no end is a spur, one where it does is a line.
"""

from __future__ import annotations

import cv2
import numpy as np

from ..values import PlanarGraph
from .sampling import sample
from .topology import join, lengths, select

Array = np.ndarray

_NO_END, _END = 0.1, 0.5  # of the end map near a tip


def prune(graph: PlanarGraph, shortest: float, ends: Array | None = None) -> PlanarGraph:
    """Drop the loose branches shorter than `shortest` px that hang on a junction.

    Every junction keeps its two longest branches, so that a small cross or star stays.

    Args:
        ends: (H, W) probability of the end of a line, or None; halves the limit where there is
            one, and doubles it where there is none.
    """
    if ends is not None:
        ends = cv2.dilate(ends, np.ones((7, 7), np.uint8))
    for _ in range(2):
        vertex, degree = graph.half_vertex, graph.degrees
        long = np.repeat(lengths(graph), 2)
        order = np.lexsort((-long, vertex))
        start = np.cumsum(degree) - degree
        rank = np.empty(len(order), np.int64)
        rank[order] = np.arange(len(order)) - start[vertex[order]]
        tip = vertex[np.arange(len(vertex)) ^ 1]
        limit = np.full(len(vertex), shortest)
        if ends is not None:
            seen = sample(ends, graph.vertices[tip])
            limit *= np.where(seen < _NO_END, 2.0, np.where(seen > _END, 0.5, 1.0))
        spur = (degree[tip] == 1) & (degree[vertex] >= 3) & (rank >= 2) & (long < limit)
        if not spur.any():
            break
        graph = join(select(graph, ~spur.reshape(-1, 2).any(1)))
    return graph
