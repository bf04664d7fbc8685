"""Which strokes the artist has selected, as Blender keeps it. Pure NumPy."""

from __future__ import annotations

import numpy as np

from .stroke_arrays import Column, Curves, column

Array = np.ndarray

SELECTION = ".selection"


def selected(cel: Curves) -> Array:
    """Numbers of the strokes of which a point is selected; all of them where nothing says so."""
    if SELECTION in cel.curves:
        return np.flatnonzero(cel.curve(SELECTION) > 0)
    if SELECTION in cel.points and len(cel):
        on = cel.point(SELECTION) > 0
        return np.flatnonzero(np.logical_or.reduceat(on, cel.offsets[:-1]))
    return np.arange(len(cel))


def as_selected(new: Curves, like: Curves) -> Curves:
    """The same strokes, selected where the cel `like`, to which they come, knows selections."""
    points, curves = dict(new.points), dict(new.curves)
    for columns, there, count in (
        (points, like.points, int(new.offsets[-1])),
        (curves, like.curves, len(new)),
    ):
        if SELECTION in there:
            columns[SELECTION] = _all(there[SELECTION], count)
    return Curves(new.offsets, points, curves)


def _all(like: Column, count: int) -> Column:
    return column(like.type, np.ones(count))
