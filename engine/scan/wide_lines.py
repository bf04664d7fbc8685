"""Lines much wider than the pen of the page: a marker beside a pen, a bold outline, soft pencil.

They are found on a reduced picture, where the grain of a broad pencil closes. What is long and
even is a line, however wide; what is not is an area.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np

from ..arrays.distance import depth, may_be_deeper
from ..settings import Settings
from ..values import Array, Scan

_REDUCED = 2  # times smaller is the picture that is looked at
_WIDE = (2.2, 9.0)  # pens, and px: a wider line is too wide for a look at the scale of the pen
_WIDEST = (16.0, 16.0)  # pens, and px: what is wider is an area, unless the user says otherwise
_EDGE = 3  # px of the page that the soft edge of a broad line takes up
_DARK = 0.45  # mean ink of a broad line, its grain included
# Bundles of close lines on held-out pages have ink on 0.91 of what looks like one broad line in the
# reduced picture; markers, and a bold pen, on 0.96 and more.
_INKED, _SOLID = 0.35, 0.945
_LONG = 5.0  # widths that a line is long (4 to 6 do alike); what is shorter may well be a shape
_EVEN, _UNEVEN = 0.8, 0.3  # share of a line that is as wide as the rest, give or take so much
_SWOLLEN = 2.6  # times as wide as the rest: a line with a spot like that runs into a shape
# These five were chosen together on 120 pages of several pens (`synthesis.hard_pages`), by the area
# of what was looked at: 0.49 and 0.42 of the broad lines are found in either half of the pages, and
# 0.011 of other ink. With 0.15, 12 pens and any spot it was 0.26 and 0.26, and 0.012 and 0.051.
# `python -m benchmarks run scan_limits` shows each of them alone.


@dataclass(frozen=True, eq=False)
class WideLines:
    """label: (H, W) int32, number of the wide line that a pixel belongs to, 0 = none.
    widths: (K + 1,) px of each, and lengths: (K + 1,) px; of 0 both are 0.
    half_width: (H, W) float32 px, right along the middle of the lines."""

    label: Array
    widths: Array
    lengths: Array
    half_width: Array

    @property
    def any(self) -> bool:
        return len(self.widths) > 1

    @cached_property
    def near(self) -> Array:
        """(H, W) bool: the lines with their soft edges."""
        side = 2 * _EDGE + 1
        return cv2.dilate((self.label > 0).view(np.uint8), np.ones((side, side), np.uint8)) > 0


def find_wide_lines(scan: Scan, settings: Settings) -> WideLines:
    """The lines too wide for a look at the scale of the page's pen."""
    shape = scan.ink.shape
    none = WideLines(np.zeros((0, 0), np.int32), np.zeros(1), np.zeros(1), np.zeros((0, 0)))
    if settings.provider == "given" or min(shape) < 8 * _REDUCED:
        return none
    wide, widest = (max(pens * scan.pen_width, px) for pens, px in (_WIDE, _WIDEST))
    if settings.solid_width:
        widest = settings.solid_width / scan.scale
    small = cv2.resize(
        scan.ink, None, fx=1 / _REDUCED, fy=1 / _REDUCED, interpolation=cv2.INTER_AREA
    )
    dark = (cv2.GaussianBlur(small, (0, 0), 1.0) > _DARK).astype(np.uint8)
    dark = _without_holes(dark, (wide / _REDUCED / 2) ** 2)
    if not may_be_deeper(dark, wide / _REDUCED / 2):
        return none
    deep = depth(dark)
    core = deep > wide / _REDUCED / 2
    if not core.any():
        return none
    label, width, length = _lines(core, deep, wide / _REDUCED / 2, widest / _REDUCED)
    label = cv2.resize(label, shape[::-1], interpolation=cv2.INTER_NEAREST)
    solid = _solid(label, scan.ink, len(width))
    if not solid.any():
        return none
    label, width, length = (solid.cumsum() * solid)[label], width[solid], length[solid]
    width, length = np.append(0, width), np.append(0, length)
    return WideLines(
        label=label.astype(np.int32),
        widths=width * _REDUCED,
        lengths=length * _REDUCED,
        half_width=cv2.resize(deep * _REDUCED, shape[::-1], interpolation=cv2.INTER_LINEAR),
    )


def _solid(label: Array, ink: Array, count: int) -> Array:
    """(K + 1,) bool: the lines that are no bundle of finer ones; the grain of a pencil is solid."""
    place = label > 0
    size = np.bincount(label[place], minlength=count)
    inked = np.bincount(label[place & (ink > _INKED)], minlength=count)
    solid = inked > _SOLID * size
    solid[0] = False
    return solid


def _without_holes(dark: Array, largest: float) -> Array:
    """The dark with its small holes, grain, closed."""
    _, label, stats, _ = cv2.connectedComponentsWithStats(1 - dark, connectivity=4)
    small = stats[:, cv2.CC_STAT_AREA] < largest
    small[0] = False
    return dark | small[label].astype(np.uint8)


def _lines(core: Array, deep: Array, radius: float, widest: float) -> tuple[Array, Array, Array]:
    """What discs can paint round each core, where that is a line: label, widths, lengths."""
    away, owner = cv2.distanceTransformWithLabels(
        (~core).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5, labelType=cv2.DIST_LABEL_CCOMP
    )
    painted = (away <= radius + 0.5) & (deep > 0)
    count = int(owner.max()) + 1
    size = np.bincount(owner[painted], minlength=count)
    middle = core & (deep >= cv2.dilate(deep, np.ones((3, 3), np.uint8)))
    half, of = deep[middle], owner[middle]
    order = np.lexsort((half, of))
    crest = np.bincount(of, minlength=count)
    typical = np.zeros(count)
    there = np.flatnonzero(crest)
    typical[there] = half[order][(np.cumsum(crest) - crest + crest // 2)[there]]
    even = np.bincount(of, np.abs(half - typical[of]) < _UNEVEN * typical[of], count)
    width = 2 * typical
    length = size / np.maximum(width, 1e-6)
    most = np.zeros(count)
    np.maximum.at(most, of.astype(np.int64), half)
    is_line = (length > _LONG * width) & (even > _EVEN * crest) & (width <= widest)
    is_line &= most < _SWOLLEN * typical
    is_line[0] = False
    number = np.cumsum(is_line) * is_line
    label = np.where(painted, number[owner], 0).astype(np.int32)
    return label, np.append(0, width[is_line]), np.append(0, length[is_line])
