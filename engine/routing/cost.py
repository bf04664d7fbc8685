"""What a wrong answer at a junction would cost: doubt times the length of stroke that changes.

A doubtful hair that crosses a long line costs nothing; a doubtful crossing of two long lines costs
both of them. So whoever decides the most costly junctions first mends most of a page.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..values import Array, Junction, PlanarGraph, Stroke


def costs(graph: PlanarGraph, strokes: Sequence[Stroke], junctions: Sequence[Junction]) -> Array:
    """(J,) px: doubt of each junction times the length of stroke that another answer moves."""
    beyond = lengths_beyond(graph, strokes)
    return np.array([_cost(junction, beyond) for junction in junctions], np.float64)


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


def _cost(junction: Junction, beyond: Array) -> float:
    """Against the likeliest other answer; the longest of the parts that change stays in place."""
    others = [way.pairs for way in junction.alternatives if way.pairs != junction.pairs]
    if junction.locked or not others:
        return 0.0
    now, then = (dict((*pairs, *(p[::-1] for p in pairs))) for pairs in (junction.pairs, others[0]))
    changed = [beyond[h] for h in junction.half_branches if now.get(h) != then.get(h)]
    return junction.doubt * (sum(changed) - max(changed, default=0.0))
