"""PlanarGraph -> Routing: which half-branches continue in which.

Every pair of half-branches at a junction gets a score (log-odds of being one line), by a network
or by geometry, and so does the one pair at each corner (`lifting`); the best involution of every
junction follows, with its ranked alternatives.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from ..errors import InvoluteError
from ..graph.topology import joined
from ..settings import Settings
from ..values import Array, Pair, PlanarGraph, Routing
from . import lifting
from .alternatives import ranked_alternatives
from .candidates import candidate_pairs

Fixed = Mapping[int, tuple[Pair, ...]]
Scorer = Callable[[PlanarGraph, Array, Fixed], Array]


def route(
    graph: PlanarGraph, settings: Settings, fixed: Fixed | None = None, *, rough: bool = False
) -> Routing:
    """Pair the half-branches of every junction and every corner.

    Args:
        fixed: number of a place -> the pairs that the user has decided; they are kept and locked,
            and the scorers may learn from them.
        rough: the lines are those of a rough drawing, see `rough.continuing`.

    Raises:
        InvoluteError: fixed pairs that are not disjoint pairs of half-branches of their junction.
    """
    fixed = {place: checked_pairs(graph, place, pairs) for place, pairs in (fixed or {}).items()}
    pairs = candidate_pairs(graph)
    turns = lifting.score(graph, fixed)
    crossing = len(pairs) - len(turns)
    score = np.concatenate([_at_junctions(graph, pairs[:crossing], fixed, settings, rough), turns])
    alternatives = ranked_alternatives(graph, score, fixed)

    best = [fixed.get(j, ways[0].pairs) for j, ways in enumerate(alternatives)]
    joined = [pair for ways in best[: len(graph.junctions)] for pair in ways]
    chosen = np.array(joined, np.int32).reshape(-1, 2)
    on = lifting.goes_on(turns, settings.corners)
    for place, ways in fixed.items():
        if place >= len(graph.junctions):
            on[place - len(graph.junctions)] = bool(ways)
    partner = np.arange(2 * graph.branch_count, dtype=np.int32)
    for a, b in (chosen.T, pairs[crossing:][on].T):
        partner[a], partner[b] = b, a

    locked = np.zeros(len(graph.places), bool)
    locked[list(fixed)] = True
    return Routing(partner, pairs, np.asarray(score, np.float32), alternatives, locked)


def with_corners(routing: Routing, graph: PlanarGraph) -> Routing:
    """A routing that knows no corners, as in files of before they were decided, with those of the
    graph: they are as its partners say, and not locked."""
    missing = len(graph.places) - len(routing.locked)
    if missing != len(graph.corners) or len(routing.alternatives) != len(routing.locked):
        return routing
    pairs = candidate_pairs(graph)[-missing:] if missing else routing.pairs[:0]
    score = np.full(missing, lifting.UNSEEN, np.float32)
    return Routing(
        routing.partner,
        np.concatenate([routing.pairs, pairs]),
        np.concatenate([routing.pair_score, score]),
        routing.alternatives + lifting.alternatives(pairs, score),
        np.concatenate([routing.locked, np.zeros(missing, bool)]),
    )


def _at_junctions(
    graph: PlanarGraph, pairs: Array, fixed: Fixed, settings: Settings, rough: bool
) -> Array:
    """(K,) scores of the pairs at junctions, which see their branches whole, corners and all."""
    if not len(pairs):
        return np.zeros(0, np.float32)
    whole, halves = joined(graph)
    number = np.full(2 * graph.branch_count, -1, np.int32)
    number[halves] = np.arange(len(halves))
    decided = {
        place: tuple(tuple(sorted(number[list(pair)].tolist())) for pair in ways)
        for place, ways in fixed.items()
        if place < len(graph.junctions)
    }
    return scorer_for(settings, rough)(whole, number[pairs], decided)


def scorer_for(settings: Settings, rough: bool = False) -> Scorer:
    """The scorer that the settings ask for; "auto" = the network when its weights are there."""
    from . import geometric

    def by_geometry(graph: PlanarGraph, pairs: Array, fixed: Fixed) -> Array:
        return geometric.score(graph, pairs)

    if settings.router == "geometric":
        return by_geometry
    if rough:
        return _by_bundles
    from . import network

    def by_network(graph: PlanarGraph, pairs: Array, fixed: Fixed) -> Array:
        shape = network.score(graph, pairs, fixed)
        other_ink = geometric.tint_score(graph, pairs) + geometric.medium_score(graph, pairs)
        return shape + other_ink

    if settings.router == "network" or network.available():
        return by_network
    return by_geometry


def _by_bundles(graph: PlanarGraph, pairs: Array, fixed: Fixed) -> Array:
    from ..rough import continuing
    from . import geometric

    return continuing.score(graph, pairs) + geometric.tint_score(graph, pairs)


def checked_pairs(graph: PlanarGraph, junction: int, pairs: tuple[Pair, ...]) -> tuple[Pair, ...]:
    """Pairs in their normal form (a < b, ascending).

    Raises:
        InvoluteError: not disjoint pairs of half-branches of that junction.
    """
    if not 0 <= junction < len(graph.places):
        raise InvoluteError(f"There is no junction {junction}; there are {len(graph.junctions)}.")
    here = {int(h) for h in graph.halves_of(graph.places[junction])}
    flat = [int(h) for pair in pairs for h in pair]
    if not set(flat) <= here or len(set(flat)) != len(flat) or any(len(p) != 2 for p in pairs):
        raise InvoluteError(
            f"Junction {junction} can only join its own half-branches "
            f"({', '.join(map(str, sorted(here)))}), each of them once."
        )
    return tuple(sorted((min(int(a), int(b)), max(int(a), int(b))) for a, b in pairs))
