"""Lines that an answer elsewhere has not changed keep their strokes, to the last bit.

What an answer changes is near it; but a page has one typical pressure and one typical width, and
these change with every line a little, and with them the points and widths of all strokes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..values import Array, Stroke

_NEAR = 0.3  # px; lines no farther apart are the same to the eye
_AS_WIDE = 0.1  # of its width that a line may become wider or narrower


def unchanged(old: Sequence[Stroke], new: Sequence[Stroke]) -> tuple[Stroke, ...]:
    """The new strokes, with the shape of the old one where that is the same line."""
    boxes = np.array([_box(stroke) for stroke in old]).reshape(-1, 4)
    found, left = [], np.ones(len(old), bool)
    for stroke in new:
        near = left & (np.abs(boxes - _box(stroke)) <= _NEAR).all(1)
        same = (k for k in np.flatnonzero(near).tolist() if _is_same(old[k], stroke))
        mate = next(same, -1)
        if mate >= 0:
            left[mate] = False
            stroke = replace(old[mate], branches=stroke.branches)
        found.append(stroke)
    return tuple(found)


def _box(stroke: Stroke) -> Array:
    return np.concatenate([stroke.points.min(0), stroke.points.max(0)])


def _is_same(one: Stroke, other: Stroke) -> bool:
    """Do they run the same way along the same line, as wide, in the same ink?"""
    kind = (one.closed, one.color, one.handles is None, one.dash)
    if kind != (other.closed, other.color, other.handles is None, other.dash):
        return False
    if abs(np.median(one.widths) / np.median(other.widths) - 1) > _AS_WIDE:
        return False
    if one.handles is not None and other.handles is not None:  # curves between few points
        alike = one.handles.shape == other.handles.shape
        return alike and bool((np.abs(one.handles - other.handles) <= _NEAR).all())
    tips = one.points[[0, -1]] - other.points[[0, -1]]
    if not one.closed and np.hypot(*tips.T).max() > 2 * _NEAR:
        return False
    return bool(max(_away(one, other), _away(other, one)) <= _NEAR)


def _away(one: Stroke, other: Stroke) -> float:
    """Px from the points of one polyline to the other, at most."""
    line = other.points.astype(np.float64)
    if other.closed:
        line = np.concatenate([line, line[:1]])
    start, side = line[:-1], np.diff(line, axis=0)
    if not len(side):
        return float(np.hypot(*(one.points - line[0]).T).max())
    ahead = one.points[:, None] - start
    share = (ahead * side).sum(2) / np.maximum((side**2).sum(1), 1e-12)
    foot = ahead - np.clip(share, 0, 1)[..., None] * side
    return float(np.hypot(foot[..., 0], foot[..., 1]).min(1).max())
