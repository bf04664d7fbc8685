"""Lines of the junction overlay as arrays, in pixels of the drawing. Pure NumPy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...engine.arrays.ragged import along, arc
from ...operators.view.junction_words import letters
from ...operators.view.picking import is_bundle, near_part
from .colors import LOOSE, STROKES, Color, doubt_colors

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from ...engine import Bundle, Drawing, Junction
    from ...operators.view.junction_table import JunctionTable

Array = np.ndarray

_SIDES = 20  # of a ring
_MINOR = 0.4  # of a ring, one of a bundle that is not worth a look
_LABEL_AT = 34.0  # px from the junction
_HALFWAY = 24  # points of a line halfway between two
_REACH_APART, _LEAST_REACH = 4.0, 12.0  # times how far two strokes lie apart, and px: of a sketch


@dataclass(frozen=True, eq=False)
class Rings:
    """points: (J * sides, 2) px. colors: (J * sides, 4). edges: (E, 2) int32 pairs of points."""

    points: Array
    colors: Array
    edges: Array


@dataclass(frozen=True, eq=False)
class Route:
    """How lines run through a junction: a polyline in px, its colour, and does it go through."""

    points: Array
    color: Color
    joined: bool


def rings(table: JunctionTable, radius: float, scale: tuple[Color, Color, Color]) -> Rings:
    """A ring around each junction with strokes: the more doubtful, the larger and the more yellow;
    those of bundles that nothing hangs on are small.

    Args:
        radius: of a certain junction's ring, px.
        scale: colours of the sure, the doubtful and the locked.
    """
    seen = np.flatnonzero(np.isfinite(table.positions[:, 0]))
    turn = np.arange(_SIDES) * (2 * np.pi / _SIDES)
    circle = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    doubt, locked = table.doubt[seen], table.locked[seen]
    radii = radius * (1.0 + np.where(locked, 0.0, np.minimum(2 * doubt, 1.0)))
    minor = (table.degree[seen] == 2) & ~table.doubtful[seen] & ~locked
    radii = np.where(minor, _MINOR * radius, radii)
    points = table.positions[seen, None] + radii[:, None, None] * circle
    colors = doubt_colors(doubt, locked, *scale)
    corner = np.arange(_SIDES)
    one = np.stack([corner, np.roll(corner, -1)], axis=1)
    edges = (np.arange(len(seen))[:, None, None] * _SIDES + one).reshape(-1, 2)
    return Rings(
        points.reshape(-1, 2).astype(np.float32),
        np.repeat(colors, _SIDES, axis=0),
        edges.astype(np.int32),
    )


def routes(
    drawing: Drawing, junction: Junction | Bundle, pairs: Iterable[tuple[int, int]]
) -> list[Route]:
    """The half-branches of a junction, joined as a routing says, each stroke in its own colour; of
    a bundle the line in the middle of its strokes, or both."""
    if is_bundle(drawing, junction):
        return _one_or_two(drawing.parts_of(junction), bool(pairs))
    return _joined(junction, pairs, lambda half: _outward(drawing, half))


def sketch(
    drawing: Drawing, junction: Junction | Bundle, pairs: Iterable[tuple[int, int]]
) -> list[Route]:
    """The same around (0, 0), y up; every half-branch reaches out as far as 1, long or short; of a
    bundle so much is seen that its strokes lie apart."""
    if is_bundle(drawing, junction):
        parts = _close_up(drawing.parts_of(junction), np.array(junction.position))
        behind = [Route(part, LOOSE, True) for part in parts] if pairs else []
        return behind + _one_or_two(parts, bool(pairs))

    def arm(half: int) -> Array:
        line = (_outward(drawing, half) - junction.position) * (1, -1)
        return line / max(np.linalg.norm(line, axis=1).max(), 1e-6)

    return _joined(junction, pairs, arm)


def _joined(
    junction: Junction, pairs: Iterable[tuple[int, int]], arm: Callable[[int], Array]
) -> list[Route]:
    """Routes of arms, the lines of half-branches from the junction outward."""
    left = set(junction.half_branches)
    found = []
    for number, (a, b) in enumerate(sorted(pairs)):
        line = np.concatenate([arm(a)[::-1], arm(b)[1:]])
        found.append(Route(line.astype(np.float32), STROKES[number % len(STROKES)], True))
        left -= {a, b}
    found += [Route(arm(half).astype(np.float32), LOOSE, False) for half in sorted(left)]
    return found


def _one_or_two(parts: Sequence[Array], one: bool) -> list[Route]:
    if one:
        parts = [_middle(*parts)]
    return [
        Route(np.asarray(part, np.float32), STROKES[k], True)
        for k, part in enumerate(parts)
        if len(part) > 1
    ]


def _middle(first: Array, second: Array) -> Array:
    """(N, 2) halfway between two lines that run beside each other."""
    shares = np.linspace(0, 1, _HALFWAY)
    a, b = (along(line, shares * arc(line)[-1]) for line in (first, second))
    if np.hypot(*(a[[0, -1]] - b[[0, -1]]).T).sum() > np.hypot(*(a[[0, -1]] - b[[-1, 0]]).T).sum():
        b = b[::-1]
    return (a + b) / 2


def _close_up(parts: Sequence[Array], middle: Array) -> list[Array]:
    """What of two lines lies around their middle, in units of how far that reaches, y up."""
    apart = min(float(np.hypot(*(parts[0] - place).T).min()) for place in parts[1])
    apart = max(apart, *(float(np.hypot(*(part - middle).T).min()) for part in parts))
    reach = max(_REACH_APART * apart, _LEAST_REACH)
    near = [part[np.hypot(*(part - middle).T) <= reach] for part in parts]
    return [((part - middle) * (1, -1) / reach).astype(np.float32) for part in near]


def _outward(drawing: Drawing, half: int) -> Array:
    return near_part(drawing, half, share=1.0)


def labels(drawing: Drawing, junction: Junction | Bundle) -> list[tuple[str, tuple[float, float]]]:
    """The letters of a junction's half-branches and where they stand, px; a bundle needs none."""
    if is_bundle(drawing, junction):
        return []
    return [
        (letter, tuple(near_part(drawing, half, _LABEL_AT, 0.8)[-1].tolist()))
        for half, letter in letters(drawing, junction).items()
    ]
