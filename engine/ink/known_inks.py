"""The inks of a sequence: a later frame's own shade of one becomes exactly that colour."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..values import Stroke
from .tint import NEUTRAL, chroma_and_hue, tint

_SAME_HUE = np.radians(35)  # a coloured ink may look darker in one frame, hardly of another hue
_SAME_GRAY = 60.0  # of 255, for black, gray and what is nearly that

Color = tuple[int, int, int]


def with_known_inks(strokes: Sequence[Stroke], inks: list[Color]) -> tuple[Stroke, ...]:
    """Strokes in the colours that their inks had before; `inks` grows by those not seen yet."""
    known: dict[Color, Color] = {}
    for color in dict.fromkeys(s.color for s in strokes):
        likely = min(inks, key=lambda ink: _ink_difference(color, ink), default=color)
        known[color] = likely if _ink_difference(color, likely) < 1.0 else color
        if known[color] not in inks:
            inks.append(known[color])
    return tuple(
        s if known[s.color] == s.color else replace(s, color=known[s.color]) for s in strokes
    )


def _ink_difference(one: Color, other: Color) -> float:
    """Below 1 for two shades of one ink."""
    colors = np.array([one, other], float)
    chroma, hue = chroma_and_hue(tint(colors))
    if (chroma > NEUTRAL).all():
        return float(abs(np.angle(np.exp(1j * (hue[0] - hue[1])))) / _SAME_HUE)
    return float(np.abs(colors[0] - colors[1]).max() / _SAME_GRAY)
