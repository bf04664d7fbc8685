"""Which lines a gesture follows: from a path on the page to half-branches in walking order.

The likeliest walk along the graph, by dynamic programming over points of the path, as roads are
found for a track of positions (Newson and Krumm, Hidden Markov Map Matching, 2009): a walk costs
what it is away from the path, and what it is longer or shorter. Pure NumPy.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...engine.arrays.ragged import along, arc
from ..grease_pencil.core.stroke_arrays import lengths_along

if TYPE_CHECKING:
    from ...engine.values import PlanarGraph

Array = np.ndarray

_MOST = 300  # points of a path that are looked at
_STEP = 0.5  # radii from one to the next
_SLACK = 2.0  # radii that a walk may be longer than the path from one point to the next
_STRAY = 0.5  # cost of a step that is as much too long or too short as a step is long
_COVERED = 0.5  # radii of its first and last line that a path has to follow, or half of the line
_BETWEEN = 4  # short lines at most that are walked whole from one point to the next
_NEVER = np.inf


class _State(NamedTuple):
    """A place on a line that is walked in one direction: half-branch, length from its start."""

    half: int
    along: float
    away: float


class _Reached(NamedTuple):
    """half: a line; begun: px walked until it begins; between: the lines on the way to it."""

    half: int
    begun: float
    between: tuple[int, ...]


class _Source(NamedTuple):
    """state: number of the one before; between: the lines on the way from it."""

    state: int
    between: tuple[int, ...]


def followed(graph: PlanarGraph, path: Array, radius: float) -> list[int]:
    """The half-branches that a path follows, in walking order.

    Args:
        path: (N, 2) px of the page.
        radius: px; what is farther away is not meant.

    Returns:
        An empty list where no walk keeps within the radius.
    """
    path = resampled(np.asarray(path, float), max(_STEP * radius, 1e-6))
    if len(path) < 2:
        return []
    lengths = lengths_along(graph.points, graph.offsets)  # px along its branch, of each point
    layers = _states(graph, path, radius, lengths)
    if not all(layers):
        return []
    step = float(np.linalg.norm(np.diff(path, axis=0), axis=1).mean())
    cost = [(s.away / radius) ** 2 for s in layers[0]]
    sources = []
    for before, here in pairwise(layers):
        reach = [
            _onward(graph, lengths, state, step + _SLACK * radius) if known < _NEVER else []
            for state, known in zip(before, cost, strict=True)
        ]
        cost, source = _next(cost, reach, here, step, radius)
        sources.append(source)
    return _walk(graph, lengths, layers, cost, sources, radius)


def _next(
    cost: list[float], reach: list[list[_Reached]], here: list[_State], step: float, radius: float
) -> tuple[list[float], list[_Source]]:
    """The least costs at the next point of the path, and from where they come."""
    known, source = [_NEVER] * len(here), [_Source(-1, ())] * len(here)
    places: dict[int, list[int]] = {}
    for k, state in enumerate(here):
        places.setdefault(state.half, []).append(k)
    for j, reached in enumerate(reach):
        for half, begun, between in reached:
            for k in places.get(half, ()):
                gone = begun + here[k].along
                if gone < -radius:  # backward on the same line
                    continue
                total = cost[j] + (here[k].away / radius) ** 2
                total += _STRAY * abs(max(gone, 0.0) - step) / step
                if total < known[k]:
                    known[k], source[k] = total, _Source(j, between)
    return known, source


def resampled(path: Array, step: float) -> Array:
    """(M, 2) points of a path, evenly spaced, about a step apart; no more than a few hundred."""
    whole = arc(path)[-1] if len(path) > 1 else 0.0
    if whole <= 0:
        return path[:1]
    count = int(np.clip(np.ceil(whole / step), 1, _MOST)) + 1
    return along(path, np.linspace(0, whole, count))


def _states(graph: PlanarGraph, path: Array, radius: float, lengths: Array) -> list[list[_State]]:
    """For each point of the path the nearest place of every line within the radius, both ways."""
    points = graph.points.astype(float)
    low, high = path.min(0) - radius, path.max(0) + radius
    near = np.flatnonzero(((points >= low) & (points <= high)).all(1))
    branch = np.searchsorted(graph.offsets, near, "right") - 1
    whole = lengths[graph.offsets[1:] - 1]
    layers = []
    for place in path:
        away = np.linalg.norm(points[near] - place, axis=1)
        found = []
        inside = np.flatnonzero(away <= radius)
        order = inside[np.argsort(away[inside], kind="stable")]
        chosen, first = np.unique(branch[order], return_index=True)
        for b, k in zip(chosen.tolist(), order[first].tolist(), strict=True):
            at = float(lengths[near[k]])
            found.append(_State(2 * b, at, float(away[k])))
            found.append(_State(2 * b + 1, float(whole[b]) - at, float(away[k])))
        layers.append(found)
    return layers


def _onward(graph: PlanarGraph, lengths: Array, state: _State, most: float) -> list[_Reached]:
    """The lines that can be walked on within `most` px, the state's own first."""
    found = [_Reached(state.half, -state.along, ())]
    waiting = list(found)
    while waiting:
        half, begun, between = waiting.pop()
        whole = float(lengths[graph.offsets[(half >> 1) + 1] - 1])
        arrived = begun + whole
        if arrived > most:
            continue
        through = between if half == state.half and not between else (*between, half)
        for after in graph.halves_of(graph.half_vertex[half ^ 1]).tolist():
            if after == half ^ 1 or after in through:
                continue
            found.append(_Reached(after, arrived, through))
            if len(through) < _BETWEEN:
                waiting.append(found[-1])
    return found


def _walk(
    graph: PlanarGraph,
    lengths: Array,
    layers: list[list[_State]],
    cost: list[float],
    sources: list[list[_Source]],
    radius: float,
) -> list[int]:
    """The cheapest walk, without lines at its ends that the path hardly touches."""
    k = int(np.argmin(cost))
    if cost[k] == _NEVER:
        return []
    last = layers[-1][k]
    walk = [last.half]
    for layer, source in zip(layers[-2::-1], sources[::-1], strict=True):
        k, between = source[k]
        walk[:0] = between
        if walk[0] != layer[k].half:
            walk.insert(0, layer[k].half)
    first = layers[0][k]

    def least(half: int) -> float:
        return min(_COVERED * radius, 0.5 * float(lengths[graph.offsets[(half >> 1) + 1] - 1]))

    if len(walk) > 1 and last.along < least(last.half):
        walk.pop()
    whole = float(lengths[graph.offsets[(first.half >> 1) + 1] - 1])
    if len(walk) > 1 and whole - first.along < least(first.half):
        walk.pop(0)
    return walk
