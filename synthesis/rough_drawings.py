"""Rough drawings, and the lines that they mean: sketches, animators' keyframes, and hatching.

Sketches say every line by several strokes. Keyframes are dark and nearly single, with the pencil
lifted at corners, and lines that run on beyond them or do not reach them. Both may lie over
construction lines, or over an earlier, paler version of themselves. Hatching and fur mean what they
are.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from . import pencilling
from .composed_pages import Library
from .figures import SIDE as FIGURE_SIDE
from .figures import figure
from .held_out_pages import endless
from .line_art import Array, Rng, Strokes, pieces, resample, wobble
from .media import DIGITAL, MEDIA, Medium, draw, line_spacing, sample
from .pencilling import Hand, angular, construction, in_pieces, keyed, pencilled

MARGIN = 24  # px around the lines of a drawing
_BEYOND = 40  # px around a window of it, where its lines are cut off unseen
_SIZE = (0.35, 0.8)  # of a page of the benchmark's size: smaller ones are traced sooner
# Share of the pages whose lines hide each other, as in cartoons: most of what animators draw.
_FIGURES = {"sketch": 0.4, "keyframe": 0.75, "clean": 0.4}
_DENSEST = {"sketch": 8.0, "keyframe": 5.0, "animated": 4.0}  # px between the lines of a page
_PENS = (1.2, 4.5)  # px; width of a pencil at the scale at which pages are traced
_APART = 2.2  # pens between the lines of a page at least
_ANGULAR = 0.6  # share of the keyframes whose lines are straight from corner to corner
_LIFTED = 22.0  # degrees; corners of keyframes at which the pencil may be lifted
_PRESSED = ((0, 0.5), (0.5, 0.75), (0.75, 2))  # strokes in three layers, from light to dark
_EVEN = 0.6  # share of the dark ones on which strokes do not darken each other
_FIGURE = (330.0, 720.0)  # px; the longer side of an animator's figure
_FIRM = ("ink", "brushpen", "crisp", "crisp", "one bit")  # what a drawing program has for pencils


@dataclass(frozen=True, eq=False)
class RoughDrawing:
    """A rough drawing. lines: what it means, (N, 2) px each; ink: (size, size) in [0, 1]; pen: its
    width, px; spread: how far its strokes stray from the lines, px."""

    lines: Strokes
    ink: Array
    pen: float
    spread: float


def meant_lines(
    rng: Rng, library: Library, kind: str, sizes: tuple[float, float] = _SIZE
) -> Strokes:
    """True lines of a kind of page, all of them at one scale: they meet where they met."""
    if rng.random() < _FIGURES[kind]:
        whole = [line + MARGIN for line in figure(rng, library)]
    else:
        whole = next(endless(rng, library))
    scale = rng.uniform(*sizes)
    return [line.astype(np.float32) * np.float32(scale) for line in whole]


def is_too_dense(lines: Strokes, kind: str, size: int) -> bool:
    """Whether bundles of strokes about some lines could not be told from each other."""
    return line_spacing(sample(lines, size), size) < _DENSEST.get(kind, 0.0)


def straightened(rng: Rng, lines: Strokes) -> Strokes:
    """The lines of a keyframe: most animators draw straight from corner to corner."""
    return angular(lines, rng.uniform(1.0, 3.5)) if rng.random() < _ANGULAR else lines


def any_pen(rng: Rng) -> float:
    """The width of a pencil on a rough page, px."""
    return _log_uniform(rng, 1.2, 3.3)


def keyframing(rng: Rng, pen: float) -> Hand:
    """The hand of an animator: sure, nearly single strokes that run on beyond their ends."""
    spread = pen * rng.uniform(0.15, 1.2)
    length = _log_uniform(rng, 50, 300)
    return Hand(
        rng.uniform(1, 2.2), spread, spread * rng.uniform(0.2, 1), length, pen * rng.uniform(1, 5)
    )


def _animating(rng: Rng, pen: float, spacing: float) -> Hand:
    """As `keyframing`, or a hand that restarts more often and strays more."""
    hand = keyframing(rng, pen)
    if rng.random() < 0.4:
        length = _log_uniform(rng, 25, 120)
        hand = replace(hand, strokes=rng.uniform(1.5, 3.5), length=length)
        hand = replace(hand, spread=pen * rng.uniform(0.5, 1.7), over=pen * rng.uniform(2, 7))
    return replace(hand, spread=min(hand.spread, 0.3 * spacing))


def sketched(rng: Rng, lines: Strokes, hand: Hand, pen: float, size: int, sure: bool) -> Array:
    """(size, size) ink of some lines, drawn by a hand over construction lines.

    sure: as an animator draws a keyframe.
    """
    medium = MEDIA[str(rng.choice(pencilling.MEDIA))]
    strokes, press = _strokes(rng, lines, hand, sure)
    ink: Array = np.zeros((size, size), np.float32)
    light = construction(rng, size) if rng.random() < (0.3 if sure else 0.6) else []
    if light:
        ink = draw(rng, sample(light, size), medium, pen, size)[0] * rng.uniform(0.2, 0.6)
    dark = rng.random() < (0.7 if sure else 0.3)  # lines of a drawing program: all as dark
    return _pressed(rng, ink, strokes, press, medium, pen, dark)


def animated(rng: Rng, library: Library) -> RoughDrawing:
    """A whole figure as animators rough it out: small, single strokes, straight from corner to
    corner, where they stick out, drawn with a firm pen."""
    lines, size = _figure(rng, library)
    if rng.random() < 0.8:
        lines = angular(lines, _log_uniform(rng, 0.6, 3.0))
    pen = _log_uniform(rng, 1.1, 2.6)
    spread = pen * _log_uniform(rng, 0.05, 0.6)
    strokes = rng.uniform(1, 1.6) if rng.random() < 0.7 else rng.uniform(1.3, 2.4)
    drift, length = spread * rng.uniform(0.2, 1.0), _log_uniform(rng, 40, 300)
    over, short = pen * _log_uniform(rng, 0.7, 5.0), pen * rng.uniform(0, 1.2)
    hand = Hand(strokes, spread, drift, length, over, short, rng.uniform(6, 40))
    firm = (*_FIRM, "fineliner", "pencil") if rng.random() < 0.75 else pencilling.MEDIA
    medium = (MEDIA | DIGITAL)[str(rng.choice(firm))]
    parts = in_pieces(rng, lines, rng.uniform(0.5, 1), rng.uniform(15, 30))
    ink: Array = np.zeros((size, size), np.float32)
    if rng.random() < 0.15:
        ink = _underneath(rng, lines, hand, pen, medium, size)
    ink = _pressed(rng, ink, *keyed(rng, parts, hand), medium, pen, True)
    return RoughDrawing(lines, ink, pen, spread)


def _figure(rng: Rng, library: Library) -> tuple[Strokes, int]:
    """The lines of a figure, and the side of a page that it fills, px."""
    while True:
        scale = np.float32(_log_uniform(rng, *_FIGURE) / FIGURE_SIDE)
        lines = [line * scale + np.float32(MARGIN) for line in figure(rng, library)]
        size = int(np.ceil(np.max([line.max(0) for line in lines]) + MARGIN))
        if line_spacing(sample(lines, size), size) >= _DENSEST["animated"]:
            return lines, size


def _log_uniform(rng: Rng, low: float, high: float) -> float:
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def rough_drawing(rng: Rng, library: Library, kind: str, size: int) -> RoughDrawing:
    """A part of a random drawing that fills a page of size x size px.

    kind: "sketch", "keyframe" or "hatched".
    """
    pen = _log_uniform(rng, *_PENS)
    sure = kind == "keyframe"
    if kind == "hatched":
        return _patches(rng, int(rng.integers(2, 9)), pen, size)
    lines: Strokes = []
    spacing = 0.0
    while not lines or spacing < max(_DENSEST[kind], _APART * pen):
        lines = _windowed(rng, meant_lines(rng, library, kind, (0.4, 1.1)), size)
        spacing = line_spacing(sample(lines, size), size) if lines else 0.0
    lines = straightened(rng, lines) if sure else lines
    hand = _animating(rng, pen, spacing) if sure else Hand.any(rng, pen, 1.5 * spacing)
    hand = replace(hand, short=pen * rng.uniform(0, 2.0), centered=rng.uniform(6, 40))
    medium = _medium(rng, sure)
    under = _underneath(rng, lines, hand, pen, medium, size)
    strokes, press = _strokes(rng, lines, hand, sure)
    dark = bool(under.any()) or rng.random() < (0.7 if sure else 0.3)
    ink = _pressed(rng, under, strokes, press, medium, pen, dark)
    drawn = RoughDrawing(lines, ink, pen, hand.spread)
    if rng.random() < 0.2:
        hatched = _patches(rng, int(rng.integers(1, 4)), pen, size)
        ink = np.maximum(ink, hatched.ink * rng.uniform(0.6, 1.0))
        drawn = replace(drawn, lines=lines + hatched.lines, ink=ink)
    return drawn


def _strokes(rng: Rng, lines: Strokes, hand: Hand, sure: bool) -> tuple[Strokes, Array]:
    if sure:
        return keyed(rng, in_pieces(rng, lines, rng.uniform(0.3, 1), _LIFTED), hand)
    return pencilled(rng, lines, hand)


def _pressed(
    rng: Rng, ink: Array, strokes: Strokes, press: Array, medium: Medium, pen: float, dark: bool
) -> Array:
    """The ink with pencil strokes over it, from light to dark; dark: all of them about as dark."""
    size = len(ink)
    layers = [(0, 2)] if dark and rng.random() < _EVEN else _PRESSED
    for low, high in layers:
        chosen = [s for s, p in zip(strokes, press, strict=True) if low <= p < high]
        if chosen:
            layer = draw(rng, sample(chosen, size), medium, pen, size)[0]
            ink = 1 - (1 - ink) * (1 - layer * (rng.uniform(0.8, 1) if dark else min(high, 1.0)))
    return ink


def _medium(rng: Rng, sure: bool) -> Medium:
    firm = rng.random() < (0.5 if sure else 0.12)
    return (MEDIA | DIGITAL)[str(rng.choice(_FIRM if firm else pencilling.MEDIA))]


def _windowed(rng: Rng, lines: Strokes, size: int) -> Strokes:
    """What of some lines lies in a window of a drawing, moved into it; of two the fuller one."""
    dense = [resample(line, 4.0) for line in lines]
    packed = np.concatenate(dense)
    low = packed.min(0) - MARGIN
    spare = packed.max(0) + MARGIN - low - size
    corners = low + rng.random((2, 2)) * spare
    shown = [((packed > c) & (packed < c + size)).all(1).sum() for c in corners]
    corner = corners[int(np.argmax(shown))]
    moved = [(line - corner).astype(np.float32) for line in dense]
    near = [((line > -_BEYOND) & (line < size + _BEYOND)).all(1) for line in moved]
    runs = [run for line, kept in zip(moved, near, strict=True) for run in pieces(line, kept)]
    return [run for run in runs if len(run) > 1]


def _underneath(
    rng: Rng, lines: Strokes, hand: Hand, pen: float, medium: Medium, size: int
) -> Array:
    """What was drawn first and means nothing any more: construction lines, paler than the rest, and
    an earlier version of the drawing."""
    ink: Array = np.zeros((size, size), np.float32)
    light = construction(rng, size) if rng.random() < 0.4 else []
    if rng.random() < 0.3:
        moved = wobble(
            rng,
            [resample(line, 4.0) for line in lines],
            pen * rng.uniform(0.5, 2.5),
            rng.uniform(80, 400),
        )
        kept = [line for line in moved if rng.random() < 0.8]
        earlier = replace(hand, strokes=rng.uniform(1, 2.5), spread=1.5 * hand.spread, centered=0.0)
        light = light + pencilled(rng, kept, earlier)[0]
    if light:
        ink = draw(rng, sample(light, size), medium, pen * rng.uniform(0.8, 1.5), size)[0]
    return ink * rng.uniform(0.12, 0.5)


def _patches(rng: Rng, count: int, pen: float, size: int) -> RoughDrawing:
    """Hatching, fur, and lines beside each other, each drawn once."""
    lines: Strokes = []
    for _ in range(count):
        lines += patch(rng, pen, size) if rng.random() < 0.7 else contours(rng, pen, size)
    lines = [line.astype(np.float32) for line in lines]
    ink = draw(rng, sample(lines, size), _medium(rng, False), pen, size)[0]
    return RoughDrawing(lines, ink, pen, 0.0)


def patch(rng: Rng, pen: float, side: int) -> Strokes:
    """Hatching, or fur: strokes of about one length at about even distances, on a page of so many
    px."""
    apart = pen * rng.uniform(1.7, 5.0)
    count, length = int(rng.integers(4, 30)), float(np.exp(rng.uniform(np.log(15), np.log(220))))
    loose, turn = rng.uniform(0.02, 0.25), rng.uniform(0, np.pi)
    bend = rng.normal(0, 0.3)
    along = np.array([np.cos(turn), np.sin(turn)])
    across = np.array([-along[1], along[0]])
    middle = rng.uniform(0.2, 0.8, 2) * side
    slant, fan = rng.normal(0, 0.3) * along, rng.normal(0, 0.02) * rng.random()
    strokes = []
    for k in range(count):
        half = 0.5 * length * (1 + loose * rng.normal())
        t = np.linspace(-1, 1, max(3, int(abs(half)) + 2))[:, None]
        tilt = fan * (k - count / 2) + 0.15 * loose * rng.normal()
        start = middle + apart * (k - count / 2 + loose * rng.normal()) * (across + slant)
        start = start + loose * length * 0.3 * rng.normal() * along
        strokes.append(start + half * (t * (along + tilt * across) + bend * t * t * across))
    return strokes


def contours(rng: Rng, pen: float, side: int) -> Strokes:
    """Two or three lines that run beside each other for long: a belt, a seam, a rope."""
    turn, radius = rng.uniform(0, 2 * np.pi), rng.uniform(60, 400)
    span = min(rng.uniform(60, 350) / radius, 4.0)
    center = rng.uniform(0.2, 0.8, 2) * side - radius * np.array([np.cos(turn), np.sin(turn)])
    angle = np.linspace(turn - span / 2, turn + span / 2, max(4, int(span * radius / 2)))
    way = np.stack([np.cos(angle), np.sin(angle)], 1)
    apart = pen * rng.uniform(2.2, 6)
    return [
        center + (radius + apart * (k + rng.normal(0, 0.03))) * way
        for k in range(int(rng.integers(2, 4)))
    ]
