"""What an answer of the artist changes: which strokes of a bundle mean one line, and which two.

An answer is given for two strokes where they run beside each other; others are drawn there, too.
Two lines: the bundle is parted between the two where it holds together least, as Kruskal's tree
tells it. One line: what is drawn with either becomes one.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from ..values import Answers, Array
from .cleaning import Bundled
from .sampled import SPACING


@dataclass(frozen=True, eq=False)
class Answered:
    """Bundles as the artist wants them; settled: (K,) bool, rungs that an answer decided."""

    bundles: Bundled
    settled: Array


def answered(found: Bundled, answers: Answers, scale: float) -> Answered:
    """The bundles with all answers, each in its turn.

    Args:
        scale: input pixels per working pixel.
    """
    one, settled, named = found.one.copy(), np.zeros(len(found.one), bool), found.named.copy()
    spans = answers.spans.astype(np.float64) / scale
    rows = zip(answers.strokes.tolist(), spans.tolist(), answers.one.tolist(), strict=True)
    for pair, span, joined in rows:
        own = between(found, pair, span)
        there = _around(found, own)
        sides = _joined(found, one, there, pair) if joined else _parted(found, one, there, pair)
        changed = there[sides]
        one[changed], one[own] = joined, joined
        settled[changed] = settled[own] = True
        if not joined:  # what is left over of one line would stay, too
            named[np.concatenate([found.rungs.a[own], found.rungs.b[own]])] = True
    return Answered(replace(found, one=one, named=named), settled)


def between(found: Bundled, pair: Iterable[int], span: Iterable[float]) -> Array:
    """Numbers of the rungs between two strokes, both ways, in a span along the first, px."""
    first, second = pair
    low, high = span
    strokes, of = found.strokes, found.rungs
    a, b = strokes.stroke[of.a], strokes.stroke[of.b]
    forth, back = (a == first) & (b == second), (a == second) & (b == first)
    place = np.where(forth, strokes.place[of.a], strokes.place[of.b])
    inside = (place >= low - SPACING) & (place <= high + SPACING)
    return np.flatnonzero((forth | back) & inside)


def _around(found: Bundled, own: Array) -> Array:
    """Numbers of the rungs among the samples of some rungs and all that lie beside these."""
    of, core = found.rungs, np.zeros(len(found.strokes.points), bool)
    core[of.a[own]] = core[of.b[own]] = True
    near = core.copy()
    near[of.a[core[of.b]]] = near[of.b[core[of.a]]] = True
    return np.flatnonzero(near[of.a] & near[of.b])


def _joined(found: Bundled, one: Array, there: Array, pair: list[int]) -> Array:
    """(T,) bool: the rungs between what is drawn with either of two strokes."""
    held = _Groups()
    for a, b, _ in _links(found, one, there):
        held.join(a, b)
    return _across(found, there, held, pair)


def _parted(found: Bundled, one: Array, there: Array, pair: list[int]) -> Array:
    """(T,) bool: the rungs across the cut between two strokes."""
    held, (first, second) = _Groups(), pair
    for a, b, _ in sorted(_links(found, one, there), key=lambda link: -link[2]):
        if {held.of(a), held.of(b)} != {held.of(first), held.of(second)}:
            held.join(a, b)
    return _across(found, there, held, pair)


def _links(found: Bundled, one: Array, there: Array) -> list[tuple[int, int, float]]:
    """Strokes that are mostly one line there, and how probable that is."""
    of, stroke = found.rungs, found.strokes.stroke
    both = np.sort(np.stack([stroke[of.a[there]], stroke[of.b[there]]], 1), axis=1)
    pairs, which = np.unique(both, axis=0, return_inverse=True)
    which = which.ravel()
    size = np.bincount(which, minlength=len(pairs))
    share = np.bincount(which, one[there], len(pairs)) / size
    mean = np.bincount(which, found.probability[there], len(pairs)) / size
    rows = zip(pairs.tolist(), mean.tolist(), share.tolist(), strict=True)
    return [(a, b, chance) for (a, b), chance, held in rows if a != b and held > 0.5]


def _across(found: Bundled, there: Array, held: _Groups, pair: list[int]) -> Array:
    """(T,) bool: the rungs from the group of one stroke to that of the other, if these differ."""
    first, second = (held.of(stroke) for stroke in pair)
    if first == second:
        return np.zeros(len(there), bool)
    of = found.rungs
    ends = [found.strokes.stroke[side[there]].tolist() for side in (of.a, of.b)]
    groups = {stroke: held.of(stroke) for stroke in {*ends[0], *ends[1]}}
    pairs = zip(*ends, strict=True)
    return np.array([{groups[a], groups[b]} == {first, second} for a, b in pairs], bool)


class _Groups:
    """Disjoint sets of strokes."""

    def __init__(self) -> None:
        self._above: dict[int, int] = {}

    def of(self, stroke: int) -> int:
        while (above := self._above.get(stroke, stroke)) != stroke:
            stroke = above
        return stroke

    def join(self, a: int, b: int) -> None:
        self._above[self.of(a)] = self.of(b)
