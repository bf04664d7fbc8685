"""Order, direction, colour and routing of strokes, taken over from the frame before.

Blender pairs the strokes of two keyframes by their number in the layer when it interpolates, and
from start to end; so a line keeps its number among the lines of its ink, and its direction, for as
long as it can be followed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import cv2
import numpy as np

from ..arrays.ragged import arc
from ..drawing import Drawing
from ..ink.known_inks import Color, with_known_inks
from ..values import Array, Stroke
from .steady import steadied
from .stroke_matching import SAMPLES, Matches, match_strokes, sample_strokes


@dataclass
class Follower:
    """Takes the drawings of a sequence in order and hands them back with steady strokes.

    inks: every ink seen so far; a later frame's own shade of one becomes exactly that colour.
    strokes: those of the last frame.
    """

    inks: list[Color] = field(default_factory=list)
    strokes: tuple[Stroke, ...] = ()

    def __call__(self, drawing: Drawing) -> Drawing:
        """The same drawing; what lies where it lay is joined and ended as it was (see `steady`),
        strokes are reordered, reversed, recoloured, and no line is moved."""
        drawing = steadied(drawing, self.strokes)
        strokes = with_known_inks(drawing.strokes, self.inks)
        if strokes:
            strokes = follow(self.strokes, strokes)
            # Ink by ink, as they lie in layers.
            strokes = tuple(sorted(strokes, key=lambda s: self.inks.index(s.color)))
        self.strokes = strokes or self.strokes
        return replace(drawing, strokes=strokes)


def follow(old: Sequence[Stroke], new: Sequence[Stroke]) -> tuple[Stroke, ...]:
    """The new strokes in the order and direction of the old ones that they match.

    A stroke that vanished leaves its number to a newcomer of the same ink, the nearest one, else to
    one of the last strokes, so that all others keep theirs. What has no number to keep comes last,
    the longest first: specks come and go, and should not push the lines about. A newcomer runs the
    way that the old lines around it run.
    """
    matches = match_strokes(old, new)
    strokes = list(new)
    for k, mate, start, flipped in zip(
        matches.new, matches.old, matches.start, matches.flipped, strict=True
    ):
        strokes[k] = _started_like(strokes[k], old[mate], start)
        if flipped:
            strokes[k] = reverse(strokes[k])
    newcomers = np.setdiff1d(np.arange(len(new)), matches.new)
    for k in newcomers[_against_the_grain(old, new, newcomers, matches)]:
        strokes[k] = reverse(strokes[k])
    return tuple(strokes[k] for k in np.argsort(_numbers(old, new, matches), kind="stable"))


def reverse(stroke: Stroke) -> Stroke:
    """The same stroke drawn the other way; a closed one still starts at the same point."""
    turned = _reordered(stroke, np.arange(len(stroke.points))[::-1])
    if stroke.closed:
        turned = _reordered(turned, np.roll(np.arange(len(stroke.points)), 1))
    handles = None if turned.handles is None else turned.handles[:, ::-1]
    return replace(turned, branches=stroke.branches[::-1] ^ 1, handles=handles)


def _started_like(stroke: Stroke, old: Stroke, share: float) -> Stroke:
    """A closed stroke that starts where the old one does: about that share of its length along."""
    if not stroke.closed:
        return stroke
    around = np.vstack([stroke.points, stroke.points[:1]])
    along = arc(around)
    off = np.abs((along[:-1] / along[-1] - share + 0.5) % 1.0 - 0.5)
    start = old.points[0] + _middle(stroke) - _middle(old)
    there = np.hypot(*(stroke.points - start).T) / along[-1]
    first = int(np.where(off <= max(off.min(), 1 / SAMPLES), there, np.inf).argmin())
    return _reordered(stroke, np.roll(np.arange(len(stroke.points)), -first))


def _reordered(stroke: Stroke, index: Array) -> Stroke:
    """The stroke with its points, and all that belongs to them, in another order."""
    return replace(
        stroke,
        points=stroke.points[index],
        widths=stroke.widths[index],
        opacity=stroke.opacity[index],
        handles=None if stroke.handles is None else stroke.handles[index],
    )


def _numbers(old: Sequence[Stroke], new: Sequence[Stroke], matches: Matches) -> Array:
    """The number that each new stroke gets among those of its ink, (N,)."""
    numbers = np.full(len(new), -1)
    mates = dict(zip(matches.new.tolist(), matches.old.tolist(), strict=True))
    for ink in {s.color for s in new}:
        before = [k for k, s in enumerate(old) if s.color == ink]
        number_of = {k: number for number, k in enumerate(before)}
        here = [k for k, s in enumerate(new) if s.color == ink]
        for k in here:
            number = number_of.get(mates.get(k, -1), len(here))
            numbers[k] = number if number < len(here) else -1
        waiting = sorted((k for k in here if numbers[k] < 0), key=lambda k: -_length(new[k]))
        free = sorted(set(range(len(here))) - {int(numbers[k]) for k in here})
        inherited = np.array([n for n in free if n < len(before)], int)
        there = np.array([_middle(old[before[n]]) for n in inherited]).reshape(-1, 2)
        for k in [k for k in waiting if k not in mates][: len(inherited)]:
            nearest = int(np.hypot(*(there - _middle(new[k])).T).argmin())
            numbers[k] = inherited[nearest]
            inherited, there = (np.delete(a, nearest, axis=0) for a in (inherited, there))
        free = sorted(set(free) - {int(numbers[k]) for k in here})
        waiting = [k for k in waiting if numbers[k] < 0]
        numbers[waiting] = free
    return numbers


def _middle(stroke: Stroke) -> Array:
    """The middle of its box, which does not depend on where its points lie densely."""
    return 0.5 * (stroke.points.min(axis=0) + stroke.points.max(axis=0))


def _length(stroke: Stroke) -> float:
    return float(np.hypot(*np.diff(stroke.points, axis=0).T).sum())


def _against_the_grain(
    old: Sequence[Stroke], new: Sequence[Stroke], newcomers: Array, matches: Matches
) -> Array:
    """(n,) bool: newcomers that run against the old lines nearest to them."""
    if len(newcomers) == 0 or not old:
        return np.zeros(len(newcomers), bool)
    before = sample_strokes(old)
    before = cv2.transform(before, matches.motion).reshape(before.shape)
    after = sample_strokes([new[k] for k in newcomers])
    tree = cv2.flann_Index(before.reshape(-1, 2), {"algorithm": 4, "leaf_max_size": 10})  # type: ignore[attr-defined]
    near, squared = tree.knnSearch(after.reshape(-1, 2), 1, params={"checks": -1})
    there = np.gradient(before, axis=1).reshape(-1, 2)[near[:, 0]]
    here = np.gradient(after, axis=1).reshape(-1, 2)
    size = np.hypot(*there.T) * np.hypot(*here.T) + 1e-9
    vote = (there * here).sum(axis=1) / size / (4.0 + squared[:, 0])
    return vote.reshape(len(newcomers), -1).sum(axis=1) < 0
