"""PlanarGraph -> Routing: which half-branches continue in which.

Every pair of half-branches at a junction gets a score (log-odds of being one line), by a network
or by geometry; the best involution of every junction follows, with its ranked alternatives.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from ..errors import InvoluteError
from ..settings import Settings
from ..values import Pair, PlanarGraph, Routing
from .alternatives import ranked_alternatives
from .candidates import candidate_pairs

Fixed = Mapping[int, tuple[Pair, ...]]
Scorer = Callable[[PlanarGraph, np.ndarray, Fixed], np.ndarray]


def route(graph: PlanarGraph, settings: Settings, fixed: Fixed | None = None) -> Routing:
    """Pair the half-branches of every junction.

    Args:
        fixed: junction number -> the pairs that the user has decided; they are kept and locked,
            and the scorer may learn from them.

    Raises:
        InvoluteError: fixed pairs that are not disjoint pairs of half-branches of their junction.
    """
    fixed = {
        junction: checked_pairs(graph, junction, pairs) for junction, pairs in (fixed or {}).items()
    }
    pairs = candidate_pairs(graph)
    score = scorer_for(settings)(graph, pairs, fixed) if len(pairs) else np.zeros(0, np.float32)
    alternatives = ranked_alternatives(graph, score, fixed)

    partner = np.arange(2 * graph.branch_count, dtype=np.int32)
    chosen = [fixed.get(j, ways[0].pairs) for j, ways in enumerate(alternatives)]
    joined = np.array([pair for ways in chosen for pair in ways], np.int32).reshape(-1, 2)
    partner[joined[:, 0]], partner[joined[:, 1]] = joined[:, 1], joined[:, 0]
    # A line that passes no junction and closes on itself: its two halves continue each other.
    loop = np.flatnonzero(graph.degrees[graph.half_vertex] == 2)
    partner[loop] = loop ^ 1

    locked = np.zeros(len(graph.junctions), bool)
    locked[list(fixed)] = True
    return Routing(partner, pairs, np.asarray(score, np.float32), alternatives, locked)


def scorer_for(settings: Settings) -> Scorer:
    """The scorer that the settings ask for; "auto" = the network when its weights are there."""
    from . import geometric

    def by_geometry(graph: PlanarGraph, pairs: np.ndarray, fixed: Fixed) -> np.ndarray:
        return geometric.score(graph, pairs)

    if settings.router == "geometric":
        return by_geometry
    from . import network

    def by_network(graph: PlanarGraph, pairs: np.ndarray, fixed: Fixed) -> np.ndarray:
        shape = network.score(graph, pairs, fixed)
        return shape + geometric.tint_score(graph, pairs)

    if settings.router == "network" or network.available():
        return by_network
    return by_geometry


def checked_pairs(graph: PlanarGraph, junction: int, pairs: tuple[Pair, ...]) -> tuple[Pair, ...]:
    """Pairs in their normal form (a < b, ascending).

    Raises:
        InvoluteError: not disjoint pairs of half-branches of that junction.
    """
    if not 0 <= junction < len(graph.junctions):
        raise InvoluteError(f"There is no junction {junction}; there are {len(graph.junctions)}.")
    here = {int(h) for h in graph.halves_of(graph.junctions[junction])}
    flat = [int(h) for pair in pairs for h in pair]
    if not set(flat) <= here or len(set(flat)) != len(flat) or any(len(p) != 2 for p in pairs):
        raise InvoluteError(
            f"Junction {junction} can only join its own half-branches "
            f"({', '.join(map(str, sorted(here)))}), each of them once."
        )
    return tuple(sorted((min(int(a), int(b)), max(int(a), int(b))) for a, b in pairs))
