"""Branches cross in vertices only: the last step, which makes the graph planar but for a few.

Every cluster is resolved on its own, so the curves through two of them a few pixels apart may cross
each other, and smoothing may push one line over its neighbour. Each such crossing becomes a vertex,
unless it lies beside one that both branches share.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays.ragged import owners
from ..settings import Settings
from ..values import Array, PlanarGraph
from .courses import spoilt
from .evidence import Evidence
from .limits import LIMITS
from .nearby import near_pairs
from .topology import connected, join, lengths, select

_WITHIN = 1e-4  # of a segment at its ends that count as outside
_ONE = 0.01  # px; crossings as near as that are one, of three branches and more


def planarize(graph: PlanarGraph, evidence: Evidence, settings: Settings) -> PlanarGraph:
    """The graph with a vertex wherever two of its branches cross.

    Reads: the size of the page; points at most about 1 px apart.
    Promises: planar, but for crossings a pixel beside a vertex that both branches share.
    """
    if graph.branch_count < 2:
        return graph
    first, second, part, other, places = _crossings(graph, evidence.shape)
    if not len(places):
        return graph
    vertex = len(graph.vertices) + np.arange(len(places))
    segment, along = np.concatenate([first, second]), np.concatenate([part, other])
    order = np.lexsort((along, segment))
    segment, which = segment[order], np.tile(vertex, 2)[order]
    # Each cut is the last point of one piece and the first one of the next.
    points = np.insert(
        graph.points,
        np.repeat(segment + 1, 2),
        np.repeat(places[which - len(graph.vertices)], 2, axis=0),
        axis=0,
    )
    cuts = segment + 2 + 2 * np.arange(len(segment))
    stops = graph.offsets[1:] + 2 * np.searchsorted(segment + 1, graph.offsets[1:])
    bounds = np.concatenate([cuts, stops])
    order = np.argsort(bounds)
    tail = np.concatenate([which, graph.ends[:, 1]])[order]
    head = np.concatenate([which, np.roll(graph.ends[:, 0], -1)])[order]
    cut = PlanarGraph(
        np.concatenate([graph.vertices, places]).astype(np.float32),
        points,
        np.concatenate([[0], bounds[order]]).astype(np.int32),
        np.stack([np.roll(head, 1), tail], -1).astype(np.int32),
    )
    # A ring that is crossed has no seam any more.
    return join(_merged(cut))


def _merged(graph: PlanarGraph) -> PlanarGraph:
    """The graph with one vertex where several lie in one place, linked by branches of no length."""
    none = (lengths(graph) < _ONE) & (graph.ends[:, 0] != graph.ends[:, 1])
    if not none.any():
        return graph
    ends = connected(len(graph.vertices), graph.ends[none])[graph.ends]
    points = graph.points.copy()
    points[graph.offsets[:-1]] = graph.vertices[ends[:, 0]]
    points[graph.offsets[1:] - 1] = graph.vertices[ends[:, 1]]
    return select(replace(graph, points=points, ends=ends), ~none)


def _crossings(graph: PlanarGraph, shape: tuple[int, int]) -> tuple[Array, ...]:
    """Pairs of segments that cross: first points of both, where on each, and the places (N, 2)."""
    last = np.zeros(len(graph.points), bool)
    last[graph.offsets[1:] - 1] = True
    close = np.flatnonzero(spoilt(graph, shape, 2.0) & ~last)
    points = graph.points.astype(np.float64)
    i, j = close[near_pairs((points[close] + points[close + 1]) / 2, 2.0)].T
    branch = owners(graph.offsets)
    apart = branch[i] != branch[j]
    i, j = i[apart], j[apart]
    p, d, q, e = points[i], points[i + 1] - points[i], points[j], points[j + 1] - points[j]
    cross = d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        s = ((q - p)[:, 0] * e[:, 1] - (q - p)[:, 1] * e[:, 0]) / cross
        t = ((q - p)[:, 0] * d[:, 1] - (q - p)[:, 1] * d[:, 0]) / cross
    hit = np.abs(np.stack([s, t]) - 0.5).max(0) < 0.5 - _WITHIN  # False for parallels, too
    i, j, s, t = i[hit], j[hit], s[hit], t[hit]
    places = points[i] + s[:, None] * (points[i + 1] - points[i])
    one, two = graph.ends[branch[i]], graph.ends[branch[j]]
    shared = (one[:, :, None] == two[:, None]).any(2)
    gap = np.linalg.norm(graph.vertices[one] - places[:, None], axis=-1)
    new = ~(shared & (gap < LIMITS.crossing_same)).any(1)
    return i[new], j[new], s[new], t[new], places[new]
