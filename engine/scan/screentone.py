"""Screentone: dots in an even lattice, as they are stuck or printed on comics. It is no drawing.

Every dot of a lattice has at least four neighbours, all equally far. Stippling has none of that,
a dotted line two.
"""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np

from ..arrays.components import components
from ..settings import Settings
from ..values import Array, Scan

_CLEAR = 0.7  # ink; high, so that dots that nearly touch are apart
_DOT = 2.0  # pen widths, or px where that is more; a larger piece of ink is no dot
_FEWEST = 40  # dots of a lattice
_ALIKE = 0.2  # how much farther the fourth neighbour of a dot may be than the first, as a share
_AROUND = 1.6  # distances between dots that the tone reaches beyond those inside it: its corners
_FARTHEST = 24.0  # px between the dots of a tone


def without_screentone(scan: Scan, settings: Settings) -> Scan:
    """The scan without its screentone; lines that run through it stay."""
    if not settings.screentone or settings.provider == "given":
        return scan
    clear = (scan.ink > _CLEAR).view(np.uint8)
    _, label, stats, middle = components(clear, connectivity=4)
    extent = stats[:, [cv2.CC_STAT_WIDTH, cv2.CC_STAT_HEIGHT]].max(1)
    small = extent <= _DOT * max(scan.pen_width, 2.0)
    small[0] = False
    dots = np.flatnonzero(small)
    if len(dots) < _FEWEST:
        return scan
    of_lattice, apart = _lattice(middle[dots].astype(np.float32))
    tone = _area(middle[dots[of_lattice]], apart[of_lattice], clear.shape)
    if not tone.any():
        return scan
    lines = (clear > 0) & ~small[label]
    lines = cv2.dilate(lines.view(np.uint8), np.ones((5, 5), np.uint8)) > 0
    gone = tone & ~lines
    note = f"Screentone was left out: {tone.mean():.0%} of the page."
    ink = np.where(gone, np.float32(0), scan.ink)
    return replace(scan, ink=ink, notes=(*scan.notes, note))


def _lattice(places: Array) -> tuple[Array, Array]:
    """(N,) bool: which of the points (N, 2) are in a lattice; (N,) px to the nearest other."""
    tree = cv2.flann_Index(places, {"algorithm": 4, "leaf_max_size": 10})  # type: ignore[attr-defined]
    near, squared = tree.knnSearch(places, 5, params={"checks": -1})
    apart = np.sqrt(np.maximum(squared[:, 1:], 0))
    even = (apart[:, 3] < (1 + _ALIKE) * apart[:, 0]) & (apart[:, 0] < _FARTHEST)
    # Most neighbours of one in a lattice are in it, too, and equally far apart.
    first = apart[:, 0]
    alike = np.abs(first[near[:, 1:]] - first[:, None]) < _ALIKE * first[:, None]
    return even & ((even[near[:, 1:]] & alike).sum(1) >= 2), first


def _area(places: Array, apart: Array, shape: tuple[int, ...]) -> Array:
    """(H, W) bool: the areas of the lattices."""
    area = np.zeros(shape, np.uint8)
    for (x, y), far in zip(places, apart, strict=True):
        cv2.circle(area, (round(x), round(y)), int(np.ceil(_AROUND * far)) + 1, 1, -1)
    _, label = cv2.connectedComponents(area)
    column, row = np.minimum(np.rint(places).astype(int), np.array(shape[::-1]) - 1).T
    held = np.bincount(label[row, column], minlength=int(label.max()) + 1)
    return (held >= _FEWEST)[label] & (area > 0)
