"""Sharp bends and pointed tips, which a skeleton cuts short.

Thinning rounds a sharp bend off, and turns the tip of a V, where its two lines overlap, into a
stem. Both become vertices of degree two here, whose two arms are continued until they meet, as at
a junction; `topology.join` makes one branch of them afterwards. The paper treats V-tips with three
angle rules and joins both sides by an offset copy of the stem.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays.ragged import count_up
from ..settings import Settings
from ..values import Array, PlanarGraph
from .continuations import ALONE, Continuations
from .courses import direction, read_courses
from .evidence import Evidence
from .limits import LIMITS
from .topology import join, lengths, select

READ = 16  # points of an arm that tell where it goes
SPAN = 5  # points on either side that tell the angle of a bend


def open_tips(graph: PlanarGraph, evidence: Evidence, settings: Settings) -> PlanarGraph:
    """Take away the stems of Vs: both lines really run on to the tip.

    Reads: the smoothed centerline map; points on the crest of the lines.
    Promises: tips are vertices of degree two, to be resolved like junctions.
    """
    longest = max(LIMITS.tip_longest, LIMITS.tip_pens * evidence.pen_width)
    graph = _without_eyes(graph, evidence, longest)
    vertex, degree = graph.half_vertex, graph.degrees
    long = np.repeat(lengths(graph), 2)
    stem = np.flatnonzero(
        (degree[vertex] == 3) & (degree[vertex[np.arange(len(vertex)) ^ 1]] == 1) & (long < longest)
    )
    # A junction with several stems is no V.
    once = np.bincount(vertex[stem], minlength=len(degree)) == 1
    stem = stem[once[vertex[stem]]]
    if not len(stem):
        return graph
    order, start = graph.halves_at
    three = order[start[vertex[stem]][:, None] + np.arange(3)]
    arms = three[three != stem[:, None]].reshape(-1, 2)
    used, number = np.unique(np.concatenate([arms, stem[:, None]], 1), return_inverse=True)
    a, b, c = number.reshape(-1, 3).T  # two arms and the stem, among those that are read
    half = read_courses(graph, evidence, used)
    fits = Continuations(half, evidence.value)
    along = np.maximum(fits.cost(np.stack([a, c], -1)), fits.cost(np.stack([b, c], -1)))
    across = fits.cost(np.stack([a, b], -1))
    # How long two lines overlap depends on how fast they part.
    parting = np.hypot(
        *(graph.vertices[vertex[stem]][:, None] - half.points[np.stack([a, b], -1), 0]).T
    )
    begin = half.exit[np.stack([a, b], -1)].astype(np.int64)
    short = long[stem] < LIMITS.tip_overlap * parting.max(0) + 2.0
    share = _meeting(graph, begin, arms, stem)
    hairpin = (share > LIMITS.tip_meets) & (share < 1 / LIMITS.tip_meets)
    tip = (along < 2 * ALONE) & (across > 2 * ALONE) & (short | hairpin)
    # The fork moves to the tip; its arms follow when it is resolved, at once where that is far.
    vertices, points = graph.vertices.copy(), graph.points.copy()
    vertices[vertex[stem[tip]]] = graph.vertices[vertex[stem[tip] ^ 1]]
    points[graph.offsets[:-1]] = vertices[graph.ends[:, 0]]
    points[graph.offsets[1:] - 1] = vertices[graph.ends[:, 1]]
    far = tip & hairpin & (long[stem] > LIMITS.tip_far * evidence.ridge_width)
    _straighten(points, begin[far].ravel(), graph.offsets, arms[far].ravel())
    stem = stem[tip]
    keep = np.ones(graph.branch_count, bool)
    keep[stem >> 1] = False
    return select(replace(graph, vertices=vertices, points=points), keep)


def _straighten(points: Array, begin: Array, offsets: Array, arms: Array) -> None:
    """Lay the points (P, 2) of half-branches from their first clean one to their vertex on a
    straight line, in place."""
    end = np.where(arms & 1, offsets[(arms >> 1) + 1] - 1, offsets[arms >> 1])
    count = np.abs(begin - end)
    line = np.repeat(np.arange(len(arms)), count)
    step = count_up(count)
    place = end[line] + step * np.sign(begin - end)[line]
    share = (step / np.maximum(count, 1)[line])[:, None]
    tip, first = points[end].copy(), points[begin].copy()
    points[place] = tip[line] * (1 - share) + first[line] * share


def _without_eyes(graph: PlanarGraph, evidence: Evidence, longest: float) -> PlanarGraph:
    """Without the tiny loops that a dent in the ink makes at the fork of a stem, which is at most
    `longest` px.

    The two arms of such a fork come together again at once, or are linked by a short branch.
    """
    vertex, degree = graph.half_vertex, graph.degrees
    long = np.repeat(lengths(graph), 2)
    short = long < LIMITS.tip_eye * evidence.ridge_width
    stem = (degree[vertex[np.arange(len(vertex)) ^ 1]] == 1) & (long < longest)
    fork = np.unique(vertex[stem & (degree[vertex] == 3)])
    order, start = graph.halves_at
    three = order[start[fork][:, None] + np.arange(3)]
    away = vertex[three ^ 1]
    arm = (degree[away] > 1) & short[three]
    fork = np.flatnonzero(arm.sum(1) == 2)
    arms, ends = three[fork][arm[fork]].reshape(-1, 2), away[fork][arm[fork]].reshape(-1, 2)
    same = ends[:, 0] == ends[:, 1]
    drop = np.zeros(graph.branch_count, bool)
    drop[arms[same, 1] >> 1] = True
    # The short branch between the far ends of both arms, if there is one.
    between = np.flatnonzero(short[::2])
    name = np.sort(graph.ends[between], 1) @ (len(degree), 1)
    wanted = np.sort(ends[~same], 1) @ (len(degree), 1)
    drop[between[np.isin(name, wanted)]] = True
    return join(select(graph, ~drop)) if drop.any() else graph


def _meeting(graph: PlanarGraph, begin: Array, arms: Array, stem: Array) -> Array:
    """(K,) where the arms of stems, straight on, would meet: 0 at the fork, 1 at the tip.

    Both lines of a hairpin meet at its tip, however long their ink is one before; where a line
    forks, or one of two that cross runs on, they meet before. Near the fork the ridges of the arms
    bend towards each other, so they are read as far from it again as the stem is long.

    Args:
        begin: (K, 2) points of the graph at which the clean part of both arms begins.
        arms: (K, 2) half-branches; stem: (K,) half-branches, outward from the fork.
    """
    vertex = graph.half_vertex
    fork, tip = (graph.vertices[vertex[h]].astype(np.float64) for h in (stem, stem ^ 1))
    length = np.hypot(*(tip - fork).T)
    step = np.where(arms & 1, -1, 1)
    last = np.where(arms & 1, graph.offsets[arms >> 1], graph.offsets[(arms >> 1) + 1] - 1)
    far = np.round(length)[:, None].astype(np.int64)
    room = (last - begin) * step
    first = np.minimum(far, np.maximum(room - READ, 0))
    place = first[..., None] + np.arange(READ)
    weight = (place <= room[..., None]).astype(np.float64)
    at = begin[..., None] + step[..., None] * np.minimum(place, room[..., None])
    points = graph.points[at].astype(np.float64).reshape(-1, READ, 2)
    weight = weight.reshape(-1, READ)
    outward = direction(points, weight).reshape(-1, 2, 2)
    middle = (points * weight[..., None]).sum(1) / weight.sum(1)[:, None]
    middle = middle.reshape(-1, 2, 2)
    (ax, ay), (bx, by) = np.moveaxis(outward, 0, -1)
    dx, dy = (middle[:, 1] - middle[:, 0]).T
    sine = ax * by - ay * bx
    parallel = np.abs(sine) < 1e-6
    away = (dx * by - dy * bx) / np.where(parallel, 1.0, sine)
    meets = middle[:, 0] + away[:, None] * outward[:, 0]
    share = ((meets - fork) * (tip - fork)).sum(1) / np.maximum(length**2, 1e-9)
    return np.where(parallel, 0.0, share)


def split_bends(graph: PlanarGraph, evidence: Evidence, settings: Settings) -> PlanarGraph:
    """Cut branches where they bend sharply.

    Reads: nothing but the graph; points about 1 px apart.
    Promises: bends are vertices of degree two, to be resolved like junctions.
    """
    points = graph.points.astype(np.float64)
    count = np.diff(graph.offsets)
    index = np.arange(len(points))
    first, last = np.repeat(graph.offsets[:-1], count), np.repeat(graph.offsets[1:] - 1, count)
    # A small circle turns everywhere, and has no bend.
    ring = (graph.ends[:, 0] == graph.ends[:, 1]) & (count < LIMITS.bend_ring)
    room = (index - first >= SPAN) & (last - index >= SPAN) & ~np.repeat(ring, count)
    room = np.flatnonzero(room)
    if not len(room):
        return graph
    came = points[room] - points[room - SPAN]
    goes = points[room + SPAN] - points[room]
    size = np.hypot(*came.T) * np.hypot(*goes.T)
    cosine = np.ones(len(points))
    cosine[room] = (came * goes).sum(1) / np.maximum(size, 1e-9)
    # A bend turns at once; a small circle turns less in less way.
    came = points[room] - points[room - SPAN // 2]
    goes = points[room + SPAN // 2] - points[room]
    size = np.hypot(*came.T) * np.hypot(*goes.T)
    at_once = np.arccos(np.clip((came * goes).sum(1) / np.maximum(size, 1e-9), -1, 1))
    round_off = at_once < LIMITS.bend_at_once * np.arccos(np.clip(cosine[room], -1, 1))
    cosine[room[round_off]] = 1.0
    # Only the sharpest point of every bend.
    near = np.lib.stride_tricks.sliding_window_view(
        np.pad(cosine, SPAN, constant_values=1.0), 2 * SPAN + 1
    )
    sharp = np.flatnonzero(
        (cosine < np.cos(np.radians(LIMITS.bend_sharp))) & (near.argmin(1) == SPAN)
    )
    if not len(sharp):
        return graph
    fresh = len(graph.vertices) + np.arange(len(sharp))
    # A bend is the last point of one piece and the first of the next.
    where = np.concatenate([np.arange(len(points)), sharp])
    where = np.sort(where, kind="stable")
    cuts = np.sort(np.concatenate([graph.offsets[1:], sharp + 1]))
    pieces = cuts + np.searchsorted(sharp, cuts - 1)
    is_bend = np.isin(cuts, sharp + 1)
    tail = np.empty(len(cuts), np.int64)
    tail[is_bend] = fresh
    tail[~is_bend] = graph.ends[:, 1]
    head = np.empty(len(cuts), np.int64)
    opens = np.concatenate([[False], is_bend[:-1]])
    head[opens] = fresh
    head[~opens] = graph.ends[:, 0]
    return PlanarGraph(
        np.concatenate([graph.vertices, graph.points[sharp]]),
        graph.points[where],
        np.concatenate([[0], pieces]).astype(np.int32),
        np.stack([head, tail], -1).astype(np.int32),
    )
