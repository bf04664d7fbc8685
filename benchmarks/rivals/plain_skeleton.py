"""From a skeleton to its pieces, and from pieces that continue each other to strokes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix
from scipy.sparse.csgraph import connected_components, dijkstra

Array = np.ndarray


class Pieces(NamedTuple):
    """The branches of a skeleton.

    paths: (N, 2) polylines, px; ends: (B, 2) the nodes that they start and end on; nodes: (V, 2)
    px. A loop that meets nothing else has a node of its own.
    """

    paths: list[Array]
    ends: Array
    nodes: Array


def pieces(skeleton: Array) -> Pieces:
    """Cut an (H, W) bool skeleton, 1 px wide, at its junctions.

    Junction pixels that touch each other are one node, at their centre; so is each tip.
    """
    pixels, links = _pixel_graph(skeleton)
    count = len(pixels)
    degree = np.bincount(links.ravel(), minlength=count)
    core = degree >= 3
    # A loop without a junction gets one: its first pixel.
    whole = _components(links, count)
    plain = np.bincount(whole, degree != 2) == 0
    first = np.unique(whole, return_index=True)[1]
    core[first[plain]] = True

    in_core = core[links].sum(1)
    cluster = np.full(count, -1)
    _, cluster[core] = np.unique(_components(links[in_core == 2], count)[core], return_inverse=True)
    inner = links[in_core == 0]
    path = _components(inner, count)

    # Each path has two ends: where it touches a cluster, or its tip.
    mixed = links[in_core == 1]
    outside = np.where(core[mixed[:, 0]], mixed[:, 1], mixed[:, 0])
    inside = np.where(core[mixed[:, 0]], mixed[:, 0], mixed[:, 1])
    tips = np.flatnonzero((degree == 1) & ~core)
    clusters = cluster.max(initial=-1) + 1
    end_pixel = np.concatenate([outside, tips])
    end_node = np.concatenate([cluster[inside], clusters + np.arange(len(tips))])
    end_order = np.argsort(path[end_pixel], kind="stable")
    end_pixel, end_node = end_pixel[end_order].reshape(-1, 2), end_node[end_order].reshape(-1, 2)
    size = np.maximum(1, np.bincount(cluster[core], minlength=clusters))
    centres = [np.bincount(cluster[core], axis[core], clusters) / size for axis in pixels.T]
    nodes = np.vstack([np.stack(centres, -1), pixels[tips]])

    graph = _graph(inner, count)
    steps = np.zeros(count)
    if len(end_pixel):
        steps = dijkstra(graph, False, end_pixel[:, 0], unweighted=True, min_only=True)
    order = np.lexsort((steps, path))
    order = order[~core[order] & (degree[order] > 0)]
    lines = np.split(pixels[order], np.flatnonzero(np.diff(path[order])) + 1) if len(order) else []
    kept = [k for k, (a, b) in enumerate(end_node) if a != b or len(lines[k]) > 1]
    return Pieces(
        [np.vstack([nodes[end_node[k, 0]], lines[k], nodes[end_node[k, 1]]]) for k in kept],
        end_node[kept],
        nodes,
    )


def strokes(paths: list[Array], partner: Array) -> list[Array]:
    """Join pieces into strokes, grown to both sides.

    Args:
        paths: (N, 2) polylines; the half 2 * k starts at the first point of paths[k], 2 * k + 1 at
            its last.
        partner: (2K,) the half that each half continues in; itself where the stroke ends.
    """
    done = np.zeros(len(paths), bool)
    result = []
    # Open strokes start at an end; what is left then are closed ones.
    starts = np.flatnonzero(partner == np.arange(len(partner)))
    for start in [*starts.tolist(), *range(0, len(partner), 2)]:
        line, half = [], start
        while not done[half >> 1]:
            done[half >> 1] = True
            line.append(paths[half >> 1][:: -1 if half & 1 else 1])
            half = int(partner[half ^ 1])
        if line:
            closed = partner[start] != start
            result.append(np.vstack([*line, line[0][:1]] if closed else line))
    return result


def _pixel_graph(skeleton: Array) -> tuple[Array, Array]:
    """The pixel centres (P, 2) and the links (L, 2) between neighbours.

    Diagonal neighbours are linked only where no pixel lies between them, so that a corner of
    three pixels is no junction.
    """
    ink = np.pad(skeleton.astype(bool), 1)
    number = np.full(ink.shape, -1)
    number[ink] = np.arange(ink.sum())
    rows, columns = np.nonzero(ink)
    links = []
    for down, right in ((0, 1), (1, 0), (1, 1), (1, -1)):
        there = ink[rows + down, columns + right]
        if down and right:
            there &= ~ink[rows + down, columns] & ~ink[rows, columns + right]
        ends = number[rows[there], columns[there]], number[rows + down, columns + right][there]
        links.append(np.stack(ends, -1))
    return np.stack([columns, rows], -1) - 0.5, np.concatenate(links)


def _graph(links: Array, count: int) -> csr_matrix:
    ones = np.ones(len(links))
    return (coo_matrix((ones, (links[:, 0], links[:, 1])), (count, count))).maximum(
        coo_matrix((ones, (links[:, 1], links[:, 0])), (count, count))
    )


def _components(links: Array, count: int) -> Array:
    return connected_components(_graph(links, count), directed=False)[1]
