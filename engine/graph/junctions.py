"""Put every junction where its lines meet.

Inside a cluster of forks the ridge can't be trusted: it is bent towards the middle, a shallow
crossing is one line for a while, a crossing is two forks. The paper tries one or two junctions on a
grid of candidates and joins each branch to them by a straight line. We let the branches run on, as
smooth curves fitted outside the cluster: their crossings ARE the junctions, one or several; what
doesn't run through (a stem) ends on the first curve it hits; where nothing runs through, the
junction is the least-squares meeting point. The branches then follow these curves to the junction.
"""

from __future__ import annotations

import numpy as np

from ..arrays.ragged import offsets_of, ranges
from ..arrays.sampling import sample
from ..involution import least_cost
from ..settings import Settings
from ..values import Array, PlanarGraph
from .clusters import find_clusters
from .continuations import ALONE, SAMPLES, Continuations, extend, pairs_within
from .courses import Courses, read_courses
from .evidence import Evidence
from .limits import LIMITS
from .shared_ridges import told_apart
from .topology import connected, join


def resolve_junctions(graph: PlanarGraph, evidence: Evidence, settings: Settings) -> PlanarGraph:
    """Move the junctions of a skeleton's graph to where its lines meet.

    Reads: the smoothed centerline map; points on the crest of the lines.
    Promises: junctions in their place; sharp bends are still vertices of degree two.
    """
    ring = graph.ends[graph.ends[:, 0] == graph.ends[:, 1], 0]
    active = graph.degrees >= 2
    active[ring] &= graph.degrees[ring] > 2
    if not active.any():
        return graph
    value = evidence.value
    half = read_courses(graph, evidence)
    fits = Continuations(half, value)
    cluster, inner = find_clusters(graph, fits)
    return _rebuild(graph, half, fits, np.where(active, cluster, -1), inner, value)


def _rebuild(
    graph: PlanarGraph,
    half: Courses,
    fits: Continuations,
    group: Array,
    inner: Array,
    value: Array,
) -> PlanarGraph:
    """Replace all clusters by curves; see the module's docstring."""
    h_group = np.where(np.repeat(inner, 2), -1, group[graph.half_vertex])
    pairs = pairs_within(h_group)
    cost = fits.cost(pairs)
    chosen = np.flatnonzero(least_cost(h_group, pairs, cost, ALONE))
    chosen = chosen[~_stars(h_group, pairs[chosen], cost[chosen], graph, half, value)]
    through = pairs[chosen]
    alone = h_group >= 0
    alone[through] = False
    stems = np.flatnonzero(alone)

    # Clusters by consecutive numbers, and their middle.
    names, of_half = np.unique(h_group[h_group >= 0], return_inverse=True)
    cluster = np.full(len(h_group), -1)
    cluster[h_group >= 0] = of_half
    exits = half.points[:, 0]
    member = np.flatnonzero(group >= 0)
    home = np.searchsorted(names, group[member])
    known = (home < len(names)) & (names[np.minimum(home, len(names) - 1)] == group[member])
    member, home = member[known], home[known]
    weight = np.maximum(np.bincount(home, minlength=len(names)), 1)
    middle = np.stack(
        [np.bincount(home, graph.vertices[member, k], len(names)) / weight for k in (0, 1)], -1
    )

    to_middle = np.hypot(*(middle[cluster[stems]] - exits[stems]).T)
    path = extend(half.points[stems], half.weights[stems], to_middle + LIMITS.junction_merge + 1.0)
    smooth = told_apart(fits.of(through).sampled(), cluster[through[:, 0]], through, half, value)
    curves = np.concatenate([smooth, path])
    curve_cluster = np.concatenate([cluster[through[:, 0]], cluster[stems]]).astype(np.int64)
    is_stem = np.arange(len(curves)) >= len(chosen)

    meetings = _meetings(curves, curve_cluster, is_stem)
    lone = _meeting_points(path, cluster[stems], middle, value)
    stops, places = _stops(meetings, curves, curve_cluster, is_stem, lone)
    active = cluster >= 0
    return _assemble(graph, half, active, inner, through, stems, curves, stops, places)


def _stars(
    group: Array, through: Array, cost: Array, graph: PlanarGraph, half: Courses, value: Array
) -> Array:
    """(K,) bool: pairs of clusters whose half-branches, straight on, all meet in one point.

    Where lines end together the smoothest pairs would bend around that point.
    """
    bent = np.unique(group[through[cost > LIMITS.junction_bent, 0]])
    member = np.flatnonzero(np.isin(group, bent) & (group >= 0))
    if not len(member):
        return np.zeros(len(through), bool)
    home = np.searchsorted(bent, group[member])
    count = np.bincount(home)
    middle = np.stack([np.bincount(home, half.points[member, 0, k]) / count for k in (0, 1)], -1)
    reach = np.hypot(*(middle[home] - half.points[member, 0]).T) + LIMITS.junction_merge
    paths = extend(half.points[member], half.weights[member], reach)
    place = _meeting_points(paths, home, middle, value)
    gap = np.hypot(*np.moveaxis(paths - place[home, None], -1, 0))
    near = np.clip(gap.argmin(1), 1, SAMPLES - 2)
    rows = np.arange(len(paths))
    course = paths[rows, near + 1] - paths[rows, near - 1]
    course /= np.maximum(np.hypot(*course.T), 1e-9)[:, None]
    off = place[home] - paths[rows, near]
    aside = np.abs(off[:, 0] * course[:, 1] - off[:, 1] * course[:, 0])
    worst = np.zeros(len(bent))
    np.maximum.at(worst, home, aside)
    return np.isin(group[through[:, 0]], bent[(worst < LIMITS.junction_star) & (count > 2)])


def _meetings(curves: Array, cluster: Array, is_stem: Array) -> Array:
    """Where the curves of each cluster meet: (M, 5) rows of curve, curve, time, time, weight.

    A time runs from 0 at the curve's first sample to SAMPLES - 1 at its last.
    """
    pairs = pairs_within(cluster)
    pairs = _close_by(curves, pairs[~is_stem[pairs].all(1)])
    found = [np.zeros((0, 5))]
    for some in np.array_split(pairs, len(pairs) // 512 + 1):
        if len(some):
            found += [_crossings(curves, some)]
    crossings = np.concatenate(found)
    # Through-curves that only touch, and stems that end just short of a curve.
    missed = np.zeros(0)
    if len(pairs):
        key = pairs[:, 0] * len(curves) + pairs[:, 1]
        crossed = np.isin(key, crossings[:, 0] * len(curves) + crossings[:, 1])
        apart = pairs[~crossed]
        limit = np.where(is_stem[apart].any(1), LIMITS.junction_stray, LIMITS.junction_touch)
        near, gap = _touches(curves, apart, limit)
        has_hit = np.zeros(len(curves), bool)
        has_hit[crossings[:, :2].astype(np.int64)] = True
        stem = is_stem[near[:, 1].astype(np.int64)]
        known = ~(stem & has_hit[near[:, 1].astype(np.int64)])
        missed = np.concatenate([np.zeros(len(crossings)), gap[known]])
        crossings = np.concatenate([crossings, near[known]])
    # Stems come after the through-curves, so a stem is always second; it ends on its first hit,
    # or else where it comes nearest.
    second = crossings[:, 1].astype(np.int64)
    order = np.lexsort((crossings[:, 3], missed, second))
    first = np.diff(second[order], prepend=-1) != 0
    return crossings[order[first | ~is_stem[second[order]]]]


def _close_by(curves: Array, pairs: Array) -> Array:
    """The pairs of curves that may meet, by the boxes around them: few, however large a cluster."""
    reach = max(LIMITS.junction_stray, LIMITS.junction_touch)
    low, high = curves.min(1) - reach / 2, curves.max(1) + reach / 2
    a, b = pairs.T
    return pairs[((low[a] <= high[b]) & (low[b] <= high[a])).all(1)]


def _crossings(curves: Array, pairs: Array) -> Array:
    """Crossings of pairs of polylines; rows as in `_meetings`."""
    p, q = curves[pairs[:, 0]], curves[pairs[:, 1]]
    d, e = np.diff(p, axis=1)[:, :, None], np.diff(q, axis=1)[:, None]
    offset = q[:, None, :-1] - p[:, :-1, None]
    cross = d[..., 0] * e[..., 1] - d[..., 1] * e[..., 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        s = (offset[..., 0] * e[..., 1] - offset[..., 1] * e[..., 0]) / cross
        t = (offset[..., 0] * d[..., 1] - offset[..., 1] * d[..., 0]) / cross
    hit = (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    k, i, j = np.nonzero(hit)
    norm = np.hypot(d[k, i, 0, 0], d[k, i, 0, 1]) * np.hypot(e[k, 0, j, 0], e[k, 0, j, 1])
    sine = np.abs(cross[k, i, j]) / np.maximum(norm, 1e-12)
    return np.stack([*pairs[k].T, i + s[k, i, j], j + t[k, i, j], sine**2 + 1e-3], -1)


def _touches(curves: Array, pairs: Array, limit: Array) -> tuple[Array, Array]:
    """Nearest points of pairs of polylines within their limit: rows as above, and how near."""
    found, gaps = [np.zeros((0, 5))], [np.zeros(0)]
    for at in range(0, len(pairs), 512):
        some, near = pairs[at : at + 512], limit[at : at + 512]
        gap = curves[some[:, 0], :, None] - curves[some[:, 1], None, :]
        gap = np.hypot(gap[..., 0], gap[..., 1]).reshape(len(some), -1)
        best = gap.argmin(1)
        least = gap[np.arange(len(some)), best]
        k = np.flatnonzero(least < near)
        i, j = np.divmod(best[k], SAMPLES)
        found.append(np.stack([*some[k].T, i, j, np.full(len(k), 1e-3)], -1))
        gaps.append(least[k])
    return np.concatenate(found), np.concatenate(gaps)


def _meeting_points(paths: Array, cluster: Array, middle: Array, value: Array) -> Array:
    """(N, 2): for each cluster the point nearest to all its stems, continued into it.

    A stem vouches for its side the less, the farther it had to be continued. The middle of the
    skeleton's cluster has its say too; less so at a bend, which the skeleton cuts short.
    """
    count, found = len(middle), middle
    bend = np.bincount(cluster, minlength=count) == 2
    prior = np.where(bend, 1 / 5.0**2, 1.0)
    rows = np.arange(len(paths))
    gap = np.hypot(*(paths[:, 0] - middle[cluster]).T)
    trust = 1 / (0.15**2 + (0.08 * gap) ** 2)
    for _ in range(2):
        offset = paths - found[cluster][:, None]
        near = np.clip(np.hypot(offset[..., 0], offset[..., 1]).argmin(1), 1, SAMPLES - 2)
        course = paths[rows, near + 1] - paths[rows, near - 1]
        course /= np.maximum(np.hypot(*course.T), 1e-9)[:, None]
        across = trust[:, None, None] * (np.eye(2) - course[:, :, None] * course[:, None, :])
        matrix = prior[:, None, None] * np.eye(2)
        np.add.at(matrix, cluster, across)
        vector = np.zeros((count, 2))
        away = paths[rows, near] - middle[cluster]
        np.add.at(vector, cluster, np.einsum("kij,kj->ki", across, away))
        found = middle + np.linalg.solve(matrix, vector[..., None])[..., 0]
    # Never leave the ink: as far towards the meeting point as the line is half as bright.
    way = np.linspace(0, 1, 9)
    light = sample(value, middle[:, None] + way[:, None] * (found - middle)[:, None])
    dark = light < LIMITS.junction_ink * light[:, :1]
    reach = np.where(dark.any(1), way[np.maximum(dark.argmax(1) - 1, 0)], 1.0)
    return middle + reach[:, None] * (found - middle)


def _at(curves: Array, curve: Array, time: Array) -> Array:
    """(N, 2) points of the curves at fractional sample numbers."""
    low = np.clip(time.astype(np.int64), 0, SAMPLES - 2)
    part = (time - low)[:, None]
    return curves[curve, low] * (1 - part) + curves[curve, low + 1] * part


def _stops(
    meetings: Array, curves: Array, cluster: Array, is_stem: Array, lone: Array
) -> tuple[Array, Array]:
    """Merge meetings to junctions: stops (S, 3) of curve, junction, time; places (J, 2)."""
    curve = meetings[:, :2].astype(np.int64)
    here = (_at(curves, curve[:, 0], meetings[:, 2]) + _at(curves, curve[:, 1], meetings[:, 3])) / 2
    pairs = pairs_within(cluster[curve[:, 0]]) if len(meetings) else np.zeros((0, 2), np.int64)
    close = np.hypot(*(here[pairs[:, 0]] - here[pairs[:, 1]]).T) < LIMITS.junction_merge
    label = connected(len(meetings), pairs[close])
    names, junction = np.unique(label, return_inverse=True)
    weight = np.bincount(junction, meetings[:, 4], len(names))
    places = np.stack(
        [np.bincount(junction, meetings[:, 4] * here[:, k], len(names)) / weight for k in (0, 1)],
        -1,
    )
    junction_cluster = np.zeros(len(names), np.int64)
    junction_cluster[junction] = cluster[curve[:, 0]]
    stops = np.concatenate(
        [np.stack([curve[:, k], junction, meetings[:, 2 + k]], -1) for k in (0, 1)]
    )
    # A curve that passes a junction twice (its meetings were merged) stops there once.
    keys, same = np.unique(stops[:, 0] * (len(names) + 1) + stops[:, 1], return_inverse=True)
    mean = np.bincount(same, stops[:, 2], len(keys)) / np.maximum(np.bincount(same), 1)
    stops = np.stack([keys // (len(names) + 1), keys % (len(names) + 1), mean], -1)

    # Stems that hit nothing end at their cluster's nearest junction, or all together at a lone one.
    hit = np.zeros(len(curves), bool)
    hit[stops[:, 0].astype(np.int64)] = True
    lost = np.flatnonzero(is_stem & ~hit)
    if len(lost):
        first = np.full(len(lone), -1)
        first[junction_cluster[::-1]] = np.arange(len(names))[::-1]
        need = np.unique(cluster[lost][first[cluster[lost]] < 0])
        first[need] = len(names) + np.arange(len(need))
        places = np.concatenate([places, lone[need]])
        to = first[cluster[lost]]
        gap = curves[lost] - places[to][:, None]
        time = np.maximum(np.hypot(gap[..., 0], gap[..., 1]).argmin(1), 0.5)
        stops = np.concatenate([stops, np.stack([lost, to, time], -1)])
    return stops[np.lexsort((stops[:, 2], stops[:, 0]))], places


def _assemble(
    graph: PlanarGraph,
    half: Courses,
    active: Array,
    inner: Array,
    through: Array,
    stems: Array,
    curves: Array,
    stops: Array,
    places: Array,
) -> PlanarGraph:
    """The graph with every cluster replaced: branches cut at their exits, then pieces of curves."""
    # Vertices: the old ones, then the exits (by their point), then the junctions.
    exit_point, exit_vertex = np.unique(half.exit, return_inverse=True)
    old = len(graph.vertices)
    exit_vertex = np.where(active, old + exit_vertex, graph.half_vertex)
    vertices = np.concatenate([graph.vertices, graph.points[exit_point], places])
    first_junction = old + len(exit_point)

    cut = np.where(
        active, half.exit, np.stack([graph.offsets[:-1], graph.offsets[1:] - 1], -1).ravel()
    )
    begin, end = cut.reshape(-1, 2).T.astype(np.int64)
    kept = ~inner & (end > begin)
    counts = (end - begin + 1)[kept]
    branch_points = graph.points[ranges(begin[kept], counts)]
    branch_ends = exit_vertex.reshape(-1, 2)[kept]

    # Every curve: its first exit, its stops, and (a through-curve) its second exit.
    curve = np.concatenate([np.arange(len(curves)), np.arange(len(through)), stops[:, 0]])
    time = np.concatenate(
        [np.zeros(len(curves)), np.full(len(through), SAMPLES - 1.0), stops[:, 2]]
    )
    node = np.concatenate(
        [
            exit_vertex[np.concatenate([through[:, 0], stems])],
            exit_vertex[through[:, 1]],
            first_junction + stops[:, 1].astype(np.int64),
        ]
    )
    rank = np.concatenate([np.zeros(len(curves)), np.full(len(through), 2.0), np.ones(len(stops))])
    order = np.lexsort((time, rank, curve))
    pieces = _pieces(curves, vertices, curve[order].astype(np.int64), time[order], node[order])
    result = PlanarGraph(
        vertices.astype(np.float32),
        np.concatenate([branch_points, pieces[0]]).astype(np.float32),
        offsets_of(np.concatenate([counts, pieces[1]])).astype(np.int32),
        np.concatenate([branch_ends, pieces[2]]).astype(np.int32),
    )
    return join(result, hold=np.arange(len(vertices)) >= first_junction)


def _pieces(
    curves: Array, vertices: Array, curve: Array, time: Array, node: Array
) -> tuple[Array, Array, Array]:
    """The curves cut at their stops (S,), each piece bent so that it ends on its vertices.

    Returns:
        Points (P, 2), how many each piece has, and the (K, 2) vertices that it links.
    """
    shift = vertices[node] - _at(curves, curve, time)
    piece = np.flatnonzero(curve[1:] == curve[:-1])
    t = np.arange(SAMPLES)
    t0, t1 = time[piece, None], time[piece + 1, None]
    inside = (t > t0 + 0.25) & (t < t1 - 0.25)
    u = np.clip((t - t0) / np.maximum(t1 - t0, 1e-9), 0, 1)
    u = (u * u * (3 - 2 * u))[..., None]
    body = curves[curve[piece]] + shift[piece, None] * (1 - u) + shift[piece + 1, None] * u
    rows = np.concatenate([vertices[node[piece], None], body, vertices[node[piece + 1], None]], 1)
    yes = np.ones((len(piece), 1), bool)
    mask = np.concatenate([yes, inside, yes], 1)
    return rows[mask], mask.sum(1), np.stack([node[piece], node[piece + 1]], -1)
