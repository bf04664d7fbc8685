"""What the artist has decided on one drawing, done again on another one of the same page.

The same lines, traced with other settings, have other numbers: places are found by where they lie,
lines by the direction in which they leave.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .errors import InvoluteError
from .rough.asking import carried_answers
from .values import Array, Bundle, Junction, Pair, PlanarGraph

if TYPE_CHECKING:
    from .drawing import Drawing

_NEAR = 2.5  # pen widths; a junction that is traced again lies that near to where it was
_TURNED = np.radians(40.0)  # a line that leaves in another direction is another one
_SAME_SPAN = 1.0  # px; the pencil strokes are the same, and so is what is asked of them
_REACH = 5.0  # pen widths over which the direction of a line is measured


class Carried(NamedTuple):
    """A drawing with the decisions of another, and how many of these found no place on it."""

    drawing: Drawing
    lost: int


def carried(old: Drawing, new: Drawing) -> Carried:
    """The new drawing with every decision of the old one that it has a place for."""
    lost = 0
    if old.pencil and len(old.pencil.answers.one):
        lost = len(old.pencil.answers.one)
        if new.pencil:
            scales = old.scale, new.scale
            answers, lost = carried_answers(old.pencil, new.pencil, scales, new.size)
            new = new.answered(answers) if len(answers.one) else new
    made = decided_again(old, new)
    return Carried(made.drawing, made.lost + lost)


def decided_again(old: Drawing, new: Drawing) -> Carried:
    """The same for junctions and corners alone, what was cut and what was joined."""
    if _same_lines(old, new):
        steps = old.edits.steps if old.edits else ()
        again = new.with_edits(steps).with_scores(old.routing.pair_score)
        return Carried(again.with_routing(old.routing.partner, old.routing.locked), 0)
    lost, pen = 0, _pen(old.graph)
    for point, other in _edited(old):
        made = _edited_at(new, point, other, _NEAR * pen)
        new, lost = (made, lost) if made is not None else (new, lost + 1)
    own = {place.index for place in _by_hand(old)}
    for number in np.flatnonzero(old.routing.locked).tolist():
        if number in own:
            continue
        decision = old.place(number)
        found = _same_place(old, decision, new, _NEAR * pen)
        if found is None:
            lost += 1
            continue
        place, halves = found
        pairs = [_ordered(halves[a], halves[b]) for a, b in decision.pairs]
        new = new.reroute(place, pairs)
    return Carried(new, lost)


def number_in(new: Drawing, old: Drawing, number: int) -> int:
    """The number that a junction, corner or bundle has after an answer about bundles; -1 = none."""
    if new.pencil is old.pencil:
        return number
    asked = old.asked(number)
    if isinstance(asked, Bundle):
        same = [b for b in new.bundles if b.strokes == asked.strokes]
        apart = [abs(b.span[0] - asked.span[0]) + abs(b.span[1] - asked.span[1]) for b in same]
        best = int(np.argmin(apart)) if same else -1
        return same[best].index if same and apart[best] < _SAME_SPAN else -1
    found = _same_place(old, asked, new, _NEAR * _pen(old.graph))
    return -1 if found is None else found[0]


def _same_lines(old: Drawing, new: Drawing) -> bool:
    """Is it the same graph before the artist came, as when only the strokes are made anew?"""
    graph = old.edits.graph if old.edits else old.graph
    return (
        graph.points.shape == new.graph.points.shape
        and np.array_equal(graph.points, new.graph.points)
        and np.array_equal(graph.ends, new.graph.ends)
        and (old.edits is not None or len(old.routing.pairs) == len(new.routing.pairs))
    )


def _by_hand(drawing: Drawing) -> list[Junction]:
    """The corners that the artist made."""
    count = len(drawing.edits.steps) if drawing.edits else 0
    return list(drawing.corners[len(drawing.corners) - count :]) if count else []


def _edited(drawing: Drawing) -> Iterator[tuple[Array, Array | None]]:
    """Where strokes were cut: (place, None); which ends were joined: (place, other place)."""
    graph = drawing.graph
    for corner in _by_hand(drawing):
        place = np.array(corner.position)
        if not corner.pairs:
            yield place, None
            continue
        # One of the two lines was lengthened to where the other one began.
        firsts = [graph.half_branch(half)[:2].astype(float) for half in corner.half_branches]
        longer = max(firsts, key=lambda two: float(np.hypot(*(two[-1] - two[0]))))
        yield longer[-1], place


def _edited_at(drawing: Drawing, place: Array, other: Array | None, near: float) -> Drawing | None:
    """The same cut or join there; None where it can't be."""
    try:
        if other is None:
            away = [_distance(stroke.points, place) for stroke in drawing.strokes]
            if not away or min(away) > near:
                return None
            return drawing.cut(int(np.argmin(away)), (float(place[0]), float(place[1])))
        ends = [_loose_end(drawing.graph, at, near) for at in (place, other)]
        if None in ends:
            return None
        return drawing.join(*(end for end in ends if end is not None))
    except InvoluteError:  # it ends there anyway, or goes on by now
        return None


def _loose_end(graph: PlanarGraph, place: Array, near: float) -> int | None:
    vertex = graph.half_vertex
    away = np.hypot(*(graph.vertices[vertex] - place).T)
    away = np.where(graph.degrees[vertex] == 1, away, np.inf)
    if not len(away) or away.min() > near:
        return None
    return int(away.argmin())


def _same_place(
    old: Drawing, decision: Junction, new: Drawing, near: float
) -> tuple[int, dict[int, int]] | None:
    """The place of the new drawing, and which of its half-branches stands for each of the old."""
    graph = new.graph
    places = graph.vertices[graph.places]
    away = np.hypot(*(places - np.array(decision.position)).T)
    mine = _directions(old.graph, decision.half_branches)
    for number in np.argsort(away, kind="stable").tolist():
        if away[number] > near:
            return None
        halves = graph.halves_of(graph.places[number]).tolist()
        if len(halves) != decision.degree:
            continue
        theirs = _directions(graph, halves)
        turned = np.abs(np.angle(np.exp(1j * (mine[:, None] - theirs))))
        order = turned.argmin(1)
        if len(set(order.tolist())) == len(halves) and turned.min(1).max() <= _TURNED:
            pairs = zip(decision.half_branches, order.tolist(), strict=True)
            return number, {half: halves[k] for half, k in pairs}
    return None


def _directions(graph: PlanarGraph, halves: Sequence[int]) -> Array:
    """(d,) the angles at which half-branches leave."""
    reach = _REACH * _pen(graph)
    found = []
    for half in halves:
        line = graph.half_branch(half).astype(np.float64)
        along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
        at = min(reach, 0.7 * along[-1])
        out = [np.interp(at, along, line[:, k]) - line[0, k] for k in (0, 1)]
        found.append(np.arctan2(out[1], out[0]))
    return np.array(found)


def _distance(points: Array, place: Array) -> float:
    start, side = points[:-1].astype(float), np.diff(points.astype(float), axis=0)
    if not len(side):
        return float(np.hypot(*(points[0] - place)))
    share = ((place - start) * side).sum(1) / np.maximum((side**2).sum(1), 1e-12)
    foot = start + np.clip(share, 0, 1)[:, None] * side
    return float(np.hypot(*(foot - place).T).min())


def _pen(graph: PlanarGraph) -> float:
    return 4.0 if graph.widths is None or not len(graph.widths) else float(np.median(graph.widths))


def _ordered(a: int, b: int) -> Pair:
    return (a, b) if a < b else (b, a)
