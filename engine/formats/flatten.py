"""Strokes as plain polylines, with widths, for formats and pictures that know no Bezier curves."""

from __future__ import annotations

import numpy as np

from ..values import Array, Stroke

_T = np.linspace(0, 1, 17, dtype=np.float32)[1:, None, None]  # places along a Bezier segment


def outline(stroke: Stroke) -> Array:
    """The line of a stroke, (N, 2) float32; a closed one ends where it begins."""
    points, handles = stroke.points, stroke.handles
    if stroke.closed:
        points = np.concatenate([points, points[:1]])
    if handles is None:
        return points
    handles = np.concatenate([handles, handles[:1]])
    a, b, c, d = points[:-1], handles[: len(points) - 1, 1], handles[1 : len(points), 0], points[1:]
    t, u = _T, 1 - _T
    curve = u**3 * a + 3 * u**2 * t * b + 3 * u * t**2 * c + t**3 * d
    return np.concatenate([points[:1], curve.transpose(1, 0, 2).reshape(-1, 2)])


def widths_along(stroke: Stroke) -> Array:
    """The full widths, (N,) float32 px, at the points of `outline`: even between its own points."""
    widths = stroke.widths
    if stroke.closed:
        widths = np.concatenate([widths, widths[:1]])
    if stroke.handles is None:
        return widths
    t, a, b = _T[:, :, 0], widths[:-1], widths[1:]
    between = (1 - t) * a + t * b
    return np.concatenate([widths[:1], between.T.reshape(-1)]).astype(np.float32)
