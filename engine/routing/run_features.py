"""What tells a run of two lines from one on which lines end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays.two_clusters import finer_pen
from ..graph.topology import joined, lengths, means
from ..values import Array, PlanarGraph, Routing
from .double_runs import Runs
from .encoding import along

FEATURES = 80  # of a run
_REACH = np.array([6.0, 12.0, 24.0, 48.0])  # px from a junction at which two lines are compared
_OUTSIDE = ((0, 2), (1, 3))  # which of these tell how a line comes
_PLACES = np.array([0.2, 0.5, 0.8])  # of a run, where its width is compared
_FARTHEST = 200.0  # px; longer lines are all alike
_SCORE = 10.0  # log-odds; larger ones are all alike


def features(graph: PlanarGraph, routing: Routing, runs: Runs) -> Array:
    """(K, F) float64 of the runs of a measured graph; the same however the page lies and whichever
    end comes first. The last one is 1 where the ends of both lines lie on the same side, else -1:
    what is said of touching and crossing is in that order (`exchanged`)."""
    whole, halves = joined(graph)
    number = np.full(2 * graph.branch_count, -1)
    number[halves] = np.arange(len(halves))
    ends = [_End.of(whole, own, number[own]) for own in (runs.first, runs.last)]
    known = _scores(graph, routing)
    each = [_of_end(graph, whole, end, known) for end in ends]
    aside = [(end.ended - end.through).imag / _REACH for end in ends]
    side = -aside[0] * aside[1]
    same = np.where(-aside[0].sum(1) * aside[1].sum(1) < 0, -1.0, 1.0)
    (h, x), (g, y) = ([_turn(z[:, 1:]) for z in (end.ended, end.through)] for end in ends)
    return np.column_stack(
        [
            np.minimum(*each),
            np.maximum(*each),
            np.abs(side) ** 0.5 * np.where(side * same[:, None] > 0, 1.0, -1.0),
            *exchanged(same, _size(h - g) + _size(x - y), _size(h - y) + _size(x - g)),
            *exchanged(same, _size(h + g) + _size(x + y), _size(h + y) + _size(x + g)),
            *_smoothness(ends, same),
            _of_paths(graph, runs),
            same,
        ]
    )


@dataclass(frozen=True, eq=False)
class _End:
    """One end of K runs, with corners left out.

    own: (K, 3) half-branches as in `Runs`; side: the same of the graph without corners.
    place: (K,) complex px. seen: (K, 3, S) the three lines at `_REACH` from there, complex px;
    ended, through: (K, S) two of them, turned so that the run leaves along the x axis.
    long: (K, 2) px of these.
    """

    own: Array
    side: Array
    place: Array
    seen: Array
    ended: Array
    through: Array
    long: Array

    @staticmethod
    def of(whole: PlanarGraph, own: Array, side: Array) -> _End:
        away, long = along(whole, _REACH)
        seen = away[side]
        out = np.conj(seen[:, 0, 1:2])
        turned = seen * (out / np.maximum(np.abs(out), 1e-9))[:, None]
        place = whole.vertices[whole.half_vertex[side[:, 0]]].astype(np.float64) @ [1, 1j]
        return _End(own, side, place, seen, turned[:, 1], turned[:, 2], long[side[:, 1:]])


def _of_end(
    graph: PlanarGraph, whole: PlanarGraph, end: _End, known: Callable[[Array, Array], Array]
) -> Array:
    """(K, 20) how the lines lie at one end of runs, and what the router says of them."""
    assert whole.widths is not None, "runs are judged in a measured graph"
    assert whole.strength is not None
    wide, dark = np.log(means(whole, whole.widths)), means(whole, whole.strength)
    run, others = end.side[:, :1] >> 1, end.side[:, 1:] >> 1
    inside, ended, through = end.own.T
    return np.column_stack(
        [
            np.abs(_turn(end.ended[:, 1:])),
            np.abs(_turn(end.through[:, 1:])),
            np.abs(end.ended - end.through) / _REACH,
            np.log(np.minimum(end.long, _FARTHEST)),
            graph.degrees[graph.half_vertex[inside]],
            wide[run] - wide[others],
            dark[run] - dark[others],
            known(inside, ended),
            known(inside, through),
            known(ended, through),
        ]
    )


def exchanged(same: Array, a: Array, b: Array) -> tuple[Array, Array]:
    """Two (K, ...) arrays: where `same` is below zero, exchanged."""
    first = (same > 0).reshape(-1, *[1] * (a.ndim - 1))
    return np.where(first, a, b), np.where(first, b, a)


def _smoothness(ends: list[_End], same: Array) -> list[Array]:
    """How much the two lines bend in a run, radians, seen from outside of it: if each leaves to the
    side that it came from, and if they change sides; the less and the more bent one."""
    found: list[Array] = []
    for near, far in _OUTSIDE:

        def bend(a: int, b: int, near: int = near, far: int = far) -> Array:
            ways = [end.seen[:, k] for end, k in zip(ends, (a, b), strict=True)]
            start, stop = (end.place + way[:, near] for end, way in zip(ends, ways, strict=True))
            first, last = (way[:, far] - way[:, near] for way in ways)
            return np.abs(_angle(-first, stop - start)) + np.abs(_angle(stop - start, last))

        routed, changed = (np.sort([bend(1, a), bend(2, b)], axis=0).T for a, b in ((1, 2), (2, 1)))
        found += exchanged(same, routed, changed)
    return found


def _angle(a: Array, b: Array) -> Array:
    """From one complex direction to another, radians."""
    return np.angle(b * np.conj(a))


def _size(turn: Array) -> Array:
    """Turns of any number of rounds as what they are, 0 to pi."""
    return np.abs(np.angle(np.exp(1j * turn)))


def _turn(away: Array) -> Array:
    """By how much lines turn into a run that leaves along the x axis, radians, signed."""
    return np.angle(-np.conj(away))


def _scores(graph: PlanarGraph, routing: Routing) -> Callable[[Array, Array], Array]:
    """The router's log-odds of pairs of half-branches."""
    size = 2 * graph.branch_count
    key = routing.pairs[:, 0].astype(np.int64) * size + routing.pairs[:, 1]
    order = np.argsort(key)

    def known(a: Array, b: Array) -> Array:
        wanted = np.minimum(a, b).astype(np.int64) * size + np.maximum(a, b)
        at = order[np.minimum(np.searchsorted(key[order], wanted), len(key) - 1)]
        return np.clip(routing.pair_score[at], -_SCORE, _SCORE)

    return known


def _of_paths(graph: PlanarGraph, runs: Runs) -> Array:
    """(K, 15): how long, straight, wide and dark the runs are."""
    assert graph.widths is not None, "runs are judged in a measured graph"
    assert graph.strength is not None
    pen = float(np.median(finer_pen(graph.widths)))
    count = np.array([len(path) for path in runs.path])
    branch = np.array([half >> 1 for path in runs.path for half in path], int)
    begin = np.cumsum(count) - count
    long = lengths(graph)
    length = np.add.reduceat(long[branch], begin)

    def mean(values: Array) -> Array:
        return np.add.reduceat(means(graph, values)[branch] * long[branch], begin) / length

    tips = graph.vertices[graph.half_vertex[np.stack([runs.first[:, 0], runs.last[:, 0]])]]
    chord = np.hypot(*(tips[1] - tips[0]).astype(float).T)
    full = np.average(means(graph, graph.strength), weights=long)
    return np.column_stack(
        [
            np.log(length),
            np.log(length / pen),
            count,
            chord / length,
            mean(graph.widths) / pen,
            mean(graph.strength) / full,
            np.full(len(count), np.log(pen)),
            *(_along(graph, runs, values) for values in (np.log(graph.widths), graph.strength)),
        ]
    )


def _along(graph: PlanarGraph, runs: Runs, values: Array) -> Array:
    """(K, 4): values of the points, less their means on the four lines outside: the least on each
    run, their mean there, in its middle, and how much more they are there than towards its ends.
    Lines that cross are one in the middle; lines side by side never are."""
    mean = means(graph, values)
    found = []
    for path in runs.path:
        parts = [values[slice(*graph.offsets[half >> 1 : (half >> 1) + 2])] for half in path]
        row = np.concatenate(
            [part[::-1] if half & 1 else part for half, part in zip(path, parts, strict=True)]
        )
        before, middle, after = np.interp(_PLACES * (len(row) - 1), np.arange(len(row)), row)
        found.append([row.min(), row.mean(), middle, middle - (before + after) / 2])
    outside = np.concatenate([runs.first[:, 1:], runs.last[:, 1:]], 1) >> 1
    return np.array(found) - mean[outside].mean(1)[:, None] * [1, 1, 1, 0]
