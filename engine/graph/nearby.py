"""Which of many points lie close to each other."""

from __future__ import annotations

import numpy as np

from ..values import Array
from .continuations import pairs_within


def near_pairs(points: Array, reach: float) -> Array:
    """(K, 2), a < b: all pairs of points (N, 2) at most `reach` px apart, and some others."""
    found = [np.zeros((0, 2), np.int64)]
    # Of four grids, shifted by half a cell, one has both points of a pair in one cell.
    for shift in np.stack(np.meshgrid([0, reach], [0, reach]), -1).reshape(-1, 2):
        column, row = ((points + shift) // (2 * reach)).astype(np.int64).T
        found.append(pairs_within(row * (1 << 32) + column))
    key = np.concatenate([(a << 32) + b for a, b in (np.sort(f, axis=1).T for f in found)])
    return np.stack(np.divmod(np.unique(key), 1 << 32), -1)
