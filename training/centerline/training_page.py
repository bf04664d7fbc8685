"""One synthetic page: ink as the network gets it, and its targets."""

from __future__ import annotations

import cv2
import numpy as np
from involute.engine.scan.paper import flatten_paper

from ...synthesis.line_art import Array, Library, Rng, Strokes, broken, invented, true_drawing
from ...synthesis.media import MEDIA, Medium, Samples, draw, line_spacing, noise, sample
from ...synthesis.sheet_of_paper import clean, paper, scan, shadow
from ...synthesis.wear import dust
from .targets import MAX_HALF_WIDTH, Targets, targets

_MIN_SPACING = 2.7  # px; denser hatching is a tone, not lines
_SEEN_OVER = 49  # samples of half a px
# Channels of a page, all uint8: value = 255 * map, half-width = 255 * px / MAX_HALF_WIDTH.
CHANNELS = ("ink", "centerline", "junctions", "endpoints", "half_width", "solid")


def page(
    rng: Rng, library: Library, size: int, held_out: bool = False, only: str | None = None
) -> Array:
    """A page as (6, size, size) uint8, channels as in CHANNELS.

    The same generator state gives the same page; held_out picks from the validation drawings,
    only names the one medium to draw with.
    """
    drawings = _compose(rng, library, size, held_out)
    ink = np.zeros((size, size), np.float32)
    all_samples, halves = [], []
    medium = _medium(rng, only)
    pen = _pen(rng, medium)
    faint = rng.uniform(0.12, 0.5) if rng.random() < 0.12 else 1.0
    for strokes, widest in drawings:
        if rng.random() < 0.25:
            medium = _medium(rng, only)
            pen = _pen(rng, medium)
        samples = sample(strokes, size)
        spacing = line_spacing(samples, size)
        if len(samples) < 2 or spacing < _MIN_SPACING:
            continue
        if rng.random() < 0.9:
            widest = min(widest, 0.8 * spacing)
        width = max(1.0, min(pen * rng.uniform(0.9, 1.1), widest))
        if medium.grain[1] <= 0.3 and rng.random() < 0.15:
            samples = sample(broken(rng, strokes, width + 1.5) or strokes, size)
            if len(samples) < 2:
                continue
        layer, half = draw(rng, samples, medium, width, size)
        own = faint if rng.random() < 0.85 else rng.uniform(0.2, 0.9)
        ink = 1 - (1 - ink) * (1 - layer * own)
        all_samples.append(samples)
        halves.append(half)
    solid = _solids(rng, size) if rng.random() < 0.15 else np.zeros_like(ink)
    ink = 1 - (1 - ink) * (1 - solid * rng.uniform(0.85, 1.0))
    gray = _photograph(rng, ink, library, size, held_out)
    cleaned = flatten_paper(gray) if rng.random() < 0.7 else clean(rng, gray)
    maps = _targets(all_samples, halves, cleaned)
    return _pack(cleaned, maps, (solid < 0.5).astype(np.float32), solid)


def _compose(rng: Rng, library: Library, size: int, held_out: bool) -> list[tuple[Strokes, float]]:
    """Up to four drawings, true ones and invented ones, over each other."""
    kind = rng.random()
    if kind < 0.06:
        return []
    if kind < 0.12:  # a nearly blank sheet
        strokes, widest = true_drawing(rng, library, size, held_out, (0.1, 0.5))
        return [(_sane(strokes, size), widest)] if strokes else []
    drawings = []
    for _ in range(rng.choice([1, 2, 2, 3, 4])):
        if rng.random() < 0.68:
            drawings.append(true_drawing(rng, library, size, held_out))
        else:
            drawings.append(invented(rng, size))
    return [(_sane(strokes, size), widest) for strokes, widest in drawings if strokes]


def _sane(strokes: Strokes, size: int) -> Strokes:
    """Strokes that come near the page at all; at most 3000 of them."""
    near = [
        s for s in strokes if len(s) > 1 and (s.max(0) > -40).all() and (s.min(0) < size + 40).all()
    ]
    return near[:3000] or [np.full((2, 2), -1e4, np.float32)]


def _medium(rng: Rng, only: str | None) -> Medium:
    return MEDIA[only or str(rng.choice(list(MEDIA)))]


def _pen(rng: Rng, medium: Medium) -> float:
    """Full width, px: the medium's own range, pulled towards the 1.5 to 8 px of a working page."""
    low, high = medium.width
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def _targets(samples: list[Samples], halves: list[Array], ink: Array) -> Targets:
    """The maps of all strokes that can be seen in the ink."""
    size = len(ink)
    if samples:
        merged, half = Samples.merge(samples), np.concatenate(halves)
        seen = _visible(merged.position, ink)
        if np.count_nonzero(seen) > 1:
            return targets(merged.take(seen), half[seen], size)
    blank = np.zeros((size, size), np.float32)
    return Targets(blank, blank, blank, blank)


def _visible(points: Array, ink: Array) -> Array:
    """Which of (N, 2) samples along strokes show: most of the 24 px along them is inked.

    Nobody can trace what the paper's grain has swallowed. Points off the page count as well.
    """
    inked = cv2.dilate(ink, np.ones((3, 3), np.uint8)) > 0.035
    cell = np.clip(points.astype(int), 0, len(ink) - 1)
    near = np.convolve(inked[cell[:, 1], cell[:, 0]], np.full(_SEEN_OVER, 1 / _SEEN_OVER), "same")
    # On grainy paper a stroke must do better than the grain.
    return near[: len(points)] > max(0.42, min(0.9, 0.3 + inked.mean()))


def _solids(rng: Rng, size: int) -> Array:
    """Solid black areas: smooth or angular closed shapes at least 20 px across; (size, size)."""
    mask = np.zeros((size, size), np.uint8)
    for _ in range(rng.integers(1, 4)):
        count = int(rng.choice([3, 4, 5, 7, 40, 60]))
        turn = (
            np.sort(rng.uniform(0, 2 * np.pi, count))
            if count < 10
            else np.linspace(0, 2 * np.pi, count)
        )
        wave = 1.0
        if count >= 10:
            harmonics = np.arange(1, 5)[:, None]
            wave += (
                rng.normal(0, 0.22, (4, 1))
                / harmonics
                * np.sin(harmonics * turn + rng.uniform(0, 7, (4, 1)))
            ).sum(0)
        radius = rng.uniform(14, 0.28 * size) * wave
        shape = np.stack([np.cos(turn), np.sin(turn) * rng.uniform(0.4, 1)], 1) * np.reshape(
            radius, (-1, 1)
        )
        shape += rng.uniform(0, 1, 2) * size
        cv2.fillPoly(mask, [np.round(shape * 16).astype(np.int32)], 255, cv2.LINE_AA, 4)
    # Thin parts would be lines.
    core = cv2.morphologyEx(
        mask, cv2.MORPH_OPEN, cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (19, 19))
    )
    return core.astype(np.float32) / 255


def _photograph(rng: Rng, ink: Array, library: Library, size: int, held_out: bool) -> Array:
    """Ink on paper under a lamp, scanned: (size, size) float32 luminance."""
    drawn = ink[ink > 0.1]
    level = float(np.median(drawn)) if drawn.size > 50 else 0.5
    sheet = paper(rng, size, level, 0.25 if ink.mean() > 0.02 else 0.6)
    if rng.random() < 0.08:
        sheet *= 1 - _show_through(rng, library, size, held_out) * level
    if rng.random() < 0.08:  # a smudge: ink rubbed along one direction
        length = int(rng.choice([9, 15, 25]))
        rubbed = cv2.blur(ink, (length, 3)) * np.clip(noise(rng, "cloud", size), 0, 1)
        sheet *= 1 - rng.uniform(0.05, 0.3) * rubbed
    if rng.random() < 0.06:  # eraser: a band in which a ghost of older lines stays
        ghost = np.roll(ink, rng.integers(20, size - 20, 2), (0, 1))
        sheet *= 1 - rng.uniform(0.01, 0.07) * cv2.GaussianBlur(ghost, (0, 0), 1.2)
    if rng.random() < 0.1:
        sheet *= 1 - dust(rng, ink)
    black = rng.uniform(0.0, 0.12)
    gray = sheet * (1 - ink) + black * ink
    if rng.random() < 0.5:
        gray *= shadow(rng, size)
    return scan(rng, gray)


def _show_through(rng: Rng, library: Library, size: int, held_out: bool) -> Array:
    """The drawing on the back of the sheet, blurred and faint."""
    strokes, widest = true_drawing(rng, library, size, held_out)
    samples = sample(_sane(strokes, size), size)
    if len(samples) < 2:
        return np.zeros((size, size), np.float32)
    back, _ = draw(rng, samples, MEDIA["marker"], min(5.0, widest), size)
    return cv2.GaussianBlur(back, (0, 0), rng.uniform(1.2, 3)) * rng.uniform(0.03, 0.16)


def _pack(ink: Array, maps: Targets, keep: Array, solid: Array) -> Array:
    layers = [
        ink,
        maps.centerline * keep,
        maps.junctions * keep,
        maps.endpoints * keep,
        maps.half_width * keep / MAX_HALF_WIDTH,
        solid,
    ]
    return np.round(np.clip(np.stack(layers), 0, 1) * 255).astype(np.uint8)
