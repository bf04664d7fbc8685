"""Pages with pairs of lines that run together for a while and part again, as when a line touches
another one for long, or crosses it at hardly any angle."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from involute.engine.arrays.ragged import along

Array = np.ndarray

_RUN = (40.0, 260.0)  # px that two lines run together, shortest and longest
_BEYOND = (50.0, 220.0)  # px that each line goes on beyond its run, on either side
_APART = (0.5, 1.1)  # pen widths that lines are apart where they begin to be two, and
_LEAST = 2.5  # px, at least
_NEAR = (0.0, 0.8)  # share of that that is left in the middle of a run, or passed evenly
_POWER = (2.0, 4.0)  # with which power of the way from the middle lines part
_CLEAR = 15.0  # px between a run and the lines of other pairs: two lines on a ridge are enough
_TRIES = 20


def with_shared_runs(
    rng: np.random.Generator, drawing: list[Array], size: float, pen: float, pairs: int
) -> tuple[list[Array], Array]:
    """A drawing with pairs of lines over it that share a run.

    Args:
        drawing: (N, 2) px each. size: px, of the square page. pen: its width, px.
        pairs: as many are tried; some find no room.

    Returns:
        The strokes, and (K, 2) the numbers of the two of each pair.
    """
    lines = list(drawing)
    numbers: list[tuple[int, int]] = []
    for _ in range(pairs):
        pair = _Pair.drawn(rng, pen)
        for _ in range(_TRIES):
            two = pair.along_a_curve(rng)
            low, high = np.concatenate(two).min(0), np.concatenate(two).max(0)
            room = size - (high - low) - 2 * pen
            if (room < 0).any():
                continue
            move = pen + rng.uniform(0, room) - low
            two = [line + move for line in two]
            others = [(lines[a], lines[b]) for a, b in numbers]
            if all(_clear(two, other) and _clear(other, two) for other in others):
                numbers.append((len(lines), len(lines) + 1))
                lines += two
                break
    return lines, np.array(numbers, int).reshape(-1, 2)


def _clear(two: Sequence[Array], others: Sequence[Array]) -> bool:
    """Is the run of two lines clear of others?"""
    run = two[0][_distance(two[0], two[1]) < _CLEAR]
    return not len(run) or bool(_distance(run, np.concatenate(others)).min() > _CLEAR)


def _distance(a: Array, b: Array) -> Array:
    """(N,) px from the points of one line to the nearest of another."""
    return np.hypot(*np.moveaxis(a[:, None] - b, -1, 0)).min(1)


@dataclass(frozen=True, eq=False)
class _Pair:
    """Two lines along one curve that are near each other on a run.

    run: px. reach: (2, 2) px of each line before and after the run. begin: px between them at the
    ends of the run. near: share of that in its middle, or passed evenly, power: of the way that
    they part by. share: of the way between them that the second line lies aside.
    """

    run: float
    reach: Array
    begin: float
    near: float
    power: float
    share: float
    crosses: bool

    @staticmethod
    def drawn(rng: np.random.Generator, pen: float) -> _Pair:
        return _Pair(
            run=float(np.exp(rng.uniform(*np.log(_RUN)))),
            reach=rng.uniform(*_BEYOND, (2, 2)),
            begin=max(_LEAST, rng.uniform(*_APART) * pen),
            near=rng.uniform(*_NEAR),
            power=rng.uniform(*_POWER),
            share=rng.random(),
            crosses=rng.random() < 0.5,
        )

    def along_a_curve(self, rng: np.random.Generator) -> list[Array]:
        """Both lines, (N, 2) px each, anywhere."""
        base, normal = _curve(rng, self.run + 2 * _BEYOND[1])
        lines = []
        for part, (before, after) in zip((-self.share, 1 - self.share), self.reach, strict=True):
            at = np.arange(-self.run / 2 - before, self.run / 2 + after, 2.0)
            way = np.abs(at) / (self.run / 2)
            parting = (1 - self.near) * way**self.power
            gap = np.sign(at) * (self.near * way + parting) if self.crosses else self.near + parting
            place = at + self.run / 2 + _BEYOND[1]
            lines.append(along(base, place) + (part * self.begin * gap)[:, None] * normal(place))
        return lines


def _curve(rng: np.random.Generator, length: float) -> tuple[Array, Callable[[Array], Array]]:
    """A smooth curve, (N, 2) px in steps of 2, and its unit normals, (K, 2), by px along it."""
    count = int(length / 2) + 2
    knots = rng.normal(0, 1 / 250, int(length / 90) + 3)
    bend = np.interp(np.linspace(0, len(knots) - 1, count), np.arange(len(knots)), knots)
    angle = rng.uniform(0, 2 * np.pi) + np.cumsum(2 * bend)

    def normal(place: Array) -> Array:
        turn = np.interp(place, 2.0 * np.arange(count), angle)
        return np.stack([-np.sin(turn), np.cos(turn)], 1)

    return np.cumsum(2 * np.stack([np.cos(angle), np.sin(angle)], 1), 0), normal
