"""How the interface names half-branches: letters clockwise from the top, with an arrow each."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from ..language import label
from .picking import is_bundle

if TYPE_CHECKING:
    from ...engine import Bundle, Drawing, Junction

_ARROWS = "→↘↓↙←↖↑↗"  # clockwise, y down
_REACH = 12.0  # px; how far out a half-branch's direction is looked at


def letters(drawing: Drawing, junction: Junction) -> dict[int, str]:
    """The letter of each half-branch of a junction: A is the first one clockwise from the top."""
    angles = {half: angle(drawing, half) for half in junction.half_branches}
    clockwise = sorted(angles, key=lambda half: ((angles[half] + np.pi / 2) % (2 * np.pi), half))
    return {half: _letter(number) for number, half in enumerate(clockwise)}


def angle(drawing: Drawing, half: int) -> float:
    """The direction in which a half-branch leaves its junction, radians, y down."""
    points = drawing.graph.half_branch(half).astype(np.float64)
    lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    reach = min(_REACH, 0.5 * lengths[-1])
    out = [np.interp(reach, lengths, points[:, k]) - points[0, k] for k in (0, 1)]
    return float(np.arctan2(out[1], out[0]))


def arrow(radians: float) -> str:
    """The arrow that points most nearly in a direction."""
    return _ARROWS[round(radians / (np.pi / 4)) % 8]


def sentence(names: dict[int, str], pairs: Iterable[tuple[int, int]]) -> str:
    """A routing in words, such as "A–C, B–D" or "A–C, B ends"."""
    pairs = list(pairs)
    joined = sorted("–".join(sorted((names[a], names[b]))) for a, b in pairs)
    loose = sorted(set(names.values()) - {names[half] for pair in pairs for half in pair})
    if loose:
        end = "{lines} ends" if len(loose) == 1 else "{lines} end"
        joined.append(label(end, lines=" ".join(loose)))
    return ", ".join(joined)


def in_words(drawing: Drawing, place: Junction | Bundle, pairs: Iterable[tuple[int, int]]) -> str:
    """What is joined at a junction, or whether the strokes of a bundle are one line."""
    if is_bundle(drawing, place):
        return label("One line") if list(pairs) else label("Two lines")
    return sentence(letters(drawing, place), pairs)


def percent(probability: float) -> str:
    """A probability for people; what is possible never reads 0 %, what is doubtful never 100 %."""
    if 0.0 < probability < 0.01:
        return "< 1 %"
    return "> 99 %" if 0.99 < probability < 0.9995 else f"{100 * probability:.0f} %"


def _letter(number: int) -> str:
    return chr(ord("A") + number % 26) * (1 + number // 26)
