"""Figures as cartoons have them: parts in front of each other, and what is behind is hidden.

Most lines of a figure end on others, at corners as often as not, and few cross. The drawings of the
library are the parts: each is bent out of its symmetry and laid over those behind it, whose lines
end where its closed lines begin.
"""

from __future__ import annotations

import cv2
import numpy as np

from .composed_pages import Library
from .line_art import Array, Rng, Strokes, random_matrix, resample, transform, wobble
from .true_graph import single_lines

_PARTS = {
    "openclipart": 3.0,
    "streamline": 3.0,
    "openmoji": 2.0,
    "quickdraw_raw": 1.0,
    "quickdraw_simplified": 0.5,
    "arcticons": 0.5,
}
SIDE = 1024  # px of a figure
_PART = (0.25, 0.8)  # of that, the longer side of a part
_CLOSED = 0.03  # of the length of a line, the gap between its ends
_SHORTEST = 14.0  # px of a line that is left of one hidden
_LINES = (12, 110)  # of a figure
_LEAST_HIDES = 0.02  # of the square of a part's side that it must cover to hide anything


def figure(rng: Rng, library: Library) -> Strokes:
    """The lines of one figure, (N, 2) px each, with its longer side of SIDE px."""
    fewest, most = _LINES
    while True:
        lines = _laid(rng, library, int(rng.integers(2, 9)))
        lines = single_lines(lines) if lines else []
        if not fewest <= len(lines) <= most:
            continue
        low = np.min([line.min(0) for line in lines], 0)
        side = float((np.max([line.max(0) for line in lines], 0) - low).max())
        return [((line - low) * SIDE / side).astype(np.float32) for line in lines]


def _laid(rng: Rng, library: Library, count: int) -> Strokes:
    """So many parts on each other, the hindmost first."""
    names = [name for name in _PARTS if name in library.sources]
    weight = np.array([_PARTS[name] for name in names])
    seen: Strokes = []
    for _ in range(count):
        part = library.pick(rng, str(rng.choice(names, p=weight / weight.sum())))
        if not part:
            continue
        side = SIDE * float(np.exp(rng.uniform(*np.log(_PART))))
        part = transform(part, random_matrix(rng, side), rng.uniform(0.3, 0.7, 2) * SIDE)
        part = wobble(
            rng,
            [resample(line, 3.0) for line in part],
            side * rng.uniform(0.0, 0.02),
            side * rng.uniform(0.5, 1.5),
        )
        cover = _covered(part)
        if cover.mean() * cover.size < _LEAST_HIDES * side**2:
            continue
        seen = [piece for line in seen for piece in outside(line, cover)] + part
    return seen


def _covered(part: Strokes) -> Array:
    """(SIDE * 2, SIDE * 2) bool, from -SIDE / 2: what the closed lines of a part hide."""
    cover = np.zeros((2 * SIDE, 2 * SIDE), np.uint8)
    for line in part:
        gap, length = np.hypot(*(line[0] - line[-1])), np.hypot(*np.diff(line, axis=0).T).sum()
        if gap < _CLOSED * length:
            cv2.fillPoly(cover, [np.round(line + SIDE / 2).astype(np.int32)], 1)
    return cover.astype(bool)


def outside(line: Array, cover: Array) -> Strokes:
    """What is seen of a line behind something."""
    column, row = np.clip(np.round(line + SIDE / 2).astype(int), 0, len(cover) - 1).T
    hidden = cover[row, column]
    if not hidden.any():
        return [line]
    if np.hypot(*(line[0] - line[-1])) < 2:  # a ring begins where it is hidden
        first = int(np.flatnonzero(hidden)[0])
        line, hidden = np.roll(line[:-1], -first, 0), np.roll(hidden[:-1], -first)
        line, hidden = np.concatenate([line, line[:1]]), np.append(hidden, hidden[0])
    cuts = np.flatnonzero(np.diff(hidden)) + 1
    runs = np.split(np.arange(len(line)), cuts)
    pieces = [line[max(run[0] - 1, 0) : run[-1] + 2] for run in runs if not hidden[run[0]]]
    return [p for p in pieces if np.hypot(*np.diff(p, axis=0).T).sum() > _SHORTEST]
