"""Which half-branches run on into which: smooth curves through a cluster.

Every pair of half-branches that leave one cluster is tried: one cubic through the clean points of
both sides, in the frame of their chord. A true continuation fits to a tenth of a pixel and hardly
turns. This pairing only serves to find the exact place of the junction; what is one stroke is
decided later, by the routing.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields

import numpy as np

from ..arrays.sampling import sample
from ..values import Array
from .courses import Courses, direction
from .limits import LIMITS

SAMPLES = 17  # points of a curve within the cluster, exits included
ALONE = 1.0  # cost of a half-branch that runs on into none
CHUNK = 8192  # pairs fitted at a time, which bounds the memory
NEVER = 1e3  # cost of what is out of the question
FADE = 6  # power; how fast a curve goes over from the ridge point at its exit to the cubic


@dataclass(frozen=True, eq=False)
class Fits:
    """Cubics through pairs of half-branches; K pairs.

    origin (K, 2), axis (K, 2): the frame; scale (K,): px per unit of x; coefficients (K, 4) of
    y(x) in px, lowest power first; span (K, 2): x at the two exits; offset (K, 2): what is missing
    at the exits to the ridge points there; cost (K,).
    """

    origin: Array
    axis: Array
    scale: Array
    coefficients: Array
    span: Array
    offset: Array
    cost: Array

    def pick(self, ids: Array) -> Fits:
        """Some of them."""
        return Fits(*(getattr(self, f.name)[ids] for f in fields(self)))

    @staticmethod
    def joined(parts: Sequence[Fits]) -> Fits:
        """All of several."""
        names = [f.name for f in fields(Fits)]
        return Fits(*(np.concatenate([getattr(part, n) for part in parts]) for n in names))

    def sampled(self) -> Array:
        """(K, SAMPLES, 2) points from the first exit to the second."""
        t = np.linspace(0, 1, SAMPLES)
        x = self.span[:, :1] * (1 - t) + self.span[:, 1:] * t
        # Off the exits the cubic knows better than any single ridge point.
        fade = np.stack([(1 - t) ** FADE, t**FADE])
        y = _value(self.coefficients, x) + self.offset @ fade
        ax, ay = self.axis[:, None, 0], self.axis[:, None, 1]
        x = x * self.scale[:, None]
        return self.origin[:, None] + np.stack([x * ax - y * ay, x * ay + y * ax], -1)

    def distance(self, points: Array) -> Array:
        """(K, N) px: how far points (K, N, 2) lie beside their curve."""
        x, y = _local(points, self.origin, self.axis, self.scale)
        slope = _slope(self.coefficients, x) / self.scale[:, None]
        return np.abs(y - _value(self.coefficients, x)) / np.hypot(1, slope)


class Continuations:
    """The cubics through pairs of half-branches.

    Args:
        half: the course of all half-branches.
        value: (H, W) the smoothed centerline map; a curve that leaves the ink is out.
    """

    def __init__(self, half: Courses, value: Array) -> None:
        self._half = half
        self._value = value
        # Costs that are known, sorted by their pairs, and others not sorted in yet.
        self._keys, self._costs = np.zeros(0, np.int64), np.zeros(0)
        self._fresh: list[tuple[Array, Array]] = []

    def of(self, pairs: Array) -> Fits:
        """The fits of pairs (K, 2) of half-branches, from the first of each to the second."""
        return Fits.joined([_fit(self._half, some, self._value) for some in _chunks(pairs)])

    def cost(self, pairs: Array) -> Array:
        """(K,) what they cost; fitted when first asked for."""
        count = len(self._half.exit)
        keys = pairs[:, 0].astype(np.int64) * count + pairs[:, 1]
        wanted, place = np.unique(keys, return_inverse=True)
        if sum(len(k) for k, _ in self._fresh) > len(self._keys) / 2:
            self._sort_in()
        found = np.full(len(wanted), np.nan)
        if len(self._keys):
            at = np.minimum(np.searchsorted(self._keys, wanted), len(self._keys) - 1)
            known = self._keys[at] == wanted
            found[known] = self._costs[at[known]]
        new = np.flatnonzero(np.isnan(found))
        for some in _chunks(new):
            fits = _fit(self._half, np.stack(np.divmod(wanted[some], count), -1), self._value)
            found[some] = fits.cost
        if len(new):
            self._fresh.append((wanted[new], found[new]))
        return found[place.reshape(-1)]

    def _sort_in(self) -> None:
        known = [(self._keys, self._costs), *self._fresh]
        keys, costs = (np.concatenate(parts) for parts in zip(*known, strict=True))
        self._keys, first = np.unique(keys, return_index=True)
        self._costs, self._fresh = costs[first], []


def _chunks(rows: Array) -> Iterator[Array]:
    """Parts of an array, one at least."""
    for at in range(0, max(len(rows), 1), CHUNK):
        yield rows[at : at + CHUNK]


def _fit(half: Courses, pairs: Array, value: Array) -> Fits:
    """One cubic through both half-branches of each pair."""
    a, b = pairs.T
    chord = half.center[b] - half.center[a]
    length = np.hypot(*chord.T)
    axis = chord / np.maximum(length, 1e-9)[:, None]
    scale = np.maximum(length, 1.0)
    origin = (half.points[a, 0] + half.points[b, 0]) / 2
    # Both sides must lie on their own side of the cluster, and run away from it.
    side = LIMITS.continue_side
    apart = ((half.outward[a] * axis).sum(1) < -side) & ((half.outward[b] * axis).sum(1) > side)
    some = np.flatnonzero(apart)
    cost = np.full(len(pairs), NEVER)
    coefficients, span, offset = (np.zeros((len(pairs), n)) for n in (4, 2, 2))
    fits = Fits(origin, axis, scale, coefficients, span, offset, cost)
    if not len(some):
        return fits

    a, b = pairs[some].T
    gap = np.hypot(*(half.points[b, 0] - half.points[a, 0]).T)
    # The longer the gap, the more of both sides is needed to bridge it.
    reach = np.clip(0.75 * gap, 6.0, 14.0)[:, None]
    fade = np.exp(-((np.arange(half.points.shape[1]) / reach) ** 2))
    weight = np.concatenate([half.weights[a] * fade, half.weights[b] * fade], 1)
    both = np.concatenate([half.points[a], half.points[b]], 1)
    x, y = _local(both, origin[some], axis[some], scale[some])
    c, rms = _cubic(x, y, weight)

    n = half.points.shape[1]
    ends = np.stack([x[:, 0], x[:, n]], -1)
    across = _value(c, ends)
    angle = np.arctan(_slope(c, ends) / scale[some, None])
    wide = np.maximum((ends[:, 1] - ends[:, 0]) * scale[some], 1e-9)
    lean = np.arctan2(across[:, 1] - across[:, 0], wide)
    turn = angle[:, 1] - angle[:, 0]
    # A curve that bends as both of its sides do bends no more than it must.
    due = (half.bend[b] - half.bend[a]) / 2 * gap
    due = np.where(turn * due > 0, np.minimum(np.abs(due), np.abs(turn)), 0.0)
    turn = np.abs(turn) - LIMITS.continue_bent * due
    swerve = angle.mean(1) - lean
    total = (
        (rms / LIMITS.continue_noise) ** 2
        + (turn / np.radians(LIMITS.continue_turn)) ** 2
        + (swerve / np.radians(LIMITS.continue_swerve)) ** 2
    )
    total[(ends[:, 1] < ends[:, 0]) | ~np.isfinite(total)] = NEVER
    coefficients[some], span[some] = c, ends
    offset[some] = np.stack([y[:, 0], y[:, n]], -1) - across
    # Whether it leaves the ink is asked only of those that cost less than to join none.
    cheap = np.flatnonzero(total < 2 * ALONE)
    dark = sample(value, fits.pick(some[cheap]).sampled()).min(1)
    level = np.minimum(half.level[a[cheap]], half.level[b[cheap]])
    total[cheap[dark < LIMITS.continue_ink * level]] = NEVER
    cost[some] = np.minimum(total, NEVER)
    return fits


def _cubic(x: Array, y: Array, weight: Array) -> tuple[Array, Array]:
    """Weighted least-squares cubics: coefficients (K, 4) and root mean square residuals (K,)."""
    moments, mixed, power = [], [], weight
    for p in range(7):
        moments.append(power.sum(1))
        if p < 4:
            mixed.append((power * y).sum(1))
        power = power * x
    # Just enough to keep short half-branches solvable; cubics are dearer than lines.
    normal = np.stack([np.stack(moments[p : p + 4], -1) for p in range(4)], 1)
    normal = normal + np.diag([1e-6, 1e-6, 1e-3, 1e-2])
    c = np.linalg.solve(normal, np.stack(mixed, -1)[..., None])[..., 0]
    residual = y - _value(c, x)
    return c, np.sqrt((weight * residual**2).sum(1) / np.maximum(moments[0], 1e-9))


def extend(points: Array, weights: Array, reach: Array) -> Array:
    """Half-branches continued into their cluster.

    Args:
        points, weights: (K, N, 2) and (K, N), outward from the exit.
        reach: (K,) px to go on.

    Returns:
        (K, SAMPLES, 2) points from the exit inward.
    """
    fade = np.exp(-((np.arange(points.shape[1]) / 8.0) ** 2))
    weight = weights * fade
    inward = -direction(points, weight)
    exit_point = points[:, :1]
    offset = points - exit_point
    x = -(offset * inward[:, None]).sum(-1)
    y = offset[..., 1] * inward[:, None, 0] - offset[..., 0] * inward[:, None, 1]
    powers = x[..., None] ** np.arange(3)
    weighted = powers * weight[..., None]
    normal = np.einsum("kni,knj->kij", weighted, powers)
    # Curvature is held down: a short stem would otherwise curl.
    normal += np.diag([1e-6, 1e-3, 300.0])
    c = np.linalg.solve(normal, np.einsum("kni,kn->ki", weighted, y)[..., None])[..., 0]
    t = np.linspace(0, 1, SAMPLES)
    along = t * reach[:, None]
    across = _value(c, -along) - c[:, :1] * np.maximum(0.0, 1 - t) * (1 - t)
    side = np.stack([-inward[:, 1], inward[:, 0]], -1)
    return exit_point + along[..., None] * inward[:, None] + across[..., None] * side[:, None]


def pairs_within(group: Array) -> Array:
    """All pairs (K, 2), a < b, of members of one group (N,); members of group -1 have none."""
    member = np.flatnonzero(group >= 0)
    member = member[np.argsort(group[member], kind="stable")]
    size = np.unique(group[member], return_counts=True)[1]
    begin = np.concatenate([[0], np.cumsum(size)[:-1]]).astype(np.int64)
    found = [np.zeros((0, 2), np.int64)]
    for k in np.unique(size):
        a, b = np.triu_indices(k, 1)
        rows = member[begin[size == k][:, None] + np.arange(k)]
        found.append(np.stack([rows[:, a].ravel(), rows[:, b].ravel()], -1))
    return np.concatenate(found)


def _local(points: Array, origin: Array, axis: Array, scale: Array) -> tuple[Array, Array]:
    """Points (K, N, 2) in the frames: x in units of the scale, y in px."""
    offset = points - origin[:, None]
    ax, ay = axis[:, None, 0], axis[:, None, 1]
    x = (offset[..., 0] * ax + offset[..., 1] * ay) / scale[:, None]
    return x, offset[..., 1] * ax - offset[..., 0] * ay


def _value(coefficients: Array, x: Array) -> Array:
    value = np.zeros_like(x)
    for c in coefficients.T[::-1]:
        value = value * x + c[:, None]
    return value


def _slope(coefficients: Array, x: Array) -> Array:
    return _value(coefficients[:, 1:] * np.arange(1, coefficients.shape[1]), x)
