"""Half-branches at junctions: which pairs could be one line."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..values import PlanarGraph

Array = np.ndarray


def by_degree(graph: PlanarGraph) -> Iterator[tuple[Array, Array]]:
    """Junctions of one degree at a time.

    Yields:
        junctions: (n,) numbers into graph.junctions.
        halves: (n, degree) the half-branches at each, ascending.
    """
    order, starts = graph.halves_at
    degree = graph.degrees[graph.junctions]
    for d in np.unique(degree):
        junctions = np.flatnonzero(degree == d)
        yield junctions, order[starts[graph.junctions[junctions]][:, None] + np.arange(d)]


def candidate_pairs(graph: PlanarGraph) -> Array:
    """All pairs of half-branches that share a junction: (K, 2) int32, a < b, junction by junction.

    The pairs of a junction with half-branches h lie together, in the order of
    np.triu_indices(len(h), 1); see `pair_starts`.
    """
    starts = pair_starts(graph)
    pairs = np.empty((starts[-1], 2), np.int32)
    for junctions, halves in by_degree(graph):
        a, b = np.triu_indices(halves.shape[1], 1)
        rows = starts[junctions][:, None] + np.arange(len(a))
        pairs[rows] = np.stack([halves[:, a], halves[:, b]], axis=-1)
    return pairs


def pair_starts(graph: PlanarGraph) -> Array:
    """(J + 1,) int: where each junction's pairs begin in `candidate_pairs`."""
    degree = graph.degrees[graph.junctions].astype(np.int64)
    return np.concatenate([[0], np.cumsum(degree * (degree - 1) // 2)])
