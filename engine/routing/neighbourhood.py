"""A few junctions with what their branches lead to, as a graph of its own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..graph.topology import select
from ..values import Array, Pair, PlanarGraph
from .windows import HOPS


@dataclass(frozen=True, eq=False)
class Neighbourhood:
    """Part of a graph.

    graph: the part; its corners and the clues of these are left out.
    near: vertices of the whole graph within `HOPS` junctions of the middle, without the middle.
    number: (2B,) half-branches of the whole graph -> those of the part, -1 = not in it.
    vertex: (V,) the same for vertices.
    """

    graph: PlanarGraph
    near: Array
    number: Array
    vertex: Array

    @staticmethod
    def of(graph: PlanarGraph, centers: Array, without: Array) -> Neighbourhood:
        """The neighbourhood of some vertices, with context: one junction more all around.

        without: (B,) bool, branches that are left out.
        """
        inside = np.zeros(len(graph.vertices), bool)
        inside[centers] = True
        near = inside
        for hop in range(HOPS + 1):
            inside = _wider(graph, inside)
            near = inside.copy() if hop == HOPS - 1 else near
        near[centers] = False
        kept = inside[graph.ends].any(1) & ~without
        part = select(graph, kept)
        vertex, number = np.full(len(graph.vertices), -1), np.full(2 * graph.branch_count, -1)
        vertex[graph.ends[kept]] = part.ends
        number[np.repeat(kept, 2)] = np.arange(2 * part.branch_count)
        return Neighbourhood(part, np.flatnonzero(near), number, vertex)

    def fixed(
        self, whole: PlanarGraph, decided: Mapping[int, tuple[Pair, ...]]
    ) -> dict[int, tuple[Pair, ...]]:
        """What was decided at junctions that are whole in the part, in its numbers."""
        found = {}
        for junction, pairs in decided.items():
            at = int(whole.places[junction])
            here = int(self.vertex[at])
            if here >= 0 and self.graph.degrees[here] == whole.degrees[at] >= 3:
                found[int(self.graph.place_at[here])] = tuple(
                    tuple(sorted(self.number[list(pair)].tolist())) for pair in pairs
                )
        return found


def _wider(graph: PlanarGraph, inside: Array) -> Array:
    """What is one junction further on, along corners as if they were none."""
    while True:
        reached = inside.copy()
        reached[graph.ends[inside[graph.ends].any(1)]] = True
        fresh = reached & ~inside
        through = fresh & (graph.degrees == 2)
        if not through.any():
            return reached
        # Only the corners among what is new are walked through.
        inside = inside | through
