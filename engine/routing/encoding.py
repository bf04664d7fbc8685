"""What the routing network sees of a graph: a table of junctions, each with a few half-branches.

Every half-branch is described in its own frame (origin at its junction, x axis along its first
few pixels) and every ordered pair (i, j) by j seen in the frame of a pen that arrives along i. So
the description does not change when the page is turned or moved, and one that is large near the
junction stays comparable to one that is large far away: a sample s px along the branch is divided
by s. Training and inference share this file.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..values import Array, Pair, PlanarGraph

# Arc lengths, px, at which a half-branch is sampled: log-spaced, 1 to 128.
REACH = np.geomspace(1.0, 128.0, 16)
# Windows, px along the branch, over which its direction is measured.
WINDOWS = np.array([[1.0, 6.0], [3.0, 14.0], [6.0, 32.0]])
# The window that sets the frame of a half-branch.
FRAME = np.array([[2.0, 10.0]])
# Arc lengths, px, at which the ink of a half-branch is compared: near its junction and farther out.
INK_NEAR, INK_FAR = np.array([2.0, 4.0, 6.0, 8.0]), np.array([12.0, 18.0, 26.0, 36.0])
# Junctions with more half-branches than this are too rare to be learnt.
MAX_DEGREE = 8

_FAR_DEGREES = 5  # none, 1, 3, 4, 5 and more
TOKEN_SIZE = 2 * len(REACH) + 2 * len(WINDOWS) + 4 + _FAR_DEGREES + 11
PAIR_SIZE = 2 * len(REACH) + 4 * len(WINDOWS) + 15


@dataclass(frozen=True, eq=False)
class Encoding:
    """A graph as the network's input: J junctions with up to D half-branches each.

    halves: (J, D) int32 half-branch in each slot, -1 = empty slot.
    tokens: (J, D, TOKEN_SIZE) float32; pairs: (J, D, D, PAIR_SIZE) float32, ordered pairs.
    sibling: (J, D) int32 flat slot of the other end of the branch, J * D = it has no slot.
    """

    halves: Array
    tokens: Array
    pairs: Array
    sibling: Array

    @property
    def mask(self) -> Array:
        """(J, D) float32, 1 where a slot is filled."""
        return (self.halves >= 0).astype(np.float32)


def encode(
    graph: PlanarGraph, fixed: Mapping[int, tuple[Pair, ...]] | None = None, slots: int = 0
) -> Encoding:
    """Describe the junctions of a graph; those with more half-branches than slots are left out.

    Args:
        graph: the drawing; widths, strength and colors are used when there.
        fixed: junction number -> pairs that the user has locked there.
        slots: D; 0 = the highest degree in the graph, at most MAX_DEGREE.
    """
    order, starts = graph.halves_at
    degree = graph.degrees[graph.junctions]
    slots = slots or min(MAX_DEGREE, int(degree.max(initial=3)))
    rows = graph.junctions[degree <= slots]
    degree = graph.degrees[rows]
    place = np.arange(slots)
    filled = place < degree[:, None]
    halves = np.full((len(rows), slots), -1, np.int32)
    halves[filled] = order[(starts[rows][:, None] + place)[filled]]

    shape = _Shapes.of(graph)
    halves = _by_angle(halves, shape.frame)
    flat = np.full(2 * graph.branch_count, halves.size, np.int32)
    flat[halves[filled]] = np.flatnonzero(filled)
    sibling = np.where(filled, flat[halves ^ 1], halves.size).astype(np.int32)

    tokens = np.zeros((*halves.shape, TOKEN_SIZE), np.float32)
    tokens[filled] = _token_features(graph, shape, halves, filled, degree)
    pairs = np.zeros((*halves.shape, slots, PAIR_SIZE), np.float32)
    both = filled[:, :, None] & filled[:, None, :] & ~np.eye(slots, dtype=bool)
    decided = _fixed_pairs(graph, halves, rows, fixed or {})
    pairs[both] = _pair_features(graph, shape, halves, both, degree, decided)
    return Encoding(halves, tokens, pairs, sibling)


@dataclass(frozen=True, eq=False)
class _Shapes:
    """Geometry of all half-branches as complex numbers (x + iy), relative to their vertex.

    samples (H, S): position at REACH, divided by it; frame (H,): unit direction;
    heading (H, W): unit direction over WINDOWS; offset (H, W): how far those lines run beside the
    vertex, px, signed; length (H,) of the branch in px; tip (H,): where it ends.
    """

    samples: Array
    frame: Array
    heading: Array
    offset: Array
    length: Array
    tip: Array

    @staticmethod
    def of(graph: PlanarGraph) -> _Shapes:
        axis = _Axis.of(graph)
        length = axis.length

        def line(windows: Array) -> tuple[Array, Array]:
            low = axis.seen(np.minimum(windows[:, 0], 0.3 * length[:, None]))
            heading = _unit(axis.seen(windows[:, 1]) - low)
            return heading, (np.conj(heading) * low).imag

        heading, offset = line(WINDOWS)
        frame = line(FRAME)[0][:, 0]
        tip = axis.seen(np.array([np.inf]))[:, 0]
        return _Shapes(axis.seen(REACH) / REACH, frame, heading, offset, length, tip)


def along(graph: PlanarGraph, reach: Array) -> tuple[Array, Array]:
    """Where each half-branch is after some arc length, seen from the vertex that it starts at.

    Args:
        reach: (S,), or (2B, S) for lengths of each half-branch's own, px; beyond the end of the
            branch it is the end.

    Returns:
        (2B, S) complex x + iy, and the (2B,) length of the branch, px.
    """
    axis = _Axis.of(graph)
    return axis.seen(reach), axis.length


@dataclass(frozen=True, eq=False)
class _Axis:
    """All branches laid end to end.

    points: (P,) complex x + iy; arc: (P,) where they lie on that axis; start: (2B,) the point that
    each half-branch starts at, sign: (2B,) the way that it runs, length: (2B,) of its branch, px.
    """

    points: Array
    arc: Array
    start: Array
    sign: Array
    length: Array

    @staticmethod
    def of(graph: PlanarGraph) -> _Axis:
        points = graph.points.astype(np.float64)
        first, last = graph.offsets[:-1], graph.offsets[1:] - 1
        step = np.hypot(*np.diff(points, axis=0, prepend=points[:1]).T)
        step[first] = 1.0  # a gap between branches, so that the arc length grows for ever
        arc = np.cumsum(step)
        return _Axis(
            points[:, 0] + 1j * points[:, 1],
            arc,
            np.stack([first, last], 1).reshape(-1),
            np.tile([1.0, -1.0], graph.branch_count),
            np.repeat(arc[last] - arc[first], 2),
        )

    def places(self, reach: Array) -> Array:
        """(2B, S) where each half-branch is on the axis after some arc length, as in `along`."""
        way = self.sign[:, None] * np.minimum(reach, self.length[:, None])
        return self.arc[self.start][:, None] + way

    def seen(self, reach: Array) -> Array:
        """(2B, S) the same on the page, from the vertex that it starts at, complex x + iy."""
        if not len(self.points):
            return self.places(reach).astype(complex)
        found = np.interp(self.places(reach), self.arc, self.points)
        return found - self.points[self.start][:, None]


def _rise(graph: PlanarGraph, *of_points: Array | None) -> list[Array]:
    """(2B,) for each value of the points, how much larger it is near the junction than farther out;
    zeros where it is unknown. A stroke that ends at the junction may taper or fade towards it."""
    axis = _Axis.of(graph)
    places = axis.places(np.concatenate([INK_NEAR, INK_FAR]))
    found = []
    for values in of_points:
        if values is None or not len(values):
            found.append(np.zeros(2 * graph.branch_count))
        else:
            seen = np.interp(places, axis.arc, values)
            found.append(seen[:, : len(INK_NEAR)].mean(1) - seen[:, len(INK_NEAR) :].mean(1))
    return found


def _unit(z: Array) -> Array:
    size = np.abs(z)
    return np.where(size > 1e-9, z / np.maximum(size, 1e-9), 1.0)


def _by_angle(halves: Array, frame: Array) -> Array:
    """Sort the half-branches of every junction around it; empty slots stay last."""
    angle = np.where(halves >= 0, np.angle(frame[halves]), np.inf)
    return np.take_along_axis(halves, np.argsort(angle, axis=1), axis=1)


def _fixed_pairs(
    graph: PlanarGraph, halves: Array, rows: Array, fixed: Mapping[int, tuple[Pair, ...]]
) -> Array:
    """(J, D, D) int8: 1 = the user joined this pair, -1 = the user decided against it."""
    decided = np.zeros((*halves.shape, halves.shape[1]), np.int8)
    row_of = {int(vertex): row for row, vertex in enumerate(rows)}
    for junction, pairs in fixed.items():
        row = row_of.get(int(graph.junctions[junction]))
        if row is None:
            continue
        decided[row] = -1
        slot = {int(half): place for place, half in enumerate(halves[row])}
        for a, b in pairs:
            decided[row, slot[a], slot[b]] = decided[row, slot[b], slot[a]] = 1
    return decided


def _appearance(graph: PlanarGraph) -> tuple[Array, Array, Array]:
    """Per branch: log of its width, strength, colour (B, 3) in [0, 1]; zeros where unknown."""
    count = np.maximum(np.diff(graph.offsets), 1)

    def mean(values: Array) -> Array:
        shape = (-1,) + (1,) * (values.ndim - 1)
        return np.add.reduceat(values, graph.offsets[:-1]) / count.reshape(shape)

    none = np.zeros(graph.branch_count)
    width = none if graph.widths is None else mean(np.log(np.maximum(graph.widths, 0.3) / 3.0))
    strength = none if graph.strength is None else mean(graph.strength.astype(np.float64)) - 0.7
    color = np.zeros((len(none), 3)) if graph.colors is None else mean(graph.colors / 255.0)
    return width, strength, color


def _token_features(
    graph: PlanarGraph, shape: _Shapes, halves: Array, filled: Array, degree: Array
) -> Array:
    half = halves[filled]
    turn = np.conj(shape.frame[half])[:, None]
    samples = shape.samples[half] * turn
    bend = np.angle(shape.heading[half] * turn)
    around = np.where(filled, np.angle(shape.frame[halves]), 0.0)
    before, after = _gaps(around, degree)
    own = np.minimum(np.broadcast_to(degree[:, None], halves.shape)[filled], 6) - 3
    far_vertex = graph.half_vertex[half ^ 1]
    far_degree = np.array([0, 1, 0, 2, 3, 4])[np.minimum(graph.degrees[far_vertex], 5)]
    width, strength, _ = _appearance(graph)
    length = shape.length[half]
    log_width = None if graph.widths is None else np.log(np.maximum(graph.widths, 0.3))
    wider, darker = _rise(graph, log_width, graph.strength)
    scalars = (
        np.log(np.maximum(length, 0.5) / 16.0),
        np.minimum(length / 16.0, 1.0),
        np.abs(shape.tip[half]) / np.maximum(length, 1e-6),
        before[filled] / np.pi,
        after[filled] / np.pi,
        far_vertex == graph.half_vertex[half],
        width[half >> 1],
        np.full(len(half), graph.widths is not None),
        strength[half >> 1],
        2.0 * wider[half],
        4.0 * darker[half],
    )
    return np.concatenate(
        [
            samples.real,
            samples.imag,
            2.0 * bend,
            np.tanh(shape.offset[half] / 2.0),
            np.eye(4)[own],
            np.eye(_FAR_DEGREES)[far_degree],
            np.stack(scalars, 1),
        ],
        axis=1,
        dtype=np.float32,
    )


def _gaps(angle: Array, degree: Array) -> tuple[Array, Array]:
    """(J, D) angles to the half-branch before and after each one, going round the junction."""
    if not angle.size:
        return angle, angle
    place = np.arange(angle.shape[1])
    last = (degree - 1)[:, None]
    before = np.take_along_axis(angle, np.where(place == 0, last, place - 1), 1)
    after = np.take_along_axis(angle, np.where(place >= last, 0, np.minimum(place + 1, last)), 1)
    return (angle - before) % (2 * np.pi), (after - angle) % (2 * np.pi)


def _pair_features(
    graph: PlanarGraph, shape: _Shapes, halves: Array, both: Array, degree: Array, decided: Array
) -> Array:
    row, a, b = np.nonzero(both)
    i, j = halves[row, a], halves[row, b]
    arriving = -np.conj(shape.frame[i])[:, None]
    samples = shape.samples[j] * arriving
    turn = np.angle(-shape.heading[j] * np.conj(shape.heading[i]))
    gap = np.tanh((shape.offset[i] + shape.offset[j]) / 4.0)

    straight = np.full(both.shape, np.inf)
    straight[both] = np.abs(turn[:, 1])
    rank = np.argsort(np.argsort(straight, axis=2), axis=2)[both]
    back = np.argsort(np.argsort(straight, axis=1), axis=1)[both]
    apart = np.abs(a - b)
    apart = np.minimum(apart, degree[row] - apart)

    width, strength, color = _appearance(graph)
    c, d = i >> 1, j >> 1
    scalars = (
        np.minimum(rank, 3) / 3.0,
        np.minimum(back, 3) / 3.0,
        (rank == 0) & (back == 0),
        apart == 1,
        2 * apart == degree[row],
        apart / degree[row],
        c == d,
        graph.half_vertex[i ^ 1] == graph.half_vertex[j ^ 1],
        np.exp(-np.abs(shape.tip[i] - shape.tip[j]) / 8.0),
        np.abs(width[c] - width[d]),
        np.abs(strength[c] - strength[d]),
        np.abs(color[c] - color[d]).sum(1),
        np.full(len(i), graph.colors is not None),
        decided[row, a, b] == 1,
        decided[row, a, b] == -1,
    )
    return np.concatenate(
        [
            samples.real,
            samples.imag,
            np.cos(turn),
            np.sin(turn),
            np.abs(turn),
            gap,
            np.stack(scalars, 1),
        ],
        axis=1,
        dtype=np.float32,
    )
