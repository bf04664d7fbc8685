"""What lies in front: a line goes on along the rim of the face that hides what is behind it.

Where the rim of something meets a line that it hides, the two half-branches that bound it are one
line, be it straight or a corner. Which of the faces at a junction that is, the other junctions
around each face tell: all along the rim of what is in front, the rim is what goes on most straight.
"""

from __future__ import annotations

import numpy as np

from ..fills.faces import areas_of, face_of_halves
from ..graph.at_vertices import directions
from ..values import Array, PlanarGraph

FEATURES = 7  # of a pair of half-branches
_LOOK = 8  # points of a branch that tell its direction
_UNKNOWN = 0.5  # share of the junctions around a face that has no others


def fronts(graph: PlanarGraph, pairs: Array, turn: Array, best: Array, pen: float) -> list[Array]:
    """What tells of pairs of half-branches whether they bound something in front, (K,) each.

    Args:
        pairs: (K, 2), all of the junctions. turn: (K,) by which each pair bends, radians.
        best: (K,) bool: no other pair of either bends less. pen: px.
    """
    before, face = face_of_halves(graph)
    a, b = pairs.T
    within = np.where(before[a] == b, face[b], np.where(before[b] == a, face[a], -1))
    beside = within >= 0
    faces = len(before)
    number = np.bincount(within[beside], minlength=faces)
    rims = np.bincount(within[beside], best[beside], faces)
    others = np.where(beside, number[within] - 1, 0)
    share = np.where(others > 0, (rims[within] - best) / np.maximum(others, 1), _UNKNOWN)
    area = np.where(beside, areas_of(graph, face)[within], 0.0)
    return [
        share,
        share - _best_of_others(graph.half_vertex[a], share),
        np.log1p(others),
        np.log1p(np.abs(area) / pen**2),
        np.sign(area),
        beside,
        np.where(beside, _wedge(graph, pairs, before), np.pi),
    ]


def _best_of_others(vertex: Array, share: Array) -> Array:
    """(K,) the largest share that another pair of the same vertex has."""
    order = np.lexsort((-share, vertex))
    first = np.flatnonzero(np.diff(vertex[order], prepend=-1))
    last = np.append(first[1:], len(order)) - 1
    found = share[order[first]][np.repeat(np.arange(len(first)), last - first + 1)]
    found[first] = np.where(last > first, share[order[np.minimum(first + 1, last)]], _UNKNOWN)
    back = np.empty(len(order), np.int64)
    back[order] = np.arange(len(order))
    return found[back]


def _wedge(graph: PlanarGraph, pairs: Array, before: Array) -> Array:
    """(K,) the angle between both half-branches on the side of the face that they bound."""
    a, b = pairs.T
    later, earlier = np.where(before[a] == b, (a, b), (b, a))
    way = directions(graph, _LOOK)
    angle = np.arctan2(way[:, 1], way[:, 0])
    return (angle[later] - angle[earlier]) % (2 * np.pi)
