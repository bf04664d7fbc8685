"""The ways to route a junction, ranked, each with its probability.

A way to route a junction is an involution of its half-branches; its probability is proportional to
exp(sum of the scores of its pairs). Up to degree 10 all of them are listed and the probabilities
are exact. Above, only the best one and those that differ from it by one step are looked at, and the
probabilities are relative to these.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..involution import (
    MAX_LISTED_DEGREE,
    best_matching,
    involutions,
    local_pairs,
    pair_matrix,
    pairs_within,
)
from ..values import Alternative, Array, Pair, PlanarGraph
from .candidates import by_degree, pair_starts

KEPT = 6  # alternatives a person would look at


def ranked_alternatives(
    graph: PlanarGraph,
    pair_score: Array,
    keep: Mapping[int, tuple[Pair, ...]] | None = None,
    only: Array | None = None,
) -> tuple[tuple[Alternative, ...], ...]:
    """The best ways to route each junction and each corner, best first.

    Args:
        pair_score: (K,) log-odds of joining, in the order of `candidate_pairs`.
        keep: number of a place -> pairs that must be in the list, however improbable.
        only: numbers of the places that are wanted; the others get an empty list. None = all.

    Returns:
        For each vertex in graph.places order up to `KEPT` alternatives (one more if the kept
        way is not among them); the first is the maximum-weight matching.
    """
    keep = keep or {}
    starts = pair_starts(graph)
    found: list[tuple[Alternative, ...]] = [()] * len(graph.places)
    for junctions, halves in by_degree(graph):
        if only is not None:
            wanted = np.isin(junctions, only)
            junctions, halves = junctions[wanted], halves[wanted]
        if not len(junctions):
            continue
        degree = halves.shape[1]
        rows = starts[junctions][:, None] + np.arange(degree * (degree - 1) // 2)
        scores = np.asarray(pair_score, np.float64)[rows]
        rank = _listed if degree <= MAX_LISTED_DEGREE else _searched
        for junction, own, ranked in zip(
            junctions.tolist(), halves, rank(degree, scores), strict=True
        ):
            found[junction] = _collect(own, *ranked, keep.get(junction))
    return tuple(found)


_Ranked = tuple[Array, Array, list[tuple[Pair, ...]]]
"""(n, d) partners, best first, their (n,) probabilities, and the first few as local pairs."""


def _listed(degree: int, scores: Array) -> list[_Ranked]:
    """All involutions of each junction, best first, with exact probabilities."""
    ways = involutions(degree)
    total = scores @ pair_matrix(degree).T.astype(np.float64)
    order = np.argsort(-total, axis=1, kind="stable")
    weight = np.exp(total - total.max(1, keepdims=True))
    probability = np.take_along_axis(weight / weight.sum(1, keepdims=True), order, 1)
    pairs, first = local_pairs(degree), order[:, :KEPT].tolist()
    return [
        (ways[o], p, [pairs[way] for way in best])
        for o, p, best in zip(order, probability, first, strict=True)
    ]


def _searched(degree: int, scores: Array) -> list[_Ranked]:
    """The best involution of each junction and its neighbours, best first."""
    a, b = np.triu_indices(degree, 1)
    found = []
    for row in scores:
        matrix = np.zeros((degree, degree))
        matrix[a, b] = matrix[b, a] = row
        ways, totals = neighbourhood(matrix, best_matching(matrix))
        weight = np.exp(totals - totals[0])
        found.append((ways, weight / weight.sum(), [pairs_within(way) for way in ways[:KEPT]]))
    return found


def neighbourhood(score: Array, best: Array) -> tuple[Array, Array]:
    """An involution and all that are one step away from it, highest total first.

    A step splits a pair, or joins two things that were not a pair; their partners, if they had
    any, are then left single or joined with each other.

    Args:
        score: (d, d) symmetric scores of joining two things against ending both; diagonal 0.
        best: (d,) partners; the one with the highest total.

    Returns:
        (n, d) partners, `best` first, and their (n,) total scores.
    """
    things = np.arange(len(best))
    worth = score[things, best]
    i, j = np.triu_indices(len(best), 1)
    pair = best[i] == j
    p, q = best[i], best[j]
    gain = np.where(pair, -score[i, j], score[i, j] - worth[i] - worth[j])
    # Both had partners, which join in their turn; (i, j) and (p, q) stand for the same step.
    cross = ~pair & (p != i) & (q != j) & (np.minimum(i, j) < np.minimum(p, q))
    steps = np.concatenate([np.arange(len(i)), np.flatnonzero(cross)])
    joins = np.arange(len(steps)) >= len(i)
    gain = gain[steps] + np.where(joins, score[p[steps], q[steps]], 0.0)

    i, j, p, q, pair = (values[steps] for values in (i, j, p, q, pair))
    row = np.arange(len(steps))
    ways = np.tile(best, (len(steps), 1))
    ways[row, p], ways[row, q] = np.where(joins, q, p), np.where(joins, p, q)
    ways[row, i], ways[row, j] = np.where(pair, i, j), np.where(pair, j, i)
    order = np.argsort(-gain, kind="stable")
    total = worth.sum() / 2
    return np.vstack([best, ways[order]]), np.concatenate([[total], total + gain[order]])


def _collect(
    halves: Array,
    ways: Array,
    probability: Array,
    pairs: list[tuple[Pair, ...]],
    must: tuple[Pair, ...] | None,
) -> tuple[Alternative, ...]:
    """The first few ways as alternatives, and the one that must be there at its place."""
    own = halves.tolist()
    chosen = [
        Alternative(tuple([(own[i], own[j]) for i, j in way]), p)
        for way, p in zip(pairs, probability[:KEPT].tolist(), strict=True)
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
