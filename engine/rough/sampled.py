"""Pencil strokes as evenly spaced samples, so that each step runs over all of them at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays.ragged import count_up, end_to_end, offsets_of, owners, ranges
from ..strokes.walk import walk
from ..values import Array, PlanarGraph

SPACING = 2.0  # px at most between two samples of a branch
_REACH = (3.0, 4.0, 24.0)  # pens, and px more, and px at most, between strokes of one line
_AHEAD = 3  # samples to either side that tell a direction


@dataclass(frozen=True, eq=False)
class Sampled:
    """The branches of a routed graph, sampled; the first and last sample of a branch are its ends.

    points: (N, 2) float64, px. offsets: (B + 1,); branch b has the samples offsets[b] up to
    offsets[b + 1]. vertex: (N,) the vertex that a sample lies on, or -1.
    stroke: (N,) the pencil stroke; place: (N,) px along it; length: (S,) px of each stroke.
    back, ahead: (N,) the sample before and after along the stroke, itself at an end.
    tangent: (N, 2) unit vectors. strength, width: (N,) darkness of the ink and width of the line.
    colors: (N, 3) uint8 sRGB of the ink, or None on a grey page.
    """

    points: Array
    offsets: Array
    vertex: Array
    stroke: Array
    place: Array
    length: Array
    back: Array
    ahead: Array
    tangent: Array
    strength: Array
    width: Array
    colors: Array | None

    @property
    def normal(self) -> Array:
        """(N, 2) unit vectors to the right of the tangents, as the page is seen."""
        return np.stack([-self.tangent[:, 1], self.tangent[:, 0]], 1)

    @classmethod
    def of(cls, graph: PlanarGraph, partner: Array) -> Sampled:
        """Sample a measured graph along the strokes that an involution makes of it."""
        return cls.from_samples(samples_of(graph), partner)

    @classmethod
    def from_samples(cls, graph: PlanarGraph, partner: Array) -> Sampled:
        """The same of a graph whose points are the samples, as `samples_of` gives it."""
        assert graph.widths is not None, "a pencil graph is measured"
        assert graph.strength is not None
        points, offsets = graph.points.astype(np.float64), graph.offsets
        vertex = np.full(len(points), -1)
        vertex[offsets[:-1]], vertex[offsets[1:] - 1] = graph.ends.T
        order, bounds, closed = _walked(offsets, partner)
        stroke, place, length, back, ahead = _along(points, order, bounds, closed)
        return cls(
            points,
            offsets,
            vertex,
            stroke,
            place,
            length,
            back,
            ahead,
            _tangents(points, back, ahead),
            graph.strength.astype(np.float64),
            graph.widths.astype(np.float64),
            graph.colors,
        )


def samples_of(graph: PlanarGraph) -> PlanarGraph:
    """A measured graph with evenly spaced points on its branches, no more than `SPACING` apart."""
    assert graph.widths is not None, "a pencil graph is measured"
    assert graph.strength is not None
    axis = end_to_end(graph.points, graph.offsets)
    low, high = axis[graph.offsets[:-1]], axis[graph.offsets[1:] - 1]
    count = np.maximum(1, np.ceil((high - low) / SPACING)).astype(np.int64) + 1
    offsets = offsets_of(count)
    branch, number = owners(offsets), count_up(count)
    at = low[branch] + number / (count[branch] - 1) * (high - low)[branch]

    def values(of: Array) -> Array:
        return np.interp(at, axis, of).astype(np.float32)

    points = np.stack([values(graph.points[:, k]) for k in (0, 1)], 1)
    # The tips are their vertices, to the last bit.
    points[offsets[:-1]], points[offsets[1:] - 1] = graph.vertices[graph.ends.T]
    return PlanarGraph(
        vertices=graph.vertices,
        points=points,
        offsets=offsets.astype(np.int32),
        ends=graph.ends,
        widths=values(graph.widths),
        strength=values(graph.strength),
        colors=_colors(graph, at, axis),
    )


def reach_of(pen: float) -> float:
    """How far apart two strokes of one line may lie, px; pen: the width of one, px."""
    times, more, most = _REACH
    return min(times * pen + more, most)


def _colors(graph: PlanarGraph, at: Array, axis: Array) -> Array | None:
    if graph.colors is None:
        return None
    return graph.colors[np.clip(np.searchsorted(axis, at), 0, len(axis) - 1)]


def _walked(offsets: Array, partner: Array) -> tuple[Array, Array, Array]:
    """All samples in the order of the strokes, where each stroke begins, which are closed."""
    walks = walk(partner)
    halves = np.array([half for one in walks for half in one.halves], np.int64)
    branch, flipped = halves >> 1, (halves & 1).astype(bool)
    count = np.diff(offsets)[branch]
    forward = ranges(offsets[branch], count)
    within = count_up(count)
    backward = np.repeat(offsets[branch + 1] - 1, count) - within
    order = np.where(np.repeat(flipped, count), backward, forward)
    sizes = offsets_of(count)
    first = offsets_of([len(one.halves) for one in walks])
    return order, sizes[first], np.array([one.closed for one in walks], bool)


def _along(points: Array, order: Array, bounds: Array, closed: Array) -> tuple[Array, ...]:
    """Stroke, place, length, and the neighbours along the stroke of every sample."""
    run = owners(bounds)
    step = np.hypot(*np.diff(points[order], axis=0, prepend=points[order[:1]]).T)
    step[bounds[:-1]] = 0.0
    total = np.cumsum(step)
    total -= total[bounds[:-1]][run]
    count = len(order)
    stroke, place = np.empty(count, np.int64), np.empty(count)
    stroke[order], place[order] = run, total
    index = np.arange(count)
    before, after = np.maximum(index - 1, bounds[run]), np.minimum(index + 1, bounds[run + 1] - 1)
    before[bounds[:-1][closed]] = bounds[1:][closed] - 1
    after[bounds[1:][closed] - 1] = bounds[:-1][closed]
    back, ahead = np.empty(count, np.int64), np.empty(count, np.int64)
    back[order], ahead[order] = order[before], order[after]
    return stroke, place, total[bounds[1:] - 1], back, ahead


def _tangents(points: Array, back: Array, ahead: Array) -> Array:
    first = last = np.arange(len(points))
    for _ in range(_AHEAD):
        first, last = back[first], ahead[last]
    way = points[last] - points[first]
    # A short ring comes back to itself: its nearest neighbours tell the direction.
    short = np.hypot(*way.T) < 1e-6
    way[short] = (points[ahead] - points[back])[short]
    way[np.hypot(*way.T) < 1e-9] = (1.0, 0.0)
    return way / np.hypot(*way.T)[:, None]
