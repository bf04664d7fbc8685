"""Which stroke of one frame is which stroke of the next.

Every stroke becomes a few evenly spaced samples. How far a pair lies apart, in place and in shape,
is its cost; the cheapest one-to-one assignment of all strokes is found by an auction (Bertsekas,
"The auction algorithm", 1988) among each stroke's few nearest candidates. What moved together is
then moved along, first as a whole, then region by region, and the matching is asked again: an arm
that swings by more than the distance between two lines is followed like that.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from ..arrays.ragged import offsets_of, owners, steps
from ..values import Array, Stroke

SAMPLES = 32  # per stroke
_CANDIDATES = 10  # strokes that one stroke may turn out to be
_NEIGHBOURS = 8  # matched strokes that say how the region around a stroke moves
_REACH = 0.12  # of the drawing's diagonal: how far a stroke may move on its own at first
_SHAPE = 0.22  # of its length: how far the samples of a stroke may move against each other
_ROUNDS = 5
_UNMATCHED = 1.0  # the cost of leaving a stroke without a partner


@dataclass(frozen=True, eq=False)
class Matches:
    """Pairs of strokes that are one line at two times.

    old, new: (M,) int32 stroke numbers, ascending in old; each appears at most once.
    flipped: (M,) bool; the new stroke runs the other way round.
    start: (M,) float32 in [0, 1); for two closed strokes, the share of the new one's length, in
        the direction that it runs now, after which the old one starts; else 0.
    motion: (2, 3) float32, the similarity that moves the old drawing as a whole onto the new one.
    """

    old: Array
    new: Array
    flipped: Array
    start: Array
    motion: Array


def match_strokes(old: Sequence[Stroke], new: Sequence[Stroke]) -> Matches:
    """Match the strokes of two neighbouring frames; both in pixels of the same page.

    Only strokes of one kind are matched: both closed or both open, and of exactly one colour.
    About n log n in the strokes.
    """
    still = np.array([[1, 0, 0], [0, 1, 0]], np.float32)
    if not old or not new:
        none = np.zeros(0, np.int32)
        return _matches(none, none, none, still)
    before, after = sample_strokes(old), sample_strokes(new)
    colors = {color: 2 * k for k, color in enumerate({s.color for s in (*old, *new)})}
    here, there = (np.array([colors[s.color] + s.closed for s in frame]) for frame in (old, new))
    # The drawing may have crossed the page: start from both in place and centred, keep the better.
    centred = still.copy()
    centred[:, 2] = after.mean(axis=(0, 1)) - before.mean(axis=(0, 1))
    return min(
        (_follow_motion(before, after, (here, there), motion) for motion in (still, centred)),
        key=lambda result: result[0],
    )[1]


def sample_strokes(strokes: Sequence[Stroke], count: int = SAMPLES) -> Array:
    """Points at even steps along every stroke, (N, count, 2) float32, px.

    Open strokes are sampled from end to end, closed ones once around without the start again.
    """
    points = [np.vstack([s.points, s.points[:1]]) if s.closed else s.points for s in strokes]
    offsets = offsets_of([len(p) for p in points])
    packed = np.concatenate(points).astype(np.float64)
    way = np.cumsum(steps(packed, offsets))
    first, last = way[offsets[:-1]], way[offsets[1:] - 1]
    closed = np.array([s.closed for s in strokes])
    share = np.arange(count) / np.where(closed, count, count - 1)[:, None]
    # All strokes lie on one axis, one after the other, a little apart: one interp serves them all.
    number = np.arange(len(strokes))[:, None]
    at = first[:, None] + share * (last - first)[:, None] + number
    axis = way + owners(offsets)
    out = [np.interp(at.ravel(), axis, packed[:, k]) for k in (0, 1)]
    return np.stack(out, 1).reshape(len(strokes), count, 2).astype(np.float32)


def _follow_motion(
    before: Array, after: Array, kinds: tuple[Array, Array], motion: Array
) -> tuple[float, Matches]:
    """Match, let matched strokes carry their surroundings along, match again; cost and result."""
    box = np.vstack([before.reshape(-1, 2), after.reshape(-1, 2)])
    reach = _REACH * float(np.hypot(*np.ptp(box, axis=0))) + 1.0
    base = moved = cv2.transform(before, motion).reshape(before.shape)
    for round_ in range(_ROUNDS):
        old, new, variant, cost = _assign(moved, after, kinds, reach)
        if len(old) <= _NEIGHBOURS or round_ == _ROUNDS - 1:
            break
        target = _oriented(after[new], kinds[1][new] & 1, variant)
        if round_ == 0:
            fitted, _ = cv2.estimateAffinePartial2D(
                before[old].reshape(-1, 2),
                target.reshape(-1, 2),
                method=cv2.RANSAC,
                ransacReprojThreshold=0.25 * reach,
            )
            motion = motion if fitted is None else fitted.astype(np.float32)
            base = moved = cv2.transform(before, motion).reshape(before.shape)
        else:
            moved = _carry(base, old, target)
        reach *= 0.8
    return cost, _matches(old, new, variant, motion)


def _carry(base: Array, old: Array, target: Array) -> Array:
    """Move every stroke as the matched strokes around it do, never by its own match alone."""
    centre = base.mean(axis=1)
    travel = target.mean(axis=1) - centre[old]
    near, distance = _nearest(centre[old], centre, _NEIGHBOURS + 1)
    weight = 1.0 / (1.0 + distance / (distance[:, -1:] + 1e-6))
    own = np.full(len(base), -1)
    own[old] = np.arange(len(old))
    weight = np.where(near == own[:, None], 0.0, weight)
    # The median, not the mean: one wrong match must not pull its neighbours along.
    shift = np.stack([_weighted_median(travel[near, k], weight) for k in (0, 1)], 1)
    return base + shift[:, None].astype(np.float32)


def _weighted_median(values: Array, weights: Array) -> Array:
    """Row-wise; 0 where all weights are 0."""
    order = np.argsort(values, axis=1)
    values = np.take_along_axis(values, order, 1)
    mass = np.cumsum(np.take_along_axis(weights, order, 1), axis=1)
    middle = np.argmax(mass >= 0.5 * mass[:, -1:], axis=1)
    rows = np.arange(len(values))
    return np.where(mass[:, -1] > 0, values[rows, middle], 0.0)


def _assign(
    before: Array, after: Array, kinds: tuple[Array, Array], reach: float
) -> tuple[Array, Array, Array, float]:
    """The cheapest assignment: old and new numbers, variant of each pair, total cost."""
    count = min(_CANDIDATES, len(after))
    near, _ = _nearest(_summary(after), _summary(before), count)
    rows = np.repeat(np.arange(len(before)), count)
    cost, variant = _pair_costs(before, after, kinds, rows, near.ravel(), reach)
    chosen = _auction(near, cost.reshape(near.shape), len(after))
    old = np.flatnonzero(chosen >= 0)
    pick = old * count + chosen[old]
    total = float(cost[pick].sum()) + _UNMATCHED * (len(before) - len(old))
    return old, near[old, chosen[old]], variant[pick], total


def _summary(samples: Array) -> Array:
    """What candidates are looked up by: middle and spread, the same for either direction."""
    return np.hstack([samples.mean(axis=1), samples.std(axis=1)])


def _pair_costs(
    before: Array,
    after: Array,
    kinds: tuple[Array, Array],
    rows: Array,
    cols: Array,
    reach: float,
) -> tuple[Array, Array]:
    """Cost of each pair and its best variant: 0 as is, 1 reversed, 2 s + r for closed strokes.

    A closed stroke may start at any of its samples (s) and run either way (r).
    """
    cost = np.full(len(rows), np.inf)
    variant = np.zeros(len(rows), np.int32)
    alike = kinds[0][rows] == kinds[1][cols]
    for closed in (0, 1):
        here = np.flatnonzero(alike & (kinds[0][rows] & 1 == closed))
        a, b = before[rows[here]], after[cols[here]]
        place = b.mean(axis=1) - a.mean(axis=1)
        a, b = (s - s.mean(axis=1, keepdims=True) for s in (a, b))
        likeness = _likeness(a, b, closed)
        best = likeness.argmax(axis=1)
        power = (a**2).sum(axis=(1, 2)) + (b**2).sum(axis=(1, 2))
        shape = (power - 2 * likeness[np.arange(len(here)), best]) / SAMPLES
        scale = 0.5 * _SHAPE * (_length(a) + _length(b)) + 0.1 * reach
        cost[here] = (place**2).sum(axis=1) / reach**2 + np.maximum(shape, 0) / scale**2
        variant[here] = best
    return cost, variant


def _likeness(a: Array, b: Array, closed: int) -> Array:
    """Inner product of each pair of shapes in every variant, (n, 2) or for closed (n, 2 S)."""
    if not closed:
        return np.stack([(a * b).sum(axis=(1, 2)), (a * b[:, ::-1]).sum(axis=(1, 2))], 1)
    # All shifts at once are a circular correlation; the product of complex points holds both axes.
    a, b = (np.fft.fft(s[..., 0] + 1j * s[..., 1], axis=1) for s in (a, b))
    backward = np.roll(b[:, ::-1], 1, axis=1)  # the transform of b read the other way round
    forward, reverse = (np.fft.ifft(np.conj(a) * c, axis=1).real for c in (b, backward))
    return np.stack([forward, reverse], 2).reshape(-1, 2 * SAMPLES)


def _oriented(samples: Array, closed: Array, variant: Array) -> Array:
    """Samples read in the direction, and for closed strokes from the start, of each variant."""
    steps = np.arange(SAMPLES)
    reverse, shift = (variant & 1)[:, None], (variant >> 1)[:, None]
    index = np.where(reverse, np.where(closed[:, None], -steps, SAMPLES - 1 - steps), steps)
    index = (index + np.where(reverse, -shift, shift)) % SAMPLES
    return np.take_along_axis(samples, index[..., None], axis=1)


def _length(samples: Array) -> Array:
    return np.hypot(*np.moveaxis(np.diff(samples, axis=1), 2, 0)).sum(axis=1)


def _auction(near: Array, cost: Array, objects: int) -> Array:
    """Assign each row to one of its candidate columns, or to none for the price of _UNMATCHED.

    Returns:
        (N,) position of the chosen candidate in its row, -1 = none; within 0.02 a row of the best.
    """
    value = _UNMATCHED - np.minimum(cost, 1e6)  # staying alone is worth 0
    price = np.zeros(objects)
    owner = np.full(objects, -1)
    chosen = np.full(len(near), -1)
    bidders = np.flatnonzero((value > 0).any(axis=1))
    while len(bidders):
        gain = value[bidders] - price[near[bidders]]
        best = gain.argmax(axis=1)
        line = np.arange(len(bidders))
        top = gain[line, best]
        gain[line, best] = 0.0  # the second best is at least staying alone
        raise_ = top - np.maximum(gain.max(axis=1), 0.0) + 0.02
        keen = top > 0
        bidders, best, raise_ = bidders[keen], best[keen], raise_[keen]
        wanted = near[bidders, best]
        # Of several bids for one column the highest wins: the last to write in ascending order.
        for_price = np.argsort(raise_, kind="stable")
        winner = np.full(objects, -1)
        winner[wanted[for_price]] = for_price
        sold = np.flatnonzero(winner >= 0)
        won = winner[sold]
        outbid = owner[sold]
        chosen[outbid[outbid >= 0]] = -1
        owner[sold] = bidders[won]
        chosen[bidders[won]] = best[won]
        price[sold] += raise_[won]
        lost = np.ones(len(bidders), bool)
        lost[won] = False
        bidders = np.concatenate([bidders[lost], outbid[outbid >= 0]])
    return chosen


def _nearest(data: Array, queries: Array, count: int) -> tuple[Array, Array]:
    """The nearest data rows to each query and their distances, (Q, count), exact."""
    data = np.ascontiguousarray(data, np.float32)
    tree = cv2.flann_Index(data, {"algorithm": 4, "leaf_max_size": 10})  # type: ignore[attr-defined]
    found, squared = tree.knnSearch(
        np.ascontiguousarray(queries, np.float32), count, params={"checks": -1}
    )
    return found.astype(np.int64), np.sqrt(np.maximum(squared, 0))


def _matches(old: Array, new: Array, variant: Array, motion: Array) -> Matches:
    """Pack an assignment; `start` is given in the direction that the new stroke runs now."""
    shift = np.where(variant & 1, -(variant >> 1), variant >> 1) % SAMPLES
    return Matches(
        old.astype(np.int32),
        new.astype(np.int32),
        (variant & 1).astype(bool),
        (shift / SAMPLES).astype(np.float32),
        motion,
    )
