"""Which of many points lie close to each other, or to others."""

from __future__ import annotations

import numpy as np

from ..arrays.ragged import ranges
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


def near_between(some: Array, others: Array, reach: float) -> tuple[Array, Array]:
    """All pairs of points (A, 2) and (B, 2) at most `reach` px apart: numbers (K,) and (K,)."""
    cell = np.floor(others / reach).astype(np.int64)
    key = cell[:, 1] * (1 << 32) + cell[:, 0]
    order = np.argsort(key, kind="stable")
    key = key[order]
    home = np.floor(some / reach).astype(np.int64)
    found = []
    for row in (-1, 0, 1):  # three cells side by side are one range
        low = (home[:, 1] + row) * (1 << 32) + home[:, 0] - 1
        begin, end = np.searchsorted(key, low), np.searchsorted(key, low + 2, "right")
        a = np.repeat(np.arange(len(some)), end - begin)
        found.append((a, order[ranges(begin, end - begin)]))
    a, b = (np.concatenate(part) for part in zip(*found, strict=True))
    near = ((some[a] - others[b]) ** 2).sum(1) <= reach**2
    return a[near], b[near]
