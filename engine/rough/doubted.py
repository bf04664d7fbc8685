"""The bundles of a rough drawing that can be asked about: is it one line or two?

Two strokes that run beside each other are a question, unless a third one ties both together more
strongly than they hold to each other: then the questions are about that one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays.ragged import ranges
from ..values import Alternative, Answers, Array, Bundle
from .answered import Answered
from .cleaning import ONE, Bundled
from .sampled import SPACING

_MISSED = 12.0  # px along a stroke without a rung that end a run
_WINDOW = 12  # samples to either side, over which a probability is even: half a stretch
_SURE = 0.02  # of being wrong; what is surer than that is no question


@dataclass(frozen=True, eq=False)
class Runs:
    """Where two strokes run beside each other, taken from both sides: Q of them.

    strokes: (Q, 2), the lower number first. span: (Q, 2) px along the first, working pixels.
    middle: (Q, 2) px. probability: (Q,) that both are one line; in_force, settled, tied: (Q,) bool:
    they are one line now; an answer decided that; a third stroke ties them more strongly.
    of_rung: (K,) the number of the run that each rung is part of, or -1.
    """

    strokes: Array
    span: Array
    middle: Array
    probability: Array
    in_force: Array
    settled: Array
    tied: Array
    of_rung: Array


def bundles_of(
    asked: Answered, answers: Answers, says: Array, scale: float, first: int
) -> tuple[Bundle, ...]:
    """All that can be asked, in the order of the strokes.

    Args:
        says: (S,) bool, pencil strokes that are part of a line; of two others nothing is asked.
        scale: input pixels per working pixel. first: number of the first of them.
    """
    runs = runs_of(asked)
    answer = answers_at(answers, runs.strokes, scale * runs.span)
    sure = np.where(runs.in_force, 1 - runs.probability, runs.probability) < _SURE
    open_ones = ~runs.tied & ~runs.settled & ~sure & says[runs.strokes].any(1)
    found: list[Bundle] = []
    for k in np.flatnonzero(open_ones | (answer >= 0)).tolist():
        a, b = runs.strokes[k].tolist()
        chance = float(runs.probability[k])
        ways = [Alternative(((a, b),), chance), Alternative((), 1 - chance)]
        found.append(
            Bundle(
                index=first + len(found),
                position=(float(scale * runs.middle[k, 0]), float(scale * runs.middle[k, 1])),
                strokes=(a, b),
                span=(float(scale * runs.span[k, 0]), float(scale * runs.span[k, 1])),
                pairs=((a, b),) if runs.in_force[k] else (),
                alternatives=tuple(sorted(ways, key=lambda way: -way.probability)),
                locked=bool(answer[k] >= 0),
            )
        )
    return tuple(found)


def answers_at(answers: Answers, strokes: Array, spans: Array) -> Array:
    """(Q,) number of the answer to the question about two strokes that has most of a span; -1."""
    found, most = np.full(len(strokes), -1), np.zeros(len(strokes))
    for number, (pair, (low, high)) in enumerate(zip(answers.strokes, answers.spans, strict=True)):
        shared = np.minimum(spans[:, 1], high) - np.maximum(spans[:, 0], low) + SPACING
        more = (strokes == pair).all(1) & (shared > most) & (shared > 0.5 * np.ptp(spans, axis=1))
        found[more], most[more] = number, shared[more]
    return found


def runs_of(asked: Answered) -> Runs:
    """Everything that runs beside each other, but a stroke beside itself."""
    found, of = asked.bundles, asked.bundles.rungs
    stroke, place = found.strokes.stroke, found.strokes.place
    apart = np.flatnonzero(stroke[of.a] != stroke[of.b])
    a, b = of.a[apart], of.b[apart]
    forth = stroke[a] < stroke[b]
    low, high = np.where(forth, a, b), np.where(forth, b, a)
    order = np.lexsort((place[low], stroke[high], stroke[low]))
    low, high, rung = low[order], high[order], apart[order]
    new = np.ones(len(low), bool)
    new[1:] = (np.diff(stroke[low]) != 0) | (np.diff(stroke[high]) != 0)
    new[1:] |= np.diff(place[low]) > _MISSED
    chance = found.probability[rung]
    new[1:] |= np.diff(_evened(chance, new) > ONE)
    first = np.flatnonzero(new)
    size = np.diff(np.append(first, len(low)))
    run = np.cumsum(new) - 1

    def mean(values: Array) -> Array:
        return np.bincount(run, values, len(first)) / np.maximum(size, 1)

    of_rung = np.full(len(of.a), -1)
    of_rung[rung] = run
    half = first + size // 2
    points = found.strokes.points
    last = first + size - 1
    return Runs(
        np.stack([stroke[low[first]], stroke[high[first]]], 1),
        np.stack([place[low[first]], place[low[last]]], 1),
        (points[low[half]] + points[high[half]]) / 2,
        mean(chance),
        mean(found.one[rung]) > 0.5,
        mean(asked.settled[rung]) > 0.5,
        mean(_tied(found)[rung]) > 0.5,
        of_rung,
    )


def _evened(values: Array, new: Array) -> Array:
    """(K,) the mean of values around each, within its run."""
    total = np.concatenate([[0.0], np.cumsum(values)])
    first = np.append(np.flatnonzero(new), len(values))
    run = np.cumsum(new) - 1
    index = np.arange(len(values))
    start = np.maximum(index - _WINDOW, first[run])
    stop = np.minimum(index + _WINDOW + 1, first[run + 1])
    return (total[stop] - total[start]) / (stop - start)


def _tied(found: Bundled) -> Array:
    """(K,) bool: rungs whose two strokes both hold more strongly to a third one beside them."""
    of, stroke, count = found.rungs, found.strokes.stroke, len(found.strokes.length)
    # What lies beside each sample: the other stroke, and how probably it is the same line.
    key = np.concatenate([of.a * count + stroke[of.b], of.b * count + stroke[of.a]])
    chance = np.tile(found.probability, 2)
    order = np.lexsort((-chance, key))
    key, chance = key[order], chance[order]
    best = np.diff(key, prepend=-1) != 0
    key, chance = key[best], chance[best]
    first = np.searchsorted(key, np.arange(len(found.strokes.points) + 1) * count)
    size = np.diff(first)[of.a]
    rung = np.repeat(np.arange(len(of.a)), size)
    beside = ranges(first[of.a], size)
    third = key[beside] % count
    other = of.b[rung] * count + third
    there = np.minimum(np.searchsorted(key, other), max(len(key) - 1, 0))
    weaker = np.where(key[there] == other, np.minimum(chance[beside], chance[there]), 0.0)
    new = (third != stroke[of.a[rung]]) & (third != stroke[of.b[rung]])
    return np.bincount(rung, new & (weaker > found.probability[rung]), len(of.a)) > 0
