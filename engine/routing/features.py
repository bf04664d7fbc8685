"""How half-branches leave their junction, and how well two of them would make one line.

All lengths are in pen widths, so that the numbers mean the same on every scan.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..ink.tint import tint
from ..values import Array, PlanarGraph

DEFAULT_WIDTH = 4.0  # px; for graphs whose widths were not measured
# Stretches of a half-branch, in pen widths from its junction. Right at the junction lines run
# together, so that nothing can be seen there.
_NEAR = (0.5, 2.5)
_MIDDLE = (0.6, 4.0)
_FAR = (1.0, 9.0)
_SAMPLES = 8
_KNOTS = (0.2, 0.6, 1.3)  # radians; where the worth of an angle changes its slope
_SAME = 1e-3  # radians; directions that differ by less are one
_MANY = 5  # half-branches from which on a junction is a cluster and judged by other weights


@dataclass(frozen=True, eq=False)
class Stretch:
    """The same stretch of every half-branch, seen from its vertex, in pen widths.

    arc: (2B, S) arc lengths; points: (2B, S, 2) positions relative to the vertex.
    line: (2B, 2) unit direction of the line fitted to it, away from the junction.
    start: (2B, 2) unit direction at the junction of the parabola fitted to it.
    """

    arc: Array
    points: Array
    line: Array
    start: Array


@dataclass(frozen=True, eq=False)
class HalfFeatures:
    """One row per half-branch.

    length: (2B,) of the whole branch in pen widths.
    width: (2B,) in pen widths; strength: (2B,) ink in [0, 1]; tint: (2B, 2), see `engine.ink.tint`;
        each the median of the middle stretch.
    """

    near: Stretch
    middle: Stretch
    far: Stretch
    length: Array
    width: Array
    strength: Array
    tint: Array


def half_features(graph: PlanarGraph) -> HalfFeatures:
    """Measure every half-branch; the cost is linear in points."""
    unit = DEFAULT_WIDTH
    if graph.widths is not None and len(graph.widths):
        unit = max(float(np.median(graph.widths)), 1e-3)
    sampler = _Sampler(graph, unit)
    at = sampler.at(sampler.stretch(*_MIDDLE))

    def middle(values: Array | None, default: float) -> Array:
        if values is None:
            return np.full(len(at), default)
        return np.median(_interp(at, values), axis=1)

    return HalfFeatures(
        near=_fit(sampler, _NEAR),
        middle=_fit(sampler, _MIDDLE),
        far=_fit(sampler, _FAR),
        length=sampler.length,
        width=middle(graph.widths, unit) / unit,
        strength=middle(graph.strength, 1.0),
        tint=np.zeros((len(at), 2)) if graph.colors is None else tint(middle(graph.colors, 0.0)),
    )


class _Sampler:
    """Reads half-branches at arc lengths from their vertex."""

    def __init__(self, graph: PlanarGraph, unit: float) -> None:
        self.graph, self.unit = graph, unit
        step = np.hypot(*np.diff(graph.points.astype(np.float64), axis=0, append=np.nan).T)
        # All branches laid end to end, a pixel apart.
        step[graph.offsets[1:] - 1] = 1.0
        self._key = np.cumsum(step) - step
        first, last = self._key[graph.offsets[:-1]], self._key[graph.offsets[1:] - 1]
        self._origin = np.stack([first, last], 1).ravel()
        self._forward = np.tile([1.0, -1.0], graph.branch_count)
        self.length = np.repeat(last - first, 2) / unit

    def stretch(self, low: float, high: float) -> Array:
        """(2B, S) arc lengths in pen widths, moved in where the branch is shorter."""
        start = np.minimum(low, 0.2 * self.length)[:, None]
        stop = np.minimum(high, self.length)[:, None]
        return start + (stop - start) * np.linspace(0, 1, _SAMPLES)

    def at(self, arc: Array) -> Array:
        """Fractional point numbers (2B, S) at these arc lengths."""
        key = self._origin[:, None] + self._forward[:, None] * arc * self.unit
        return np.interp(key, self._key, np.arange(len(self._key), dtype=np.float64))

    def points(self, arc: Array) -> Array:
        """Positions (2B, S, 2) relative to the vertex, in pen widths."""
        vertices = self.graph.vertices[self.graph.half_vertex].astype(np.float64)
        return (_interp(self.at(arc), self.graph.points) - vertices[:, None]) / self.unit


def _interp(at: Array, values: Array) -> Array:
    """Values at fractional numbers `at` (...): (...) or (..., C)."""
    low = np.minimum(at.astype(np.int64), max(len(values) - 2, 0))
    share = at - low
    share = share if values.ndim == 1 else share[..., None]
    return values[low] * (1 - share) + values[low + 1] * share


def _fit(sampler: _Sampler, window: tuple[float, float]) -> Stretch:
    """Line and parabola by least squares; every half-branch shares one design matrix."""
    arc = sampler.stretch(*window)
    points = sampler.points(arc)
    u = np.linspace(-1, 1, _SAMPLES)
    line = np.linalg.pinv(np.stack([np.ones_like(u), u], 1))
    parabola = np.linalg.pinv(np.stack([np.ones_like(u), u, u * u / 2], 1))
    slope = np.einsum("s,hsc->hc", line[1], points)
    first, second = np.einsum("ks,hsc->khc", parabola[1:], points)
    # The junction, in units of u; not further out than a parabola can be trusted.
    half = np.maximum(arc[:, -1] - arc[:, 0], 1e-6) / 2
    junction = np.maximum(-(arc[:, -1] + arc[:, 0]) / 2 / half, -2.5)
    return Stretch(arc, points, _unit(slope), _unit(first + second * junction[:, None]))


def _unit(vectors: Array) -> Array:
    return vectors / np.maximum(np.hypot(*vectors.T), 1e-9)[:, None]


def _angle_terms(name: str) -> list[str]:
    bends = [f"{name} over {k:g}" for k in _KNOTS]
    return [name, *bends, f"{name}, many", f"{name} over {_KNOTS[1]:g}, many"]


FEATURES: tuple[str, ...] = (
    "join",
    "join, three",
    "join, many",
    *_angle_terms("turn of lines"),
    *_angle_terms("turn of curves"),
    *_angle_terms("turn of chords"),
    "misfit, middle",
    "misfit, far",
    "opposite",
    "opposite, many",
    "short",
    "width",
    "strength",
    "tint",
)


def pair_features(graph: PlanarGraph, pairs: Array) -> Array:
    """What speaks for and against joining pairs: (K, F) float64, columns as in `FEATURES`.

    turn: the angle by which the line would turn, between the lines fitted to both sides, between
        the curves at the junction, and between the chords to both sides.
    misfit: log of how far one cubic through both sides misses them.
    opposite: 1 where as many other half-branches lie on one side of the pair as on the other.
    short: how little of the shorter one there is to see.
    width, strength, tint: how much the ink differs.
    three, many: the same again at junctions of three, or of five or more.
    """
    half = half_features(graph)
    a, b = pairs.T
    degree = graph.degrees[graph.half_vertex[a]]
    many = degree >= _MANY
    one = np.ones(len(pairs))
    columns = [one, one * (degree == 3), one * many]
    chord = _unit(half.near.points[:, -1])
    for direction in (half.near.line, half.near.start, chord):
        turn = np.arccos(np.clip(-(direction[a] * direction[b]).sum(1), -1, 1))
        over = [np.maximum(turn - k, 0) for k in _KNOTS]
        columns += [turn, *over, turn * many, over[1] * many]
    columns += [np.log(_misfit(s, a, b) + 0.02) for s in (half.middle, half.far)]
    opposite = _opposite(graph, half.middle.start, a, b)
    columns += [opposite, opposite * many]
    columns.append(1 / (0.5 + np.minimum(half.length[a], half.length[b])))
    width = np.abs(np.log((half.width[a] + 0.1) / (half.width[b] + 0.1)))
    columns.append(np.minimum(width, 1.5))
    columns.append(np.abs(half.strength[a] - half.strength[b]))
    columns.append(tint_gap(half, a, b))
    return np.stack(columns, 1)


def tint_gap(half: HalfFeatures, a: Array, b: Array) -> Array:
    """(K,) how much the hue of two inks differs: 0 = one ink, 1 = two."""
    return np.clip(np.hypot(*(half.tint[a] - half.tint[b]).T) - 0.25, 0, 1)


def _misfit(stretch: Stretch, a: Array, b: Array) -> Array:
    """Root mean square distance of both sides from the cubic fitted to them together."""
    arc = np.concatenate([-stretch.arc[a], stretch.arc[b]], 1)
    points = np.concatenate([stretch.points[a], stretch.points[b]], 1)
    t = arc / np.maximum(np.abs(arc).max(1, keepdims=True), 1e-6)
    design = np.stack([np.ones_like(t), t, t**2, t**3], -1)
    normal = np.einsum("nsi,nsj->nij", design, design) + 1e-6 * np.eye(4)
    fitted = design @ np.linalg.solve(normal, np.einsum("nsi,nsc->nic", design, points))
    return np.sqrt(((points - fitted) ** 2).sum(-1).mean(1))


def _opposite(graph: PlanarGraph, direction: Array, a: Array, b: Array) -> Array:
    """1 = half of the other half-branches lie on either side, 0 = neighbours around the vertex.

    Half-branches that leave a vertex in one direction count as one: nothing says which is first.
    """
    vertex = graph.half_vertex
    rank, count = _around(np.arctan2(direction[:, 1], direction[:, 0]), vertex)
    apart, count = np.abs(rank[a] - rank[b]), count[vertex[a]]
    apart = np.maximum(np.minimum(apart, count - apart), 1)
    return (apart - 1) / np.maximum((count - 2) / 2, 1)


def _around(angle: Array, vertex: Array) -> tuple[Array, Array]:
    """(2B,) the number of each direction around its vertex, and (V,) how many directions it has."""
    order = np.lexsort((angle, vertex))
    angle, at = angle[order], vertex[order]
    first = np.diff(at, prepend=-1) > 0
    new = first | (np.diff(angle, prepend=0.0) > _SAME)
    number = np.cumsum(new) - 1
    start = np.maximum.accumulate(np.where(first, number, 0))
    count = np.zeros(int(vertex.max(initial=-1)) + 1, np.int64)
    np.maximum.at(count, at, number - start + 1)
    # The last directions may be the first one again, a turn later.
    lowest = np.maximum.accumulate(np.where(first, np.arange(len(order)), 0))
    again = (angle[lowest] + 2 * np.pi - angle < _SAME) & (count[at] > 1)
    again &= number - start == count[at] - 1
    count[np.unique(at[again])] -= 1
    rank = np.empty(len(order), np.int64)
    rank[order] = np.where(again, 0, number - start)
    return rank, count
