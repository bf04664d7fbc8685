"""Sharp bends and pointed tips, which a skeleton cuts short.

Thinning rounds a sharp bend off, and turns the tip of a V, where its two lines overlap, into a
stem. Both become vertices of degree two here, whose two arms are continued until they meet, as at
a junction; `topology.join` makes one branch of them afterwards. The paper treats V-tips with three
angle rules and joins both sides by an offset copy of the stem.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..settings import Settings
from ..values import PlanarGraph
from .continuations import ALONE, Continuations
from .courses import read_courses
from .evidence import Evidence
from .limits import LIMITS
from .topology import lengths, select

SPAN = 5  # points on either side that tell the angle of a bend


def open_tips(graph: PlanarGraph, evidence: Evidence, settings: Settings) -> PlanarGraph:
    """Take away the stems of Vs: both lines really run on to the tip.

    Reads: the smoothed centerline map; points on the crest of the lines.
    Promises: tips are vertices of degree two, to be resolved like junctions.
    """
    vertex, degree = graph.half_vertex, graph.degrees
    long = np.repeat(lengths(graph), 2)
    stem = np.flatnonzero(
        (degree[vertex] == 3)
        & (degree[vertex[np.arange(len(vertex)) ^ 1]] == 1)
        & (long < LIMITS.tip_longest)
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
    tip = (
        (along < 2 * ALONE)
        & (across > 2 * ALONE)
        & (long[stem] < LIMITS.tip_overlap * parting.max(0) + 2.0)
    )
    stem = stem[tip]
    # The fork moves to the tip; its arms follow when it is resolved.
    vertices, points = graph.vertices.copy(), graph.points.copy()
    vertices[vertex[stem]] = graph.vertices[vertex[stem ^ 1]]
    points[graph.offsets[:-1]] = vertices[graph.ends[:, 0]]
    points[graph.offsets[1:] - 1] = vertices[graph.ends[:, 1]]
    keep = np.ones(graph.branch_count, bool)
    keep[stem >> 1] = False
    return select(replace(graph, vertices=vertices, points=points), keep)


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
