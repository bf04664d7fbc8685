"""Small changes to a planar graph: keep some branches, join those that meet two by two."""

from __future__ import annotations

import numpy as np

from ..arrays.ragged import count_up, offsets_of, steps
from ..settings import Settings
from ..values import Array, PlanarGraph
from .chains import follow
from .evidence import Evidence


def select(graph: PlanarGraph, keep: Array) -> PlanarGraph:
    """The graph with only the branches (B,) bool that are kept; vertices are renumbered."""
    counts = np.diff(graph.offsets)
    ends = graph.ends[keep]
    used = np.zeros(len(graph.vertices), bool)
    used[ends] = True
    number = np.cumsum(used) - 1
    stays = np.repeat(keep, counts)
    return PlanarGraph(
        graph.vertices[used],
        graph.points[stays],
        offsets_of(counts[keep]).astype(np.int32),
        number[ends].astype(np.int32).reshape(-1, 2),
        **graph.measures(stays),
    )


def join_bends(graph: PlanarGraph, evidence: Evidence, settings: Settings) -> PlanarGraph:
    """Make one branch of those that meet at a bend or where a gap was bridged.

    Reads: nothing but the graph.
    Promises: vertices are ends, junctions, and one on every ring.
    """
    return join(graph)


def join(graph: PlanarGraph, hold: Array | None = None) -> PlanarGraph:
    """Join branches at vertices of degree two, so that only ends, junctions and rings remain.

    hold: (V,) bool, vertices that stay all the same.
    """
    return joined(graph, hold)[0]


def joined(graph: PlanarGraph, hold: Array | None = None) -> tuple[PlanarGraph, Array]:
    """What `join` makes, and (2B,) int32 which old half-branch each of its half-branches was."""
    if graph.branch_count == 0:
        return PlanarGraph.empty(), np.zeros(0, np.int32)
    halves = np.arange(2 * graph.branch_count)
    stop = graph.degrees != 2
    if hold is not None:
        stop |= hold
    order, bounds = follow(graph.half_vertex, halves ^ 1, stop)
    branch, flipped = order >> 1, (order & 1).astype(bool)
    counts = np.diff(graph.offsets)[branch]
    # Read every branch in walking order; all but the last of a chain leave out their last point.
    last = np.zeros(len(order), bool)
    last[bounds[1:] - 1] = True
    taken = counts - ~last
    total, within = offsets_of(taken), count_up(taken)
    start = np.where(flipped, graph.offsets[branch + 1] - 1, graph.offsets[branch])
    step = np.where(flipped, -1, 1)
    index = np.repeat(start, taken) + np.repeat(step, taken) * within
    halves = np.stack([order[bounds[:-1]], order[bounds[1:] - 1] ^ 1], -1).astype(np.int32)
    ends = graph.half_vertex[halves]
    whole = PlanarGraph(
        graph.vertices,
        graph.points[index],
        total[bounds].astype(np.int32),
        ends.astype(np.int32),
        **graph.measures(index),
    )
    return select(whole, np.ones(whole.branch_count, bool)), halves.reshape(-1)


def repeated(graph: PlanarGraph) -> Array:
    """(B,) bool: branches that lie on earlier ones from end to end, point by point, as the second
    line on a shared run does (`routing.second_lines`); no others have inner points in common."""
    count = np.diff(graph.offsets)
    place = np.ascontiguousarray(graph.points, np.float32).view(np.uint64)[:, 0]
    _, first, same = np.unique(place, return_index=True, return_inverse=True)
    branch = np.repeat(np.arange(graph.branch_count), count)
    earlier = branch[first][same.reshape(-1)] < branch
    earlier[graph.offsets[:-1]] = earlier[graph.offsets[1:] - 1] = True
    return (np.bincount(branch, earlier, graph.branch_count) == count) & (count > 2)


def places_of_repeated(graph: PlanarGraph) -> Array:
    """(J + C,) bool: the places at which a repeated branch begins or ends."""
    return np.isin(graph.places, graph.ends[repeated(graph)])


def connected(count: int, links: Array) -> Array:
    """(count,) int32: the smallest number that each number is linked to by (K, 2) links."""
    label = np.arange(count, dtype=np.int32)
    while len(links):
        low = np.minimum(label[links[:, 0]], label[links[:, 1]])
        before = label.copy()
        np.minimum.at(label, links[:, 0], low)
        np.minimum.at(label, links[:, 1], low)
        label = label[label]
        if np.array_equal(label, before):
            break
    return label


def lengths(graph: PlanarGraph) -> Array:
    """(B,) float64: arc length of every branch in px."""
    if graph.branch_count == 0:
        return np.zeros(0)
    return np.add.reduceat(steps(graph.points, graph.offsets), graph.offsets[:-1])


def means(graph: PlanarGraph, values: Array) -> Array:
    """(B,) the mean of (P,) values on each branch."""
    return np.add.reduceat(values.astype(np.float64), graph.offsets[:-1]) / np.diff(graph.offsets)


def rank_at_vertex(vertex: Array, degree: Array, worth: Array) -> Array:
    """(H,) how many half-branches at the same vertex are worth more."""
    order = np.lexsort((-worth, vertex))
    start = np.cumsum(degree) - degree
    rank = np.empty(len(order), np.int64)
    rank[order] = np.arange(len(order)) - start[vertex[order]]
    return rank
