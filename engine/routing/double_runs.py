"""Runs of strokes on which a second line may go on.

A line that joins another one ends where they meet, for the graph has one branch of both, and begins
anew where they part. So a run reaches from one end that lies on a stroke, and runs on smoothly into
it, along that stroke to another such end.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..graph.topology import joined, lengths
from ..values import Array, PlanarGraph
from .encoding import along

_TURN = np.cos(np.radians(60.0))  # a line that turns by more does not run on into another
_LOOK = 12.0  # px over which that is seen
_LONGEST = 500.0  # px of a run
_MET = 3  # ends that lie nearest along a stroke; a second line goes to one of them


@dataclass(frozen=True, eq=False)
class Runs:
    """Runs of strokes on which a second line may go on, K of them.

    first, last: (K, 3) int half-branches where the run begins and ends: the run itself, seen from
        there; the line that ends there; the one by which the stroke goes on.
    path: the half-branches of each run, in walking order.
    """

    first: Array
    last: Array
    path: tuple[tuple[int, ...], ...]

    def __len__(self) -> int:
        return len(self.path)


def find_runs(graph: PlanarGraph, partner: Array) -> Runs:
    """All runs between two ends on one stroke that could be one line.

    partner: (2B,) the half-branch in which each one continues.
    """
    found: dict[tuple[int, ...], tuple[list[int], list[int], tuple[int, ...]]] = {}
    for end, through, path, other in _walks(graph, partner):
        first, last = [path[0], end, through], [path[-1] ^ 1, other, int(partner[path[-1] ^ 1])]
        key = (end, other) if end < other else (other, end)
        found.setdefault((*key, min(path[0], path[-1] ^ 1)), (first, last, path))
    rows = [found[key] for key in sorted(found)]
    table = np.array([[first, last] for first, last, _ in rows], int).reshape(-1, 2, 3)
    return Runs(table[:, 0], table[:, 1], tuple(path for *_, path in rows))


def _walks(graph: PlanarGraph, partner: Array) -> Iterator[tuple[int, int, tuple[int, ...], int]]:
    """An end on a stroke, the half-branch by which that comes, its run, and an end further on."""
    vertex, length, out = graph.half_vertex.tolist(), lengths(graph).tolist(), _outward(graph)
    order, starts = graph.halves_at
    mate = partner.tolist()
    ends: dict[int, list[int]] = {}
    loose = (partner == np.arange(len(partner))) & (graph.degrees[graph.half_vertex] >= 3)
    for half in np.flatnonzero(loose).tolist():
        ends.setdefault(vertex[half], []).append(half)

    def runs_on(a: int, b: int) -> bool:
        return -(out[a] * np.conj(out[b])).real >= _TURN

    for at, here in ends.items():
        for begin in order[starts[at] : starts[at + 1]].tolist():
            smooth = [end for end in here if mate[begin] != begin and runs_on(end, begin)]
            if not smooth:
                continue
            path, way, met = [begin], length[begin >> 1], 0
            while way < _LONGEST and met < _MET:
                leaving = path[-1] ^ 1
                onward = mate[leaving]
                if onward in (leaving, begin):
                    break
                others = ends.get(vertex[leaving], [])
                met += len(others)
                for other in others:
                    if runs_on(other, leaving):
                        yield from (
                            (end, mate[begin], tuple(path), other) for end in smooth if end != other
                        )
                path.append(onward)
                way += length[onward >> 1]


def _outward(graph: PlanarGraph) -> Array:
    """(2B,) complex unit directions in which half-branches leave junctions, corners left out."""
    whole, halves = joined(graph)
    away = along(whole, np.array([_LOOK]))[0][:, 0]
    out = np.zeros(2 * graph.branch_count, complex)
    out[halves] = away / np.maximum(np.abs(away), 1e-9)
    return out
