"""Half-branches at junctions and corners: which pairs could be one line."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..values import Array, PlanarGraph


def by_degree(graph: PlanarGraph) -> Iterator[tuple[Array, Array]]:
    """Junctions and corners of one degree at a time.

    Yields:
        places: (n,) numbers into graph.places.
        halves: (n, degree) the half-branches at each, ascending.
    """
    order, starts = graph.halves_at
    degree = graph.degrees[graph.places]
    for d in np.unique(degree):
        places = np.flatnonzero(degree == d)
        yield places, order[starts[graph.places[places]][:, None] + np.arange(d)]


def candidate_pairs(graph: PlanarGraph) -> Array:
    """All pairs of half-branches that share a vertex: (K, 2) int32, a < b, place by place.

    The pairs of a junction with half-branches h lie together, in the order of
    np.triu_indices(len(h), 1); see `pair_starts`. Those of corners, one each, come last.
    """
    starts = pair_starts(graph)
    pairs = np.empty((starts[-1], 2), np.int32)
    for places, halves in by_degree(graph):
        a, b = np.triu_indices(halves.shape[1], 1)
        rows = starts[places][:, None] + np.arange(len(a))
        pairs[rows] = np.stack([halves[:, a], halves[:, b]], axis=-1)
    return pairs


def pair_starts(graph: PlanarGraph) -> Array:
    """(J + C + 1,) int: where the pairs of each place begin in `candidate_pairs`."""
    degree = graph.degrees[graph.places].astype(np.int64)
    return np.concatenate([[0], np.cumsum(degree * (degree - 1) // 2)])
