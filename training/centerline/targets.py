"""What the network should see: ridge, junctions, endpoints, half-width."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from involute.engine.centerline.learned import HALF_WIDTH_UNIT
from scipy.spatial import cKDTree

from ...synthesis.line_art import Array
from ...synthesis.media import STEP, Samples, nearest
from .lines_together import doubled

RIDGE_SIGMA = 0.8  # px; a ridge about 2 px wide keeps a valley between lines 3 px apart
SPOT_SIGMA = 1.5  # px, of a junction or an endpoint
MAX_HALF_WIDTH = HALF_WIDTH_UNIT  # also the unit of `apart`
_TOUCH = 1.5  # px between an end and another line that still is a touch
_MIN_ANGLE = np.sin(np.deg2rad(8))  # shallower crossings have no definite place


@dataclass(frozen=True)
class Targets:
    """(size, size) float32 maps; see `engine.values.LineMaps`. half_width and apart are px, 0 off
    the lines; doubled is `lines_together.UNKNOWN` where nobody can tell."""

    centerline: Array
    junctions: Array
    endpoints: Array
    half_width: Array
    doubled: Array
    apart: Array

    @staticmethod
    def blank(size: int) -> Targets:
        """The maps of a page without lines."""
        return Targets(*np.zeros((6, size, size), np.float32))


def targets(samples: Samples, half_width: Array, size: int) -> Targets:
    """The maps of the given strokes; half_width: (N,) px of each sample."""
    distance, owner = nearest(samples, np.zeros(len(samples)), size, 4.0)
    state, apart = doubled(samples, half_width)
    crossings = find_crossings(samples)
    touches, ends = find_ends(samples)
    near = (np.where(owner >= 0, of[owner], 0) for of in (half_width, state, apart))
    widths, two, gap = (of.astype(np.float32) for of in near)
    marks = spots(np.concatenate([crossings, touches]), size)
    return Targets(_ridge(distance), marks, spots(ends, size), widths, two, gap)


def ridge(samples: Samples, size: int) -> Array:
    """The (size, size) ridge map of some strokes."""
    return _ridge(nearest(samples, np.zeros(len(samples)), size, 4.0)[0])


def _ridge(distance: Array) -> Array:
    return np.exp(-0.5 * (distance / RIDGE_SIGMA) ** 2).astype(np.float32)


def spots(points: Array, size: int) -> Array:
    """A (size, size) heatmap: the maximum of a Gaussian at each of (N, 2) points."""
    heat = np.zeros((size, size), np.float32)
    r = int(4 * SPOT_SIGMA)
    points = points[((points > -r) & (points < size + r)).all(1)]
    if not len(points):
        return heat
    dy, dx = (o.ravel() for o in np.mgrid[-r : r + 1, -r : r + 1])
    cell = np.floor(points).astype(np.int64)
    x, y = cell[:, :1] + dx, cell[:, 1:] + dy
    d2 = (x + 0.5 - points[:, :1]) ** 2 + (y + 0.5 - points[:, 1:]) ** 2
    value = np.exp(-d2 / (2 * SPOT_SIGMA**2)).astype(np.float32)
    good = (x >= 0) & (y >= 0) & (x < size) & (y < size)
    np.maximum.at(heat, (y[good], x[good]), value[good])
    return heat


def find_crossings(samples: Samples) -> Array:
    """(K, 2) px: where strokes cross each other or themselves."""
    # Chords of two steps are plenty for a crossing and halve the work.
    even = (np.round(samples.arc / STEP).astype(int) % 2 == 0) | (
        samples.arc > samples.length - 1e-6
    )
    s = samples.take(even)
    joined = (s.stroke[1:] == s.stroke[:-1]) & (np.diff(s.arc) < 2.6 * STEP)
    a, b = s.position[:-1][joined], s.position[1:][joined]
    stroke, arc = s.stroke[:-1][joined], s.arc[:-1][joined]
    if len(a) < 2:
        return np.zeros((0, 2))
    longest = float(np.hypot(*(b - a).T).max())
    i, j = cKDTree((a + b) / 2).query_pairs(longest, output_type="ndarray").T
    other = (stroke[i] != stroke[j]) | (np.abs(arc[i] - arc[j]) > 4.0)
    i, j = i[other], j[other]
    r, q, gap = b[i] - a[i], b[j] - a[j], a[j] - a[i]
    clear = np.abs(_cross(r, q)) > _MIN_ANGLE * np.hypot(*r.T) * np.hypot(*q.T)
    i, j, r, q, gap = (of[clear] for of in (i, j, r, q, gap))
    t, u = _cross(gap, q) / _cross(r, q), _cross(gap, r) / _cross(r, q)
    meet = (t >= 0) & (t <= 1) & (u >= 0) & (u <= 1)
    i, j, r, t = (of[meet] for of in (i, j, r, t))
    # A closed stroke meets itself, and a corner another stroke's end, without a junction.
    points = a[i] + t[:, None] * r
    at_end = _at_end(samples, stroke[i], points) & _at_end(samples, stroke[j], points)
    return points[~at_end]


def _cross(a: Array, b: Array) -> Array:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def _at_end(samples: Samples, stroke: Array, points: Array) -> Array:
    """Whether (K, 2) points lie at an end of the strokes with the given (K,) numbers."""
    first, last = _ends(samples)
    table = np.full((samples.stroke.max() + 1, 2, 2), 1e9)
    table[samples.stroke[first], 0] = samples.position[first]
    table[samples.stroke[last], 1] = samples.position[last]
    return np.hypot(*(np.moveaxis(table[stroke] - points[:, None], -1, 0))).min(1) < _TOUCH


def _ends(samples: Samples) -> tuple[Array, Array]:
    """Indices of the samples that are the first and the last of their stroke."""
    return np.flatnonzero(samples.arc <= 0), np.flatnonzero(samples.arc >= samples.length - 1e-6)


def find_ends(samples: Samples) -> tuple[Array, Array]:
    """Where ends touch other lines, or three ends meet, and the free ends; (K, 2) px each."""
    ids = np.concatenate(_ends(samples))
    if not len(ids):
        return np.zeros((0, 2)), np.zeros((0, 2))
    ends = samples.position[ids]
    arc_end = np.minimum(samples.arc, samples.length - samples.arc)
    inner = np.flatnonzero(arc_end > 2.0)
    # Of its own stroke, an end may touch what is well away along the arc.
    touching = np.zeros(len(ids), bool)
    contact = ends.copy()
    if len(inner):
        near = cKDTree(samples.position[inner]).query(ends, k=24, distance_upper_bound=_TOUCH)
        found = np.isfinite(near[0])
        other = inner[np.where(found, near[1], 0)]
        same = samples.stroke[other] == samples.stroke[ids][:, None]
        own = np.abs(samples.arc[other] - samples.arc[ids][:, None])
        found &= ~same | (own > 8.0)
        touching = found.any(1)
        contact = samples.position[other[np.arange(len(ids)), found.argmax(1)]]
    pairs = cKDTree(ends).query_pairs(_TOUCH, output_type="ndarray")
    meeting = np.bincount(pairs.ravel(), minlength=len(ids)) + 1
    joint = touching | (meeting >= 3)
    free = (meeting == 1) & ~touching
    place = np.where(touching[:, None], contact, ends)
    return place[joint], ends[free]
