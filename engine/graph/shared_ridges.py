"""Two lines that run so close that they are one ridge, told apart by their picture.

Where two lines cross at a shallow angle or touch, no ridge point belongs to one of them, and curves
fitted outside are off by a multiple of their noise (a tenth of a pixel across is a whole one along
the lines). But the ridge is wider where the lines are apart: so both curves together are fitted to
the map itself, as two strips of ink, blurred, whose overlap counts once (Gauss and Newton's method
on the eight coefficients of two cubics, with Huber's weights for what else is in the picture).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..arrays.sampling import sample
from ..values import Array
from .continuations import FADE, SAMPLES, pairs_within
from .courses import Courses
from .limits import LIMITS

STATIONS = 24  # places along both curves at which the map is compared
ACROSS = np.linspace(-2.1, 2.1, 7)  # px to both sides of each curve
ROUNDS = 5  # of Gauss and Newton; the last ones move nothing any more
HOLD = 1e-3  # how strongly the coefficients are held at what the outside says
CHUNK = 128  # pairs fitted at a time, so that they need little memory
_POWERS = np.arange(4)


def told_apart(curves: Array, cluster: Array, through: Array, half: Courses, value: Array) -> Array:
    """Curves (C, SAMPLES, 2) through clusters, those of close pairs fitted to the map.

    Args:
        curves: points from exit to exit, px; cluster: (C,) the cluster of each.
        through: (C, 2) the half-branches that each one joins.
        half: the course of all half-branches.
        value: (H, W) the smoothed centerline map.
    """
    curves = curves.copy()
    pairs = _close_pairs(curves, cluster)
    if not len(pairs):
        return curves
    for part in np.array_split(pairs, len(pairs) // CHUNK + 1):
        fitted, good = _fitted(curves[part], through[part], half, value)
        curves[part[good]] = fitted[good]
    return curves


def _close_pairs(curves: Array, cluster: Array) -> Array:
    """(K, 2) pairs of one cluster that are one ridge somewhere; every curve is in one at most."""
    pairs = pairs_within(cluster)
    if not len(pairs):
        return pairs
    way = np.gradient(curves, axis=1)
    way /= np.maximum(np.hypot(way[..., 0], way[..., 1]), 1e-9)[..., None]
    found, cosine = [np.zeros((0, 2), np.int64)], [np.zeros(0)]
    for some in np.array_split(pairs, len(pairs) // 512 + 1):
        gap = curves[some[:, 0], :, None] - curves[some[:, 1], None, :]
        gap = np.hypot(gap[..., 0], gap[..., 1]).reshape(len(some), -1)
        i, j = np.divmod(gap.argmin(1), SAMPLES)
        turn = np.abs((way[some[:, 0], i] * way[some[:, 1], j]).sum(-1))
        close = (gap.min(1) < LIMITS.shared_near) & (
            turn > np.cos(np.radians(LIMITS.shared_shallow))
        )
        found.append(some[close])
        cosine.append(turn[close])
    pairs = np.concatenate(found)[np.argsort(-np.concatenate(cosine), kind="stable")]
    # Three lines on one ridge are too many; a pair goes ahead when it is the first of both curves.
    first = np.unique(pairs, return_index=True)[1] // 2
    return pairs[np.bincount(first, minlength=len(pairs)) == 2]


@dataclass(frozen=True)
class _Frame:
    """Where K pairs of lines are looked at: x along both of them, from -1 to 1, y across, in px.

    origin (K, 2), axis (K, 2): px; middle (K,), scale (K,): px along the axis of x = 0 and x = 1.
    """

    origin: Array
    axis: Array
    middle: Array
    scale: Array

    def local(self, points: Array) -> tuple[Array, Array]:
        """x and y of points (K, ..., 2)."""
        origin, (ax, ay), middle, scale = self._spread(points.ndim - 1)
        dx, dy = np.moveaxis(points - origin, -1, 0)
        return (dx * ax + dy * ay - middle) / scale, dy * ax - dx * ay

    def world(self, x: Array, y: Array) -> Array:
        """Points (K, ..., 2), px, of x and y."""
        origin, (ax, ay), middle, scale = self._spread(x.ndim)
        along = x * scale + middle
        return origin + np.stack([along * ax - y * ay, along * ay + y * ax], -1)

    def _spread(self, dimensions: int) -> tuple[Array, Array, Array, Array]:
        one = (len(self.origin), *[1] * (dimensions - 1))
        axis = np.moveaxis(self.axis.reshape(*one, 2), -1, 0)
        return (
            self.origin.reshape(*one, 2),
            axis,
            self.middle.reshape(one),
            self.scale.reshape(one),
        )


def _fitted(curves: Array, through: Array, half: Courses, value: Array) -> tuple[Array, Array]:
    """Pairs of curves (K, 2, SAMPLES, 2) fitted to the map, and which fits (K,) can be trusted."""
    chord = curves[:, :, -1] - curves[:, :, 0]
    against = (chord[:, 0] * chord[:, 1]).sum(-1) < 0
    curves, through = curves.copy(), through.copy()
    curves[against, 1], through[against, 1] = curves[against, 1, ::-1], through[against, 1, ::-1]
    outside = half.points[through]  # (K, 2 curves, 2 ends, WINDOW, 2)
    weights = half.weights[through]
    reach = np.clip((weights > 0).sum(-1) - 1.0, 0, LIMITS.shared_beyond)  # points, about a px each
    frame = _frame(curves, reach)
    weights = 0.3 * weights * (np.arange(weights.shape[-1]) <= reach[..., None])
    start = _cubics(frame, curves, outside, weights)
    wide = _strip(half.level[through].mean(-1))[..., None, None] / 2  # (K, 2, 1, 1)
    fit, good = _solved(frame, start, wide, value)

    # Back to points from exit to exit.
    ends, heights = frame.local(curves[:, :, [0, -1]])
    t = np.linspace(0, 1, SAMPLES)
    x = ends[..., :1] * (1 - t) + ends[..., 1:] * t
    y = np.einsum("kcni,kci->kcn", x[..., None] ** _POWERS, fit)
    y = y + (heights - y[..., [0, -1]]) @ np.stack([(1 - t) ** FADE, t**FADE])
    result = frame.world(x, y)
    # Beyond what was compared with the map a cubic may swing away.
    good &= np.hypot(*np.moveaxis(result - curves, -1, 0)).max((1, 2)) < LIMITS.shared_farthest
    result[against, 1] = result[against, 1, ::-1]
    return result, good


def _frame(curves: Array, reach: Array) -> _Frame:
    """The frame of pairs of curves that run side by side, `reach` px (K, 2, 2) beyond them."""
    chord = curves[:, :, -1] - curves[:, :, 0]
    axis = (chord / np.maximum(np.linalg.norm(chord, axis=-1), 1e-9)[..., None]).sum(1)
    axis /= np.maximum(np.hypot(*axis.T), 1e-9)[:, None]
    count = len(curves)
    frame = _Frame(curves.mean((1, 2)), axis, np.zeros(count), np.ones(count))
    ends, _ = frame.local(curves[:, :, [0, -1]])
    # Only where both of them can be seen.
    low, high = (ends[..., 0] - reach[..., 0]).max(1), (ends[..., 1] + reach[..., 1]).min(1)
    return replace(frame, middle=(low + high) / 2, scale=np.maximum((high - low) / 2, 1.0))


def _cubics(frame: _Frame, curves: Array, outside: Array, weights: Array) -> Array:
    """(K, 2, 4): both curves as cubics y(x), with what is known outside of their exits."""
    count = len(curves)
    x, y = frame.local(np.concatenate([curves, outside.reshape(count, 2, -1, 2)], 2))
    weight = np.concatenate([np.ones(curves.shape[:3]), weights.reshape(count, 2, -1)], -1)
    powers = x[..., None] ** _POWERS
    weighted = powers * weight[..., None]
    normal = np.swapaxes(weighted, -1, -2) @ powers + 1e-6 * np.eye(4)
    return np.linalg.solve(normal, np.swapaxes(weighted, -1, -2) @ y[..., None])[..., 0]


def _solved(frame: _Frame, start: Array, wide: Array, value: Array) -> tuple[Array, Array]:
    """The cubics (K, 2, 4) that explain the map best, near `start`, and whether they do (K,).

    wide: (K, 2, 1, 1) half the widths of the two strips, px.
    """
    x = np.linspace(-1, 1, STATIONS)
    basis = x[:, None] ** _POWERS
    heights = (start @ basis.T)[..., None] + ACROSS  # (K, 2, STATIONS, A)
    places = frame.world(np.broadcast_to(x[:, None], heights.shape), heights)
    seen = sample(value, places)
    slope = (start[..., 1:] * _POWERS[1:]).mean(1) @ basis[:, :3].T / frame.scale[:, None]
    lean = (1 / np.hypot(1, slope))[:, None, :, None]  # px across for every px of y
    # Single precision is plenty for a picture, and twice as fast.
    heights, lean, wide = (a.astype(np.float32) for a in (heights, lean, wide))
    fit, costs = start, []
    for _ in range(ROUNDS):
        model, by_line = _picture(heights, (fit @ basis.T).astype(np.float32), wide, lean)
        off = model - seen
        robust = np.minimum(1.0, LIMITS.shared_huber / np.maximum(np.abs(off), 1e-9))
        costs.append((robust * off**2).mean((1, 2, 3)))
        gradient = np.einsum("klcsa,kcsa,si->kli", by_line, robust * off, basis)
        curvature = np.einsum("klcsa,kcsa,kmcsa->klms", by_line, robust, by_line)
        matrix = np.einsum("klms,si,sj->klimj", curvature, basis, basis).reshape(-1, 8, 8)
        size = seen[0].size
        gradient = (gradient / size + HOLD * (fit - start)).reshape(-1, 8, 1)
        step = np.linalg.solve(matrix / size + HOLD * np.eye(8), gradient)
        fit = fit - step.reshape(fit.shape)
    moved = np.abs((fit - start) @ basis.T).max((1, 2))
    return fit, (costs[-1] < costs[0]) & (moved < LIMITS.shared_farthest)


def _picture(at: Array, course: Array, wide: Array, lean: Array) -> tuple[Array, Array]:
    """What the map would show at heights `at` (K, 2, S, A), and how that changes with each line.

    course: (K, 2, S) heights of the two lines; wide: half their widths; lean: px per unit height.
    Returns (K, 2, S, A) and (K, 2 lines, 2, S, A).
    """
    below: Array
    above: Array
    below, above = course[..., None] * lean - wide, course[..., None] * lean + wide  # (K, 2, S, 1)
    place = at * lean
    low: Array
    high: Array
    low, high = below.min(1, keepdims=True), above.max(1, keepdims=True)
    gap_low, gap_high = above.min(1, keepdims=True), below.max(1, keepdims=True)
    apart = gap_high > gap_low
    lit = _step(place - low) - _step(place - high)
    lit = lit - np.where(apart, _step(place - gap_low) - _step(place - gap_high), 0)
    slopes = []
    for line in (0, 1):
        mine_below, mine_above = below[:, line : line + 1], above[:, line : line + 1]
        own = np.where(mine_below <= low, -_bell(place - low), 0)
        own = own + np.where(mine_above >= high, _bell(place - high), 0)
        inner = np.where(mine_above <= gap_low, _bell(place - gap_low), 0)
        inner = inner - np.where(mine_below >= gap_high, _bell(place - gap_high), 0)
        slopes.append((own + np.where(apart, inner, 0)) * lean)
    return lit, np.stack(slopes, 1)


def _step(x: Array) -> Array:
    """A blurred step (the normal distribution to a thousandth)."""
    z = x / LIMITS.shared_blur
    return 0.5 + 0.5 * np.tanh(z * (0.79788456 + 0.03567741 * z * z))


def _bell(x: Array) -> Array:
    z = x / LIMITS.shared_blur
    return np.exp(-0.5 * z * z) / (LIMITS.shared_blur * 2.50662827)


_WIDTHS = np.linspace(0.2, 4.0, 77)  # px; of strips whose brightness is known


def _strip(level: Array) -> Array:
    """Width in px of the strip that, blurred, is this bright in its middle."""
    return np.interp(level, _step(_WIDTHS / 2) - _step(-_WIDTHS / 2), _WIDTHS)
