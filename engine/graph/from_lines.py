"""Lines that someone has drawn as vectors -> a planar graph: cut where they cross, touch and meet.

1. Lines are cut where they cross another line or themselves, and where the end of one comes near
   another one (a T).
2. Cuts and ends that lie together are one vertex.
3. What is left between two vertices is a branch; tails that reach past a crossing by less than the
   pen, and stretches that vanish in a vertex, go.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays.ragged import arc, count_up, offsets_of, owners
from ..values import Array, PlanarGraph
from .nearby import near_pairs
from .topology import connected, join, lengths, select

STEP = 2.0  # px from point to point, at most: what lies near is found by the middles of segments
_LEAST_TOUCH = 1.0  # px; hairlines touch from as far
_WIDEST = 12.0  # px; lines wider than that reach no farther: working pages have pens of some 3 px
_PARALLEL = 1e-9  # sine of an angle; less is rounding, where one line lies upon another one
_WITHIN = 1e-6  # of a segment at either end, so that no crossing falls between two segments


def graph_of_lines(
    lines: Sequence[Array],
    widths: Array,
    strength: Array,
    colors: Array,
) -> PlanarGraph:
    """The planar graph of lines with a width, a strength and a colour each.

    Args:
        lines: (N, 2) px; one whose first point is its last is closed.
        widths: (L,) px; half of it is how near a line's end must come to another line to touch it.
        strength: (L,) in [0, 1]. colors: (L, 3) uint8.
    """
    lines, source = _clean(lines)
    if not lines:
        return PlanarGraph.empty()
    ink = _Ink([_dense(line) for line in lines], np.asarray(widths, np.float64)[source])
    line, at, place = _cuts(ink)
    cluster = _clusters(ink, line, place)
    graph, of = _branches(ink, line, at, cluster, place)
    of = np.asarray(source)[of]
    graph = PlanarGraph(
        *(graph.vertices, graph.points, graph.offsets, graph.ends),
        widths=np.asarray(widths, np.float32)[of],
        strength=np.asarray(strength, np.float32)[of],
        colors=np.asarray(colors, np.uint8)[of],
    )
    return join(graph)


class _Ink:
    """All lines end to end: `at` is the way along its own line to each point."""

    def __init__(self, lines: Sequence[Array], widths: Array) -> None:
        self.widths = np.minimum(widths, _WIDEST)
        self.points = np.concatenate(lines)
        self.offsets = offsets_of([len(line) for line in lines])
        self.of = owners(self.offsets)
        self.at = np.concatenate([arc(line) for line in lines])
        self.length = self.at[self.offsets[1:] - 1]
        self.closed = np.array([bool((line[0] == line[-1]).all()) for line in lines])
        inner = np.ones(len(self.points), bool)
        inner[self.offsets[1:] - 1] = False
        self.segments = np.flatnonzero(inner)

    def apart(self, i: Array, j: Array, least: Array | float) -> Array:
        """Whether two points are of different lines, or farther apart than that along one."""
        way = np.abs(self.at[i] - self.at[j])
        length = self.length[self.of[i]]
        way = np.where(self.closed[self.of[i]], np.minimum(way, length - way), way)
        return (self.of[i] != self.of[j]) | (way > least)


def _clean(lines: Sequence[Array]) -> tuple[list[Array], list[int]]:
    """The lines as float64 without points twice; what has no length is left out."""
    found, source = [], []
    for number, line in enumerate(lines):
        line = np.asarray(line, np.float64)
        line = line[np.concatenate([[True], np.hypot(*np.diff(line, axis=0).T) > 1e-6])]
        if len(line) > 1:
            found.append(line)
            source.append(number)
    return found, source


def _dense(line: Array) -> Array:
    parts = np.maximum(1, np.ceil(np.hypot(*np.diff(line, axis=0).T) / STEP)).astype(np.int64)
    share = (count_up(parts) / np.repeat(parts, parts))[:, None]
    first = np.repeat(np.arange(len(parts)), parts)
    return np.vstack([line[first] * (1 - share) + line[first + 1] * share, line[-1:]])


def _cuts(ink: _Ink) -> tuple[Array, Array, Array]:
    """All cuts and ends: the line, the way along it, and the place (N, 2)."""
    first, last = ink.offsets[:-1], ink.offsets[1:] - 1
    lines, ways = [ink.of[first], ink.of[last]], [ink.at[first], ink.at[last]]
    places = [ink.points[first], ink.points[last]]
    for line, way, place in (_crossings(ink), _touches(ink)):
        lines.append(line)
        ways.append(way)
        places.append(place)
    return np.concatenate(lines), np.concatenate(ways), np.concatenate(places)


def _crossings(ink: _Ink) -> tuple[Array, Array, Array]:
    points, segments = ink.points, ink.segments
    pairs = near_pairs((points[segments] + points[segments + 1]) / 2, STEP)
    i, j = segments[pairs[:, 0]], segments[pairs[:, 1]]
    far = ink.apart(i, j, 2 * STEP)
    i, j = i[far], j[far]
    p, d, q, e = points[i], points[i + 1] - points[i], points[j], points[j + 1] - points[j]
    cross = d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        s = ((q - p)[:, 0] * e[:, 1] - (q - p)[:, 1] * e[:, 0]) / cross
        t = ((q - p)[:, 0] * d[:, 1] - (q - p)[:, 1] * d[:, 0]) / cross
    hit = np.abs(np.stack([s, t]) - 0.5).max(0) <= 0.5 + _WITHIN
    hit &= np.abs(cross) > _PARALLEL * np.hypot(*d.T) * np.hypot(*e.T)
    i, j, s, t = i[hit], j[hit], s[hit], t[hit]
    place = points[i] + s[:, None] * (points[i + 1] - points[i])
    way = [ink.at[k] + share * (ink.at[k + 1] - ink.at[k]) for k, share in ((i, s), (j, t))]
    return np.concatenate([ink.of[i], ink.of[j]]), np.concatenate(way), np.tile(place, (2, 1))


def _touches(ink: _Ink) -> tuple[Array, Array, Array]:
    """Where the end of a line comes nearest to another line that it touches."""
    ends = np.concatenate([ink.offsets[:-1], ink.offsets[1:] - 1])[np.tile(~ink.closed, 2)]
    reach = ink.widths[ink.of]
    count = len(ends)
    within = float(reach.max()) + STEP
    pairs = near_pairs(np.concatenate([ink.points[ends], ink.points]), within)
    one, other = pairs.min(1), pairs.max(1) - count
    mixed = (one < count) & (other >= 0)
    one, other = one[mixed], other[mixed]
    end = ends[one]
    far = ink.apart(end, other, 4 * within)
    one, other, end = one[far], other[far], end[far]
    # Of the two segments at a point of the other line, the nearer place counts.
    best, way, place = np.full(len(end), np.inf), np.zeros(len(end)), np.zeros((len(end), 2))
    for a in (other - 1, other):
        good = (a >= 0) & (a + 1 < len(ink.points))
        good[good] = ink.of[a[good]] == ink.of[a[good] + 1]
        good &= ink.of[np.clip(a, 0, None)] == ink.of[other]
        k = np.clip(a, 0, len(ink.points) - 2)
        p, d = ink.points[k], ink.points[k + 1] - ink.points[k]
        share = ((ink.points[end] - p) * d).sum(1) / np.maximum((d * d).sum(1), 1e-12)
        share = np.clip(share, 0, 1)
        foot = p + share[:, None] * d
        distance = np.where(good, np.hypot(*(foot - ink.points[end]).T), np.inf)
        better = distance < best
        best[better], place[better] = distance[better], foot[better]
        way[better] = (ink.at[k] + share * (ink.at[k + 1] - ink.at[k]))[better]
    line = ink.of[other]
    touching = best <= np.maximum((reach[end] + reach[other]) / 2, _LEAST_TOUCH)
    # One cut for each end and each line that it touches: the nearest.
    order = np.lexsort([best, line, one])
    order = order[touching[order]]
    new = np.ones(len(order), bool)
    new[1:] = (one[order][1:] != one[order][:-1]) | (line[order][1:] != line[order][:-1])
    order = order[new]
    return line[order], way[order], place[order]


def _clusters(ink: _Ink, line: Array, place: Array) -> Array:
    """(N,) the number of the vertex that each cut belongs to: what lies within half a pen."""
    reach = np.maximum(ink.widths[line] / 2, _LEAST_TOUCH)
    pairs = near_pairs(place, float(2 * reach.max()))
    a, b = pairs.T
    near = np.hypot(*(place[a] - place[b]).T) <= reach[a] + reach[b]
    label = connected(len(place), pairs[near].astype(np.int32))
    return np.unique(label, return_inverse=True)[1]


def _branches(
    ink: _Ink, line: Array, at: Array, cluster: Array, place: Array
) -> tuple[PlanarGraph, Array]:
    """The pieces from cut to cut; also the line that each of their points is of."""
    count = int(cluster.max()) + 1
    times = np.bincount(cluster, minlength=count)[:, None]
    vertices = np.stack([np.bincount(cluster, place[:, k], count) for k in (0, 1)], 1) / times
    order = np.lexsort([at, line])
    line, at, cluster = line[order], at[order], cluster[order]
    same = np.flatnonzero(line[1:] == line[:-1])
    pieces, ends, source = [], [], []
    for k in same.tolist():
        a, b, number = cluster[k], cluster[k + 1], line[k]
        if a == b and at[k + 1] - at[k] < 3 * max(ink.widths[number], _LEAST_TOUCH):
            continue
        low, high = ink.offsets[number], ink.offsets[number + 1]
        way = ink.at[low:high]
        start, stop = np.searchsorted(way, at[k], "right"), np.searchsorted(way, at[k + 1])
        inner = ink.points[low + start : low + stop]
        # Points nearer to a vertex than it was moved would make a hook.
        for vertex in (vertices[a], vertices[b]):
            inner = inner[np.hypot(*(inner - vertex).T) > ink.widths[number] / 2]
        pieces.append(np.vstack([vertices[a], inner, vertices[b]]))
        ends.append((a, b))
        source.append(np.full(len(pieces[-1]), number))
    if not pieces:
        return PlanarGraph.empty(), np.zeros(0, np.int64)
    graph = PlanarGraph(
        vertices.astype(np.float32),
        np.concatenate(pieces).astype(np.float32),
        offsets_of([len(piece) for piece in pieces]).astype(np.int32),
        np.array(ends, np.int32),
    )
    return _without_tails(graph, np.concatenate(source), ink)


def _without_tails(graph: PlanarGraph, source: Array, ink: _Ink) -> tuple[PlanarGraph, Array]:
    """Without free ends at a junction that are shorter than the pen is wide."""
    degree = graph.degrees[graph.ends]
    wide = ink.widths[source[graph.offsets[:-1]]]
    tail = (degree.min(1) == 1) & (degree.max(1) > 2) & (lengths(graph) <= wide)
    stays = np.repeat(~tail, np.diff(graph.offsets))
    return select(graph, ~tail), source[stays]
