"""Log-odds that two half-branches are one line, from their geometry alone."""

from __future__ import annotations

import numpy as np

from ..values import PlanarGraph
from .features import half_features

Array = np.ndarray


def score(graph: PlanarGraph, pairs: Array) -> Array:
    """(K,) float32 log-odds of joining each of the (K, 2) pairs against ending both."""
    half = half_features(graph)
    a, b = pairs.T
    cosine = -(half.direction[a] * half.direction[b]).sum(1)
    turn = np.arccos(np.clip(cosine, -1, 1))
    bend = np.abs(half.curvature[a] + half.curvature[b])
    width = np.abs(np.log((half.width[a] + 0.1) / (half.width[b] + 0.1)))
    color = np.abs(half.color[a] - half.color[b]).sum(1)
    return (4.0 - 6.0 * turn - 1.5 * bend - width - 2 * color).astype(np.float32)
