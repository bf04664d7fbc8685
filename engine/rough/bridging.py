"""Lines that go on over a gap: two loose ends of redrawn lines that are one line.

Where the pencil was lifted for a moment, or a junction of leftovers was taken away, a line breaks
off. A small network judges every two loose ends that are not far from each other: how far, how
straight, how long and dark the lines are, and whether there is pencil between them.
"""

from __future__ import annotations

import numpy as np

from ..arrays.sampling import sample
from ..graph.gaps import linked, looks, mutual
from ..graph.nearby import near_pairs
from ..graph.topology import join, lengths, means
from ..values import Array, PlanarGraph
from .grouping import log_odds
from .redrawn import Bundles

FEATURES = 21  # of a pair of loose ends
_REACH = 10.0  # pens between two ends that may be one line; 97 % of the true gaps are narrower
_BETWEEN = (0.2, 0.35, 0.5, 0.65, 0.8)  # of the way across: there we look for pencil


def bridged(graph: PlanarGraph, bundles: Bundles, pen: float) -> PlanarGraph:
    """The graph with the gaps closed across which a line most probably goes on."""
    halves = candidates(graph, pen)
    if not len(halves):
        return graph
    score = log_odds(features(graph, halves, bundles, pen), "bridges")
    good = score > 0
    a, b = halves[good].T
    best = mutual(a, b, -score[good], 2 * graph.branch_count)
    return closed(graph, halves[good][best])


def closed(graph: PlanarGraph, halves: Array) -> PlanarGraph:
    """The graph with one branch from each pair of half-branches that end loosely; (K, 2)."""
    return join(linked(graph, graph.half_vertex[halves])) if len(halves) else graph


def candidates(graph: PlanarGraph, pen: float) -> Array:
    """(K, 2) half-branches that end loosely not far from each other."""
    free = np.flatnonzero(graph.degrees[graph.half_vertex] == 1)
    if len(free) < 2:
        return np.zeros((0, 2), np.int64)
    halves = free[near_pairs(graph.vertices[graph.half_vertex[free]], _REACH * pen)]
    tips = graph.vertices[graph.half_vertex[halves]]
    gap = np.hypot(*(tips[:, 0] - tips[:, 1]).T)
    # Both ends of a line may close it to a ring, but not to one as small as its gap.
    own = halves[:, 0] >> 1 == halves[:, 1] >> 1
    fits = ~own | (lengths(graph)[halves[:, 0] >> 1] > 3 * gap)
    return halves[fits & (gap <= _REACH * pen)]


def features(graph: PlanarGraph, halves: Array, bundles: Bundles, pen: float) -> Array:
    """(K, F) float64: what tells of two loose ends whether a line goes on from one to the other."""
    assert graph.strength is not None, "a redrawn graph is measured"
    a, b = halves.T
    ends, index = np.unique(halves, return_inverse=True)
    i, j = index.reshape(halves.shape).T
    tips, outward = looks(graph, ends)
    way = tips[j] - tips[i]
    gap = np.hypot(*way.T)
    ahead = np.stack([(outward[i] * way).sum(1), -(outward[j] * way).sum(1)]) / pen
    across = np.stack([-way[:, 1], way[:, 0]], 1)
    aside = np.abs(np.stack([(outward[k] * across).sum(1) for k in (i, j)])) / pen
    length = np.log(lengths(graph) / pen + 0.1)
    number, dark = means(graph, sample(bundles.count, graph.points)), means(graph, graph.strength)
    away = np.stack([sample(bundles.away, tips[i] + t * way) for t in _BETWEEN]) / pen
    gaps = np.full((2, len(ends)), np.inf)
    for side in (i, j):
        np.minimum.at(gaps[0], side, gap)
    rival = gap / np.maximum(np.minimum(gaps[0, i], gaps[0, j]), 1e-3)
    columns = [
        np.log(gap / pen + 0.1),
        gap / pen,
        ahead.min(0),
        ahead.max(0),
        aside.min(0),
        aside.max(0),
        (ahead / (gap / pen + 0.1)).min(0),
        -(outward[i] * outward[j]).sum(1),
        np.log(np.minimum(rival, 50.0)),
        gap <= 1.001 * gaps[0, i],
        gap <= 1.001 * gaps[0, j],
        *(how(length[a >> 1], length[b >> 1]) for how in (np.minimum, np.maximum)),
        *(how(number[a >> 1], number[b >> 1]) for how in (np.minimum, np.maximum)),
        *(how(dark[a >> 1], dark[b >> 1]) for how in (np.minimum, np.maximum)),
        away.max(0),
        away.mean(0),
        a >> 1 == b >> 1,
        np.full(len(gap), np.log(pen)),
    ]
    return np.column_stack(columns).astype(np.float64)
