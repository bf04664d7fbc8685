"""Strokes as formats draw them: the points of their Bezier segments, or, where a format or picture
knows no such curves, plain polylines with widths.
"""

from __future__ import annotations

import numpy as np

from ..values import Array, Stroke

_T = np.linspace(0, 1, 17, dtype=np.float32)[1:, None, None]  # places along a Bezier segment


def controls(stroke: Stroke) -> Array:
    """(3 S + 1, 2) float32: the anchors and handles of a Bezier stroke's S segments as a pen meets
    them: anchor, handle, handle, anchor, and so on; a closed one ends where it begins."""
    handles = stroke.handles
    assert handles is not None, "only a Bezier stroke has them"
    if stroke.closed:
        handles = np.concatenate([handles, handles[:1]])
    points = around(stroke)
    rows = np.stack([handles[:-1, 1], handles[1:, 0], points[1:]], axis=1)
    return np.concatenate([points[:1], rows.reshape(-1, 2)])


def around(stroke: Stroke) -> Array:
    """The points of a stroke, (N, 2) float32; of a closed one with the first again at the end."""
    return np.concatenate([stroke.points, stroke.points[:1]]) if stroke.closed else stroke.points


def outline(stroke: Stroke) -> Array:
    """The line of a stroke, (N, 2) float32; a closed one ends where it begins."""
    if stroke.handles is None:
        return around(stroke)
    places = controls(stroke)
    a, b, c, d = places[:-1:3], places[1::3], places[2::3], places[3::3]
    t, u = _T, 1 - _T
    curve = u**3 * a + 3 * u**2 * t * b + 3 * u * t**2 * c + t**3 * d
    return np.concatenate([places[:1], curve.transpose(1, 0, 2).reshape(-1, 2)])


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
