"""Rough drawings: every line said by several pencil strokes, among construction lines."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import cv2
import numpy as np

from .line_art import Array, Rng, Strokes, resample

MEDIA = ("pencil", "soft pencil", "pencil", "coloured pencil", "ballpoint", "charcoal", "fineliner")


_AT_ONCE = 4  # samples of 2 px, within which a corner turns


@dataclass(frozen=True)
class Hand:
    """How somebody sketches. strokes: how many lie over each point of a line; spread, drift: how
    far they stray to the side, px; length: of one stroke, px; over: beyond the ends, px."""

    strokes: float
    spread: float
    drift: float
    length: float
    over: float

    @staticmethod
    def any(rng: Rng, pen: float, spacing: float) -> Hand:
        """A hand whose bundles stay apart where lines are `spacing` px apart."""
        spread = min(pen * rng.uniform(0.3, 2.2), 0.2 * spacing)
        return Hand(
            rng.uniform(1.6, 6),
            spread,
            spread * rng.uniform(0.2, 1.0),
            float(np.exp(rng.uniform(np.log(40), np.log(300)))),
            pen * rng.uniform(0.5, 5),
        )


def pencilled(rng: Rng, lines: Strokes, hand: Hand) -> tuple[Strokes, Array]:
    """The pencil strokes of some lines and how hard each is pressed, (N,) in (0, 1]."""
    strokes: Strokes = []
    press: list[float] = []
    for line in lines:
        dense = resample(line, 2.0)
        arc = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(dense, axis=0).T))])
        length = min(hand.length, arc[-1])
        count = max(1, round(hand.strokes * arc[-1] / max(length, 1.0)))
        middle = (np.arange(count) + 0.5) / count * arc[-1] + rng.normal(0, 0.15 * length, count)
        sure = rng.integers(count) if rng.random() < 0.7 else -1
        for k in range(count):
            half = 0.5 * length * rng.uniform(0.6, 1.4)
            part = _along(rng, dense, arc, middle[k] - half, middle[k] + half, hand, k == sure)
            if part is not None:
                strokes.append(part)
                press.append(1.0 if k == sure else rng.uniform(0.3, 0.85))
    return strokes, np.array(press)


def keyed(rng: Rng, lines: Strokes, hand: Hand) -> tuple[Strokes, Array]:
    """The strokes of an animator's keyframe, and how hard each is pressed: every line is said from
    end to end, stroke after stroke, and some stretches of it again."""
    strokes: Strokes = []
    press: list[float] = []
    for line in lines:
        dense = resample(line, 2.0)
        arc = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(dense, axis=0).T))])
        at = -np.inf
        while at < arc[-1]:
            begin = max(at, 0.0)
            stop = begin + hand.length * rng.uniform(0.5, 1.5)
            stop = np.inf if arc[-1] - stop < 0.4 * hand.length else stop
            spans = [(at, stop)]
            for _ in range(rng.poisson(max(hand.strokes - 1, 0.0))):
                a, b = np.sort(rng.uniform(begin, min(stop, arc[-1]), 2))
                spans.append((a if rng.random() < 0.6 else at, b if rng.random() < 0.6 else stop))
            for k, (a, b) in enumerate(spans):
                part = _along(rng, dense, arc, a, b, hand, k == 0)
                if part is not None:
                    strokes.append(part)
                    press.append(1.0 if k == 0 else rng.uniform(0.6, 1.0))
            at = stop - hand.over * rng.uniform(-0.15, 2.0)
    return strokes, np.array(press)


def angular(lines: Strokes, tolerance: float) -> Strokes:
    """Lines as somebody draws them who thinks in straight strokes, within so many px of them."""
    curves = [line.astype(np.float32)[:, None] for line in lines]
    straight = [cv2.approxPolyDP(curve, tolerance, False)[:, 0] for curve in curves]
    return [one for one in straight if len(one) > 1]


def _along(
    rng: Rng, line: Array, arc: Array, start: float, stop: float, hand: Hand, sure: bool
) -> Array | None:
    """One pencil stroke beside a piece of a line; it may run on straight beyond the line's ends."""
    over = hand.over * rng.exponential(1.0, 2) * (rng.random(2) < 0.6)
    start, stop = max(start, -over[0]), min(stop, arc[-1] + over[1])
    if stop - start < 4:
        return None
    at = np.linspace(start, stop, max(6, int((stop - start) / 2)))
    points = np.stack([np.interp(at, arc, line[:, c]) for c in (0, 1)], 1)
    for end, far in ((0, np.minimum(at, 0)), (-1, np.maximum(at - arc[-1], 0))):
        out = line[end] - line[min(4, len(line) - 1) if end == 0 else max(-5, -len(line))]
        points += np.abs(far)[:, None] * out / max(float(np.hypot(*out)), 1e-6)
    tangent = np.gradient(points, axis=0)
    normal = np.stack([-tangent[:, 1], tangent[:, 0]], 1)
    normal /= np.maximum(np.hypot(*tangent.T), 1e-6)[:, None]
    t = np.linspace(-1, 1, len(at))
    aside = rng.normal(0, hand.spread) + t * rng.normal(0, hand.drift)
    aside = aside + rng.normal(0, 0.4 * hand.drift) * np.sin(
        rng.uniform(2, 6) * t + rng.uniform(0, 7)
    )
    return (points + normal * (aside * (0.4 if sure else 1.0))[:, None]).astype(np.float32)


def in_pieces(rng: Rng, lines: Strokes, share: float, sharp: float = 40.0) -> Strokes:
    """Lines cut at that share of their corners, as somebody draws who lifts the pencil there.

    sharp: degrees by which a line turns within a few px where it has a corner.
    """
    pieces: Strokes = []
    for line in lines:
        dense = resample(line, 2.0)
        way = np.diff(dense, axis=0)
        heading = np.unwrap(np.arctan2(way[:, 1], way[:, 0]))
        turn = np.abs(heading[_AT_ONCE:] - heading[:-_AT_ONCE]) if len(heading) > _AT_ONCE else []
        cuts, last = [0], -2 * _AT_ONCE
        for at in np.flatnonzero(np.asarray(turn) > np.radians(sharp)):
            if at - last > 2 * _AT_ONCE and rng.random() < share:
                cuts.append(int(at) + _AT_ONCE // 2 + 1)
            last = at
        cuts.append(len(dense) - 1)
        pieces += [dense[a : b + 1] for a, b in pairwise(cuts) if b - a >= 2]
    return pieces


def construction(rng: Rng, size: int) -> Strokes:
    """Light lines that belong to nothing: axes, ellipses, sweeps."""
    strokes: Strokes = []
    for _ in range(rng.integers(0, 5)):
        center, reach = rng.uniform(0.1, 0.9, 2) * size, rng.uniform(0.15, 0.8) * size
        turn = rng.uniform(0, np.pi)
        along = np.array([np.cos(turn), np.sin(turn)])
        across = np.array([-along[1], along[0]])
        if rng.random() < 0.5:
            t = np.linspace(-1, 1, 40)[:, None]
            line = center + reach * (t * along + rng.normal(0, 0.05) * t * t * across)
        else:
            a = np.linspace(0, rng.uniform(4, 11), 120)[:, None]
            flat = rng.uniform(0.3, 1.0)
            line = center + 0.5 * reach * (np.cos(a) * along + flat * np.sin(a) * across)
            line = line + rng.normal(0, 2, 2) * a / 6
        strokes.append(resample(line.astype(np.float32), 4.0))
    return strokes
