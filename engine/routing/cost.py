"""What a wrong answer at a junction would cost: doubt times the length of stroke that changes.

A doubtful hair that crosses a long line costs nothing; a doubtful crossing of two long lines costs
both of them. So whoever decides the most costly junctions first mends most of a page.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..values import Array, PlanarGraph, Routing, Stroke
from .ways import Ways


def costs(graph: PlanarGraph, routing: Routing, strokes: Sequence[Stroke]) -> Array:
    """(J,) px: doubt of each junction times the length of stroke that the likeliest other answer
    moves; the longest of the parts that change stays in place."""
    return Ways.of(graph, routing).costs(routing, lengths_beyond(graph, strokes))


def lengths_beyond(graph: PlanarGraph, strokes: Sequence[Stroke]) -> Array:
    """(2B,) px: the length of stroke from where each half-branch starts, outward to its end."""
    points = graph.points.astype(np.float64)
    steps = np.concatenate([[0.0], np.linalg.norm(np.diff(points, axis=0), axis=1)])
    along = np.cumsum(steps)
    lengths = along[graph.offsets[1:] - 1] - along[graph.offsets[:-1]]
    found = np.repeat(lengths, 2)
    walked = [stroke.branches for stroke in strokes if len(stroke.branches)]
    if not walked:
        return found
    halves = np.concatenate(walked).astype(np.int64)
    sizes = np.array([len(branches) for branches in walked])
    starts = np.repeat(np.cumsum(sizes) - sizes, sizes)
    total = np.cumsum(lengths[halves >> 1])
    before = total - lengths[halves >> 1]  # where each half-branch begins on all strokes in a row
    first = before[starts]
    whole = np.repeat(np.add.reduceat(lengths[halves >> 1], np.cumsum(sizes) - sizes), sizes)
    found[halves] = whole - (before - first)
    found[halves ^ 1] = before - first + lengths[halves >> 1]
    return found
