"""What the artist did to traced strokes, kept when the page is traced again. Pure NumPy.

A stroke that was touched stays as it is and stands for the new stroke along the same line; a stroke
that was deleted stays deleted.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ....engine.arrays.ragged import along as places_along
from .pixel_map import PixelMap
from .splice import untouched_strokes
from .stretches import corner_lengths, corners, whole_length
from .stroke_arrays import ALONG, HALF, TRACE, Curves

if TYPE_CHECKING:
    from ....engine import Drawing, Stroke

Array = np.ndarray

_SAME = 0.8  # share of two lines that has to run together for them to be one
_BESIDE = 1.5  # pen widths between lines that run together
_SAMPLES = 40  # places of a stroke that are looked at


@dataclass(frozen=True, eq=False)
class Kept:
    """What stays in one cel.

    index: of a stroke; half: first half-branch of the new stroke that it stands for, counted from
    1, or 0 where there is none: then it is one drawn by hand.
    along: (n,) px along that new stroke, for its points.
    """

    index: int
    half: int
    along: Array


@dataclass(frozen=True, eq=False)
class HandEdits:
    """kept: per cel. left_out: numbers of new strokes that are not drawn."""

    kept: list[list[Kept]] = field(default_factory=list)
    left_out: set[int] = field(default_factory=set)


def hand_edits(
    old: Drawing,
    new: Drawing,
    cels: Sequence[Curves],
    key: int,
    pixel_map: PixelMap,
    same: Mapping[int, int] | None = None,
) -> HandEdits:
    """What stays of the old drawing's strokes, and which new ones it stands for.

    Args:
        cels: what the layers show. key: of the old trace.
        same: old strokes, and new ones that are just like them: these stay untouched or not.
    """
    same = same or {}
    untouched = untouched_strokes(old, cels, key, pixel_map)
    owner = {int(h) >> 1: i for i, s in enumerate(old.strokes) for h in s.branches}
    there: dict[int, list[tuple[int, int]]] = {}
    for number, cel in enumerate(cels):
        mine = (cel.mark(TRACE) == key) & (cel.mark(HALF) > 0)
        for curve in np.flatnonzero(mine).tolist():
            index = owner.get((int(cel.mark(HALF)[curve]) - 1) >> 1)
            if index is not None:
                there.setdefault(index, []).append((number, curve))
    changed = [i for i in range(len(old.strokes)) if i not in untouched and i not in same]
    stands_for = {**same, **_same_lines(old, new, changed, set(same.values()))}
    edits = HandEdits([[] for _ in cels])
    for index in [*same, *changed]:
        chosen = stands_for.get(index)
        if chosen is not None:
            edits.left_out.add(chosen)
        for number, curve in there.get(index, ()):
            edits.kept[number].append(_kept(old, new, index, chosen, cels[number], curve))
    return edits


def same_strokes(old: Drawing, new: Drawing) -> dict[int, int]:
    """Strokes of the old drawing, and those of the new one that are just like them."""
    there = {_content(stroke): number for number, stroke in enumerate(new.strokes)}
    found = {n: there.get(_content(stroke), -1) for n, stroke in enumerate(old.strokes)}
    return {before: now for before, now in found.items() if now >= 0}


def _content(stroke: Stroke) -> tuple[bytes, bytes, bool]:
    return stroke.points.tobytes(), stroke.widths.tobytes(), stroke.closed


def _kept(
    old: Drawing, new: Drawing, index: int, chosen: int | None, cel: Curves, curve: int
) -> Kept:
    part = slice(cel.offsets[curve], cel.offsets[curve + 1])
    along = cel.point(ALONG)[part].astype(float)
    if chosen is None:
        return Kept(curve, 0, along)
    before, after = old.strokes[index], new.strokes[chosen]
    if _content(before) == _content(after):
        return Kept(curve, int(after.branches[0]) + 1, along)
    places = places_along(corners(before), along)
    return Kept(curve, int(after.branches[0]) + 1, _lengths_on(after, places))


def _same_lines(
    old: Drawing, new: Drawing, changed: Sequence[int], taken: set[int]
) -> dict[int, int]:
    """Old stroke -> the new one that runs along the same line, all along, and is not taken."""
    pen = 4.0 if old.graph.widths is None else float(np.median(old.graph.widths))
    boxes = np.array([[*s.points.min(0), *s.points.max(0)] for s in new.strokes]).reshape(-1, 4)
    found = {}
    for index in changed:
        mine = _places(old.strokes[index])
        low, high = mine.min(0) - _BESIDE * pen, mine.max(0) + _BESIDE * pen
        near = (boxes[:, :2] <= high).all(1) & (boxes[:, 2:] >= low).all(1)
        for number in np.flatnonzero(near).tolist():
            theirs = _places(new.strokes[number])
            shares = [
                (_away(a, stroke) <= _BESIDE * pen).mean()
                for a, stroke in ((mine, new.strokes[number]), (theirs, old.strokes[index]))
            ]
            if min(shares) >= _SAME and number not in taken:
                found[index] = number
                taken.add(number)
                break
    return found


def _places(stroke: Stroke) -> Array:
    """(n, 2) places evenly along a stroke."""
    return places_along(corners(stroke), np.linspace(0, whole_length(stroke), _SAMPLES))


def _away(places: Array, stroke: Stroke) -> Array:
    return _nearest(places, stroke)[0]


def _lengths_on(stroke: Stroke, places: Array) -> Array:
    """How far along a stroke the places lie, in their order along it."""
    along = _nearest(places, stroke)[1]
    backward = len(along) > 1 and along[0] > along[-1] and not stroke.closed
    ordered = np.maximum.accumulate(along[::-1] if backward else along)
    return ordered[::-1] if backward else ordered


def _nearest(places: Array, stroke: Stroke) -> tuple[Array, Array]:
    """(N,) distance of places from a stroke, and (N,) how far along it the nearest place lies."""
    points, lengths = corners(stroke), corner_lengths(stroke)
    if len(points) < 2:
        return np.hypot(*(places - points[0]).T), np.zeros(len(places))
    start, side = points[:-1], np.diff(points, axis=0)
    share = ((places[:, None] - start) * side).sum(2) / np.maximum((side**2).sum(1), 1e-12)
    share = np.clip(share, 0, 1)
    foot = start + share[..., None] * side
    away = np.hypot(*np.moveaxis(places[:, None] - foot, 2, 0))
    best = away.argmin(1)
    rows = np.arange(len(places))
    return away[rows, best], lengths[best] + share[rows, best] * np.diff(lengths)[best]
