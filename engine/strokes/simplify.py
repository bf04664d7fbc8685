"""Fewer points: what lies within a tolerance of the line between its neighbours goes.

Ramer, Douglas and Peucker's method, all strokes at once and round by round: in each round every
stretch that strays too far is split at its farthest sample.
"""

from __future__ import annotations

import numpy as np

from ..arrays.ragged import ranges
from ..values import Array

_STEPS = 32  # of the tolerance, to which errors are rounded up; see `worst_of`
_EVEN = 24  # rounds after which stretches are halved, so that no line costs more than n log n


def simplify(points: Array, keep: Array, tolerance: float) -> Array:
    """Which samples to keep, (N,) bool.

    Args:
        points: (N, D), D >= 2; further columns (width, ...) count like coordinates.
        keep: (N,) bool; samples that stay in any case, the ends of every run among them.
        tolerance: greatest distance of a dropped sample from the line that replaces it.
    """
    kept = keep.copy()
    stops = np.flatnonzero(kept)
    first, last = stops[:-1], stops[1:]
    for turn in range(64):
        first, last = _longer_than(first, last, 1)
        if not len(first):
            break
        worst, distance = _farthest(points, first, last, tolerance)
        split = distance > tolerance
        middle = (first + last) // 2 if turn > _EVEN else worst
        first, last, middle = first[split], last[split], middle[split]
        kept[middle] = True
        first, last = np.concatenate([first, middle]), np.concatenate([middle, last])
    return kept


def runs(first: Array, last: Array) -> tuple[Array, Array, Array]:
    """All samples of the stretches first..last, ends included.

    Returns:
        sample index, number of the stretch it belongs to, and where each stretch begins in these.
    """
    size = last - first + 1
    begin = np.cumsum(size) - size
    stretch = np.repeat(np.arange(len(size)), size)
    return ranges(first, size), stretch, begin


def worst_of(error: Array, tolerance: float, begin: Array, sample: Array) -> tuple[Array, Array]:
    """The greatest error of each stretch, and the sample where it is first met.

    Errors are rounded up to small parts of the tolerance: along a gentle bend many samples are
    about as far off, and the last bits of their positions shall not decide between them.
    """
    unit = max(tolerance / _STEPS, 1e-9)
    error = np.ceil(error / unit) * unit
    greatest = np.maximum.reduceat(error, begin)
    size = np.diff(np.append(begin, len(error)))
    hit = np.flatnonzero(error == np.repeat(greatest, size))
    stretch = np.searchsorted(begin, hit, side="right") - 1
    first_hit = hit[np.unique(stretch, return_index=True)[1]]
    return sample[first_hit], greatest


def _longer_than(first: Array, last: Array, steps: int) -> tuple[Array, Array]:
    long = last - first > steps
    return first[long], last[long]


def _farthest(points: Array, first: Array, last: Array, tolerance: float) -> tuple[Array, Array]:
    """The inner sample of each stretch that is farthest from its chord, and how far it is."""
    sample, stretch, begin = runs(first, last)
    start, chord = points[first], points[last] - points[first]
    size = np.maximum((chord * chord).sum(1), 1e-12)
    away = points[sample] - start[stretch]
    t = np.clip((away * chord[stretch]).sum(1) / size[stretch], 0.0, 1.0)
    away -= t[:, None] * chord[stretch]
    distance = np.sqrt((away * away).sum(1))
    distance[begin] = distance[begin + last - first] = -1.0
    return worst_of(distance, tolerance, begin, sample)
