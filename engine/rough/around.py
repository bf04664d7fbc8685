"""What the answers around a pair of half-branches tell of it: a second look at which lines go on.

A line that ends at one end rarely goes on at the other; what goes on most of the way round a face
is the rim of something in front, and goes on all the way; lines close where they come back to
themselves. All this is read from how probable each pair was at a first look.
"""

from __future__ import annotations

import numpy as np

from ..fills.faces import face_of_halves
from ..graph.topology import lengths
from ..values import Array, PlanarGraph

FEATURES = 18  # of a pair of half-branches
_LEAST = 1e-3  # probability that is told from zero
_THROUGH, _LOOSE = 5.0, -5.0  # log-odds of going on: at a bend, and at a loose end
_CLIP = 4.0  # log-odds, so that no single pair decides what is thought of a face


def features(graph: PlanarGraph, pairs: Array, one: Array, pen: float) -> Array:
    """(K, F) float64: how probable the pairs around each pair are, and what lines they make.

    Args:
        pairs: (K, 2), all of the junctions. one: (K,) how probable each of them is. pen: px.
    """
    halves = 2 * graph.branch_count
    a, b = pairs.T
    going = np.bincount(pairs.ravel(), np.repeat(one, 2), halves)
    ends = _log_odds(going)
    ends[graph.degrees[graph.half_vertex] == 1] = _LOOSE
    ends[graph.degrees[graph.half_vertex] == 2] = _THROUGH
    best, second = _two_best(pairs, one, halves)
    rivals = [np.where(one >= best[half], second[half], best[half]) for half in (a, b)]
    partner = _partners(graph, pairs, one, best)
    length, last, ring = _runs(graph, partner)
    closes = (last[a] == b) | (ring[a] & (partner[a] == b))
    columns = [
        _log_odds(one),
        *_both(ends[a], ends[b]),
        *_both(*(_log_odds(rival) for rival in rivals)),
        *_both(ends[a ^ 1], ends[b ^ 1]),
        *_both(_log_odds(best[a ^ 1]), _log_odds(best[b ^ 1])),
        *_both(np.log(length[a] / pen + 0.1), np.log(length[b] / pen + 0.1)),
        partner[a] == b,
        closes,
        *_faces(graph, pairs, _log_odds(one)),
    ]
    return np.column_stack(columns).astype(np.float64)


def _log_odds(probability: Array) -> Array:
    p = np.clip(probability, _LEAST, 1 - _LEAST)
    return np.log(p / (1 - p))


def _both(a: Array, b: Array) -> list[Array]:
    """Of two half-branches, whichever comes first, the less and the more."""
    return [np.minimum(a, b), np.maximum(a, b)]


def _two_best(pairs: Array, one: Array, halves: int) -> tuple[Array, Array]:
    """(2B,) of every half-branch how probable its best pair is, and its second best."""
    half, of = pairs.ravel(), np.repeat(np.arange(len(pairs)), 2)
    order = np.lexsort((-one[of], half))
    half, value = half[order], one[of][order]
    first = np.flatnonzero(np.diff(half, prepend=-1))
    best, second = np.zeros(halves), np.zeros(halves)
    best[half[first]] = value[first]
    more = first[np.diff(np.append(first, len(half))) > 1]
    second[half[more]] = value[more + 1]
    return best, second


def _partners(graph: PlanarGraph, pairs: Array, one: Array, best: Array) -> Array:
    """(2B,) the half-branch that each one goes on in, as far as can be seen, or -1."""
    partner = np.full(2 * graph.branch_count, -1)
    a, b = pairs[(one > 0.5) & (one >= best[pairs].max(1))].T
    partner[a], partner[b] = b, a
    order, starts = graph.halves_at
    bends = starts[:-1][graph.degrees == 2]
    a, b = order[bends], order[bends + 1]
    partner[a], partner[b] = b, a
    return partner


def _runs(graph: PlanarGraph, partner: Array) -> tuple[Array, Array, Array]:
    """(2B,) px from every half-branch on to where its line ends, the half-branch that lies there,
    looking back, and whether the line closes, so that it never ends."""
    halves = np.arange(2 * graph.branch_count)
    far = np.append(lengths(graph)[halves >> 1], 0.0)
    nowhere = len(halves)
    onward = np.append(np.where(partner[halves ^ 1] < 0, nowhere, partner[halves ^ 1]), nowhere)
    last = np.append(halves ^ 1, nowhere)
    most = max(float(lengths(graph).sum()), 1.0)
    for _ in range(int(np.ceil(np.log2(max(nowhere, 2)))) + 1):
        far = np.minimum(far + far[onward], most)
        last = np.where(onward == nowhere, last, last[onward])
        onward = onward[onward]
    ring = onward[:nowhere] != nowhere
    return far[:nowhere], last[:nowhere], ring


def _faces(graph: PlanarGraph, pairs: Array, odds: Array) -> list[Array]:
    """How lines go on round the face that each pair bounds, (K,) each.

    A wedge is named after its half-branch x: it lies between before[x] and x. Round its face we
    come along x ^ 1 and leave along before[x].
    """
    before, face = face_of_halves(graph)
    halves = np.arange(2 * graph.branch_count)
    a, b = pairs.T
    wedge = np.where(before[a] == b, a, np.where(before[b] == a, b, -1))
    beside = wedge >= 0
    value = np.where(before == halves, _LOOSE, _THROUGH)
    value[wedge[beside]] = odds[beside]
    known = np.zeros(len(halves), bool)
    known[wedge[beside]] = True
    around = face[halves ^ 1]
    held = np.clip(value, -_CLIP, _CLIP)
    count = np.bincount(around, known, len(halves))
    total = np.bincount(around, held * known, len(halves))
    firm = np.bincount(around, known & (value > 0), len(halves))
    here = around[wedge]
    others = np.maximum(count[here] - 1, 0)
    after = np.empty_like(before)
    after[before] = halves
    rim = [
        *_both(value[after[wedge ^ 1]], value[before[wedge] ^ 1]),
        (total[here] - held[wedge]) / np.maximum(others, 1),
        (firm[here] - (odds > 0)) / np.maximum(others, 1),
        np.log1p(others),
    ]
    return [np.where(beside, column, 0.0) for column in rim]
