"""Strokes in the order and direction in which a hand would draw them.

Long outlines first, then what belongs to them; from the left to the right and from the top to the
bottom, one neighbourhood after the other. For animations that draw the page stroke by stroke.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..values import Array, Stroke

_LONG = 0.25  # of the page's longer side: a stroke from which on it is an outline
_BLOCKS = 6  # neighbourhoods along the longer side


def hand_order(strokes: Sequence[Stroke], size: tuple[int, int]) -> list[tuple[int, bool]]:
    """The numbers of strokes in drawing order, and whether each is drawn the other way round.

    Args:
        size: (width, height) of the page, px.
    """
    if not strokes:
        return []
    side = max(size)
    tips = np.array([[s.points[0], s.points[-1]] for s in strokes], np.float64)
    way = tips[:, 1] - tips[:, 0]
    sideways = np.abs(way[:, 0]) >= np.abs(way[:, 1])
    turned = np.where(sideways, way[:, 0] < 0, way[:, 1] < 0)
    turned &= np.array([not s.closed for s in strokes])
    start = np.where(turned[:, None], tips[:, 1], tips[:, 0])
    short = np.array([_length(s) for s in strokes]) < _LONG * side
    block = np.floor(start * (_BLOCKS / side))
    order = np.lexsort((start[:, 0], start[:, 1], block[:, 0], block[:, 1], short))
    return [(int(k), bool(turned[k])) for k in order]


def _length(stroke: Stroke) -> float:
    points: Array = stroke.points.astype(np.float64)
    if stroke.closed:
        points = np.concatenate([points, points[:1]])
    return float(np.hypot(*np.diff(points, axis=0).T).sum())
