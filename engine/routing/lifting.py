"""Whether a stroke goes on at a corner: one line that turns, or two that meet.

Nobody can tell every corner by itself: ends that meet exactly look like a turn. But an artist
draws alike all over a page. So a small network weighs the clues of each corner (`graph.lifts`)
against the means of those of the whole page, and what the user has decided at others.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..graph.clues import WEIGHTS, available
from ..perceptron import forward, load, probability
from ..values import Alternative, Array, Pair, PlanarGraph

UNSEEN = 4.0  # log-odds of going on where nothing was seen: lines of older drawings are whole
_NEVER = 1e-4  # a lift that is less probable is no lift for any bias


def score(graph: PlanarGraph, fixed: Mapping[int, tuple[Pair, ...]]) -> Array:
    """(C,) float32 log-odds that a stroke goes on at each corner.

    Args:
        fixed: number of a place -> the pairs that the user has decided there.

    Raises:
        InvoluteError: the weights are damaged.
    """
    if graph.clues is None or not len(graph.clues) or not available():
        return np.full(len(graph.corners), UNSEEN, np.float32)
    first = len(graph.junctions)
    decided = np.zeros(len(graph.clues))
    for place, pairs in fixed.items():
        if place >= first:
            decided[place - first] = 1.0 if pairs else -1.0
    known = np.isfinite(graph.clues).all(1)  # a cut that the user made was never looked at
    found = np.full(len(known), UNSEEN, np.float32)
    found[known] = judged(graph.clues[known].astype(np.float64), decided[known], load(WEIGHTS))
    return found


def judged(clues: Array, decided: Array, net: Mapping[str, Array]) -> Array:
    """(C,) log-odds of going on, given all corners of a page.

    Args:
        clues: (C, K). decided: (C,) 1 where the user joined, -1 where not, 0 where he said nothing.
    """
    about = page_of(clues, decided)
    rows = np.concatenate([clues, np.tile(about, (len(clues), 1))], axis=1)
    return forward(rows, net, "judge_")[:, 0]


def page_of(clues: Array, decided: Array) -> Array:
    """(2 K + 2,) the habit of a page: the mean of the clues and how much they differ, which share
    of the decided corners goes on, and how many were decided."""
    count = np.abs(decided).sum()
    said = [decided.sum() / (count + 1.0), count / (count + 3.0)]
    return np.concatenate([clues.mean(0), clues.std(0), said])


def goes_on(log_odds: Array, bias: float) -> Array:
    """(C,) bool: which corners a stroke runs through.

    Args:
        bias: -1 = all of them, 0 = where that is more probable, 1 = none where the pen may have
            been lifted at all.
    """
    lift = probability(-np.asarray(log_odds))
    return (lift <= (1.0 - bias) / 2) | (lift < _NEVER)


def alternatives(pairs: Array, log_odds: Array) -> tuple[tuple[Alternative, ...], ...]:
    """The two ways to route each corner, the more probable one first.

    Args:
        pairs: (C, 2) its half-branches. log_odds: (C,) of joining them.
    """
    found = []
    for (a, b), p in zip(pairs.tolist(), probability(log_odds).tolist(), strict=True):
        ways = (Alternative(((a, b),), p), Alternative((), 1.0 - p))
        found.append(ways if p > 0.5 else ways[::-1])
    return tuple(found)
