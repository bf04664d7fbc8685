"""A traced part of a page as triangles and lines, cut off at its borders. Pure NumPy.

Every stroke in a colour of its own: as wide as its ink, and a line where its middle runs.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...engine.formats.flatten import outline, widths_along
from .stroke_lines import color_numbers

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ...engine import Drawing, Stroke

Array = np.ndarray


@dataclass(frozen=True, eq=False)
class PartShapes:
    """Places in px of the page, colours RGB.

    wide: (S, 4, 2) the four corners of each piece of a stroke, around; middle: (S, 2, 2) its line.
    colors: (S, 3) of the pieces.
    ends: (K, 2) of open strokes; end_colors: (K, 3).
    """

    wide: Array
    middle: Array
    colors: Array
    ends: Array
    end_colors: Array


def part_shapes(
    drawing: Drawing,
    corner: tuple[int, int],
    box: tuple[int, int, int, int],
    palette: Sequence[tuple[float, float, float]],
) -> PartShapes:
    """What is inside of a part.

    Args:
        drawing: in pixels of a picture whose top left corner is the page's pixel `corner`.
        box: left, top, right, bottom of the part, px of the page.
    """
    table = np.array(palette, np.float32).reshape(-1, 3)
    numbers = color_numbers(drawing, len(table))
    low, high = np.array(box[:2], float), np.array(box[2:], float)
    pieces, sides, owners = [np.zeros((0, 2, 2))], [np.zeros((0, 2, 2))], [np.zeros(0, int)]
    ends, end_owners = [np.zeros((0, 2))], [np.zeros(0, int)]
    for number, stroke in enumerate(drawing.strokes):
        line = outline(stroke).astype(np.float64) + corner
        piece, side = clipped(line, _sides(line, widths_along(stroke)), low, high)
        pieces.append(piece)
        sides.append(side)
        owners.append(np.full(len(piece), number))
        if not stroke.closed:
            tips = line[[0, -1]]
            tips = tips[((tips >= low) & (tips <= high)).all(1)]
            ends.append(tips)
            end_owners.append(np.full(len(tips), number))
    color = np.array([_number(stroke, k, numbers) for k, stroke in enumerate(drawing.strokes)], int)
    color = table[color % max(len(table), 1)].reshape(-1, 3)
    middle, side, owner = (np.concatenate(every) for every in (pieces, sides, owners))
    wide = np.concatenate([middle + side, (middle - side)[:, ::-1]], axis=1)
    return PartShapes(
        wide, middle, color[owner], np.concatenate(ends), color[np.concatenate(end_owners)]
    )


def clipped(line: Array, sides: Array, low: Array, high: Array) -> tuple[Array, Array]:
    """The pieces of a line inside a box, each where it enters and leaves (Liang and Barsky, 1984).

    Args:
        line: (N, 2); sides: (N, 2) what runs along with it.
        low, high: (2,) corners of the box.

    Returns:
        (S, 2, 2) first and last place of each piece; the same of the sides.
    """
    a, step = line[:-1], np.diff(line, axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        first, second = (low - a) / step, (high - a) / step
    within = (a >= low) & (a <= high)
    still = step == 0
    enter = np.where(still, np.where(within, 0.0, np.inf), np.minimum(first, second))
    leave = np.where(still, np.where(within, 1.0, -np.inf), np.maximum(first, second))
    start, stop = np.maximum(enter.max(1), 0.0), np.minimum(leave.min(1), 1.0)
    seen = np.flatnonzero(start < stop)
    at = np.stack([start[seen], stop[seen]], axis=1)[:, :, None]
    pieces = a[seen, None] + at * step[seen, None]
    return pieces, sides[seen, None] + at * (sides[seen + 1] - sides[seen])[:, None]


def cut_off(ring: Array, box: tuple[int, int, int, int]) -> Array:
    """The part (M, 2) of an area inside a box, one side of it after the other (Sutherland and
    Hodgman, 1974); where the area falls apart, its parts hang together along the border.

    Args:
        ring: (N, 2) its outline.
    """
    ring = np.asarray(ring, np.float64)
    for axis, limit, sign in ((0, box[0], 1), (1, box[1], 1), (0, box[2], -1), (1, box[3], -1)):
        beyond = sign * (ring[:, axis] - limit)  # below zero = outside
        after, there = np.roll(ring, -1, axis=0), np.roll(beyond, -1)
        crosses = (beyond >= 0) != (there >= 0)
        share = beyond / np.where(crosses, beyond - there, 1.0)
        both = np.stack([ring, ring + share[:, None] * (after - ring)], axis=1)
        ring = both[np.stack([beyond >= 0, crosses], axis=1)]
    return ring


def _sides(line: Array, widths: Array) -> Array:
    """(N, 2) from each place of a line to the left border of its ink."""
    if len(line) < 2:
        return np.zeros_like(line)
    step = np.gradient(line, axis=0)
    length = np.maximum(np.linalg.norm(step, axis=1, keepdims=True), 1e-9)
    return step[:, ::-1] / length * (-1, 1) * widths[:, None] / 2


def _number(stroke: Stroke, k: int, numbers: dict[int, int]) -> int:
    return numbers.get(int(stroke.branches[0]) + 1, k) if len(stroke.branches) else k
