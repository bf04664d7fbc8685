"""How artists lift their pen: pages whose strokes are cut where a habit says, and redrawn so.

Clip art runs around its corners; many an artist draws a box in four strokes, whose ends overshoot,
stop short or miss each other by half a pen. A habit is one for a whole page: how many of its
corners are lifted at, how far the ends then lie from each other along and across, how often a long
line is drawn in two.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

Array = np.ndarray

KINDS = ("as drawn", "lifting", "mixed")
_ARM = 6.0  # px on both sides that tell a corner of a true stroke
_LEAST = np.radians(30.0)  # what turns less is no corner
_SHARP = np.radians(60.0)  # what turns more is lifted at as often as the habit says
_APART = 14.0  # px between two cuts of a stroke, and to its ends
_BEND = 30.0  # px over which an end that is moved aside bends away


@dataclass(frozen=True)
class Habit:
    """How one page is drawn.

    corners: share of the sharp corners that the pen is lifted at. seams: cuts of smooth lines, per
    px. along, across: spread of where ends lie, px. over: how much they overshoot on average, px.
    exact: share of the lifts whose ends meet exactly all the same.
    """

    corners: float
    seams: float
    along: float
    across: float
    over: float
    exact: float

    @staticmethod
    def drawn(rng: np.random.Generator, pen: float, kind: str = "") -> Habit:
        """A random habit; without a kind (see `KINDS`) four pages in ten are as their artist made
        them, as many are lifted at nearly every corner, the others are mixed."""
        kind = kind or KINDS[int(np.searchsorted([0.4, 0.8], rng.random(), "right"))]
        share = {"as drawn": 0.0, "lifting": rng.uniform(0.85, 1.0), "mixed": rng.random()}
        corners = share[kind]
        seams = rng.choice([0.0, 1 / 1500, 1 / 400]) if corners else 0.0
        exact = rng.choice([0.0, 1.0, rng.random()], p=[0.5, 0.1, 0.4])
        along, across = rng.uniform(0.3, 1.5) * pen, rng.uniform(0.2, 0.8) * pen
        over = rng.normal(0.0, 0.5) * pen
        return Habit(corners, float(seams), along, across, over, float(exact))


def lifted(rng: np.random.Generator, strokes: list[Array], habit: Habit) -> list[Array]:
    """The strokes, (N, 2) px each, as a hand of this habit draws them."""
    if habit.corners == 0.0 and habit.seams == 0.0:
        return strokes
    return [piece for line in strokes for piece in _cut(rng, np.asarray(line, float), habit)]


def _cut(rng: np.random.Generator, line: Array, habit: Habit) -> list[Array]:
    line = _dense(line)
    closed = np.hypot(*(line[0] - line[-1])) < 2 and len(line) > 30
    at, turn = corners(line, closed)
    chance = habit.corners * np.clip((turn - _LEAST) / (_SHARP - _LEAST), 0.1, 1.0)
    chosen = at[rng.random(len(at)) < chance]
    seams = rng.integers(0, len(line), rng.poisson(habit.seams * len(line)))
    cuts = _apart(chosen, seams, len(line), closed)
    if not len(cuts):
        return [line]
    if closed:
        line = np.concatenate([line[cuts[0] :], line[1 : cuts[0] + 1]])
        cuts = np.append(cuts[1:] - cuts[0], len(line) - 1)
    else:
        cuts = np.append(cuts, len(line) - 1)
    starts = np.concatenate([[0], cuts[:-1]])
    pieces = []
    for k, (a, b) in enumerate(zip(starts, cuts, strict=True)):
        first, last = closed or k > 0, closed or k < len(cuts) - 1
        pieces.append(_moved(rng, line[a : b + 1], habit, first, last))
    return pieces


def _dense(line: Array) -> Array:
    """The line with a point every px."""
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    at = np.linspace(0, arc[-1], max(2, round(arc[-1]) + 1))
    return np.stack([np.interp(at, arc, line[:, c]) for c in (0, 1)], 1)


def corners(line: Array, closed: bool) -> tuple[Array, Array]:
    """Where a dense line turns suddenly, ascending, and by how much, radians."""
    arm, count = round(_ARM), len(line)
    place = np.arange(count)
    if closed:
        before, after = (place - arm) % (count - 1), (place + arm) % (count - 1)
    else:
        before, after = np.maximum(place - arm, 0), np.minimum(place + arm, count - 1)
    a, b = line - line[before], line[after] - line
    turn = np.abs(np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], (a * b).sum(1)))
    if closed:
        turn[-1] = 0.0
    else:
        turn[:arm] = turn[count - arm :] = 0.0
    best = turn > _LEAST
    for k in range(1, 2 * arm):
        for other in ((place + k), (place - k)):
            other = other % (count - 1) if closed else np.clip(other, 0, count - 1)
            best &= (turn > turn[other]) | ((turn == turn[other]) & (place <= other))
    at = np.flatnonzero(best)
    return at, turn[at]


def _apart(chosen: Array, seams: Array, count: int, closed: bool) -> Array:
    """Cuts far enough from each other and from the ends; corners go before seams."""
    kept: list[int] = []
    for place in [*chosen.tolist(), *seams.tolist()]:
        inside = closed or _APART < place < count - 1 - _APART
        if inside and all(
            min(abs(place - k), count - 1 - abs(place - k) if closed else count) > _APART
            for k in kept
        ):
            kept.append(place)
    return np.sort(np.array(kept, int))


def _moved(rng: np.random.Generator, piece: Array, habit: Habit, first: bool, last: bool) -> Array:
    """A piece whose cut ends lie where the hand put them: longer or shorter, and bent aside."""
    for there in (first, last):
        if there and len(piece) > 8 and rng.random() >= habit.exact:
            piece = _end_moved(rng, piece, habit)
        piece = piece[::-1]
    return piece


def _end_moved(rng: np.random.Generator, piece: Array, habit: Habit) -> Array:
    """A piece with its first end moved along and across."""
    way = piece[0] - piece[min(6, len(piece) - 1)]
    way /= max(np.hypot(*way), 1e-9)
    along = np.clip(habit.over + rng.normal(0, habit.along), -0.3 * len(piece), 12.0)
    arc = np.arange(len(piece))
    fade = np.exp(-arc / min(_BEND, 0.3 * len(piece)))
    normal = np.array([-way[1], way[0]])
    piece = piece + rng.normal(0, habit.across) * fade[:, None] * normal
    if along < 0:
        return piece[min(round(-along), len(piece) - 4) :]
    tip = piece[0] + way * along
    return np.concatenate([np.linspace(tip, piece[0], round(along) + 2)[:-1], piece])
