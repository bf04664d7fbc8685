"""Few-point curves: cubic Bezier segments within a tolerance of the samples, corners kept.

Least squares with given end tangents and Newton steps for the parameters (Schneider, "An Algorithm
for Automatically Fitting Digitized Curves", Graphics Gems 1990), for all segments at once; those
that stray too far are split at their worst sample, round by round. Splitting leaves more anchors
than are needed: at last every other one is tried to do without.
"""

from __future__ import annotations

import numpy as np

from ..values import Array
from .simplify import runs, worst_of

_NEWTON = 6  # steps that move the parameters to the nearest points of the curve
_MERGES = 6  # rounds of trying to do without anchors
_EVEN = 16  # rounds after which segments are halved


def fit(
    points: Array, run: Array, keep: Array, corner: Array, tolerance: float
) -> tuple[Array, Array]:
    """Choose anchors and handles.

    Args:
        points: (N, 2) samples; run: (N,) a number for each line that they belong to.
        keep: (N,) bool, samples that become anchors in any case, the ends of every run among them.
        corner: (N,) bool, where the curve may turn, the ends of every run among them.
        tolerance: greatest distance of a sample from the curve.

    Returns:
        (N,) bool, the anchors, and (N, 2, 2) left and right handles, valid at anchors; the outer
        handles at the ends of a run are the ends themselves.
    """
    anchor = keep.copy()
    left, right = points.copy(), points.copy()
    ahead, back = _tangents(points, corner)
    stops = np.flatnonzero(keep)
    same = run[stops[:-1]] == run[stops[1:]]
    first, last = stops[:-1][same], stops[1:][same]
    for turn in range(64):
        if not len(first):
            break
        inner_a, inner_b, worst, error = _fit_all(points, ahead, back, first, last, tolerance)
        split = (error > tolerance) & (last - first > 1)
        done = ~split
        right[first[done]], left[last[done]] = inner_a[done], inner_b[done]
        first, last, worst = first[split], last[split], worst[split]
        if turn > _EVEN:
            worst = (first + last) // 2
        anchor[worst] = True
        first, last = np.concatenate([first, worst]), np.concatenate([worst, last])
    for turn in range(_MERGES):
        spare = _every_other(anchor, keep, turn % 2)
        stops = np.flatnonzero(anchor)
        place = np.searchsorted(stops, spare)
        first, last = stops[place - 1], stops[place + 1]
        if not len(first):
            continue
        inner_a, inner_b, _, error = _fit_all(points, ahead, back, first, last, tolerance)
        good = error <= tolerance
        anchor[spare[good]] = False
        right[first[good]], left[last[good]] = inner_a[good], inner_b[good]
    return anchor, np.stack([left, right], 1)


def _every_other(anchor: Array, keep: Array, odd: int) -> Array:
    """The anchors that need not be, of neighbours only one: counted from the last that must be."""
    stops = np.flatnonzero(anchor)
    place = np.arange(len(stops))
    must = np.maximum.accumulate(np.where(keep[stops], place, 0))
    return stops[(place > must) & ((place - must) % 2 == odd)]


def _tangents(points: Array, corner: Array) -> tuple[Array, Array]:
    """Unit directions in which the line leaves each sample forward and backward."""
    step = np.diff(points, axis=0)
    forward, backward = np.vstack([step, -step[-1:]]), np.vstack([step[:1], -step])
    through = np.zeros_like(points)
    through[1:-1] = points[2:] - points[:-2]
    forward = np.where(corner[:, None], forward, through)
    backward = np.where(corner[:, None], backward, -through)
    return _unit(forward), _unit(backward)


def _unit(vectors: Array) -> Array:
    return vectors / np.maximum(np.hypot(*vectors.T), 1e-12)[:, None]


def _fit_all(
    points: Array, ahead: Array, back: Array, first: Array, last: Array, tolerance: float
) -> tuple[Array, Array, Array, Array]:
    """One cubic for each stretch: its two handles, its worst sample and the error there."""
    sample, stretch, begin = runs(first, last)
    t = (sample - first[stretch]) / (last - first)[stretch]
    a, b = points[first], points[last]
    da, db = ahead[first], back[last]
    chord = np.hypot(*(b - a).T)
    target = points[sample]
    for step in range(_NEWTON + 1):
        b0, b1, b2, b3 = (1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3
        rest = target - (b0 + b1)[:, None] * a[stretch] - (b2 + b3)[:, None] * b[stretch]
        c11 = np.add.reduceat(b1 * b1, begin)
        c22 = np.add.reduceat(b2 * b2, begin)
        c12 = np.add.reduceat(b1 * b2, begin) * (da * db).sum(1)
        x1 = np.add.reduceat(b1 * (rest * da[stretch]).sum(1), begin)
        x2 = np.add.reduceat(b2 * (rest * db[stretch]).sum(1), begin)
        det = c11 * c22 - c12 * c12
        safe = np.where(np.abs(det) > 1e-9 * c11 * c22, det, 1.0)
        alpha, beta = (x1 * c22 - x2 * c12) / safe, (x2 * c11 - x1 * c12) / safe
        length = chord / 3
        good = (safe == det) & (alpha > 0.05 * length) & (beta > 0.05 * length)
        alpha, beta = np.where(good, alpha, length), np.where(good, beta, length)
        p, q = a + alpha[:, None] * da, b + beta[:, None] * db
        curve = (
            b0[:, None] * a[stretch]
            + b1[:, None] * p[stretch]
            + b2[:, None] * q[stretch]
            + b3[:, None] * b[stretch]
        )
        away = curve - target
        if step == _NEWTON:
            break
        d1 = 3 * (
            ((1 - t) ** 2)[:, None] * (p - a)[stretch]
            + (2 * t * (1 - t))[:, None] * (q - p)[stretch]
            + (t**2)[:, None] * (b - q)[stretch]
        )
        d2 = 6 * (
            (1 - t)[:, None] * (q - 2 * p + a)[stretch] + t[:, None] * (b - 2 * q + p)[stretch]
        )
        slope = (d1 * d1).sum(1) + (away * d2).sum(1)
        move = (away * d1).sum(1) / np.where(np.abs(slope) > 1e-9, slope, np.inf)
        t = np.clip(t - np.clip(move, -0.1, 0.1), 0.0, 1.0)
    worst, error = worst_of(np.hypot(*away.T), tolerance, begin, sample)
    return p, q, worst, error
