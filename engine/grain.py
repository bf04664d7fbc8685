"""Grainy lines, of pencil, crayon and charcoal, are looked at from farther away.

From close by, a grainy line is torn: pieces with loose ends, hooks and rungs. On a smaller picture
its grain closes. So a page whose ink is soft and whose lines have many loose ends is traced at
smaller sizes as well, and the drawing that says as much with far fewer strokes is kept.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import cv2
import numpy as np

from .drawing import Drawing
from .settings import Settings
from .values import Array, Scan

# Chosen on 154 held-out pages, 90 of them of pencil, charcoal, ballpoint and brush pen: mean F1
# 0.502 as it was, 0.535 with these (23 pages better by 0.03 and more, none worse), junctions found
# 0.768 and 0.768, their precision 0.493 and 0.519. Shares of 0.6 to 0.8 of the strokes do nearly
# alike; with 0.9 of the length F1 is 0.535 and 0.760 of the junctions are found. All in place, with
# the slimmed network, on the 90: F1 0.469 and 0.510 (13 better, 2 worse), 1.12 and 1.56 CPU s.
_COARSE, _MEDIUM = 0.7, 0.85  # of the strokes that are left, at most
# Of the strokes left by coarse from which on medium is of no use either: of 170 held-out pages of
# all media medium was kept on 11, with 0.55 to 0.84 and once 0.89 left by coarse; 14 more looks
# between 0.85 and 0.95 came to nothing.
_HOPE = 0.85
# The lean network gains alike: 40 held-out pages of all media, 0.577 to 0.583 (the other one 0.592
# to 0.598). On 59 pages in charcoal and pencil one look more makes 0.449 of 0.439.
_TATTERED, _FEWER = 0.4, 0.9  # of the strokes left by coarse; and again by coarsest
_LENGTH = 0.96  # share of the length of all strokes that is left, at least ...
_MESS = 0.5  # ... unless so few strokes are left: then much of the length was hooks and rungs
_LOST = 0.01  # share of the ink that may be lost more; changes nothing on those pages
# Which pages are looked at again: nine tenths of the gain, three quarters of the pages of pencil
# and charcoal and a third of the others (on the same pages; 0.004 does alike, with 0.012 a tenth of
# the gain goes). All 154 together took 0.29 more time, the 64 of all media 0.18.
_TORN = 0.008  # loose ends for each pen width of line, at least
_SOFT = 0.37  # spread of the ink on lines, at most; black and white has up to 0.5
_LINES = 0.25  # of the ink, smoothed over half a pen, from which on there is a line


def is_decided(settings: Settings) -> bool:
    """Whether a page is looked at from one place only: the user says so, or no other was tried."""
    return (
        settings.grain != "auto"
        or settings.drawing != "clean"
        or settings.provider not in ("auto", "network", "lean")
    )


def is_torn(drawing: Drawing, scan: Scan) -> bool:
    """Whether the lines of a page are soft, and their strokes have many loose ends."""
    length = _length(drawing)
    loose = int((drawing.graph.degrees == 1).sum())
    pen = scan.pen_width * scan.scale
    return loose * pen > _TORN * max(length, 1.0) and _spread(scan.ink, scan.pen_width) < _SOFT


class Look(Protocol):
    """A page that can be traced from some distance."""

    def area_count(self) -> int:
        """How many solid areas are seen; that is known soon."""
        ...

    def drawing(self) -> Drawing: ...


def simplest(close: Drawing, look: Callable[[str], Look]) -> tuple[Drawing, str]:
    """The drawing of a torn page that is kept, and from where it was looked at.

    Args:
        close: its drawing from close by. look: at the page, for another value of `Settings.grain`.
    """
    first = look("coarse")
    if first.area_count() < len(close.fills):
        return close, "fine"  # an ink drawing: its solid areas fall apart from afar
    coarse = first.drawing()
    if not _says_as_much(coarse, close, _COARSE):
        if _left(coarse, close) < _HOPE and (seen := _as_good(look("medium"), close, _MEDIUM)):
            return seen, "medium"
        return close, "fine"
    if _left(coarse, close) < _TATTERED:
        seen = _as_good(look("coarsest"), close, _TATTERED)
        if seen and _left(seen, coarse) < _FEWER:
            return seen, "coarsest"
    return coarse, "coarse"


def _as_good(look: Look, than: Drawing, share: float) -> Drawing | None:
    """What is drawn from there, if it says as much as another drawing."""
    if look.area_count() < len(than.fills):
        return None  # its lines need not be looked at
    drawing = look.drawing()
    return drawing if _says_as_much(drawing, than, share) else None


def _says_as_much(drawing: Drawing, than: Drawing, share: float) -> bool:
    """Whether a drawing has the ink, the length and the solid areas of another one in that small a
    share of its strokes."""
    left = _left(drawing, than)
    if len(drawing.fills) < len(than.fills):
        return False
    lost = [one.fidelity.lost if one.fidelity else 0.0 for one in (drawing, than)]
    if left >= share or lost[0] > lost[1] + _LOST:
        return False
    return left < _MESS or _length(drawing) >= _LENGTH * _length(than)


def _left(drawing: Drawing, than: Drawing) -> float:
    """Share of the strokes of one drawing that another one has."""
    return len(drawing.strokes) / max(len(than.strokes), 1)


def note(grain: str) -> str:
    """What is said of a page that was looked at from farther away."""
    return f"The lines are grainy: traced from farther away (--grain {grain})."


def _length(drawing: Drawing) -> float:
    """Of all strokes together, px of the input."""
    return float(
        sum(np.hypot(*np.diff(stroke.points, axis=0).T).sum() for stroke in drawing.strokes)
    )


def _spread(ink: Array, pen: float) -> float:
    """Standard deviation of the ink where lines are."""
    lines = cv2.GaussianBlur(ink, (0, 0), pen / 2) > _LINES
    return float(ink[lines].std()) if lines.any() else 1.0
