"""Take inks that are not to be traced out of a scan: blue construction pencil under black ink.

Where inks lie over each other their optical densities (-log of the reflectance) add up, so what a
pixel holds of an unwanted ink can be subtracted, and a black line over a blue one stays whole.
"""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np

from ..settings import Settings
from ..values import Array, Scan

# What people mean by the names, sRGB.
_MEANT = {
    "red": (215, 40, 40),
    "orange": (240, 130, 20),
    "yellow": (235, 210, 30),
    "green": (40, 150, 60),
    "cyan": (40, 185, 210),
    "blue": (50, 90, 210),
    "purple": (130, 60, 180),
    "pink": (240, 110, 180),
}
COLORED = 0.3  # how far a density is from grey, relative to its size, in coloured ink
_FAINT = 0.06  # mean density below which a pixel is paper
_NEAR = np.radians(60)  # an ink farther than this round the colour circle is not the one meant
_BINS = 36
_FAINTER = 0.68  # of the ink's darkness: what a pencil under ink is at most
_BETWEEN = 0.08  # of the inked pixels: how many may be neither pencil nor ink
_ACROSS = np.array([[2.0, -1.0, -1.0], [0.0, 3.0**0.5, -(3.0**0.5)]]).T / 6.0**0.5


def without_inks(scan: Scan, settings: Settings) -> Scan:
    """The scan without the inks in `settings.ignore_inks`; those it does not have are no matter."""
    kept = np.ones_like(scan.ink)
    if scan.color is not None:
        for name in settings.ignore_inks:
            if name in _MEANT:
                kept *= _kept_beside(name, scan)
    if "gray" in settings.ignore_inks:
        kept *= _kept_beside_pencil(scan.ink * kept, scan.pen_width)
    return replace(scan, ink=scan.ink * kept) if (kept < 1).any() else scan


def hue_of(density: Array) -> tuple[Array, Array]:
    """Chroma and hue (radians) of densities, (..., 3) -> (...), (...); 0 chroma is grey."""
    mean = np.maximum(density.mean(axis=-1, keepdims=True), _FAINT)
    a, b = np.moveaxis((density / mean - 1.0) @ _ACROSS, -1, 0)
    return np.hypot(a, b), np.arctan2(b, a)


def _kept_beside(name: str, scan: Scan) -> Array:
    """The share of each pixel's ink that is not of the named one, (H, W) float32 in [0, 1]."""
    kept = np.ones_like(scan.ink)
    rows, columns = np.nonzero(scan.ink > 0.05)
    density = _density(scan)[rows, columns]
    chroma, hue = hue_of(density)
    colored = (chroma > COLORED) & (density.mean(axis=1) > _FAINT)
    meant = [k for k, ink in enumerate(_inks(hue[colored])) if _is_meant(ink, name)]
    if not meant:
        return kept
    inks = _inks(hue[colored])
    apart = np.abs(_turn(hue[:, None] - inks))
    unwanted = colored & np.isin(apart.argmin(axis=1), meant)
    # The soft edge of a black line has colour fringes; it belongs to the line.
    line = np.zeros(scan.ink.shape, np.uint8)
    line[rows, columns] = (~colored) & (scan.ink[rows, columns] > 0.6)
    line = cv2.dilate(line, np.ones((3, 3), np.uint8))
    unwanted &= line[rows, columns] == 0
    if not unwanted.any():
        return kept
    # The soft edge of an unwanted line is too faint to show its colour.
    edge = np.zeros(scan.ink.shape, np.uint8)
    edge[rows[unwanted], columns[unwanted]] = 1
    edge = cv2.dilate(edge, np.ones((5, 5), np.uint8))
    kept[(edge > 0) & (line == 0) & (scan.ink < 0.3)] = 0.0
    share = _other_share(density[unwanted], np.median(density[unwanted], axis=0))
    kept[rows[unwanted], columns[unwanted]] = share
    return kept


def _other_share(density: Array, ink: Array) -> Array:
    """How much of each density is black beside this ink: least squares with both parts >= 0."""
    ink = ink / ink.mean()
    # density = black (1, 1, 1) + amount ink; the normal equations of two unknowns, solved.
    gray, along = density.mean(axis=1), density @ ink / 3.0
    square = float((ink**2).mean())
    amount = np.clip((along - gray) / max(square - 1.0, 1e-3), 0.0, gray)
    share = 1.0 - amount / np.maximum(gray, 1e-6)
    return np.clip((share - 0.3) / 0.4, 0.0, 1.0)  # what is nearly all one or the other is


def _density(scan: Scan) -> Array:
    """Optical density over the paper, (H, W, 3) float32."""
    density = -np.log((scan.color.astype(np.float32) + 8.0) / 263.0)
    # Paper and its shading change slowly: seen where there is no ink, small, smooth.
    size = (max(1, scan.ink.shape[1] // 16), max(1, scan.ink.shape[0] // 16))
    bare = (scan.ink < 0.03).astype(np.float32)
    weight = cv2.resize(bare, size, interpolation=cv2.INTER_AREA)
    paper = cv2.resize(density * bare[..., None], size, interpolation=cv2.INTER_AREA)
    weight = cv2.GaussianBlur(weight, (0, 0), 8.0) + 1e-6
    paper = cv2.GaussianBlur(paper, (0, 0), 8.0) / weight[..., None]
    paper = cv2.resize(paper, scan.ink.shape[::-1], interpolation=cv2.INTER_LINEAR)
    return np.maximum(density - paper, 0.0)


def _inks(hue: Array) -> Array:
    """The hues of a page's inks: peaks of the histogram round the colour circle, radians."""
    if len(hue) < 20:
        return np.zeros(0)
    bins = ((hue + np.pi) / (2 * np.pi) * _BINS).astype(int) % _BINS
    share = np.bincount(bins, minlength=_BINS) / len(hue)
    near = share + 0.5 * (np.roll(share, 1) + np.roll(share, -1))
    around = np.max([np.roll(near, k) for k in (-3, -2, -1, 1, 2, 3)], axis=0)
    return (np.flatnonzero((near >= around) & (near > 0.03)) + 0.5) / _BINS * 2 * np.pi - np.pi


def _is_meant(hue: float, name: str) -> bool:
    """Whether an ink is the one that people call so, or would call so for want of another name."""
    off = {n: abs(_turn(hue - _hue_named(n))) for n in _MEANT}
    return off[name] < _NEAR and off[name] < 2.5 * min(off.values()) + np.radians(10)


def _hue_named(name: str) -> float:
    density = -np.log((np.array(_MEANT[name], float) + 8.0) / 263.0)
    return float(hue_of(density)[1])


def _turn(angle: Array) -> Array:
    """The same angle in [-pi, pi)."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


def _kept_beside_pencil(ink: Array, pen_width: float) -> Array:
    """0 on lines that are much fainter than the ink of the page, else 1; (H, W) float32.

    A page that is drawn in one strength has no pencil, however faint it is; nor has one whose
    strengths pass into each other, as hardly and firmly drawn pencil does.
    """
    reach = 2 * max(1, round(0.75 * pen_width)) + 1
    strength = cv2.dilate(ink, np.ones((reach, reach), np.uint8))
    lines = strength[ink > 0.1]
    if len(lines) == 0:
        return np.ones_like(ink)
    level, _ = cv2.threshold(
        np.uint8(np.round(lines * 255))[None], 0, 255, cv2.THRESH_BINARY | cv2.THRESH_OTSU
    )
    level /= 255
    faint, strong = lines[lines <= level], lines[lines > level]
    if len(faint) == 0 or len(strong) == 0 or faint.mean() > _FAINTER * strong.mean():
        return np.ones_like(ink)
    third = (strong.mean() - faint.mean()) / 3
    between = (lines > faint.mean() + third) & (lines < strong.mean() - third)
    if between.mean() > _BETWEEN:
        return np.ones_like(ink)
    strong = strength > level
    return (strong & ~_touching_specks(strong, strength, reach)).astype(np.float32)


def _touching_specks(strong: Array, strength: Array, reach: int) -> Array:
    """(H, W) bool: small dark spots on faint lines, as where two pencil lines cross."""
    count, labels, stats, _ = cv2.connectedComponentsWithStats(strong.view(np.uint8))
    faint = cv2.dilate((~strong & (strength > 0.1)).view(np.uint8), np.ones((3, 3), np.uint8))
    touched = np.bincount(labels[faint > 0], minlength=count) > 0
    small = np.maximum(stats[:, cv2.CC_STAT_WIDTH], stats[:, cv2.CC_STAT_HEIGHT]) < 4 * reach
    small[0] = False
    return (touched & small)[labels]
