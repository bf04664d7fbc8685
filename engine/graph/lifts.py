"""Places where the pen may have been lifted, though only two lines meet: corners, seams, gaps.

Nothing but the picture can say whether an artist drew around a corner or began anew there: ends
overshoot, stop short, taper, or miss each other. So a branch is cut wherever it turns suddenly,
fades, or where the endpoint map sees an end in its course. The new vertices have degree two, and
routing decides at each of them, as at a junction, whether the stroke goes on (`routing.lifting`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np

from ..arrays.sampling import sample
from ..settings import Settings
from ..values import Array, LineMaps, PlanarGraph, Scan
from .clues import available, clues
from .evidence import Evidence
from .nearby import near_between, near_pairs
from .topology import join, lengths

ARM = 1.5  # pen widths of line on both sides that tell a corner
LEAST_ARM = 4  # px
TURN = np.radians(35.0)  # over the arm; nine in ten lifts at corners turn by more
SUDDEN = 0.5  # share of the turn that half the arm must have; 0.5 on a circle
ENDED = 0.35  # of the endpoint map
FADED = 0.4  # share of the branch's own brightness below which the line is broken
CLEAR = 1.5  # pen widths from a junction or free end; nearer, it is that one's business
FREE, LEAST_FREE = 3.0, 8  # pen widths and px from a free end, which the endpoint map sees as well
_REACH = np.array([0.5, 1.0, 1.5, 2.0, 3.0])  # pen widths beyond a corner: overshoots
_SHARP = np.radians(60.0)  # a turn that nobody takes for a curve
_IN_LINE = np.cos(np.radians(35.0))  # two directions that are one line
_SCALES = (0.75, 1.5, 3.0, 6.0)  # pen widths; arms over which a turn is measured


def mark_lifts(graph: PlanarGraph, evidence: Evidence, settings: Settings) -> PlanarGraph:
    """Cut every branch where the pen may have been lifted.

    Reads: the final, measured lines, the page and all its maps.
    Promises: vertices of degree two, each with its clues; no line moves. Without weights, without
    a page, or if strokes run through all corners, the graph stays.
    """
    if evidence.scan is None or settings.corners <= -1.0 or not available():
        return graph
    cut, seen = cut_at_lifts(graph, evidence.scan, evidence.maps)
    return replace(cut, clues=clues(seen))


def cut_at_lifts(graph: PlanarGraph, scan: Scan, maps: LineMaps) -> tuple[PlanarGraph, Array]:
    """Cut the branches of a measured graph wherever the pen may have been lifted.

    Args:
        graph: points about 1 px apart.

    Returns:
        The graph with vertices of degree two, and the (C, F) float32 evidence at each of them,
        in order of `graph.corners`.
    """
    if graph.branch_count == 0:
        return graph, np.zeros((0, evidence_size()), np.float32)
    course = _Course.of(graph, max(scan.pen_width, 1.5))
    places = _proposed(course, maps)
    seen = evidence(course, places, scan, maps)
    cut, order = _cut(graph, places)
    return cut, seen[order]


@dataclass(frozen=True, eq=False)
class _Course:
    """A graph whose points can be walked along their branches, round and round on rings.

    first, last: (P,) of the branch of each point; ring: (P,) bool. pen: px.
    """

    graph: PlanarGraph
    points: Array
    first: Array
    last: Array
    ring: Array
    pen: float

    @staticmethod
    def of(graph: PlanarGraph, pen: float) -> _Course:
        count = np.diff(graph.offsets)
        ring = (graph.ends[:, 0] == graph.ends[:, 1]) & (graph.degrees[graph.ends[:, 0]] == 2)
        return _Course(
            graph,
            graph.points.astype(np.float64),
            np.repeat(graph.offsets[:-1].astype(np.int64), count),
            np.repeat(graph.offsets[1:].astype(np.int64) - 1, count),
            np.repeat(ring, count),
            pen,
        )

    def step(self, place: Array, by: Array | int) -> Array:
        """The points `by` points further on, at most to the end of the branch."""
        first, last = self.first[place], self.last[place]
        around = first + (place - first + by) % np.maximum(last - first, 1)
        return np.where(self.ring[place], around, np.clip(place + by, first, last))

    def room(self, place: Array) -> Array:
        """(N,) points to the nearer end of the branch; half the way round on rings."""
        first, last = self.first[place], self.last[place]
        return np.where(
            self.ring[place], (last - first) // 2, np.minimum(place - first, last - place)
        )

    def turn(self, place: Array, arm: int) -> Array:
        """(N,) the angle between the chords over `arm` points before and after, 0 to pi."""
        reach = np.minimum(arm, np.maximum(self.room(place), 1))
        a = self.points[place] - self.points[self.step(place, -reach)]
        b = self.points[self.step(place, reach)] - self.points[place]
        return np.abs(np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], (a * b).sum(1)))


def _proposed(course: _Course, maps: LineMaps) -> Array:
    """The points (C,) at which to cut, ascending; on a ring without one, its first point."""
    graph = course.graph
    every = np.arange(len(graph.points))
    arm = max(LEAST_ARM, round(ARM * course.pen))
    turn = course.turn(every, arm)
    sudden = course.turn(every, max(2, arm // 2)) > SUDDEN * turn
    bright = sample(maps.centerline, graph.points).astype(np.float64)
    usual = np.repeat(
        np.maximum(np.add.reduceat(bright, graph.offsets[:-1]) / np.diff(graph.offsets), 1e-3),
        np.diff(graph.offsets),
    )
    told = [np.where(sudden, turn / TURN, 0.0), (1 - bright / usual) / (1 - FADED)]
    if maps.endpoints is not None:
        near = cv2.dilate(maps.endpoints, np.ones((3, 3), np.uint8))
        told.append(sample(near, graph.points) / ENDED)
    clear = course.room(every) >= max(LEAST_ARM - 1, round(CLEAR * course.pen))
    clear &= ~course.ring | (every < course.last)
    signs = np.where(clear, np.stack(told), 0.0)
    signs[1:, _near_free_end(course, every)] = 0.0
    strength = signs.sum(0)
    best = np.flatnonzero(signs.max(0) >= 1)
    for k in range(1, arm + 1):
        before = course.step(best, -k)
        later = strength[best] >= strength[course.step(best, k)]
        best = best[later & ((strength[best] > strength[before]) | (before == best))]
    whole = np.ones(graph.branch_count, bool)
    whole[np.searchsorted(graph.offsets, best, "right") - 1] = False
    starts = graph.offsets[:-1][course.ring[graph.offsets[:-1]] & whole]
    return np.sort(np.concatenate([best, starts]))


def _near_free_end(course: _Course, place: Array) -> Array:
    """(N,) bool: a loose end of the branch is so near that it is what the maps see."""
    graph = course.graph
    branch = np.searchsorted(graph.offsets, place, "right") - 1
    loose = graph.degrees[graph.ends[branch]] == 1
    near = max(LEAST_FREE, round(FREE * course.pen))
    way = np.stack([place - course.first[place], course.last[place] - place], -1)
    return (loose & (way < near)).any(1)


def _cut(graph: PlanarGraph, places: Array) -> tuple[PlanarGraph, Array]:
    """Cut branches at some of their points; what was of degree two before is joined.

    Returns:
        The graph, and which of the places each of its corners is.
    """
    inner = ~np.isin(places, graph.offsets[:-1])
    at, count = places[inner], len(graph.vertices)
    vertex = np.empty(len(places), np.int64)
    vertex[inner] = count + np.arange(len(at))
    vertex[~inner] = graph.ends[np.searchsorted(graph.offsets, places[~inner]), 0]
    pieces = split(graph, at)
    hold = np.zeros(len(pieces.vertices), bool)
    hold[vertex] = True
    stays = (pieces.degrees != 2) & (pieces.degrees > 0) | hold
    number = np.full(len(hold), -1)
    number[vertex] = np.arange(len(places))
    return join(pieces, hold), number[stays & (pieces.degrees == 2)]


def split(graph: PlanarGraph, at: Array) -> PlanarGraph:
    """Cut branches at some of their inner points (K,), ascending; the new vertices come last."""
    if not len(at):
        return graph
    # A cut is the last point of one piece and the first of the next.
    where = np.sort(np.concatenate([np.arange(len(graph.points)), at]), kind="stable")
    stops = np.sort(np.concatenate([graph.offsets[1:], at + 1]))
    inner = np.isin(stops, at + 1)
    fresh = len(graph.vertices) + np.arange(len(at))
    tail, head = np.empty(len(stops), np.int64), np.empty(len(stops), np.int64)
    tail[inner], tail[~inner] = fresh, graph.ends[:, 1]
    opens = np.concatenate([[False], inner[:-1]])
    head[opens], head[~opens] = fresh, graph.ends[:, 0]
    return PlanarGraph(
        np.concatenate([graph.vertices, graph.points[at]]),
        graph.points[where],
        np.concatenate([[0], stops + np.searchsorted(at, stops - 1)]).astype(np.int32),
        np.stack([head, tail], -1).astype(np.int32),
        **graph.measures(where),
    )


# --- evidence --------------------------------------------------------------------------------


def evidence(course: _Course, places: Array, scan: Scan, maps: LineMaps) -> Array:
    """(C, F) float32: what is seen at places of a graph that tells a lift from a turn."""
    parts = [
        _shape(course, places),
        _ink(course, places),
        _beyond(course, places, scan, maps),
        _between(course, places, scan, maps),
        _page(course, places, maps),
    ]
    return np.concatenate(parts, axis=1, dtype=np.float32)


def evidence_size() -> int:
    """F, how many numbers that is."""
    return len(_SCALES) + 11 + 11 + 4 * len(_REACH) + 12 + 15


def _two(a: Array, b: Array) -> list[Array]:
    """The two sides of a corner have no order: the smaller and the larger of each."""
    return [np.minimum(a, b), np.maximum(a, b)]


def _sides(course: _Course, places: Array) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Of both sides a (C, 2) point of the line fitted 1 to 4 pens away, and the unit direction in
    which that line arrives at the corner."""
    low, high = 0.8 * course.pen, max(4.0 * course.pen, 8.0)
    room = np.maximum(course.room(places), 2)[:, None]
    reach = np.linspace(low, high, 8) * np.minimum(1.0, room / high)
    found = []
    for sign in (-1, 1):
        by = np.maximum(np.rint(reach), 1).astype(np.int64) * sign
        side = course.points[course.step(places[:, None], by)]
        middle = side.mean(1)
        u = np.linspace(1, -1, 8)
        way = np.einsum("k,nkc->nc", u, side - middle[:, None])
        found.append((middle, way / np.maximum(np.hypot(*way.T), 1e-9)[:, None]))
    return found[0], found[1]


def _meeting(course: _Course, places: Array) -> tuple[Array, Array, Array]:
    """Where the lines of both sides meet (the corner itself, if nowhere near), and their
    directions, (C, 2) each."""
    (p, u), (q, v) = _sides(course, places)
    cross = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    gap = q - p
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (gap[:, 0] * v[:, 1] - gap[:, 1] * v[:, 0]) / cross
        meet = p + t[:, None] * u
        far = np.hypot(*(meet - course.points[places]).T) > 2.5 * course.pen
    lost = far | ~np.isfinite(meet).all(1) | (np.abs(cross) < 0.3)
    return np.where(lost[:, None], course.points[places], meet), u, v


def _shape(course: _Course, places: Array) -> Array:
    pen, points = course.pen, course.points
    graph = course.graph
    turns = [course.turn(places, max(2, round(scale * pen))) for scale in _SCALES]
    (p, u), (q, v) = _sides(course, places)
    corner = points[places]
    aside = [np.abs(_cross(way, corner - at)) / pen for at, way in ((p, u), (q, v))]
    meet, _, _ = _meeting(course, places)
    bent = []
    for sign in (-1, 1):
        reach = np.rint(np.linspace(1, 6 * pen, 10)).astype(np.int64)
        side = points[course.step(places[:, None], sign * reach)] - corner[:, None]
        chord = side[:, -1] / np.maximum(np.hypot(*side[:, -1].T), 1e-9)[:, None]
        off = side[..., 0] * chord[:, None, 1] - side[..., 1] * chord[:, None, 0]
        bent.append(np.sqrt((off * off).mean(1)) / pen)
    room = [np.log1p((places - course.first[places]) / pen)]
    room.append(np.log1p((course.last[places] - places) / pen))
    branch = np.searchsorted(graph.offsets, places, "right") - 1
    degree = graph.degrees[graph.ends[branch]]
    return np.column_stack(
        [
            *turns,
            *_two(*aside),
            np.hypot(*(meet - corner).T) / pen,
            *_two(*bent),
            *_two(*room),
            course.ring[places],
            (degree == 1).sum(1),
            (degree >= 3).sum(1),
            np.log1p(lengths(graph)[branch] / pen),
        ]
    )


def _cross(a: Array, b: Array) -> Array:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def _ink(course: _Course, places: Array) -> Array:
    """How width and darkness change towards the corner and across it."""
    graph, pen = course.graph, course.pen
    zeros = np.zeros(len(graph.points))
    columns = []
    for values in (
        zeros if graph.widths is None else np.log(np.maximum(graph.widths, 0.3) / pen),
        zeros if graph.strength is None else graph.strength.astype(np.float64),
    ):
        here = _along(course, values, places, (0.0, 0.3))
        near = _along(course, values, places, (0.5, 1.5))
        far = _along(course, values, places, (3.0, 6.0))
        columns += _two(near[0] - far[0], near[1] - far[1])
        columns += [here[0] - (far[0] + far[1]) / 2, np.abs(near[0] - near[1])]
        columns.append(np.abs(far[0] - far[1]))
    columns.append(np.full(len(places), graph.widths is not None))
    return np.column_stack(columns)


def _along(course: _Course, values: Array, places: Array, span: tuple[float, float]) -> list[Array]:
    """The mean of values of the points over a stretch in pen widths, before and after."""
    reach = np.rint(np.linspace(*span, 5) * course.pen).astype(np.int64)
    steps = [course.step(places[:, None], sign * reach) for sign in (-1, 1)]
    return [values[at].mean(1) for at in steps]


def _beyond(course: _Course, places: Array, scan: Scan, maps: LineMaps) -> Array:
    """Ink and ridge where each side would go on beyond the corner: what overshoots shows there."""
    meet, u, v = _meeting(course, places)
    full = _level(course, scan.ink)
    columns = []
    for image, level in ((scan.ink, full), (maps.centerline, _level(course, maps.centerline))):
        seen = [
            sample(image, meet[:, None] + (_REACH * course.pen)[:, None] * way[:, None]) / level
            for way in (u, v)
        ]
        columns += [np.minimum(*seen), np.maximum(*seen)]
    return np.concatenate(columns, axis=1)


def _level(course: _Course, image: Array) -> float:
    """What an image usually is on the lines."""
    return max(float(np.median(sample(image, course.graph.points))), 0.05)


def _between(course: _Course, places: Array, scan: Scan, maps: LineMaps) -> Array:
    """Gaps on the way through the corner, and what the spot maps see there."""
    reach = np.rint(np.linspace(-2.0, 2.0, 17) * course.pen).astype(np.int64)
    way = course.graph.points[course.step(places[:, None], reach)]
    columns = []
    for image in (scan.ink, maps.centerline):
        seen = sample(image, way) / _level(course, image)
        columns += [seen.min(1), seen.mean(1), seen[:, 6:11].min(1)]
    corner = course.graph.points[places]
    for heat in (maps.endpoints, maps.junctions):
        for size in (3, 7, 2 * round(1.5 * course.pen) + 3):
            if heat is None:
                columns.append(np.zeros(len(places)))
            else:
                columns.append(sample(cv2.dilate(heat, np.ones((size, size), np.uint8)), corner))
    return np.column_stack(columns)


def _page(course: _Course, places: Array, maps: LineMaps) -> Array:
    """How the whole page is drawn, the same for all its corners: most lifts are no corners of two
    half-branches, since ends that overshoot make junctions, and those that miss stay loose."""
    graph, pen = course.graph, course.pen
    length = lengths(graph) / pen
    total = max(float(length.sum()), 1.0)
    arm = max(LEAST_ARM, round(ARM * pen))
    sharp = float((course.turn(places, arm) > _SHARP).sum())
    free = np.flatnonzero(graph.degrees[graph.half_vertex] == 1)
    loose = graph.degrees[graph.ends].min(1, initial=9) == 1
    loose &= graph.degrees[graph.ends].max(1, initial=0) >= 3
    nubs = [float((loose & (length >= a) & (length < b)).sum()) for a, b in ((0, 2), (2, 5))]
    missed = _missed(course, free)
    heat = 0.0
    if maps.endpoints is not None and len(free):
        near = cv2.dilate(maps.endpoints, np.ones((5, 5), np.uint8))
        heat = float(sample(near, graph.vertices[graph.half_vertex[free]]).mean())
    about = [
        np.log(pen),
        np.log1p(sharp),
        np.log(total),
        10 * len(free) / total,
        10 * len(graph.junctions) / total,
        10 * len(places) / total,
        heat,
        _bent_forks(course),
        *(count / (count + sharp + 2) for count in (*nubs, *missed)),
    ]
    return np.tile(about, (len(places), 1))


def _missed(course: _Course, free: Array) -> list[float]:
    """How many loose ends are near another line (1, 2 and 3 pens away), and how many pairs of
    them are near each other, at an angle and in line."""
    graph, pen = course.graph, course.pen
    if not len(free):
        return [0.0] * 5
    tips = graph.vertices[graph.half_vertex[free]].astype(np.float64)
    branch = free >> 1
    count = np.diff(graph.offsets)
    owner = np.repeat(np.arange(graph.branch_count), count)
    every = np.arange(0, len(graph.points), 2)
    a, b = near_between(tips, course.points[every], 3 * pen)
    b = every[b]
    other = owner[b] != branch[a]
    # What hangs on the same vertex as a short branch is near its tip anyway.
    far = graph.half_vertex[free ^ 1]
    hangs = (graph.ends[owner[b]] == far[a, None]).any(1) & (count[branch[a]] < 6 * pen)
    a, b = a[other & ~hangs], b[other & ~hangs]
    nearest = np.full(len(free), np.inf)
    np.minimum.at(nearest, a, np.hypot(*(tips[a] - course.points[b]).T) / pen)
    a, b = near_pairs(tips, 3 * pen).T
    close = (branch[a] != branch[b]) & (np.hypot(*(tips[a] - tips[b]).T) < 3 * pen)
    out = _outward(course, free)
    line = (out[a[close]] * out[b[close]]).sum(1) < -_IN_LINE
    found = [float((nearest < k).sum()) for k in (1, 2, 3)]
    return [*found, float((~line).sum()), float(line.sum())]


def _outward(course: _Course, halves: Array) -> Array:
    """(N, 2) unit directions in which half-branches arrive at their vertices."""
    graph = course.graph
    branch, back = halves >> 1, (halves & 1) == 1
    tip = np.where(back, graph.offsets[branch + 1] - 1, graph.offsets[branch]).astype(np.int64)
    reach = max(LEAST_ARM, round(2 * course.pen))
    way = course.points[tip] - course.points[course.step(tip, np.where(back, -reach, reach))]
    return way / np.maximum(np.hypot(*way.T), 1e-9)[:, None]


def _bent_forks(course: _Course) -> float:
    """Share of the junctions of three at which no line runs straight on."""
    graph = course.graph
    forks = graph.junctions[graph.degrees[graph.junctions] == 3]
    if not len(forks):
        return 0.0
    order, starts = graph.halves_at
    out = _outward(course, order[starts[forks][:, None] + np.arange(3)].reshape(-1))
    out = out.reshape(-1, 3, 2)
    straight = np.min([(out[:, i] * out[:, j]).sum(1) for i, j in ((0, 1), (0, 2), (1, 2))], axis=0)
    return float((straight > -_IN_LINE).mean())
