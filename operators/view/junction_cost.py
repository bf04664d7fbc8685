"""What a wrong answer at a junction would cost: doubt times the length of stroke that changes.

Pure NumPy. A doubtful hair that crosses a long line costs nothing; a doubtful crossing of two long
lines costs both of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ...engine import Drawing, Junction

Array = np.ndarray


def costs(drawing: Drawing) -> Array:
    """(J,) px: doubt of each junction times the length of stroke that another answer moves."""
    beyond = lengths_beyond(drawing)
    return np.array([_cost(junction, beyond) for junction in drawing.junctions], np.float64)


def lengths_beyond(drawing: Drawing) -> Array:
    """(2B,) px: the length of stroke from where each half-branch starts, outward to its end."""
    graph = drawing.graph
    points = graph.points.astype(np.float64)
    steps = np.concatenate([[0.0], np.linalg.norm(np.diff(points, axis=0), axis=1)])
    along = np.cumsum(steps)
    lengths = along[graph.offsets[1:] - 1] - along[graph.offsets[:-1]]
    found = np.repeat(lengths, 2)
    strokes = [stroke.branches for stroke in drawing.strokes if len(stroke.branches)]
    if not strokes:
        return found
    halves = np.concatenate(strokes).astype(np.int64)
    sizes = np.array([len(branches) for branches in strokes])
    starts = np.repeat(np.cumsum(sizes) - sizes, sizes)
    total = np.cumsum(lengths[halves >> 1])
    before = total - lengths[halves >> 1]  # where each half-branch begins on all strokes in a row
    first = before[starts]
    whole = np.repeat(np.add.reduceat(lengths[halves >> 1], np.cumsum(sizes) - sizes), sizes)
    found[halves] = whole - (before - first)
    found[halves ^ 1] = before - first + lengths[halves >> 1]
    return found


def _cost(junction: Junction, beyond: Array) -> float:
    """Against the likeliest other answer; the longest of the parts that change stays in place."""
    others = [way.pairs for way in junction.alternatives if way.pairs != junction.pairs]
    if junction.locked or not others:
        return 0.0
    now, then = (dict((*pairs, *(p[::-1] for p in pairs))) for pairs in (junction.pairs, others[0]))
    changed = [beyond[h] for h in junction.half_branches if now.get(h) != then.get(h)]
    return junction.doubt * (sum(changed) - max(changed, default=0.0))
