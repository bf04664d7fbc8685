"""Which half-branches of a junction are joined: involutions, and the one with the best total.

Two stages ask: the graph stage, to put a junction where the smoothest curves meet (`least_cost`,
many junctions at once), and routing, to say what is one stroke (`best_matching`, and all of them
ranked in `routing.alternatives`).

Half-branches of different junctions never pair, so the maximum-weight matching of the drawing
(the paper "Stroke Vectorization via Involution Prediction", section on inference) is the union of
tiny ones. Up to degree 10 all involutions are listed once and scored as one matrix product for all
junctions of that degree; above that, the blossom algorithm finds the same optimum.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from .values import Array, Pair

MAX_LISTED_DEGREE = 10  # 9,496 involutions
LARGEST_EXACT = 8  # 764 involutions; half-branches of a cluster that `least_cost` solves exactly


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


def least_cost(group: Array, pairs: Array, cost: Array, alone: float) -> Array:
    """Which pairs to join so that the whole costs least, for many groups at once.

    Args:
        group: (H,) the group of every half-branch; those of group -1 take no part.
        pairs: (K, 2) all pairs within groups, and their cost (K,).
        alone: cost of a half-branch that is joined to none.

    Returns:
        (K,) bool. Groups of up to eight half-branches are solved exactly, larger ones greedily.
    """
    chosen = np.zeros(len(pairs), bool)
    if len(pairs) == 0:
        return chosen
    size = np.bincount(group[group >= 0])
    owner = group[pairs[:, 0]]
    # Pairs come group by group, each in the order of `pair_matrix`.
    order = np.lexsort((pairs[:, 1], pairs[:, 0], owner))
    for k in np.unique(size[owner]):
        mine = order[size[owner[order]] == k]
        if k <= LARGEST_EXACT:
            table = pair_matrix(int(k)).astype(np.float64)
            mine = mine.reshape(-1, table.shape[1])
            total = cost[mine] @ table.T + alone * (k - 2 * table.sum(1))
            chosen[mine] = table[total.argmin(1)] > 0
        else:
            chosen[_greedy(pairs[mine], cost[mine], mine, 2 * alone)] = True
    return chosen


def _greedy(pairs: Array, cost: Array, ids: Array, worth: float) -> Array:
    """The ids of pairs taken one after the other, cheapest first, that cost less than `worth`."""
    taken: set[int] = set()
    picked = []
    for i in np.argsort(cost, kind="stable"):
        if cost[i] >= worth:
            break
        a, b = map(int, pairs[i])
        if a not in taken and b not in taken:
            taken |= {a, b}
            picked.append(ids[i])
    return np.array(picked, np.int64)


@lru_cache(maxsize=MAX_LISTED_DEGREE + 1)
def local_pairs(degree: int) -> tuple[tuple[Pair, ...], ...]:
    """The pairs that each of `involutions(degree)` joins, ascending."""
    return tuple(pairs_within(way) for way in involutions(degree))


def pairs_within(partner: Array) -> tuple[Pair, ...]:
    """An involution of local numbers (d,) as ascending pairs of them."""
    return tuple((i, j) for i, j in enumerate(partner.tolist()) if i < j)


def pairs_of(partner: Array, halves: Array) -> tuple[Pair, ...]:
    """An involution of local numbers as ascending pairs of half-branches."""
    own = halves.tolist()
    return tuple((own[i], own[j]) for i, j in pairs_within(partner))


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
