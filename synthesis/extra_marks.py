"""Marks that true drawings have little of: even rows, hairpins, lettering, frames, printed rules.

Each returns strokes and the widest pen that keeps them apart, px; unlike those of `line_art` they
are not turned afterwards, so that lines can lie exactly along rows and columns of pixels.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .line_art import Array, Rng, Strokes, resample

# Capitals and a few more signs in a box of 1 x 1.5, y down: polylines, as a plotter writes.
_LETTERS = (
    ((0, 1.5), (0.5, 0), (1, 1.5)), ((0.2, 0.9), (0.8, 0.9)),
    ((0, 0), (0, 1.5), (1, 1.5)), ((0, 0), (1, 0)), ((0, 0.7), (0.8, 0.7)),
    ((1, 0.2), (0.6, 0), (0.1, 0.4), (0, 1), (0.3, 1.5), (0.8, 1.5), (1, 1.2)),
    ((0, 1.5), (0, 0), (1, 1.5), (1, 0)), ((0, 0), (1, 0)), ((0.5, 0), (0.5, 1.5)),
    ((0, 0), (0.3, 1.5), (0.5, 0.6), (0.7, 1.5), (1, 0)), ((0, 0), (1, 1.5)), ((1, 0), (0, 1.5)),
    ((0.5, 0), (0.1, 0.3), (0, 0.8), (0.2, 1.4), (0.6, 1.5), (1, 1), (0.9, 0.3), (0.5, 0)),
    ((1, 0.1), (0.5, 0), (0.1, 0.3), (0.5, 0.7), (1, 1.1), (0.6, 1.5), (0, 1.4)),
    ((0, 1.5), (0, 0), (0.8, 0.1), (0.8, 0.6), (0, 0.8), (1, 1.5)), ((0.5, 0.2), (0.5, 1.5)),
)  # fmt: skip


def _along(rng: Rng) -> Array:
    """A direction: along rows or columns of pixels as often as not."""
    turn = rng.choice([0, 0.5]) * np.pi if rng.random() < 0.6 else rng.uniform(0, np.pi)
    return np.array([np.cos(turn), np.sin(turn)]).round(12)


def rows(rng: Rng, size: int) -> tuple[Strokes, float]:
    """Even parallel lines 3 to 16 px apart, at any phase to the pixels, straight or bent alike."""
    gap = float(np.exp(rng.uniform(np.log(3), np.log(16))))
    gap = round(gap) if rng.random() < 0.5 else gap
    along = _along(rng)
    across = np.array([-along[1], along[0]])
    count = int(rng.integers(3, max(4, min(40, int(size / gap)))))
    start = np.round(rng.uniform(0, 0.7, 2) * size) + rng.choice([0.0, 0.5, rng.random()], 2)
    t = np.linspace(0, rng.uniform(0.1, 1.1) * size, 40)
    bend = rng.choice([0, 0, 1]) * rng.uniform(0, 0.3 * gap) * np.sin(t / rng.uniform(15, 60))
    ends = rng.integers(0, 8, count) if rng.random() < 0.4 else np.zeros(count, int)
    lines = [
        start + t[: 40 - end, None] * along + (k * gap + bend[: 40 - end, None]) * across
        for k, end in enumerate(ends)
    ]
    return [line.astype(np.float32) for line in lines], max(1.0, gap - rng.uniform(1.4, 3))


def zigzag(rng: Rng, size: int) -> tuple[Strokes, float]:
    """One stroke of hairpins of 8 to 25 degrees, pointed or round, or narrow waves."""
    angle = np.deg2rad(rng.uniform(8, 25))
    reach, count = rng.uniform(20, 0.4 * size), int(rng.integers(3, 16))
    step = 2 * reach * np.tan(angle / 2)
    knots = np.stack([np.arange(count) * step / 2, np.arange(count) % 2 * reach], 1)
    knots += rng.normal(0, [0.06 * step, 0.06 * reach], knots.shape)
    line = resample(knots.astype(np.float32), 1.0)
    if rng.random() < 0.5:
        soft = int(rng.uniform(3, max(4, 0.5 * step)))
        kernel = np.full(2 * soft + 1, 1 / (2 * soft + 1))
        inner = [np.convolve(np.pad(line[:, c], soft, "edge"), kernel, "valid") for c in (0, 1)]
        line = np.stack(inner, 1).astype(np.float32)
    along = _along(rng)
    turn = np.array([along, [-along[1], along[0]]])
    placed = (line - line.mean(0)) @ turn + rng.uniform(0.2, 0.8, 2) * size
    return [placed.astype(np.float32)], float(np.clip(0.3 * step, 1.0, 6.0))


def lettering(rng: Rng, size: int) -> tuple[Strokes, float]:
    """Lines of small capitals, 6 to 28 px high."""
    height = float(np.exp(rng.uniform(np.log(6), np.log(28))))
    unit, slant = height / 1.5, rng.normal(0, 0.15)
    start, strokes = rng.uniform(0, 0.6, 2) * size, []
    for row in range(rng.integers(1, 6)):
        x = 0.0
        for _ in range(rng.integers(3, 20)):
            if rng.random() < 0.15:
                x += 1.0
                continue
            first = int(rng.integers(len(_LETTERS)))
            for shape in _LETTERS[first : first + int(rng.integers(1, 3))]:
                letter = np.array(shape) + rng.normal(0, 0.05, (len(shape), 2))
                letter[:, 0] += x - slant * letter[:, 1]
                strokes.append(start + unit * (letter + np.array((0, row * 2.1))))
            x += rng.uniform(1.25, 1.7)
    return [resample(s.astype(np.float32), 3.0) for s in strokes], max(1.0, 0.16 * height)


def frame(rng: Rng, size: int) -> tuple[Strokes, float]:
    """Lines on and along the edge of the page: a frame, or a line that runs down one side."""
    inset = rng.uniform(-2, 7)
    low, high = inset, size - inset
    corners = np.array([(low, low), (high, low), (high, high), (low, high), (low, low)])
    first = int(rng.integers(4))
    sides = [corners[k % 4 : k % 4 + 2] for k in range(first, first + int(rng.integers(1, 5)))]
    joined = len(sides) == 4 and rng.random() < 0.5
    lines = [corners] if joined else sides
    return [resample(line.astype(np.float32), 4.0) for line in lines], 14.0


def printed(rng: Rng, size: int) -> tuple[Strokes, float]:
    """Rules or a grid across the whole sheet, 9 to 100 px apart, turned by a degree or two."""
    pitch = float(np.exp(rng.uniform(np.log(9), np.log(100))))
    turn = rng.normal(0, 0.02) * rng.choice([0, 1])
    along = np.array([np.cos(turn), np.sin(turn)])
    across = np.array([-along[1], along[0]])
    ways = [(along, across), (across, along)]
    chosen = ways if rng.random() < 0.45 else ways[:1] if rng.random() < 0.7 else ways[1:]
    middle, reach = np.full(2, size / 2), 0.75 * size
    strokes = []
    for line, step in chosen:
        for at in np.arange(-reach + rng.uniform(0, pitch), reach, pitch):
            ends = middle + at * step + np.outer((-reach, reach), line)
            strokes.append(resample(ends.astype(np.float32), 8.0))
    return strokes, 2.5


MARKS: dict[Callable[[Rng, int], tuple[Strokes, float]], float] = {
    rows: 2.0,
    zigzag: 1.5,
    lettering: 1.5,
    frame: 1.0,
}


def mark(rng: Rng, size: int) -> tuple[Strokes, float]:
    """Marks of a random kind."""
    weights = np.fromiter(MARKS.values(), float)
    return list(MARKS)[rng.choice(len(weights), p=weights / weights.sum())](rng, size)
