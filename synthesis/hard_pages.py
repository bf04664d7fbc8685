"""Held-out pages with the truth that the limits of the scan stage are chosen by.

A page of several pens says which of its pixels are broad lines, and which are shapes, bundles of
fine lines and fine lines; a sheet ruled on both sides says which are rules and which are drawn; a
page with close hatching says where its ink is, and where paper is bare.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from .extra_marks import rows
from .line_art import Array, Rng, Strokes
from .media import MEDIA, draw, line_spacing, noise, sample
from .sheet_of_paper import paper, scan, shadow

_FINE = ("technical pen", "ink", "fineliner", "ballpoint", "pencil")
_BROAD = ("marker", "brush", "brushpen", "soft pencil", "charcoal", "technical pen")
_TIMES, _BROADEST = (3.5, 14.0), 60.0  # pens, and px, that a broad line is wide
_LONG = 4.0  # widths; what is shorter may be line or shape, and counts as neither
_RULED = (14.0, 70.0)  # px between rules
_GRAINY = ("charcoal", "soft pencil", "pencil", "coloured pencil", "ballpoint", "ink")
_CLOSE = (0.8, 1.8)  # pens from one line of dense hatching to the next


@dataclass(frozen=True, eq=False)
class HardPage:
    """gray: (S, S) uint8, as scanned. wanted, other: (S, S) bool, pixels that a step should take
    and should leave; what is neither counts for nothing. kind: what it is a page of."""

    gray: Array
    wanted: Array
    other: Array
    kind: str


def several_pens(rng: Rng, strokes: Strokes, size: int) -> HardPage:
    """A drawing of a fine pen with 0 to 4 broad lines, shapes, and bundles of lines beside it.

    wanted: the broad lines. other: all other ink.
    """
    fine = rng.uniform(2, 5)
    broad = min(fine * float(np.exp(rng.uniform(*np.log(_TIMES)))), _BROADEST)
    length = np.array([np.hypot(*np.diff(line, axis=0).T).sum() for line in strokes])
    may = rng.permutation(np.flatnonzero(length > _LONG * broad))
    chosen = may[: int(rng.choice([0, 1, 1, 2, 3, 4]))]
    rest = [line for k, line in enumerate(strokes) if k not in set(chosen.tolist())]
    wanted = _drawn(rng, [strokes[k] for k in chosen], str(rng.choice(_BROAD)), broad, size)
    other = _drawn(rng, rest, str(rng.choice(_FINE)), fine, size)
    for _ in range(rng.choice([0, 1, 2])):
        other = np.maximum(other, _shape(rng, size))
    if rng.random() < 0.4:
        bundle, widest = rows(rng, size)
        medium = str(rng.choice(_FINE))
        other = np.maximum(other, _drawn(rng, bundle, medium, min(widest, 1.5 * fine), size))
    ink = 1 - (1 - wanted) * (1 - other)
    page = _scanned(rng, ink, rng.uniform(0.8, 1.0))
    return HardPage(page, wanted > 0.3, (other > 0.3) & (wanted < 0.1), "several pens")


def ruled_sheet(rng: Rng, strokes: Strokes, size: int) -> HardPage:
    """A drawing on a sheet: ruled on the front, on both sides, or not at all but with even rows
    of lines drawn on it.

    wanted: the rules where nothing is drawn. other: the drawing.
    """
    kind = str(rng.choice(["front", "both sides", "both sides", "drawn rows"]))
    drawn = _drawn(rng, strokes, str(rng.choice(_FINE)), rng.uniform(2, 4.5), size)
    if kind == "drawn rows":
        lines, widest = rows(rng, size)
        drawn = np.maximum(drawn, _drawn(rng, lines, "ink", min(widest, 3.0), size))
    pitch = float(np.exp(rng.uniform(*np.log(_RULED))))
    turn, half = rng.normal(0, 0.01), rng.uniform(0.6, 1.2)
    tone = rng.uniform(0.15, 0.45)
    rules: Array = np.zeros((size, size), np.float32)
    if kind != "drawn rows":
        rules = tone * _rules(size, pitch, turn, half, rng.uniform(0, pitch))
    if kind == "both sides":
        # The back is turned over: it lies the other way round, a little softer and paler.
        back = _rules(size, pitch, -turn + rng.normal(0, 0.004), half, rng.uniform(0, pitch))
        back = cv2.GaussianBlur(back, (0, 0), rng.uniform(0.5, 1.2))
        rules = 1 - (1 - rules) * (1 - tone * rng.uniform(0.15, 0.6) * back)
    ink = 1 - (1 - drawn) * (1 - rules)
    page = _scanned(rng, ink, rng.uniform(0.8, 1.0))
    return HardPage(page, (rules > 0.05) & (drawn < 0.02), drawn > 0.4, kind)


def both_sides(rng: Rng, strokes: Strokes, behind: Strokes, size: int) -> HardPage:
    """A drawing on a sheet through which the drawing on its back shows, or pencil under it, or
    nothing of either.

    wanted: what shows through where nothing is drawn. other: the drawing, and its pencil.
    """
    kind = str(rng.choice(["back", "back", "pencil", "front"]))
    drawn = _drawn(rng, strokes, str(rng.choice(_FINE[:4])), rng.uniform(2, 4.5), size)
    medium = str(rng.choice(_FINE)) if kind == "back" else "pencil"
    other = _drawn(rng, behind, medium, rng.uniform(2, 4.5), size)
    if kind == "back":
        other = cv2.GaussianBlur(other[:, ::-1], (0, 0), rng.uniform(1.8, 4))
        other = other * rng.uniform(0.12, 0.4) / max(float(np.quantile(other, 0.995)), 0.1)
    other = (
        np.clip(other, 0, 1) * {"back": 1.0, "pencil": rng.uniform(0.3, 0.6), "front": 0.0}[kind]
    )
    page = _scanned(rng, 1 - (1 - drawn) * (1 - other), rng.uniform(0.8, 1.0))
    pale = (other > 0.06) & (drawn < 0.02)
    kept = drawn > 0.4
    if kind == "pencil":
        return HardPage(page, np.zeros_like(pale), kept | (pale & (other > 0.2)), kind)
    return HardPage(page, pale, kept, kind)


def hatched(rng: Rng, strokes: Strokes, size: int) -> HardPage:
    """A drawing with 0 to 4 patches of hatching whose lines nearly touch, on uneven paper.

    wanted: the hatching's ink. other: paper away from all ink.
    """
    medium, pen = str(rng.choice(_GRAINY)), rng.uniform(2, 5)
    ink = _drawn(rng, strokes, medium, pen, size)
    hatching = np.zeros_like(ink)
    for _ in range(rng.choice([0, 1, 2, 4])):
        patch = _patch(rng, size, pen * rng.uniform(*_CLOSE))
        samples = sample(patch, size)
        if len(samples) > 1:
            hatching = np.maximum(hatching, draw(rng, samples, MEDIA[medium], pen, size)[0])
    ink = 1 - (1 - ink) * (1 - hatching)
    sheet = paper(rng, size, float(np.median(ink[ink > 0.1])), printed=0.0)
    full = float(np.quantile(ink[ink > 0.25], 0.8)) if (ink > 0.25).any() else 1.0
    bare = cv2.dilate((ink > 0.05 * full).astype(np.uint8), np.ones((7, 7), np.uint8)) == 0
    return HardPage(_scanned(rng, ink, sheet), hatching > 0.5 * full, bare, medium)


def _patch(rng: Rng, size: int, gap: float) -> Strokes:
    """Lines of a hand, 30 to 200 px long, side by side."""
    long, broad = rng.uniform(30, 200), rng.uniform(20, 160)
    turn, (x, y) = rng.uniform(0, np.pi), rng.uniform(0.1, 0.9, 2) * size
    along = np.array([np.cos(turn), np.sin(turn)])
    across = np.array([-along[1], along[0]])
    t = np.linspace(0, 1, 12)[:, None]
    lines = []
    for at in np.arange(0, broad, gap):
        near, far = rng.normal(0, 0.15 * gap, 2)
        start, end = rng.normal(0, 1.5, 2)
        bend = rng.normal(0, 0.1 * gap) * np.sin(np.pi * t)
        line = (start + t * (long + end - start)) * along
        lines.append(line + (at + near + t * (far - near) + bend) * across + (x, y))
    return [line.astype(np.float32) for line in lines]


def _drawn(rng: Rng, strokes: Strokes, medium: str, pen: float, size: int) -> Array:
    """(size, size) ink of some strokes; a fine pen is no wider than its lines lie apart."""
    lines = [line.astype(np.float32) for line in strokes if len(line) > 1]
    samples = sample(lines, size) if lines else None
    if samples is None or len(samples) < 2:
        return np.zeros((size, size), np.float32)
    if pen < 6:
        pen = min(pen, max(1.2, 0.8 * line_spacing(samples, size)))
    return draw(rng, samples, MEDIA[medium], pen, size)[0]


def _shape(rng: Rng, size: int) -> Array:
    """A filled shape of uneven outline, up to three times as long as wide."""
    corner = np.sort(rng.uniform(0, 2 * np.pi, int(rng.integers(5, 20))))
    reach = rng.uniform(0.02, 0.12) * size * rng.uniform(0.6, 1.4, len(corner))
    long = rng.uniform(1, 3)
    outline = np.stack([np.cos(corner) * long, np.sin(corner)], 1) * reach[:, None]
    turn = rng.uniform(0, np.pi)
    way = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    place = outline @ way + rng.uniform(0.1, 0.9, 2) * size
    mask = np.zeros((size, size), np.uint8)
    cv2.fillPoly(mask, [np.round(place * 16).astype(np.int32)], 255, cv2.LINE_AA, 4)
    return mask.astype(np.float32) / 255


def _rules(size: int, pitch: float, turn: float, half: float, start: float) -> Array:
    y, x = np.mgrid[:size, :size].astype(np.float32) + 0.5
    off = np.abs((y - turn * x + start) % pitch - pitch / 2)
    return np.clip(half + 0.5 - off, 0, 1)


def _scanned(rng: Rng, ink: Array, sheet: float | Array) -> Array:
    """(S, S) uint8 of ink on paper with some grain, scanned; sheet: the paper's tone."""
    grainy = sheet + rng.uniform(0, 0.02) * noise(rng, "grain", len(ink))
    page = grainy * (1 - ink) + rng.uniform(0, 0.1) * ink
    if rng.random() < 0.3:
        page = page * shadow(rng, len(ink))
    return np.round(np.clip(scan(rng, page), 0, 1) * 255).astype(np.uint8)
