"""Take away what the pen did not draw: spurs."""

from __future__ import annotations

import numpy as np

from ..values import PlanarGraph
from .topology import join, lengths, select

Array = np.ndarray


def prune(graph: PlanarGraph, shortest: float) -> PlanarGraph:
    """Drop the loose branches shorter than `shortest` px that hang on a junction.

    Every junction keeps its two longest branches, so that a small cross or star stays.
    """
    for _ in range(2):
        vertex, degree = graph.half_vertex, graph.degrees
        long = np.repeat(lengths(graph), 2)
        order = np.lexsort((-long, vertex))
        start = np.cumsum(degree) - degree
        rank = np.empty(len(order), np.int64)
        rank[order] = np.arange(len(order)) - start[vertex[order]]
        loose = degree[vertex[np.arange(len(vertex)) ^ 1]] == 1
        spur = loose & (degree[vertex] >= 3) & (rank >= 2) & (long < shortest)
        if not spur.any():
            break
        graph = join(select(graph, ~spur.reshape(-1, 2).any(1)))
    return graph
