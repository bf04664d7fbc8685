"""The course of every half-branch, read where no neighbour spoils it.

The paper clusters triangles of the pixel graph and looks two pixel steps out of a cluster to see
where its branches go. Two pixels say little about a direction, and the ridge of a line is bent
towards any neighbour closer than about three line widths. So we mark, along every branch, what is
clean, and read its course only there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays.ragged import owners
from ..arrays.sampling import sample
from ..values import Array, PlanarGraph
from .evidence import Evidence
from .limits import LIMITS

CHUNK = 32768  # half-branches read at a time, which bounds the memory
WINDOW = 16  # points of a half-branch, outside its cluster, that tell where it goes


@dataclass(frozen=True, eq=False)
class Courses:
    """The half-branches of a graph, read outward from where they leave their cluster.

    exit: (2B,) int32, the point of graph.points at which the clean part begins.
    points: (2B, WINDOW, 2) float64, px, and weights: (2B, WINDOW) float64: the course from there
        on; the weight is small where a neighbour spoils the ridge, 0 past the end of the branch.
    level: (2B,) float64, mean brightness of the ridge along that course.
    center (2B, 2), outward (2B, 2): its middle, and the unit direction away from the cluster.
    bend: (2B,) float64, curvature there, 1/px; positive when it turns towards +y from +x.
    """

    exit: Array
    points: Array
    weights: Array
    level: Array
    center: Array
    outward: Array
    bend: Array


def spoilt(graph: PlanarGraph, shape: tuple[int, ...], reach: float) -> Array:
    """(P,) bool: points nearer than `reach` px to a line that isn't their own course."""
    # A number per point that jumps between branches: far apart = not the same piece of line.
    place = np.arange(len(graph.points)) + 64 * owners(graph.offsets) + 64
    margin = int(np.ceil(reach))
    pixel = np.clip(graph.points.astype(np.int32), 0, np.array(shape[::-1]) - 1) + margin
    image = np.zeros(np.add(shape, 2 * margin), np.int32)
    image[pixel[:, 1], pixel[:, 0]] = place
    # What shares a pixel with another line is spoilt, and so are all branches at their vertices.
    shares = np.abs(image[pixel[:, 1], pixel[:, 0]] - place) > 8
    image[pixel[shares, 1], pixel[shares, 0]] = -(1 << 20)
    ends = np.concatenate([graph.offsets[:-1], graph.offsets[1:] - 1])
    image[pixel[ends, 1], pixel[ends, 0]] = -(1 << 20)
    flat, base = image.ravel(), pixel[:, 1] * image.shape[1] + pixel[:, 0]
    found = np.zeros(len(place), bool)
    span = np.arange(-margin, margin + 1)
    for dy, dx in np.stack(np.meshgrid(span, span), -1).reshape(-1, 2):
        if dx * dx + dy * dy > reach * reach:
            continue
        other = flat[base + dy * image.shape[1] + dx]
        found |= (other != 0) & (np.abs(other - place) > 8)
    return found


def read_courses(graph: PlanarGraph, evidence: Evidence, halves: Array | None = None) -> Courses:
    """Where every half-branch leaves its cluster, and its course from there on.

    Args:
        graph: the skeleton's graph, its points on the crest of the lines.
        evidence: its smoothed centerline map.
        halves: (N,) those that are read, in this order; None = all.
    """
    value = evidence.value
    dirty = spoilt(graph, value.shape, LIMITS.course_reach * max(1.0, evidence.ridge_width / 2))
    starts, stops = graph.offsets[:-1].astype(np.int64), graph.offsets[1:].astype(np.int64) - 1
    index = np.arange(len(graph.points))
    usable = np.where(dirty, len(index), index)
    first = np.minimum.reduceat(usable, starts)
    last = np.maximum.reduceat(np.where(dirty, -1, index), starts)
    clean = last >= 0
    middle = (starts + stops) // 2
    leave = np.stack([np.where(clean, first, middle), np.where(clean, last, middle)], -1).ravel()
    # Without a clean point, the course is read a little nearer to the vertex; near the other end
    # it starts early enough to see a direction.
    length = np.repeat(stops - starts, 2)
    ahead = np.abs(leave - np.stack([starts, stops], -1).ravel())
    ahead = np.where(np.repeat(clean, 2), ahead, length // 4)
    ahead = np.minimum(ahead, np.maximum(length - 4, 0))
    begin = np.stack([starts, stops], -1).ravel() + np.tile([1, -1], graph.branch_count) * ahead
    step = np.tile([1, -1], graph.branch_count)
    limits = np.repeat(np.stack([starts, stops], -1), 2, axis=0)
    if halves is not None:
        begin, step, limits = begin[halves], step[halves], limits[halves]
    parts = [
        _read(graph, value, dirty, *(array[at : at + CHUNK] for array in (begin, step, limits)))
        for at in range(0, max(len(begin), 1), CHUNK)
    ]
    return Courses(
        begin.astype(np.int32), *(np.concatenate(read) for read in zip(*parts, strict=True))
    )


def _read(
    graph: PlanarGraph, value: Array, dirty: Array, begin: Array, step: Array, limits: Array
) -> tuple[Array, ...]:
    """Some half-branches from the points (N,) on at which they begin, in steps of 1 or -1, within
    limits (N, 2): all fields of `Courses` but the first."""
    place = begin[:, None] + step[:, None] * np.arange(WINDOW)
    inside = (place >= limits[:, :1]) & (place <= limits[:, 1:])
    place = np.clip(place, 0, len(graph.points) - 1)
    weights = np.where(dirty[place], LIMITS.course_dirty, 1.0) * inside
    points = graph.points[place].astype(np.float64)
    total = np.maximum(weights.sum(1), 1e-9)
    level = (sample(value, points) * weights).sum(1) / total
    near = weights * np.exp(-((np.arange(WINDOW) / LIMITS.course_fade) ** 2))
    outward = direction(points, near)
    return points, weights, level, _mean(points, near), outward, _bend(points, weights)


def direction(points: Array, weights: Array) -> Array:
    """Unit direction (K, 2) along which each course (K, N, 2) runs on from its first point."""
    centred = points - _mean(points, weights)[:, None]
    place = np.arange(points.shape[1], dtype=np.float64)
    total = np.maximum(weights.sum(1), 1e-9)
    place = place - ((weights * place).sum(1) / total)[:, None]
    slope = ((weights * place)[..., None] * centred).sum(1)
    return slope / np.maximum(np.hypot(*slope.T), 1e-9)[:, None]


def _bend(points: Array, weights: Array) -> Array:
    """(K,) curvature of each course: of the parabola through it, along its mean direction."""
    along = direction(points, weights)
    offset = points - _mean(points, weights)[:, None]
    x = (offset * along[:, None]).sum(-1)
    y = along[:, None, 0] * offset[..., 1] - along[:, None, 1] * offset[..., 0]
    powers = x[..., None] ** np.arange(3)
    weighted = powers * weights[..., None]
    # Short courses say little about how they bend.
    normal = np.einsum("kni,knj->kij", weighted, powers) + np.diag([1e-6, 1e-3, 50.0])
    fit = np.linalg.solve(normal, np.einsum("kni,kn->ki", weighted, y)[..., None])[..., 0]
    return 2 * fit[:, 2]


def _mean(points: Array, weights: Array) -> Array:
    total = np.maximum(weights.sum(1), 1e-9)
    return (points * weights[..., None]).sum(1) / total[:, None]
