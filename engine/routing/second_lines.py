"""Two strokes on one ridge: which run of a stroke carries a second one.

Lines that touch, run together or coincide are one branch of the graph, on which one stroke runs
through. A small network says of every run between two ends on a stroke (`double_runs`) how probable
it is that both lines go on in it, and whether they change sides there (`run_features`). What
carries two gets one more branch, a copy of the run from end to end: graph and involution are as
ever. Both ends of a copy are joined at once, so that it is always inside a longer stroke.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from .. import weights
from ..perceptron import forward, load
from ..settings import Settings
from ..values import Array, PlanarGraph, Routing
from .alternatives import ranked_alternatives
from .candidates import candidate_pairs
from .double_runs import Runs, find_runs
from .run_features import exchanged, features

WEIGHTS = weights.FOLDER / "second_lines.npz"
SURE = 0.6  # probability of two strokes from which on a run carries them; see the model card
_WILD = 5.0  # spreads; a number farther from its mean is no farther
_LEAST = 0.1  # log-odds of joining what is joined, at least
_NEVER = np.float32(-20.0)  # log-odds of joining what can't be one line


def probabilities(rows: Array, net: Mapping[str, Array] | None = None) -> Array:
    """(K, 3) that a run carries one stroke, two that go on as they were routed, two that change
    over; net: other weights.

    The network itself says whether lines leave to the sides that they came from, or cross.
    """
    net = net or load(WEIGHTS)
    scaled = np.clip((rows - net["mean"]) / net["spread"], -_WILD, _WILD)
    odds = forward(scaled, net)
    odds = np.exp(odds - odds.max(1, keepdims=True))
    odds /= odds.sum(1, keepdims=True)
    return np.column_stack([odds[:, 0], *exchanged(rows[:, -1], odds[:, 1], odds[:, 2])])


def with_second_lines(
    graph: PlanarGraph, routing: Routing, settings: Settings
) -> tuple[PlanarGraph, Routing]:
    """The graph with a second branch along every run that most probably carries two strokes, and
    its routing; numbers of all else stay.

    Without weights, without a measured graph, or with the geometric router, both stay.

    Raises:
        InvoluteError: the weights are damaged.
    """
    measured = graph.widths is not None and graph.strength is not None
    if not measured or settings.router == "geometric" or not WEIGHTS.exists():
        return graph, routing
    load(WEIGHTS)  # before anything is found: damaged ones are told on every page
    runs = find_runs(graph, routing.partner)
    if not len(runs):
        return graph, routing
    chance = probabilities(features(graph, routing, runs))
    chosen = _chosen(graph, runs, chance)
    while len(chosen):
        longer = _longer(graph, runs, chosen)
        routed = _routed(longer, routing, runs, chosen, chance[chosen])
        own = 2 * graph.branch_count + np.arange(2 * len(chosen))
        carried = (routed.partner[own] != own).reshape(-1, 2).all(1)
        if carried.all():
            return longer, routed
        chosen = chosen[carried]  # both ends are joined, or there is no second line
    return graph, routing


def _chosen(graph: PlanarGraph, runs: Runs, chance: Array) -> Array:
    """The runs that carry two, the most probable first; no end and no branch is taken twice, and
    where the lines of a run change over, no other one begins, ends or passes."""
    ends: set[int] = set()
    branches: set[int] = set()
    passed: set[int] = set()
    changed: set[int] = set()
    vertex, sure, crosses = graph.half_vertex, 1 - chance[:, 0], chance[:, 2] > chance[:, 1]
    chosen = []
    for run in np.argsort(-sure, kind="stable").tolist():
        if sure[run] < SURE:
            break
        path = runs.path[run]
        own = {int(runs.first[run, 1]), int(runs.last[run, 1])}
        along = {half >> 1 for half in path}
        places = {int(vertex[half]) for half in (*path, path[-1] ^ 1)}
        change = {int(vertex[path[-1] ^ 1])} if crosses[run] else set()
        if own & ends or along & branches or places & changed or change & passed:
            continue
        ends |= own
        branches |= along
        passed |= places
        changed |= change
        chosen.append(run)
    return np.array(chosen, int)


def _longer(graph: PlanarGraph, runs: Runs, chosen: Array) -> PlanarGraph:
    """The graph with a copy of each chosen run as its last branches, as wide as the line that goes
    on in it where the run is wider."""
    assert graph.widths is not None, "only measured graphs have second lines"
    index, widths = [np.arange(len(graph.points))], [graph.widths]
    for run in chosen.tolist():
        parts: list[Array] = []
        for half in runs.path[run]:
            points = np.arange(*graph.offsets[half >> 1 : (half >> 1) + 2])
            parts.append((points[::-1] if half & 1 else points)[bool(parts) :])
        index.append(np.concatenate(parts))
        begin, end = (
            np.median(graph.widths[slice(*graph.offsets[h >> 1 : (h >> 1) + 2])])
            for h in (runs.first[run, 1], runs.last[run, 1])
        )
        own = np.linspace(begin, end, len(index[-1]))
        widths.append(np.minimum(own, graph.widths[index[-1]]).astype(np.float32))
    offsets = np.cumsum([len(part) for part in index])
    tips = [[runs.path[run][0], runs.path[run][-1] ^ 1] for run in chosen.tolist()]
    every = np.concatenate(index)
    measured: dict[str, Any] = graph.measures(every) | {"widths": np.concatenate(widths)}
    return replace(
        graph,
        points=graph.points[every],
        offsets=np.concatenate([graph.offsets, offsets[1:]]).astype(np.int32),
        ends=np.concatenate([graph.ends, graph.half_vertex[np.array(tips)]]).astype(np.int32),
        **measured,
    )


def _routed(
    longer: PlanarGraph, routing: Routing, runs: Runs, chosen: Array, chance: Array
) -> Routing:
    """The routing of the graph with second lines: their pairs have the log-odds of the two strokes,
    and where a run ends, those of crossing as well."""
    pairs = candidate_pairs(longer)
    size = 2 * longer.branch_count
    key = pairs[:, 0].astype(np.int64) * size + pairs[:, 1]
    order = np.argsort(key)

    def row(a: Array, b: Array) -> Array:
        wanted = np.minimum(a, b).astype(np.int64) * size + np.maximum(a, b)
        return order[np.searchsorted(key[order], wanted)]

    score = np.full(len(pairs), _NEVER, np.float32)
    score[row(*routing.pairs.T)] = routing.pair_score
    two = np.log(np.maximum(1 - chance[:, 0], 1e-6) / np.maximum(chance[:, 0], 1e-6))
    two = np.maximum(two, _LEAST)
    cross = np.log(np.maximum(chance[:, 2], 1e-6) / np.maximum(chance[:, 1], 1e-6)) / 2
    new = size - 2 * len(chosen) + 2 * np.arange(len(chosen))
    (_, end, _), (run, other, onward) = runs.first[chosen].T, runs.last[chosen].T
    score[row(end, new)] = two
    score[row(other, new + 1)] = two
    score[row(onward, new + 1)] = two + cross
    through = np.maximum(score[row(run, onward)], _LEAST)
    score[row(run, onward)] = through
    score[row(run, other)] = through + cross

    vertex = np.concatenate([longer.half_vertex[new], longer.half_vertex[new + 1]])
    places = np.unique(longer.place_at[vertex])
    ways = ranked_alternatives(longer, score, only=places)
    partner = np.concatenate([routing.partner, np.arange(size - 2 * len(chosen), size)])
    partner = partner.astype(np.int32)
    alternatives = list(routing.alternatives)
    for place in places.tolist():
        here = longer.halves_of(longer.places[place])
        partner[here] = here
        for a, b in ways[place][0].pairs:
            partner[a], partner[b] = b, a
        alternatives[place] = ways[place]
    return replace(
        routing, partner=partner, pairs=pairs, pair_score=score, alternatives=tuple(alternatives)
    )
