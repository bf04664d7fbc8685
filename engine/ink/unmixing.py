"""Take inks that are not to be traced out of a scan: blue construction pencil under black ink.

Where inks lie over each other their optical densities (-log of the reflectance) add up, so what a
pixel holds of an unwanted ink can be subtracted, and a black line over a blue one stays whole.
"""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np

from ..arrays.components import components
from ..settings import Settings
from ..values import Array, Scan
from .hue_peaks import hue_peaks, turn
from .tint import NEUTRAL, chroma_and_hue, density, tint, tint_of
from .two_strengths import split_strengths

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
_FAINT = 0.06  # mean density below which a pixel is paper
_NEAR = np.radians(60)  # an ink farther than this round the colour circle is not the one meant
_SMALLEST = 0.03  # of the coloured pixels: what an ink of its own must have


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


def _kept_beside(name: str, scan: Scan) -> Array:
    """The share of each pixel's ink that is not of the named one, (H, W) float32 in [0, 1]."""
    kept = np.ones_like(scan.ink)
    rows, columns = np.nonzero(scan.ink > 0.05)
    dense = _over_paper(scan)[rows, columns]
    chroma, hue = chroma_and_hue(tint_of(dense))
    colored = (chroma > NEUTRAL) & (dense.mean(axis=1) > _FAINT)
    inks = _inks(hue[colored])
    meant = [k for k, ink in enumerate(inks) if _is_meant(ink, name)]
    if not meant:
        return kept
    apart = np.abs(turn(hue[:, None] - inks))
    unwanted = colored & np.isin(apart.argmin(axis=1), meant)
    # The soft edge of a black line has colour fringes; it belongs to the line.
    line: Array = np.zeros(scan.ink.shape, np.uint8)
    line[rows, columns] = (~colored) & (scan.ink[rows, columns] > 0.6)
    line = cv2.dilate(line, np.ones((3, 3), np.uint8))
    unwanted &= line[rows, columns] == 0
    if not unwanted.any():
        return kept
    # The soft edge of an unwanted line is too faint to show its colour.
    edge: Array = np.zeros(scan.ink.shape, np.uint8)
    edge[rows[unwanted], columns[unwanted]] = 1
    edge = cv2.dilate(edge, np.ones((5, 5), np.uint8))
    kept[(edge > 0) & (line == 0) & (scan.ink < 0.3)] = 0.0
    share = _other_share(dense[unwanted], np.median(dense[unwanted], axis=0))
    kept[rows[unwanted], columns[unwanted]] = share
    return kept


def _other_share(dense: Array, ink: Array) -> Array:
    """How much of each density is black beside this ink: least squares with both parts >= 0."""
    ink = ink / ink.mean()
    # density = black (1, 1, 1) + amount ink; the normal equations of two unknowns, solved.
    gray, along = dense.mean(axis=1), dense @ ink / 3.0
    square = float((ink**2).mean())
    amount = np.clip((along - gray) / max(square - 1.0, 1e-3), 0.0, gray)
    share = 1.0 - amount / np.maximum(gray, 1e-6)
    return np.clip((share - 0.3) / 0.4, 0.0, 1.0)  # what is nearly all one or the other is


def _over_paper(scan: Scan) -> Array:
    """Optical density over the paper, (H, W, 3) float32."""
    assert scan.color is not None, "inks are told apart on a page in colour"
    dense = density(scan.color.astype(np.float32))
    # Paper and its shading change slowly: seen where there is no ink, small, smooth.
    size = (max(1, scan.ink.shape[1] // 16), max(1, scan.ink.shape[0] // 16))
    bare = (scan.ink < 0.03).astype(np.float32)
    weight = cv2.resize(bare, size, interpolation=cv2.INTER_AREA)
    paper = cv2.resize(dense * bare[..., None], size, interpolation=cv2.INTER_AREA)
    weight = cv2.GaussianBlur(weight, (0, 0), 8.0) + 1e-6
    paper = cv2.GaussianBlur(paper, (0, 0), 8.0) / weight[..., None]
    paper = cv2.resize(paper, scan.ink.shape[::-1], interpolation=cv2.INTER_LINEAR)
    return np.maximum(dense - paper, 0.0)


def _inks(hue: Array) -> Array:
    """The hues of a page's inks: peaks of the histogram round the colour circle, radians."""
    if len(hue) < 20:
        return np.zeros(0)
    return hue_peaks(hue, np.full(len(hue), 1 / len(hue)), _SMALLEST)


def _is_meant(hue: float, name: str) -> bool:
    """Whether an ink is the one that people call so, or would call so for want of another name."""
    off = {n: abs(turn(hue - _hue_named(n))) for n in _MEANT}
    return off[name] < _NEAR and off[name] < 2.5 * min(off.values()) + np.radians(10)


def _hue_named(name: str) -> float:
    return float(chroma_and_hue(tint(_MEANT[name]))[1])


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
    count = np.bincount(np.uint8(np.round(lines * 255)), minlength=256)
    split = split_strengths(np.flatnonzero(count) / 255, count[count > 0])
    if split is None:
        return np.ones_like(ink)
    strong = strength > split.level
    return (strong & ~_touching_specks(strong, strength, reach)).astype(np.float32)


def _touching_specks(strong: Array, strength: Array, reach: int) -> Array:
    """(H, W) bool: small dark spots on faint lines, as where two pencil lines cross."""
    count, labels, stats, _ = components(strong.view(np.uint8))
    faint = cv2.dilate((~strong & (strength > 0.1)).view(np.uint8), np.ones((3, 3), np.uint8))
    touched = np.bincount(labels[faint > 0], minlength=count) > 0
    small = np.maximum(stats[:, cv2.CC_STAT_WIDTH], stats[:, cv2.CC_STAT_HEIGHT]) < 4 * reach
    small[0] = False
    return (touched & small)[labels]
