"""Rows of different lengths, one after the other in one array: polylines, groups, runs.

Row r of `values` is values[offsets[r]:offsets[r + 1]], as in `PlanarGraph`.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..values import Array


def offsets_of(sizes: Sequence[int] | Array) -> Array:
    """(R + 1,) int64: where each of R rows begins, and where the last one ends."""
    offsets = np.zeros(len(sizes) + 1, np.int64)
    np.cumsum(sizes, out=offsets[1:])
    return offsets


def owners(offsets: Array) -> Array:
    """(N,) int64: the row that each of all values belongs to."""
    return np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))


def count_up(sizes: Array) -> Array:
    """0, 1, ... sizes[0] - 1, 0, 1, ... sizes[1] - 1, and so on."""
    return ranges(np.zeros(len(sizes), np.int64), sizes)


def ranges(first: Array, sizes: Array) -> Array:
    """first[0], first[0] + 1, ... (sizes[0] of them), first[1], first[1] + 1, ..., and so on."""
    begin = np.cumsum(sizes) - sizes
    return np.arange(np.sum(sizes, dtype=np.int64)) + np.repeat(first - begin, sizes)


def steps(points: Array, offsets: Array) -> Array:
    """(P,) px from each point (P, 2) of polylines to the one before it; 0 at the first of a row."""
    if not len(points):
        return np.zeros(0)
    points = points.astype(np.float64, copy=False)
    step = np.hypot(*np.diff(points, axis=0, prepend=points[:1]).T)
    step[offsets[:-1]] = 0.0
    return step


def arc(line: Array) -> Array:
    """(N,) px: the way along one polyline (N, 2) to each of its points."""
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])


def end_to_end(points: Array, offsets: Array) -> Array:
    """(P,) places of all points on one axis: the polylines one after the other, 1 px apart.

    One interpolation on that axis serves all rows at once.
    """
    return np.cumsum(steps(points, offsets)) + owners(offsets)


def along(line: Array, places: Array) -> Array:
    """(K, 2) points of a polyline (N, 2) at some ways along it, px; beyond its ends, the ends."""
    way = arc(line)
    return np.stack([np.interp(places, way, line[:, k]) for k in (0, 1)], -1)
