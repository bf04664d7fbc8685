"""What the artist changes in a routed graph: a branch is cut, two loose ends are joined.

Old branches, half-branches, junctions and corners keep their numbers; a new corner is the last one,
locked, and a new branch the last one.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from ..values import Alternative, Array, Pair, PlanarGraph, Routing

NEAR = 1.0  # pen widths; so near a vertex, it is meant


Step = tuple[int, int]
"""What was done once: (point, -1) cuts a branch, (a, b) joins the ends of two half-branches."""


@dataclass(frozen=True, eq=False)
class Edits:
    """What made a graph from an earlier one; enough to make it again.

    graph: the earlier one. steps: in order.
    """

    graph: PlanarGraph
    steps: tuple[Step, ...]


def edited(
    graph: PlanarGraph, routing: Routing, steps: Iterable[Step]
) -> tuple[PlanarGraph, Routing, set[int]]:
    """Cut and join; also gives the branches that are not what they were.

    Raises:
        ValueError: a step does not fit the graph.
    """
    touched: set[int] = set()
    for step in steps:
        check_step(graph, step)
        graph, routing = do_step(graph, routing, step)
        touched |= {int(half) >> 1 for half in graph.halves_of(graph.corners[-1])}
    return graph, routing, touched


def do_step(graph: PlanarGraph, routing: Routing, step: Step) -> tuple[PlanarGraph, Routing]:
    """Cut or join once."""
    first, second = step
    if second < 0:
        return cut_branch(graph, routing, first)
    return join_ends(graph, routing, first, second)


def check_step(graph: PlanarGraph, step: Step) -> None:
    """Does a step fit a graph?

    Raises:
        ValueError: it does not.
    """
    first, second = step
    if second < 0:
        tips = np.concatenate([graph.offsets, graph.offsets - 1])
        if not 0 < first < len(graph.points) - 1 or first in tips:
            raise ValueError("cut")
        return
    there = min(first, second) >= 0 and max(first, second) < 2 * graph.branch_count
    if not there or first == second:
        raise ValueError("join")
    if (graph.degrees[graph.half_vertex[[first, second]]] != 1).any():
        raise ValueError("join")


class Place(NamedTuple):
    """A point of a graph; half: the half-branch at whose vertex it lies, or -1."""

    point: int
    half: int


def place_on(graph: PlanarGraph, halves: Array, point: Array) -> Place:
    """The place nearest to a point (2,), px, on some branches, given as half-branches of them."""
    branches = np.unique(halves >> 1)
    index = np.concatenate([np.arange(*graph.offsets[b : b + 2]) for b in branches])
    away = np.hypot(*(graph.points[index] - point).T)
    best = int(index[away.argmin()])
    branch = int(np.searchsorted(graph.offsets, best, "right")) - 1
    pen = 4.0 if graph.widths is None else float(np.median(graph.widths))
    tips = graph.ends[branch]
    near = np.hypot(*(graph.vertices[tips] - graph.points[best]).T)
    inner = graph.offsets[branch] < best < graph.offsets[branch + 1] - 1
    meant = (near <= NEAR * pen) & (graph.degrees[tips] >= 2) if inner else near == near.min()
    side = int(np.where(meant, near, np.inf).argmin())
    return Place(best, 2 * branch + side if meant.any() else -1)


def cut_branch(graph: PlanarGraph, routing: Routing, point: int) -> tuple[PlanarGraph, Routing]:
    """Cut a branch at one of its inner points: its second part is the last branch, and a stroke
    ends at the new corner on either side."""
    branch = int(np.searchsorted(graph.offsets, point, "right")) - 1
    stop, last = int(graph.offsets[branch + 1]), graph.branch_count
    order = np.concatenate(
        [np.arange(point + 1), np.arange(stop, len(graph.points)), np.arange(point, stop)]
    )
    ends = np.concatenate([graph.ends, [[len(graph.vertices), graph.ends[branch, 1]]]])
    ends[branch, 1] = len(graph.vertices)
    offsets = graph.offsets - np.where(np.arange(last + 1) > branch, stop - point - 1, 0)
    changed = replace(
        _ordered(graph, order),
        vertices=np.concatenate([graph.vertices, graph.points[point : point + 1]]),
        offsets=np.append(offsets, len(order)).astype(np.int32),
        ends=ends.astype(np.int32),
        clues=_unseen(graph),
    )
    # What was the far end of the branch is the far end of its second part.
    far, new = 2 * branch + 1, 2 * last + 1
    number = np.arange(2 * last, dtype=np.int32)
    number[far] = new
    partner = np.arange(2 * last + 2, dtype=np.int32)
    partner[number] = number[routing.partner]
    return changed, _with_corner(changed, routing, number, partner, (far, new - 1), ())


def join_ends(graph: PlanarGraph, routing: Routing, a: int, b: int) -> tuple[PlanarGraph, Routing]:
    """Make one corner of the loose ends of two half-branches, at that of b; a goes on to it."""
    ends, order = graph.ends.copy(), np.arange(len(graph.points))
    old = graph.half_vertex[[a, b]]
    branch = a >> 1
    tip = graph.offsets[branch + 1] - 1 if a & 1 else graph.offsets[branch]
    order = np.insert(order, tip + (a & 1), tip)
    offsets = graph.offsets + (np.arange(len(graph.offsets)) > branch)
    made = _ordered(graph, order)
    points = made.points.copy()
    points[tip + (a & 1)] = graph.vertices[old[1]]
    ends[[a >> 1, b >> 1], [a & 1, b & 1]] = len(graph.vertices)
    kept = np.ones(len(graph.vertices) + 1, bool)
    kept[old] = False
    changed = replace(
        made,
        points=points,
        vertices=np.concatenate([graph.vertices, graph.vertices[old[1:]]])[kept],
        offsets=offsets.astype(np.int32),
        ends=(np.cumsum(kept) - 1)[ends].astype(np.int32),
        clues=_unseen(graph),
    )
    number = np.arange(2 * graph.branch_count, dtype=np.int32)
    partner = routing.partner.copy()
    partner[a], partner[b] = b, a
    pair = (min(a, b), max(a, b))
    return changed, _with_corner(changed, routing, number, partner, pair, (pair,))


def _ordered(graph: PlanarGraph, order: Array) -> PlanarGraph:
    taken: dict[str, Any] = graph.measures(order)
    return replace(graph, points=graph.points[order], **taken)


def _unseen(graph: PlanarGraph) -> Array | None:
    """The clues with those of one corner more, of which there are none."""
    if graph.clues is None:
        return None
    return np.concatenate([graph.clues, np.full((1, graph.clues.shape[1]), np.nan, np.float32)])


def _with_corner(
    graph: PlanarGraph,
    routing: Routing,
    number: Array,
    partner: Array,
    pair: Pair,
    chosen: tuple[Pair, ...],
) -> Routing:
    """The routing with one corner more, decided and locked; half-branches have new numbers."""
    pairs = np.concatenate([np.sort(number[routing.pairs], axis=1), [pair]]).astype(np.int32)
    place = graph.place_at[graph.half_vertex]
    # Place by place, as `candidate_pairs` has them: new numbers are in another order.
    order = np.lexsort((pairs[:, 1], pairs[:, 0], place[pairs[:, 0]]))
    ways = list(routing.alternatives)
    moved = np.flatnonzero(number != np.arange(len(number)))
    for at in place[number[moved]].tolist():
        if at >= 0:
            ways[at] = tuple(_renumbered(way, number) for way in ways[at])
    other = () if chosen else (pair,)
    return Routing(
        partner=partner.astype(np.int32),
        pairs=pairs[order],
        pair_score=np.append(routing.pair_score, np.float32(0.0))[order],
        alternatives=(*ways, (Alternative(chosen, 0.5), Alternative(other, 0.5))),
        locked=np.append(routing.locked, True),
    )


def _renumbered(way: Alternative, number: Array) -> Alternative:
    pairs = sorted(tuple(sorted(number[list(pair)].tolist())) for pair in way.pairs)
    return Alternative(tuple(pairs), way.probability)
