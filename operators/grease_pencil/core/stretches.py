"""What stays whole when junctions are rerouted: stretches, the pieces of strokes between cuts.

An old stroke is cut where a junction no longer continues it, a new stroke where a junction joins
what was apart. Both leave the same stretches, so every new stroke is a chain of
stretches of old ones.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ....engine.arrays.ragged import arc

if TYPE_CHECKING:
    from ....engine import Drawing, Stroke
    from ....engine.values import PlanarGraph

Array = np.ndarray

_NEAR = 1.5  # px; a stroke that passes this near to a junction may be passing through it


@dataclass(frozen=True, eq=False)
class Stretch:
    """Part of a stroke.

    stroke: the stroke's place in its drawing.
    halves: its half-branches in walking order.
    start, end: lengths along the stroke in pixels; end > start, beyond the whole length where the
        stretch of a closed stroke passes the stroke's first point.
    """

    stroke: int
    halves: tuple[int, ...]
    start: float
    end: float


def changed_halves(old: Drawing, new: Drawing) -> Array:
    """(2B,) bool: the half-branches that continue differently in two routings of one graph."""
    return old.routing.partner != new.routing.partner


def strokes_through(drawing: Drawing, changed: Array) -> list[int]:
    """The strokes that have a changed half-branch."""
    if not drawing.strokes:
        return []
    halves = np.concatenate([s.branches for s in drawing.strokes])
    owner = np.repeat(np.arange(len(drawing.strokes)), [len(s.branches) for s in drawing.strokes])
    return np.unique(owner[changed[halves] | changed[halves ^ 1]]).tolist()


def stretches_of(drawing: Drawing, index: int, changed: Array) -> Iterator[Stretch]:
    """The stretches of one stroke, in walking order; those of a closed stroke begin at a cut."""
    stroke = drawing.strokes[index]
    halves = stroke.branches.tolist()
    count = len(halves)
    cuts = np.flatnonzero(changed[stroke.branches]).tolist()
    if stroke.closed:
        cuts = [*cuts, cuts[0] + count] if cuts else [0, count]
    else:
        cuts = sorted({0, count, *cuts})
    places = _lengths_at(drawing.graph, stroke, cuts)
    for first, last, start, end in zip(cuts, cuts[1:], places, places[1:], strict=False):
        part = (halves + halves)[first:last]
        yield Stretch(index, tuple(part), start, end)


def whole_length(stroke: Stroke) -> float:
    """The length of a stroke's polygon in pixels, with the closing side."""
    return float(corner_lengths(stroke)[-1])


def corners(stroke: Stroke) -> Array:
    """(N, 2) float64: the points of a stroke, and its first one again if it is closed."""
    points = stroke.points.astype(np.float64)
    return np.concatenate([points, points[:1]]) if stroke.closed else points


def corner_lengths(stroke: Stroke) -> Array:
    """(N,) px: how far along a stroke its `corners` lie."""
    return arc(corners(stroke))


def _lengths_at(graph: PlanarGraph, stroke: Stroke, cuts: list[int]) -> list[float]:
    """How far along the stroke its cuts lie: the cut k is where its half-branch k begins."""
    lengths = corner_lengths(stroke)
    whole, count = lengths[-1], len(stroke.branches)
    steps = np.array([_branch_length(graph, int(h) >> 1) for h in stroke.branches])
    expected = np.concatenate([[0.0], np.cumsum(steps)]) * (whole / max(steps.sum(), 1e-9))
    # A closed stroke need not begin at a junction: its own points say where they lie on it.
    origin = _place_of(graph, stroke, lengths, 0, 0.0) if stroke.closed else 0.0
    places = []
    for cut in cuts:
        turn, k = divmod(cut, count)
        place = 0.0
        if k:
            place = _place_of(graph, stroke, lengths, k, (origin + expected[k]) % whole) - origin
            place = (place + _NEAR) % whole - _NEAR if stroke.closed else place
        places.append(origin + place + turn * whole)
    return np.maximum.accumulate(places).tolist()


def _place_of(graph: PlanarGraph, stroke: Stroke, lengths: Array, k: int, expected: float) -> float:
    """How far along the stroke its half-branch k begins."""
    vertex = graph.vertices[graph.half_vertex[stroke.branches[k]]]
    return _nearest_length(stroke, lengths, vertex, expected)


def _nearest_length(stroke: Stroke, lengths: Array, vertex: Array, expected: float) -> float:
    """Where a stroke passes a junction; of several passes, the one nearest to `expected`."""
    points = corners(stroke)
    start, side = points[:-1], np.diff(points, axis=0)
    square = np.maximum((side**2).sum(1), 1e-12)
    share = np.clip(((vertex - start) * side).sum(1) / square, 0.0, 1.0)
    distance = np.linalg.norm(start + share[:, None] * side - vertex, axis=1)
    place = lengths[:-1] + share * np.diff(lengths)
    passes = np.flatnonzero(distance <= distance.min() + _NEAR)
    chosen = passes[np.argmin(np.abs(place[passes] - expected))]
    # Sides next to the chosen one may be nearer still: it is the same pass.
    same = np.flatnonzero(np.abs(place - place[chosen]) <= 4 * _NEAR)
    return float(place[same[np.argmin(distance[same])]])


def _branch_length(graph: PlanarGraph, branch: int) -> float:
    steps = np.diff(graph.branch(branch).astype(np.float64), axis=0)
    return float(np.linalg.norm(steps, axis=1).sum())
