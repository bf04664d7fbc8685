"""How half-branches lie to each other at their vertices, for the networks that judge branches."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..values import Array, PlanarGraph
from .continuations import pairs_within


@dataclass(frozen=True, eq=False)
class AtVertices:
    """All half-branches among those that start at the same vertex; -1 where there are none.

    a, b: (K,) the pairs of half-branches that start at one vertex.
    straight: (2B,) how straight the straightest goes on, the cosine between both ways.
    beside: (2B,) how close to the same way the closest one leaves.
    past: (2B,) how straight the others run past: the straightest pair that it is no part of; -1
        where it is part of that.
    """

    a: Array
    b: Array
    straight: Array
    beside: Array
    past: Array

    @staticmethod
    def of(graph: PlanarGraph, look: int, least: int) -> AtVertices:
        """Of a graph.

        Args:
            look: points of a branch that tell its direction.
            least: degree of a vertex from which on its half-branches are compared.
        """
        vertex = graph.half_vertex
        out = directions(graph, look)
        a, b = pairs_within(np.where(graph.degrees[vertex] >= least, vertex, -1)).T
        turn = (out[a] * out[b]).sum(1)
        straight, beside = np.full(len(vertex), -1.0), np.full(len(vertex), -1.0)
        for one in (a, b):
            np.maximum.at(straight, one, -turn)
            np.maximum.at(beside, one, turn)
        order = np.lexsort((turn, vertex[a]))
        first = order[np.flatnonzero(np.diff(vertex[a][order], prepend=-1))]
        best = np.full((len(graph.vertices), 3), -1.0)
        best[vertex[a[first]]] = np.stack([-turn[first], a[first], b[first]], 1)
        mine = (best[vertex, 1:] == np.arange(len(vertex))[:, None]).any(1)
        past = np.where(mine, -1.0, best[vertex, 0])
        return AtVertices(a, b, straight, beside, past)

    def most(self, values: Array) -> Array:
        """(2B,) the largest of (B,) values, none below zero, that another half-branch has there."""
        found = np.zeros(len(self.straight))
        for one, other in ((self.a, self.b), (self.b, self.a)):
            np.maximum.at(found, one, values[other >> 1])
        return found


def directions(graph: PlanarGraph, look: int) -> Array:
    """(2B, 2) unit vectors in which the half-branches leave their vertices."""
    size = np.minimum(np.diff(graph.offsets) - 1, look)
    start, stop = graph.offsets[:-1], graph.offsets[1:] - 1
    ahead = graph.points[start + size].astype(np.float64) - graph.points[start]
    back = graph.points[stop - size].astype(np.float64) - graph.points[stop]
    way = np.stack([ahead, back], 1).reshape(-1, 2)
    return way / np.maximum(np.hypot(*way.T), 1e-9)[:, None]
