"""Whether a stroke goes on at a corner: one line that turns, or two that meet.

Nobody can tell every corner by itself: ends that meet exactly look like a turn. But an artist
draws alike all over a page. So a small network weighs the clues of each corner (`graph.lifts`)
against the means of those of the whole page, and what the user has decided at others. And unless
a page's sharp corners look lifted at on the whole, hardly any stroke ends at one: most artists run
around their corners, and one wrong cut spoils a whole stroke.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..graph.clues import WEIGHTS, available
from ..graph.lifts import ARM, LEAST_ARM
from ..perceptron import forward, load, probability
from ..values import Alternative, Array, Pair, PlanarGraph
from .candidates import candidate_pairs
from .encoding import along

UNSEEN = 4.0  # log-odds of going on where nothing was seen: lines of older drawings are whole
_NEVER = 1e-4  # a lift that is less probable is no lift for any bias
# The habit of a page is how probable lifts are at its sharp corners on the whole. With these limits
# (tips counted as well) none of 133 held-out pages as drawn loses more than 0.05 of F1, and 118 of
# who lifts win 0.039.
# Corners that turn by more than _SHARP tell of the habit, but for tips: a scribble runs through its
# own, though they look lifted at. With 120 degrees the gain on pages of who lifts is gone.
_SHARP, _TIP = np.radians(45.0), np.radians(135.0)
_USUAL = 0.1  # how probable a lift is at one more such corner, which every page is thought to have
_HABIT = 0.5  # from this habit on there is half the caution or less ...
_CHANGE = 0.05  # ... and a habit so much higher or lower takes it to a quarter, or three quarters
_CAUTION = 4.0  # log-odds against each lift where nobody lifts: 0.98 is asked for, not 0.5


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
    if not known.any():
        return found
    found[known] = judged(graph.clues[known].astype(np.float64), decided[known], load(WEIGHTS))
    found[known] += caution(found[known], decided[known], _turns(graph)[known])
    return found


def caution(log_odds: Array, decided: Array, turns: Array) -> float:
    """What is added to the log-odds of going on at all corners of a page: the less its artist
    seems to lift the pen at corners, the more. It has no steps, at which noise would decide how a
    whole page is drawn.

    Args:
        log_odds: (C,) of going on. decided: as in `judged`; what was decided is certain.
        turns: (C,) by how much the line turns, radians.
    """
    telling = (turns > _SHARP) & (turns < _TIP)
    lift = np.where(decided == 0, probability(-log_odds), decided < 0)[telling]
    habit = (float(lift.sum()) + _USUAL) / (len(lift) + 1)
    return _CAUTION * float(probability(np.array((_HABIT - habit) / _CHANGE)))


def _turns(graph: PlanarGraph) -> Array:
    """(C,) by how much the line turns at each corner, radians."""
    pen = LEAST_ARM / ARM if graph.widths is None else float(np.median(graph.widths))
    away = along(graph, np.array([max(float(LEAST_ARM), ARM * pen)]))[0][:, 0]
    a, b = candidate_pairs(graph)[-len(graph.corners) :].T
    return np.abs(np.angle(-away[b] * np.conj(away[a])))


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
