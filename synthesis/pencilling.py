"""Rough drawings: every line said by several pencil strokes, among construction lines."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import cv2
import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.spatial import cKDTree

from .line_art import Array, Rng, Strokes, resample

MEDIA = ("pencil", "soft pencil", "pencil", "coloured pencil", "ballpoint", "charcoal", "fineliner")


_AT_ONCE = 4  # samples of 2 px, within which a corner turns
_STEP = 2.0  # px between the samples of a line
_TOUCHES = 3.0  # px between the end of a line and another that it meets
_OFF = 0.06  # of the size of a line, that straight strokes may lie off it
_LOOSE = 0.25  # of what strokes run on beyond a meeting, what they do where a line just ends


@dataclass(frozen=True)
class Hand:
    """How somebody sketches. strokes: how many lie over each point of a line; spread, drift: how
    far they stray to the side, px; length: of one stroke, px; over: beyond the ends, px; short:
    before them, px. centered: px along a line over which its strokes are as often on one side of
    it as on the other, so that the line can be told from them; 0: over all of it at best."""

    strokes: float
    spread: float
    drift: float
    length: float
    over: float
    short: float = 0.0
    centered: float = 0.0

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
    strokes: list[_Stroke] = []
    for line, loose in zip(lines, _loose_ends(lines, hand), strict=True):
        course = _Course.of(line)
        length = min(hand.length, course.length)
        count = max(1, round(hand.strokes * course.length / max(length, 1.0)))
        middle = (np.arange(count) + 0.5) / count * course.length
        middle = middle + rng.normal(0, 0.15 * length, count)
        sure = rng.integers(count) if rng.random() < 0.7 else -1
        own: list[_Stroke] = []
        for k in range(count):
            half = 0.5 * length * rng.uniform(0.6, 1.4)
            span = middle[k] - half, middle[k] + half
            part = course.stroke(rng, span, hand, loose, k == sure)
            if part is not None:
                own.append(replace(part, press=1.0 if k == sure else rng.uniform(0.3, 0.85)))
        strokes += _centered(own, hand)
    return _laid(strokes)


def keyed(rng: Rng, lines: Strokes, hand: Hand) -> tuple[Strokes, Array]:
    """The strokes of an animator's keyframe, and how hard each is pressed: every line is said from
    end to end, stroke after stroke, and some stretches of it again."""
    strokes: list[_Stroke] = []
    for line, loose in zip(lines, _loose_ends(lines, hand), strict=True):
        course, own = _Course.of(line), []
        at = -np.inf
        while at < course.length:
            begin = max(at, 0.0)
            stop = begin + hand.length * rng.uniform(0.5, 1.5)
            stop = np.inf if course.length - stop < 0.4 * hand.length else stop
            spans = [(at, stop)]
            for _ in range(rng.poisson(max(hand.strokes - 1, 0.0))):
                a, b = np.sort(rng.uniform(begin, min(stop, course.length), 2))
                spans.append((a if rng.random() < 0.6 else at, b if rng.random() < 0.6 else stop))
            for k, span in enumerate(spans):
                part = course.stroke(rng, span, hand, loose, k == 0)
                if part is not None:
                    own.append(replace(part, press=1.0 if k == 0 else rng.uniform(0.6, 1.0)))
            at = stop - hand.over * rng.uniform(-0.15, 2.0)
        strokes += _centered(own, hand)
    return _laid(strokes)


def angular(lines: Strokes, tolerance: float) -> Strokes:
    """Lines as somebody draws them who thinks in straight strokes, within so many px of them, or
    less where a line is small."""
    curves = [line.astype(np.float32)[:, None] for line in lines]
    off = [min(tolerance, _OFF * float(np.ptp(line, 0).max())) for line in lines]
    straight = [cv2.approxPolyDP(c, t, False)[:, 0] for c, t in zip(curves, off, strict=True)]
    return [one for one in straight if len(one) > 1]


@dataclass(frozen=True, eq=False)
class _Course:
    """A line to be drawn. points: (N, 2) every _STEP px; arc: (N,) px."""

    points: Array
    arc: Array

    @staticmethod
    def of(line: Array) -> _Course:
        dense = resample(line, _STEP)
        return _Course(
            dense, np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(dense, axis=0).T))])
        )

    @property
    def length(self) -> float:
        return float(self.arc[-1])

    def stroke(
        self, rng: Rng, span: tuple[float, float], hand: Hand, loose: Array, sure: bool
    ) -> _Stroke | None:
        """One pencil stroke beside a piece of the line, from px to px along it; it may run on
        straight beyond the line's ends, less where they are loose, or not reach them."""
        over = hand.over * rng.exponential(1.0, 2) * (rng.random(2) < 0.6)
        if hand.short:
            over = over - hand.short * rng.exponential(1.0, 2) * (rng.random(2) < 0.4)
        over = over * np.where(loose, _LOOSE, 1.0)
        start, stop = max(span[0], -over[0]), min(span[1], self.length + over[1])
        if stop - start < 4:
            return None
        at = np.linspace(start, stop, max(6, int((stop - start) / _STEP)))
        t = np.linspace(-1, 1, len(at))
        aside = rng.normal(0, hand.spread) + t * rng.normal(0, hand.drift)
        aside = aside + rng.normal(0, 0.4 * hand.drift) * np.sin(
            rng.uniform(2, 6) * t + rng.uniform(0, 7)
        )
        return _Stroke(self, at, aside * (0.4 if sure else 1.0))


@dataclass(frozen=True, eq=False)
class _Stroke:
    """A pencil stroke beside a line. at, aside: (N,) px along it and to the left of it."""

    course: _Course
    at: Array
    aside: Array
    press: float = 1.0

    def laid(self) -> Array:
        """(N, 2) float32 px: where it lies."""
        at, arc, line = self.at, self.course.arc, self.course.points
        points = np.stack([np.interp(at, arc, line[:, c]) for c in (0, 1)], 1)
        for end, far in ((0, np.minimum(at, 0)), (-1, np.maximum(at - arc[-1], 0))):
            out = line[end] - line[min(4, len(line) - 1) if end == 0 else max(-5, -len(line))]
            points += np.abs(far)[:, None] * out / max(float(np.hypot(*out)), 1e-6)
        tangent = np.gradient(points, axis=0)
        normal = np.stack([-tangent[:, 1], tangent[:, 0]], 1)
        normal /= np.maximum(np.hypot(*tangent.T), 1e-6)[:, None]
        return (points + normal * self.aside[:, None]).astype(np.float32)


def _laid(strokes: list[_Stroke]) -> tuple[Strokes, Array]:
    return [one.laid() for one in strokes], np.array([one.press for one in strokes])


def _centered(strokes: list[_Stroke], hand: Hand) -> list[_Stroke]:
    """The strokes of one line, moved so that the line lies amid them, the firmer ones nearest."""
    if not hand.centered or not strokes:
        return strokes
    bins = np.arange(0, strokes[0].course.length + _STEP, _STEP)
    weight, moved = np.full((2, len(bins)), 1e-6)
    for one in strokes:
        held = one.press * ((bins >= one.at[0] - _STEP) & (bins <= one.at[-1] + _STEP))
        weight += held
        moved += held * np.interp(bins, one.at, one.aside)
    weight, moved = gaussian_filter1d([weight, moved], hand.centered / _STEP, mode="nearest")
    middle = (moved - 1e-6) / weight
    return [replace(s, aside=s.aside - np.interp(s.at, bins, middle)) for s in strokes]


def _loose_ends(lines: Strokes, hand: Hand) -> Array:
    """(L, 2) bool: the ends of lines that meet no other line, of a hand that minds them."""
    if not hand.centered or len(lines) < 2:
        return np.zeros((len(lines), 2), bool)
    dense = [resample(line, _STEP) for line in lines]
    points, line = np.concatenate(dense), np.repeat(np.arange(len(dense)), [len(d) for d in dense])
    ends = np.concatenate([one[[0, -1]] for one in dense])
    own = np.repeat(np.arange(len(dense)), 2)
    away, near = cKDTree(points).query(ends, k=12, distance_upper_bound=_TOUCHES)
    other = line[np.minimum(near, len(line) - 1)] != own[:, None]
    return ~(np.isfinite(away) & other).any(1).reshape(-1, 2)


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
