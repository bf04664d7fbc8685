"""Strokes of one page as a hand draws them, to learn routing from what a tracer makes of them.

The page is a window of a sheet at the size that people draw at: small, so that it is traced soon,
and its junctions are as large and as close to each other as on a whole page.
"""

from __future__ import annotations

import numpy as np
from involute.engine.arrays.ragged import along, arc

from ...synthesis.composed_pages import Library, loosened
from ...synthesis.held_out_pages import endless
from ...synthesis.line_art import pieces
from ...synthesis.pen_lifts import Habit, lifted

Array = np.ndarray

MARGIN = 12.0  # px around the drawing
_SIDE = (360.0, 640.0)  # px, of the window; half a second to trace on the whole
_SHEETS = 0.55  # share of the pages that are windows of a drawing as large as a sheet
_TANGLES = 0.1  # share that are windows of tangles; others of them are among the rest
_SHEET = (0.7, 1.0)  # of the benchmark's size
_PEN = 4.0  # px; a habit moves ends by shares of this
_LOOKS = 4  # places that a window may be around
_LEAST = 6.0  # px; a shorter piece of a stroke at the rim of the window is left out


def hand_drawn(rng: np.random.Generator, library: Library) -> list[Array]:
    """(N, 2) px for every stroke, in positive coordinates; now and then there is none.

    Six pages in ten are of hands that lift the pen at corners (`Habit.drawn`).
    """
    kind = rng.random()
    if kind < _TANGLES and "tangles" in library.sources:
        strokes = next(endless(rng, library, ["tangles"]))
    elif kind < _TANGLES + _SHEETS:
        strokes = next(endless(rng, library))
    else:
        strokes = library.page(rng)
    if kind < _TANGLES + _SHEETS:
        size = rng.uniform(*_SHEET)
        strokes = [line * size for line in strokes]
    strokes = lifted(rng, strokes, Habit.drawn(rng, _PEN))
    return in_window(rng, loosened(rng, strokes), rng.uniform(*_SIDE))


def in_window(rng: np.random.Generator, strokes: list[Array], side: float) -> list[Array]:
    """What lies within a square of `side` px around a place on a stroke, of some random ones that
    with the most around it, moved to positive coordinates; a drawing that fits is whole."""
    if not strokes:
        return []
    low, high = (get([get(line, 0) for line in strokes], 0) for get in (np.min, np.max))
    if (high - low).max() > side:
        dense = [along(line, np.arange(0.0, arc(line)[-1], 4.0)) for line in strokes]
        places = np.concatenate(dense)
        middles = places[rng.integers(len(places), size=_LOOKS)]
        corners = np.clip(middles - side / 2, low, np.maximum(high - side, low))
        inside = [((places >= c) & (places <= c + side)).all(1).sum() for c in corners]
        corner = corners[int(np.argmax(inside))]
        strokes = [piece for line in strokes for piece in _inside(line, corner, corner + side)]
    if not strokes:
        return []
    low = np.min([line.min(0) for line in strokes], 0)
    return [line - low + MARGIN for line in strokes]


def _inside(line: Array, low: Array, high: Array) -> list[Array]:
    """The pieces of a polyline within a rectangle."""
    if ((line >= low) & (line <= high)).all():
        return [line]
    way = arc(line)[-1]
    dense = along(line, np.linspace(0, way, max(2, round(way) + 1)))
    inside = ((dense >= low) & (dense <= high)).all(1)
    return [piece for piece in pieces(dense, inside) if len(piece) > _LEAST]
