"""The ways to route a junction, ranked, each with its probability.

A way to route a junction is an involution of its half-branches; its probability is proportional to
exp(sum of the scores of its pairs). Up to degree 10 all of them are listed and the probabilities
are exact. Above, the best few are searched, and the probabilities are relative to those few.
"""

from __future__ import annotations

import heapq
from collections.abc import Mapping

import numpy as np

from ..values import Alternative, Pair, PlanarGraph
from .halves import by_degree, pair_starts
from .matching import MAX_LISTED_DEGREE, best_matching, involutions, pair_matrix, pairs_of

Array = np.ndarray

KEPT = 6  # alternatives a person would look at
_SEARCHED = 12  # ways listed at junctions too large to list all


def ranked_alternatives(
    graph: PlanarGraph, pair_score: Array, keep: Mapping[int, tuple[Pair, ...]] | None = None
) -> tuple[tuple[Alternative, ...], ...]:
    """The best ways to route each junction, best first.

    Args:
        pair_score: (K,) log-odds of joining, in the order of `candidate_pairs`.
        keep: junction number -> pairs that must be in the list, however improbable.

    Returns:
        For each junction in graph.junctions order up to `KEPT` alternatives (one more if the kept
        way is not among them); the first is the maximum-weight matching.
    """
    keep = keep or {}
    starts = pair_starts(graph)
    found: list[tuple[Alternative, ...]] = [()] * len(graph.junctions)
    for junctions, halves in by_degree(graph):
        degree = halves.shape[1]
        rows = starts[junctions][:, None] + np.arange(degree * (degree - 1) // 2)
        scores = np.asarray(pair_score, np.float64)[rows]
        rank = _listed if degree <= MAX_LISTED_DEGREE else _searched
        for junction, own, (ways, probability) in zip(
            junctions, halves, rank(degree, scores), strict=True
        ):
            must = keep.get(int(junction))
            found[junction] = _collect(own, ways, probability, must)
    return tuple(found)


def _listed(degree: int, scores: Array) -> list[tuple[Array, Array]]:
    """All involutions of each junction, best first, with exact probabilities."""
    ways = involutions(degree)
    total = scores @ pair_matrix(degree).T.astype(np.float64)
    order = np.argsort(-total, axis=1, kind="stable")
    weight = np.exp(total - total.max(1, keepdims=True))
    probability = np.take_along_axis(weight / weight.sum(1, keepdims=True), order, 1)
    return [(ways[o], p) for o, p in zip(order, probability, strict=True)]


def _searched(degree: int, scores: Array) -> list[tuple[Array, Array]]:
    """The best `_SEARCHED` involutions of each junction, probabilities relative to these."""
    a, b = np.triu_indices(degree, 1)
    found = []
    for row in scores:
        matrix = np.zeros((degree, degree))
        matrix[a, b] = matrix[b, a] = row
        ways, total = best_matchings(matrix, _SEARCHED)
        weight = np.exp(total - total.max())
        found.append((ways, weight / weight.sum()))
    return found


def best_matchings(score: Array, count: int, budget: int = 4000) -> tuple[Array, Array]:
    """The `count` involutions with the greatest total score, best first.

    Best-first search over partial involutions. What the undecided things can still add is bounded
    by half of the best score of each, so that ways come out in their true order. Should the budget
    of steps run out, the best way of all (by the blossom algorithm) is still among those returned.

    Args:
        score: (d, d) symmetric scores of joining two things against ending both; diagonal 0.

    Returns:
        (n, d) int8 partners, n <= count, and their (n,) total scores.
    """
    degree = len(score)
    hope = np.maximum(score.max(1), 0.0) / 2
    best = best_matching(score).astype(np.int8)
    total = float(score[np.arange(degree), best].sum() / 2)
    found, totals = [best], [total]
    heap: list[tuple[float, float, tuple[int, ...]]] = [(-float(hope.sum()), 0.0, ())]
    while heap and budget > 0 and len(found) < count:
        budget -= 1
        _, gain, mates = heapq.heappop(heap)
        if len(mates) == degree:
            if any(mates[i] != best[i] for i in range(degree)):
                found.append(np.array(mates, np.int8))
                totals.append(gain)
            continue
        # `mates` decides things in ascending order; -1 has not been reached yet.
        thing = len(mates)
        taken = {mate: k for k, mate in enumerate(mates)}
        if thing in taken:
            choices = [taken[thing]]
        else:
            choices = [thing, *(j for j in range(thing + 1, degree) if j not in taken)]
        for mate in choices:
            joined = gain + (float(score[thing, mate]) if mate > thing else 0.0)
            more = (*mates, mate)
            ahead = [j for j in range(thing + 1, degree) if j not in more]
            heapq.heappush(heap, (-(joined + float(hope[ahead].sum())), joined, more))
    return np.array(found), np.array(totals)


def _collect(
    halves: Array, ways: Array, probability: Array, must: tuple[Pair, ...] | None
) -> tuple[Alternative, ...]:
    """The first few ways as alternatives, and the one that must be there at its place."""
    chosen = [
        Alternative(pairs_of(way, halves), float(p))
        for way, p in zip(ways[:KEPT], probability[:KEPT], strict=True)
    ]
    if must is not None and all(a.pairs != must for a in chosen):
        wanted = local_partner(must, halves)
        same = np.flatnonzero((ways == wanted).all(1))
        chosen.append(Alternative(must, float(probability[same[0]]) if len(same) else 0.0))
    return tuple(chosen)


def local_partner(pairs: tuple[Pair, ...], halves: Array) -> Array:
    """Pairs of half-branches as partners among the half-branches of their junction, (d,) int."""
    partner = np.arange(len(halves))
    for a, b in pairs:
        i, j = np.searchsorted(halves, [a, b])
        partner[i], partner[j] = j, i
    return partner
