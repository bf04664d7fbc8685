"""True pen strokes -> planar graph with its true routing: what routing is fitted and judged on.

`graph_from_strokes` cuts strokes exactly where they cross, touch or meet, and says which
half-branches belong together because one pen stroke ran through them. No pixels are involved, so
routing can be looked at alone, with a perfect graph.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from involute.engine.arrays.ragged import along as along_line
from involute.engine.arrays.ragged import arc as arc_length
from involute.engine.arrays.ragged import count_up, offsets_of
from involute.engine.values import PlanarGraph
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

Array = np.ndarray

_STEP = 3.0  # px; longest segment after densifying, so that midpoints find every crossing
_PARALLEL = 0.9  # |cosine| of two tangents that count as running along each other
_LONG_RUN = 18.0  # px that two lines run together before the second one counts as drawn twice
_END_RUN = 3.0  # px; the same where a stroke ends: it is absorbed at once


def graph_from_strokes(
    strokes: Sequence[Array],
    *,
    touch: float = 1.5,
    merge: float = 1.0,
    doubled: float = 1.0,
    widths: Sequence[float] | None = None,
    strength: Sequence[float] | None = None,
    colors: Sequence[tuple[int, int, int]] | None = None,
) -> tuple[PlanarGraph, Array]:
    """The planar graph of pen strokes, and the involution that gives the strokes back.

    Crossings, self-crossings, ends that touch a stroke (T) and ends that meet become vertices.
    Where exactly two ends meet and nothing else does, the line just runs on (there is no vertex
    of degree 2), as any tracer would see it. Lines drawn twice are kept once: the shorter stroke
    loses the stretch that it shares, since routing there would have two contradicting truths.

    Args:
        strokes: (N, 2) polylines in px; a stroke whose ends are within `touch` is closed.
        touch: how near an end must come to a line to touch it; overshoots shorter than this are
            taken off.
        merge: meeting points nearer to each other than this become one vertex.
        doubled: lines nearer than this, and parallel, count as one line; 0 keeps all.
        widths, strength, colors: one value per stroke, handed to its points.

    Returns:
        The graph, and (2B,) int32 partners: partner[partner[h]] == h, and partner[h] == h where
        the stroke ends; the two halves of a circle without junctions are partners of each other.
    """
    lines, source = _single_lines(strokes, doubled)
    if not lines:
        return PlanarGraph.empty(), np.zeros(0, np.int32)
    ink = _Ink(lines, touch)
    position, visits = _visits(ink, touch, merge)
    graph, of_point, partner = dissolve(*_branches(ink, position, visits, merge))
    of_point = np.asarray(source)[of_point]
    given = {"widths": (widths, np.float32), "strength": (strength, np.float32)}
    values = {k: np.asarray(v, t)[of_point] for k, (v, t) in given.items() if v is not None}
    if colors is not None:
        values["colors"] = np.asarray(colors, np.uint8)[of_point]
    return PlanarGraph(graph.vertices, graph.points, graph.offsets, graph.ends, **values), partner


def single_lines(strokes: Sequence[Array], doubled: float = 1.0) -> list[Array]:
    """The strokes without what is drawn twice, as `graph_from_strokes` takes them."""
    return _single_lines(strokes, doubled)[0]


def _single_lines(strokes: Sequence[Array], doubled: float) -> tuple[list[Array], list[int]]:
    lines, source = _clean(strokes)
    if doubled > 0 and lines:
        lines, source = _drop_doubled(lines, source, doubled)
    return lines, source


class _Ink:
    """All strokes densified and laid end to end; `key` is an arc length that grows over all."""

    def __init__(self, lines: list[Array], touch: float) -> None:
        dense = [_densify(line) for line in lines]
        arcs = [arc_length(line) for line in dense]
        self.points = np.concatenate(dense)
        self.stroke = np.repeat(np.arange(len(dense)), [len(d) for d in dense])
        self.length = np.array([a[-1] for a in arcs])
        gap = np.array([np.hypot(*(d[0] - d[-1])) for d in dense])
        self.closed = (gap <= touch) & (self.length > 6 * touch)
        # A margin between strokes keeps `key` strictly apart.
        self.base = np.concatenate([[0.0], np.cumsum(self.length + 10.0)])[:-1]
        self.key = np.concatenate(arcs) + self.base[self.stroke]
        self.segment = np.flatnonzero(self.stroke[1:] == self.stroke[:-1])
        a, b = self.points[self.segment], self.points[self.segment + 1]
        self.tree = cKDTree((a + b) / 2)

    def arc_of(self, index: Array) -> Array:
        return self.key[index] - self.base[self.stroke[index]]


def _clean(strokes: Sequence[Array]) -> tuple[list[Array], list[int]]:
    """Strokes as float64 without repeated points; what is shorter than a pixel is left out."""
    lines, source = [], []
    for index, stroke in enumerate(strokes):
        line = np.asarray(stroke, float).reshape(-1, 2)
        line = line[np.isfinite(line).all(1)]
        line = line[np.r_[True, np.hypot(*np.diff(line, axis=0).T) > 1e-6]] if len(line) else line
        if len(line) >= 2 and np.hypot(*np.diff(line, axis=0).T).sum() >= 1.0:
            lines.append(line)
            source.append(index)
    return lines, source


def _densify(line: Array) -> Array:
    """The same polyline with points added so that no segment is longer than `_STEP`."""
    size = np.hypot(*np.diff(line, axis=0).T)
    parts = np.maximum(1, np.ceil(size / _STEP)).astype(int)
    share = count_up(parts) / np.repeat(parts, parts)
    first = np.repeat(np.arange(len(parts)), parts)
    inner = line[first] + share[:, None] * (line[first + 1] - line[first])
    return np.vstack([inner, line[-1:]])


def _drop_doubled(
    lines: list[Array], source: list[int], radius: float
) -> tuple[list[Array], list[int]]:
    """Cut away what runs along a longer stroke (or along an earlier part of the same one)."""
    arcs = [arc_length(line) for line in lines]
    length = np.array([a[-1] for a in arcs])
    at = [np.linspace(0, a[-1], max(2, round(a[-1]) + 1)) for a in arcs]
    sample = np.concatenate([along_line(line, t) for t, line in zip(at, lines, strict=True)])
    owner = np.repeat(np.arange(len(lines)), [len(t) for t in at])
    arc = np.concatenate(at)
    before = np.maximum(np.arange(len(arc)) - 1, np.searchsorted(owner, owner))
    after = np.minimum(np.arange(len(arc)) + 1, np.searchsorted(owner, owner, "right") - 1)
    tangent = sample[after] - sample[before]
    tangent /= np.maximum(np.hypot(*tangent.T), 1e-9)[:, None]

    i, j = cKDTree(sample).query_pairs(radius, output_type="ndarray").T
    along = np.abs((tangent[i] * tangent[j]).sum(1)) > _PARALLEL
    other = (owner[i] != owner[j]) | (np.abs(arc[i] - arc[j]) > 3 * radius)
    wraps = np.abs(arc[i] - arc[j]) > length[owner[i]] - 3 * radius
    other &= ~((owner[i] == owner[j]) & wraps)
    i, j = i[along & other], j[along & other]
    rank = np.empty(len(lines), int)
    rank[np.argsort(-length, kind="stable")] = np.arange(len(lines))
    i_later = (rank[owner[i]] > rank[owner[j]]) | ((owner[i] == owner[j]) & (arc[i] > arc[j]))
    twice = np.zeros(len(sample), bool)
    twice[np.where(i_later, i, j)] = True

    kept, kept_source = [], []
    for k, line in enumerate(lines):
        mine = slice(*np.searchsorted(owner, [k, k + 1]))
        for low, high in _stretches_left(twice[mine], arc[mine]):
            inside = (arcs[k] > low) & (arcs[k] < high)
            tips = along_line(line, np.array([low, high]))
            kept.append(np.vstack([tips[:1], line[inside], tips[1:]]))
            kept_source.append(source[k])
    return kept, kept_source


def _stretches_left(twice: Array, arc: Array) -> list[tuple[float, float]]:
    """The (from, to) arc lengths of a stroke that are not drawn twice."""
    if not twice.any():
        return [(0.0, float(arc[-1]))]
    edge = np.flatnonzero(np.diff(np.r_[False, twice, False].astype(int)))
    starts, stops = edge[::2], edge[1::2] - 1
    far = arc[starts[1:]] - arc[stops[:-1]] > _END_RUN
    runs = np.c_[arc[starts[np.r_[True, far]]], arc[stops[np.r_[far, True]]]]
    size = runs[:, 1] - runs[:, 0]
    at_end = (runs[:, 0] <= 1.5) | (runs[:, 1] >= arc[-1] - 1.5)
    runs = runs[(size >= _LONG_RUN) | (at_end & (size >= _END_RUN)) | (size > 0.6 * arc[-1])]
    bounds = np.r_[0.0, runs.ravel(), arc[-1]].reshape(-1, 2)
    return [(a, b) for a, b in bounds if b - a > 2.0]


def _visits(ink: _Ink, touch: float, merge: float) -> tuple[Array, tuple[Array, Array, Array]]:
    """Where strokes meet: vertex positions, and (stroke, arc, vertex) visits sorted along them."""
    events = [_crossings(ink), _touches(ink, touch)]
    stroke, arc = (np.concatenate([e[k] for e in events]) for k in (0, 1))
    link = np.concatenate([events[0][2], events[1][2] + len(events[0][0])])
    is_open = ~ink.closed[stroke]
    size = ink.length[stroke]
    # Strokes that overshoot by less than `touch` end on the line that they overshoot.
    arc = np.where(
        is_open & (arc < touch), 0.0, np.where(is_open & (arc > size - touch), size, arc)
    )
    is_end = is_open & ((arc == 0) | (arc == size))
    place = _at(ink, stroke, arc)

    near = cKDTree(place).query_pairs(merge, output_type="ndarray") if len(place) else link
    edges = np.concatenate([link, near]).astype(int)
    graph = coo_matrix((np.ones(len(edges)), edges.T), (len(place),) * 2)
    count, cluster = connected_components(graph, directed=False)
    # The line that runs through says where the junction is; ends only where there is none.
    weight = np.where(is_end, 1e-6, 1.0)
    total = np.bincount(cluster, weight, count)
    position = np.stack(
        [np.bincount(cluster, weight * place[:, c], count) / total for c in (0, 1)], 1
    )

    # Ends that meet nothing, and one vertex for every closed stroke that meets nothing.
    met = np.zeros((2, len(ink.length)), bool)
    met[(arc[is_end] > 0).astype(int), stroke[is_end]] = True
    lone = ink.closed & (np.bincount(stroke, minlength=len(ink.length)) == 0)
    side, free = np.nonzero(~met & ~ink.closed | np.stack([lone, np.zeros_like(lone)]))
    free_arc = np.where(side == 1, ink.length[free], 0.0)
    position = np.concatenate([position, _at(ink, free, free_arc)])
    vertex = np.concatenate([cluster, count + np.arange(len(free))])
    stroke, arc = np.concatenate([stroke, free]), np.concatenate([arc, free_arc])

    order = np.lexsort((arc, stroke))
    stroke, arc, vertex = stroke[order], arc[order], vertex[order]
    # Going round a loop smaller than this is one visit, at its middle or at the stroke's end.
    tiny = max(4.0, 3 * merge)
    same = (np.diff(stroke) == 0) & (np.diff(vertex) == 0) & (np.diff(arc) < tiny)
    first, last = np.r_[True, ~same], np.r_[~same, True]
    stroke, vertex, low, high = stroke[first], vertex[first], arc[first], arc[last]
    open_, size = ~ink.closed[stroke], ink.length[stroke]
    arc = np.where(
        open_ & (low == 0), 0.0, np.where(open_ & (high == size), size, (low + high) / 2)
    )
    head = np.flatnonzero(np.r_[True, np.diff(stroke) != 0])
    tail = np.r_[head[1:], len(stroke)] - 1
    seam = ~open_[head] & (head < tail) & (vertex[head] == vertex[tail])
    seam &= arc[head] + size[head] - arc[tail] < tiny
    keep = np.ones(len(stroke), bool)
    keep[tail[seam]] = False
    return position, (stroke[keep], arc[keep], vertex[keep])


def _crossings(ink: _Ink) -> tuple[Array, Array, Array]:
    """Two events (stroke, arc) for every crossing of two segments, and the links between them."""
    pairs = ink.tree.query_pairs(_STEP + 1e-6, output_type="ndarray")
    i, j = ink.segment[pairs[:, 0]], ink.segment[pairs[:, 1]]
    apart = np.abs(i - j) > 1
    i, j = i[apart], j[apart]
    p, q = ink.points[i], ink.points[j]
    d, e = ink.points[i + 1] - p, ink.points[j + 1] - q
    det = _cross(d, e)
    crosses = np.abs(det) > 1e-9 * np.maximum(1e-12, np.hypot(*d.T) * np.hypot(*e.T))
    with np.errstate(divide="ignore", invalid="ignore"):
        t, u = _cross(q - p, e) / det, _cross(q - p, d) / det
        crosses &= (t > -1e-6) & (t < 1 + 1e-6) & (u > -1e-6) & (u < 1 + 1e-6)
    i, j, t, u = i[crosses], j[crosses], t[crosses], u[crosses]
    arc_i = ink.arc_of(i) + t * np.hypot(*d[crosses].T)
    arc_j = ink.arc_of(j) + u * np.hypot(*e[crosses].T)
    own = ink.stroke[i] == ink.stroke[j]
    gap = np.abs(arc_i - arc_j)
    size = ink.length[ink.stroke[i]]
    gap = np.where(ink.closed[ink.stroke[i]], np.minimum(gap, size - gap), gap)
    real = ~own | (gap > 1e-3)
    count = np.arange(real.sum())
    return (
        np.concatenate([ink.stroke[i][real], ink.stroke[j][real]]),
        np.concatenate([arc_i[real], arc_j[real]]),
        np.c_[count, count + len(count)],
    )


def _touches(ink: _Ink, touch: float) -> tuple[Array, Array, Array]:
    """Events for every stroke end that touches a line: the end itself, and its foot on the line."""
    free = np.flatnonzero(~ink.closed)
    end_stroke = np.concatenate([free, free])
    end_arc = np.concatenate([np.zeros(len(free)), ink.length[free]])
    end = _at(ink, end_stroke, end_arc)
    near = ink.tree.query_ball_point(end, _STEP / 2 + touch) if len(end) else []
    a = np.repeat(np.arange(len(end)), [len(n) for n in near]).astype(int)
    b = ink.segment[np.concatenate([np.asarray(n, int) for n in near])] if len(a) else a
    p = ink.points[b]
    d = ink.points[b + 1] - p
    u = np.clip(((end[a] - p) * d).sum(1) / np.maximum((d * d).sum(1), 1e-12), 0, 1)
    distance = np.hypot(*(p + u[:, None] * d - end[a]).T)
    foot = ink.arc_of(b) + u * np.hypot(*d.T)
    own = (ink.stroke[b] == end_stroke[a]) & (np.abs(foot - end_arc[a]) < max(4 * touch, 6.0))
    good = (distance <= touch) & ~own
    a, b, foot, distance = a[good], b[good], foot[good], distance[good]
    order = np.lexsort((distance, ink.stroke[b], a))
    a, b, foot = a[order], b[order], foot[order]
    first = np.r_[True, (np.diff(a) != 0) | (np.diff(ink.stroke[b]) != 0)][: len(a)]
    a, b, foot = a[first], b[first], foot[first]
    count = np.arange(len(a))
    return (
        np.concatenate([end_stroke[a], ink.stroke[b]]),
        np.concatenate([end_arc[a], foot]),
        np.c_[count, count + len(count)],
    )


def _at(ink: _Ink, stroke: Array, arc: Array) -> Array:
    """Points at arc lengths along strokes, (N, 2)."""
    key = ink.base[stroke] + np.clip(arc, 0, ink.length[stroke])
    return np.stack([np.interp(key, ink.key, ink.points[:, c]) for c in (0, 1)], 1)


def _cross(a: Array, b: Array) -> Array:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def _branches(
    ink: _Ink, position: Array, visits: tuple[Array, Array, Array], merge: float
) -> tuple[Array, list[Array], list[Array], Array, Array]:
    """Cut at the visits: vertices, polylines, source stroke of each point, ends, partners."""
    stroke, arc, vertex = visits
    follows = np.flatnonzero(np.diff(stroke) == 0)
    start, stop = follows, follows + 1
    first = np.flatnonzero(np.r_[True, np.diff(stroke) != 0])
    last = np.r_[first[1:] - 1, len(stroke) - 1]
    loops = ink.closed[stroke[first]]
    start, stop = np.concatenate([start, last[loops]]), np.concatenate([stop, first[loops]])
    order = np.argsort(start, kind="stable")
    start, stop = start[order], stop[order]

    base = ink.base[stroke[start]]
    bounds = np.searchsorted(
        ink.key, np.stack([base + arc[start] + merge / 2, base + arc[stop] - merge / 2], 1)
    )
    stroke_from, stroke_to = (
        np.searchsorted(ink.stroke, np.arange(len(ink.length)), s) for s in ("left", "right")
    )
    lines, sources = [], []
    for a, b, (low, high) in zip(start, stop, bounds, strict=True):
        k = stroke[a]
        if b <= a:  # round the seam of a closed stroke; its doubled seam point is left out once
            inner = np.concatenate(
                [
                    ink.points[low : stroke_to[k] - 1],
                    ink.points[stroke_from[k] : max(high, stroke_from[k])],
                ]
            )
        else:
            inner = ink.points[low:high]
        lines.append(np.vstack([position[vertex[a]], inner, position[vertex[b]]]))
        sources.append(np.full(len(lines[-1]), k))
    ends = np.stack([vertex[start], vertex[stop]], 1)

    partner = np.arange(2 * len(start))
    leaving = np.full(len(stroke), -1)
    arriving = np.full(len(stroke), -1)
    leaving[start] = 2 * np.arange(len(start))
    arriving[stop] = 2 * np.arange(len(start)) + 1
    through = (leaving >= 0) & (arriving >= 0)
    partner[leaving[through]], partner[arriving[through]] = arriving[through], leaving[through]
    return position, lines, sources, ends, partner


def _chained(link: Array) -> list[list[int]]:
    """Half-branches in chains: each is followed by the one that its far end is linked to.

    Args:
        link: (2B,) the half-branch that goes on at this one's vertex, or -1.
    """
    used = np.zeros(len(link) // 2, bool)
    chains: list[list[int]] = []
    for seed in [*np.flatnonzero(link < 0), *np.flatnonzero(link >= 0)]:
        if used[seed >> 1]:
            continue
        chain, half = [], int(seed)
        while half >= 0 and not used[half >> 1]:
            used[half >> 1] = True
            chain.append(half)
            half = int(link[half ^ 1])
        chains.append(chain)
    return chains


def dissolve(
    position: Array, lines: list[Array], sources: list[Array], ends: Array, partner: Array
) -> tuple[PlanarGraph, Array, Array]:
    """Take vertices of degree 2 out by joining their two branches; circles keep one.

    Args:
        position: (V, 2); lines, sources: the polyline of each branch and the stroke of each of its
            points; ends: (B, 2) vertices; partner: (2B,).

    Returns:
        The graph, (P,) stroke of each point, and the partners.
    """
    at = ends.reshape(-1)
    degree = np.bincount(at, minlength=len(position))
    order = np.argsort(at, kind="stable")
    two = order[degree[at[order]] == 2]
    link = np.full(len(at), -1)
    link[two[::2]], link[two[1::2]] = two[1::2], two[::2]

    chains = _chained(link)
    new_of = np.full(len(at), -1)
    points, source, tips = [], [], []
    for number, chain in enumerate(chains):
        parts = [(lines[h >> 1], sources[h >> 1]) for h in chain]
        parts = [
            (p[::-1], s[::-1]) if h & 1 else (p, s) for h, (p, s) in zip(chain, parts, strict=True)
        ]
        points.append(np.concatenate([parts[0][0]] + [p[1:] for p, _ in parts[1:]]))
        source.append(np.concatenate([parts[0][1]] + [s[1:] for _, s in parts[1:]]))
        tips.append((at[chain[0]], at[chain[-1] ^ 1]))
        new_of[chain[0]], new_of[chain[-1] ^ 1] = 2 * number, 2 * number + 1
    old_of = np.empty(2 * len(chains), int)
    old_of[new_of[new_of >= 0]] = np.flatnonzero(new_of >= 0)
    new_partner = new_of[partner[old_of]]
    used_vertices, compact = np.unique(np.array(tips), return_inverse=True)
    new_ends = compact.reshape(-1, 2)
    # A circle: its two halves meet at a vertex of degree 2 and continue each other.
    alone = (new_ends[:, 0] == new_ends[:, 1]) & (
        np.bincount(new_ends.ravel())[new_ends[:, 0]] == 2
    )
    circle = np.flatnonzero(alone)
    new_partner[2 * circle], new_partner[2 * circle + 1] = 2 * circle + 1, 2 * circle
    graph = PlanarGraph(
        position[used_vertices].astype(np.float32),
        np.concatenate(points).astype(np.float32),
        offsets_of([len(p) for p in points]).astype(np.int32),
        new_ends.astype(np.int32),
    )
    return graph, np.concatenate(source), new_partner.astype(np.int32)
