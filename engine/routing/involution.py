"""Which half-branches of a junction are joined: the involution with the greatest total score.

Half-branches of different junctions never pair, so the maximum-weight matching of the drawing
(the paper "Stroke Vectorization via Involution Prediction", section on inference) is the union of
tiny ones. Up to degree 10 all involutions are listed once and scored as one matrix product for all
junctions of that degree; above that, the blossom algorithm finds the same optimum.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ..values import Pair

Array = np.ndarray

MAX_LISTED_DEGREE = 10  # 9,496 involutions


@lru_cache(maxsize=MAX_LISTED_DEGREE + 1)
def involutions(degree: int) -> Array:
    """All involutions of `degree` things: (n, degree) int8 partners, the identity first."""
    if degree < 2:
        return np.arange(degree, dtype=np.int8)[None]
    last = degree - 1
    fewer = involutions(last)
    found = [np.column_stack([fewer, np.full(len(fewer), last, np.int8)])]
    rest = involutions(last - 1)
    for mate in range(last):
        others = np.delete(np.arange(last, dtype=np.int8), mate)
        joined = np.empty((len(rest), degree), np.int8)
        joined[:, others] = others[rest]
        joined[:, mate], joined[:, last] = last, mate
        found.append(joined)
    return np.concatenate(found)


@lru_cache(maxsize=MAX_LISTED_DEGREE + 1)
def pair_matrix(degree: int) -> Array:
    """Which pairs each involution joins: (n, degree * (degree - 1) / 2) float32 of 0 and 1."""
    a, b = np.triu_indices(degree, 1)
    return (involutions(degree)[:, a] == b).astype(np.float32)


def pairs_of(partner: Array, halves: Array) -> tuple[Pair, ...]:
    """An involution of local numbers as ascending pairs of half-branches."""
    a = np.flatnonzero(partner > np.arange(len(partner)))
    return tuple((int(i), int(j)) for i, j in zip(halves[a], halves[partner[a]], strict=True))


def best_matching(score: Array) -> Array:
    """The involution with the greatest sum of pair scores, by the blossom algorithm.

    Args:
        score: (d, d) symmetric scores of joining against ending both; <= 0 is never worth joining.

    Returns:
        (d,) int partners.
    """
    from networkx import Graph, max_weight_matching

    a, b = np.nonzero(np.triu(score, 1) > 0)
    graph = Graph()
    graph.add_weighted_edges_from(zip(a.tolist(), b.tolist(), score[a, b].tolist(), strict=True))
    partner = np.arange(len(score))
    for i, j in max_weight_matching(graph):
        partner[i], partner[j] = j, i
    return partner
