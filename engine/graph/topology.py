"""Small changes to a planar graph: keep some branches, join those that meet two by two."""

from __future__ import annotations

import numpy as np

from ..values import PlanarGraph
from .chains import follow

Array = np.ndarray


def select(graph: PlanarGraph, keep: Array) -> PlanarGraph:
    """The graph with only the branches (B,) bool that are kept; vertices are renumbered."""
    counts = np.diff(graph.offsets)
    ends = graph.ends[keep]
    used = np.zeros(len(graph.vertices), bool)
    used[ends] = True
    number = np.cumsum(used) - 1
    stays = np.repeat(keep, counts)
    measured = (graph.widths, graph.strength, graph.colors)
    return PlanarGraph(
        graph.vertices[used],
        graph.points[stays],
        np.concatenate([[0], np.cumsum(counts[keep])]).astype(np.int32),
        number[ends].astype(np.int32).reshape(-1, 2),
        *(None if values is None else values[stays] for values in measured),
    )


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
    total = np.concatenate([[0], np.cumsum(taken)])
    within = np.arange(total[-1]) - np.repeat(total[:-1], taken)
    start = np.where(flipped, graph.offsets[branch + 1] - 1, graph.offsets[branch])
    step = np.where(flipped, -1, 1)
    index = np.repeat(start, taken) + np.repeat(step, taken) * within
    halves = np.stack([order[bounds[:-1]], order[bounds[1:] - 1] ^ 1], -1).astype(np.int32)
    ends = graph.half_vertex[halves]
    measured = (graph.widths, graph.strength, graph.colors)
    whole = PlanarGraph(
        graph.vertices,
        graph.points[index],
        total[bounds].astype(np.int32),
        ends.astype(np.int32),
        *(None if values is None else values[index] for values in measured),
    )
    return select(whole, np.ones(whole.branch_count, bool)), halves.reshape(-1)


def contract(graph: PlanarGraph, shortest: float) -> PlanarGraph:
    """Make one vertex of those that branches shorter than `shortest` px link, and drop these."""
    link = (lengths(graph) < shortest) & (graph.degrees[graph.ends] >= 3).all(1)
    if not link.any():
        return graph
    label = connected(len(graph.vertices), graph.ends[link])
    count = np.maximum(np.bincount(label, minlength=len(label)), 1)
    vertices = np.stack(
        [np.bincount(label, graph.vertices[:, k], len(label)) / count for k in (0, 1)], -1
    ).astype(np.float32)
    ends = label[graph.ends]
    points = graph.points.copy()
    points[graph.offsets[:-1]] = vertices[ends[:, 0]]
    points[graph.offsets[1:] - 1] = vertices[ends[:, 1]]
    return join(select(PlanarGraph(vertices, points, graph.offsets, ends), ~link))


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
    steps = np.hypot(*np.diff(graph.points.astype(np.float64), axis=0, append=0).T)
    steps[graph.offsets[1:] - 1] = 0.0
    return np.add.reduceat(steps, graph.offsets[:-1])


def means(graph: PlanarGraph, values: Array) -> Array:
    """(B,) the mean of (P,) values on each branch."""
    return np.add.reduceat(values.astype(np.float64), graph.offsets[:-1]) / np.diff(graph.offsets)
