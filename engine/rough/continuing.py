"""Which redrawn lines go on in which: the scores of pairs of half-branches on a rough page.

Where bundles meet, nothing is exact: the directions at a junction say less than on a clean page,
and those farther along the lines more. So the features of the geometric router are read at three
scales, and a small network makes log-odds of them.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..graph.topology import lengths
from ..routing.features import FEATURES as OF_PAIRS
from ..routing.features import pair_features
from ..values import Array, PlanarGraph
from .grouping import log_odds

_SCALES = (1.0, 2.0, 4.0)  # times the pen
FEATURES = len(_SCALES) * len(OF_PAIRS) + 7  # of a pair


def score(graph: PlanarGraph, pairs: Array) -> Array:
    """(K,) float32 log-odds of joining each of the (K, 2) pairs against ending both."""
    return log_odds(features(graph, pairs), "goes_on").astype(np.float32)


def features(graph: PlanarGraph, pairs: Array) -> Array:
    """(K, F) float64: what tells of two half-branches whether they are one line."""
    assert graph.widths is not None, "a redrawn graph is measured"
    scaled = [
        pair_features(replace(graph, widths=graph.widths * np.float32(k)), pairs) for k in _SCALES
    ]
    turn = scaled[1][:, 3]
    a, b = pairs.T
    length = np.log(np.maximum(lengths(graph), 0.5) / float(np.median(graph.widths)))
    degree = graph.degrees[graph.half_vertex[a]]
    rival_a, rival_b = _rivals(pairs, turn, len(graph.half_vertex))
    extra = [
        np.minimum(length[a >> 1], length[b >> 1]),
        np.maximum(length[a >> 1], length[b >> 1]),
        degree,
        turn - np.minimum(rival_a, rival_b),
        turn - np.maximum(rival_a, rival_b),
        turn <= np.minimum(rival_a, rival_b),
        (a >> 1) == (b >> 1),
    ]
    return np.column_stack([*scaled, *extra])


def _rivals(pairs: Array, turn: Array, halves: int) -> tuple[Array, Array]:
    """For both half-branches of each pair the least turn that any other pair offers them."""
    a, b = pairs.T
    half, of = np.concatenate([a, b]), np.tile(np.arange(len(pairs)), 2)
    order = np.lexsort((turn[of], half))
    half, value = half[order], turn[of][order]
    first = np.flatnonzero(np.diff(half, prepend=-1))
    best, second = np.full(halves, np.pi), np.full(halves, np.pi)
    best[half[first]] = value[first]
    more = first[np.diff(np.append(first, len(half))) > 1]
    second[half[more]] = value[more + 1]
    found = []
    for side in (a, b):
        found.append(np.where(turn <= best[side], second[side], best[side]))
    return found[0], found[1]
