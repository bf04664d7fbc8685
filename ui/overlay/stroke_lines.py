"""Every stroke in a colour of its own, with its ends marked: wrong joins are seen at a glance.

Pure NumPy. Strokes that meet have different colours wherever the palette is large enough.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ...engine import Drawing
    from ...operators.grease_pencil.core.map_fit import Shapes

Array = np.ndarray

_STEPS = 8  # straight lines that stand for one cubic of a Bezier stroke
_BY_HAND = (0.5, 0.5, 0.5)  # of strokes that were not traced


@dataclass(frozen=True, eq=False)
class StrokeLines:
    """points: (P, 3) in object space, colors: (P, 4), edges: (E, 2) int32 pairs of points.

    ends: (K, 3) first and last points of open strokes, end_colors: (K, 4).
    """

    points: Array
    colors: Array
    edges: Array
    ends: Array
    end_colors: Array


def color_numbers(drawing: Drawing, count: int) -> dict[int, int]:
    """A number below `count` for each stroke, by its first half-branch counted from 1.

    Strokes are numbered one after the other, each as no stroke is that it meets (while numbers
    last), and as few strokes as possible so far: the colours are used evenly.
    """
    graph = drawing.graph
    met: dict[int, set[int]] = {}  # numbers at each vertex
    used = np.zeros(count, int)
    numbers = {}
    for stroke in drawing.strokes:
        if not len(stroke.branches):
            continue
        vertices = set(graph.ends[stroke.branches >> 1].reshape(-1).tolist())
        taken = set().union(*(met.get(v, set()) for v in vertices))
        free = [n for n in range(count) if n not in taken] or list(range(count))
        number = min(free, key=lambda n: used[n])
        used[number] += 1
        numbers[int(stroke.branches[0]) + 1] = number
        for vertex in vertices:
            met.setdefault(vertex, set()).add(number)
    return numbers


def stroke_lines(
    cels: Sequence[Shapes],
    key: int,
    numbers: dict[int, int],
    palette: Sequence[tuple[float, float, float]],
) -> StrokeLines:
    """The strokes of a trace as lines to draw.

    Args:
        cels: what the layers show.
        key: of the trace; other strokes are grey.
        numbers: as `color_numbers` gives them.
        palette: as many colours as there are numbers.
    """
    made = [_lines_of(shapes, key, numbers, palette) for shapes in cels if len(shapes.points)]
    counts = np.cumsum([0, *(len(one.points) for one in made)])
    edges = [one.edges + shift for one, shift in zip(made, counts, strict=False)]
    blank = StrokeLines(*(np.zeros((0, width), np.float32) for width in (3, 4, 2, 3, 4)))
    every = [blank, *made]
    return StrokeLines(
        np.concatenate([one.points for one in every]).astype(np.float32),
        np.concatenate([one.colors for one in every]).astype(np.float32),
        np.concatenate([blank.edges, *edges]).astype(np.int32),
        np.concatenate([one.ends for one in every]).astype(np.float32),
        np.concatenate([one.end_colors for one in every]).astype(np.float32),
    )


def _lines_of(
    shapes: Shapes,
    key: int,
    numbers: dict[int, int],
    palette: Sequence[tuple[float, float, float]],
) -> StrokeLines:
    table = np.array([(*color, 1.0) for color in (*palette, _BY_HAND)], np.float32)
    mine = shapes.keys == key
    chosen = [
        numbers.get(half, -1) if own else -1
        for half, own in zip(shapes.halves.tolist(), mine.tolist(), strict=True)
    ]
    color = table[np.array(chosen, int)]  # -1 is the last one
    first, last = shapes.offsets[:-1], shapes.offsets[1:] - 1
    owner = np.repeat(np.arange(len(first)), last - first + 1)
    starts = np.flatnonzero(np.isin(np.arange(len(owner)), last, invert=True))
    ends = starts + 1
    closing = shapes.cyclic & (last > first)
    starts = np.concatenate([starts, last[closing]])
    ends = np.concatenate([ends, first[closing]])
    open_ends = np.concatenate([first[~shapes.cyclic], last[~shapes.cyclic]])
    places, edges = shapes.points, np.stack([starts, ends], axis=1)
    colors = color[owner]
    if shapes.handles is not None:
        places, edges = _sampled(shapes, starts, ends)
        colors = np.repeat(color[owner[starts]], _STEPS + 1, axis=0)
    return StrokeLines(places, colors, edges, shapes.points[open_ends], color[owner[open_ends]])


def _sampled(shapes: Shapes, starts: Array, ends: Array) -> tuple[Array, Array]:
    """Points along the cubics of all sides, and the edges between them."""
    left, right = shapes.handles[:, 0], shapes.handles[:, 1]
    a, d = shapes.points[starts], shapes.points[ends]
    curved = shapes.curved[np.searchsorted(shapes.offsets, starts, "right") - 1][:, None]
    b = np.where(curved, right[starts], a + (d - a) / 3)
    c = np.where(curved, left[ends], d - (d - a) / 3)
    t = np.linspace(0, 1, _STEPS + 1)[:, None]
    weights = ((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3)
    points = sum(w * p[:, None] for w, p in zip(weights, (a, b, c, d), strict=True))
    first = np.arange(len(starts))[:, None] * (_STEPS + 1) + np.arange(_STEPS)
    edges = np.stack([first, first + 1], axis=-1)
    return points.reshape(-1, 3), edges.reshape(-1, 2)
