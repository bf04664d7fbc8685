"""PlanarGraph -> Routing: which half-branches continue in which.

Every pair of half-branches at a junction gets a score (log-odds of being one line), by a network
or by geometry, and so does the one pair at each corner (`lifting`); the best involution of every
junction follows, with its ranked alternatives.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from ..errors import InvoluteError
from ..graph.topology import joined, places_of_repeated, repeated, select
from ..involution import best_matching, pairs_of
from ..settings import Settings
from ..values import Array, Pair, PlanarGraph, Routing
from . import lifting
from .alternatives import ranked_alternatives
from .candidates import candidate_pairs
from .neighbourhood import Neighbourhood

Fixed = Mapping[int, tuple[Pair, ...]]
_HEARD = 1e-3  # log-odds; smaller changes are those of rounding
Scorer = Callable[[PlanarGraph, Array, Fixed], Array]


def route(
    graph: PlanarGraph,
    settings: Settings,
    fixed: Fixed | None = None,
    *,
    scorer: Scorer | None = None,
    known: Routing | None = None,
) -> Routing:
    """Pair the half-branches of every junction and every corner.

    Args:
        fixed: number of a place -> the pairs that the user has decided; they are kept and locked,
            and the scorers may learn from them.
        scorer: of the pairs at junctions; None = the one that the settings ask for.
        known: an earlier routing of the graph; its scores stay where second lines begin and end.

    Raises:
        InvoluteError: fixed pairs that are not disjoint pairs of half-branches of their junction.
    """
    fixed = {place: checked_pairs(graph, place, pairs) for place, pairs in (fixed or {}).items()}
    pairs = candidate_pairs(graph)
    turns = lifting.score(graph, fixed)
    crossing = len(pairs) - len(turns)
    score = np.concatenate(
        [
            _around_second(graph, pairs[:crossing], fixed, scorer or scorer_for(settings), known),
            turns,
        ]
    )
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


def rescored(
    graph: PlanarGraph, routing: Routing, pair_score: Array, keep: Fixed, only: Array | None = None
) -> Routing:
    """A routing with other log-odds, the ranks and probabilities of all ways to route that follow.

    Args:
        pair_score: (K,) in the order of its pairs.
        keep: as in `ranked_alternatives`.
        only: numbers of the places whose log-odds are others; None = all.
    """
    ways = ranked_alternatives(graph, pair_score, keep, only)
    if only is not None:
        changed = set(only.tolist())
        known = zip(ways, routing.alternatives, strict=True)
        ways = tuple(new if k in changed else old for k, (new, old) in enumerate(known))
    return replace(routing, pair_score=np.asarray(pair_score, np.float32), alternatives=ways)


def taught(
    graph: PlanarGraph, routing: Routing, before: Fixed, after: Fixed, settings: Settings
) -> tuple[Array, Array]:
    """What decisions teach about the junctions around them.

    The scorer looks at the neighbourhood twice, with the decisions of before and of after: the
    difference counts, so that it does not matter that it sees no more of the page.

    Args:
        graph: in working pixels.
        before, after: what is decided; they differ at a few junctions.

    Returns:
        (K,) float32 log-odds of all pairs, and the numbers of the junctions where they changed.
    """
    differ = {j for j in {*before, *after} if before.get(j) != after.get(j)}
    centers = np.array([j for j in sorted(differ) if j < len(graph.junctions)], np.int64)
    part = Neighbourhood.of(graph, graph.junctions[centers], repeated(graph))
    heard = np.isin(graph.places, part.near) & ~places_of_repeated(graph)
    rows = np.flatnonzero(heard[place_of_pairs(graph, routing.pairs)])
    if not len(rows):
        return routing.pair_score, np.zeros(0, np.int64)
    pairs = part.number[routing.pairs[rows]]
    old, new = (
        _at_junctions(part.graph, pairs, part.fixed(graph, fixed), scorer_for(settings))
        for fixed in (before, after)
    )
    score = routing.pair_score.copy()
    score[rows] += new - old
    moved = rows[np.abs(new - old) > _HEARD]
    return score, np.unique(place_of_pairs(graph, routing.pairs[moved]))


def place_of_pairs(graph: PlanarGraph, pairs: Array) -> Array:
    """(K,) int: the number of the place at which the half-branches of each pair meet."""
    return graph.place_at[graph.half_vertex[pairs[:, 0]]]


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


def _around_second(
    graph: PlanarGraph, pairs: Array, fixed: Fixed, scorer: Scorer, known: Routing | None
) -> Array:
    """(K,) scores of the pairs at junctions. Scorers never see second lines (`second_lines`): where
    these begin and end, scores are those that are known."""
    if known is None or not (again := repeated(graph)).any():
        return _at_junctions(graph, pairs, fixed, scorer)
    shared = places_of_repeated(graph)
    asked = ~shared[place_of_pairs(graph, pairs)]
    number = np.repeat(2 * (np.cumsum(~again) - 1), 2) + np.tile([0, 1], graph.branch_count)
    decided = {
        place: tuple((int(number[a]), int(number[b])) for a, b in ways)
        for place, ways in fixed.items()
        if not shared[place]
    }
    score = known.pair_score[: len(pairs)].copy()
    part = select(graph, ~again)
    score[asked] = _at_junctions(part, number[pairs[asked]].astype(np.int32), decided, scorer)
    return score


def _at_junctions(graph: PlanarGraph, pairs: Array, fixed: Fixed, scorer: Scorer) -> Array:
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
    return scorer(whole, number[pairs], decided)


def scorer_for(settings: Settings) -> Scorer:
    """The scorer that the settings ask for; "auto" = the network when its weights are there."""
    from . import geometric

    def by_geometry(graph: PlanarGraph, pairs: Array, fixed: Fixed) -> Array:
        return geometric.score(graph, pairs)

    if settings.router == "geometric":
        return by_geometry
    from . import network

    def by_network(graph: PlanarGraph, pairs: Array, fixed: Fixed) -> Array:
        shape = network.score(graph, pairs, fixed)
        other_ink = geometric.tint_score(graph, pairs) + geometric.medium_score(graph, pairs)
        return shape + other_ink

    if settings.router == "network" or network.available():
        return by_network
    return by_geometry


def around(halves: Array, routing: Routing, pairs: set[Pair]) -> tuple[Pair, ...]:
    """The best way to route a junction in which some pairs are joined in any case.

    Args:
        halves: (d,) the half-branches there. pairs: each a < b.

    Raises:
        InvoluteError: a half-branch is in two of the pairs.
    """
    taken = [half for pair in pairs for half in pair]
    if len(set(taken)) != len(taken):
        raise InvoluteError("A line can go on in one other only.")
    free = np.setdiff1d(halves, taken)
    score = np.zeros((len(free), len(free)))
    here = np.isin(routing.pairs, free).all(1)
    a, b = np.searchsorted(free, routing.pairs[here]).T
    score[a, b] = score[b, a] = routing.pair_score[here]
    return tuple(sorted([*pairs, *pairs_of(best_matching(score), free)]))


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
