"""Solid black areas: taken out of the scan before tracing, kept as closed outlines.

Hair, boots and hats are areas, not lines: a centerline through them would be a scribble.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import cv2
import numpy as np

from ..arrays import distance
from ..arrays.sampling import sample
from ..settings import Settings
from ..values import Array, Scan

Fill = tuple[Array, ...]
"""One area: its outer ring, then the rings of its holes; each (N, 2) float32, closed, px."""

_WIDE, _WIDEST = (3.2, 7.0), (5.0, 10.0)  # diameters in pen widths, and at least in px
_NARROWER = 0.7  # of the width from which on it is an area, that the rest of it has at least
_REACH = 2.0  # widest diameters; how far an area goes on from its widest parts
_LONG, _EVEN, _STROKE = 4.0, 0.8, 16.0  # a line is so many widths long, so even, and so wide in px
_FRINGE = 1.5  # px; how far the soft edge of an area reaches
_DETAIL = 0.1  # px; how far an outline may stray when points are saved


def split_solids(
    scan: Scan, settings: Settings, lines: Array | None = None
) -> tuple[Scan, list[Fill]]:
    """Take the areas much wider than the pen out of a scan.

    What is narrower stays, also where it touches an area: such a line ends at the border.

    Args:
        lines: (H, W) bool, what is a line however wide it is.

    Returns:
        The scan without the areas, and the areas in working pixels.
    """
    if not settings.solids or settings.provider == "given":
        return scan, []
    soft = cv2.GaussianBlur(scan.ink, (0, 0), 0.6)
    wide, widest = (max(px, pens * scan.pen_width) for pens, px in (_WIDE, _WIDEST))
    dark = (soft > 0.5).astype(np.uint8)
    if lines is not None:
        dark[lines] = 0
    longest = _STROKE
    if settings.solid_width:  # the user knows what is an area here
        longest = widest = max(settings.solid_width / scan.scale, 2.0)
        wide = min(wide, _NARROWER * widest)
    area = _areas(dark, wide / 2, widest / 2, longest)
    if not area.any():
        return scan, []
    near = _distance_to(area > 0) <= _FRINGE
    return replace(scan, ink=np.where(near, np.float32(0), scan.ink)), _outlines(area, soft)


def _areas(dark: Array, wide: float, widest: float, stroke: float) -> Array:
    """The dark pixels that belong to areas, (H, W) uint8, 0 or 1.

    An area is what discs of radius `wide` can paint within the dark, around a place where even one
    of radius `widest` fits; but a long even line stays a line up to a width of `stroke`.
    """
    if not distance.may_be_deeper(dark, widest):
        return np.zeros_like(dark)
    depth = distance.depth(dark)
    seed = depth > widest
    if not seed.any():
        return seed.astype(np.uint8)
    core = (depth > wide) & (_distance_to(seed) < _REACH * 2 * widest)
    away, owner = cv2.distanceTransformWithLabels(
        (~core).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5, labelType=cv2.DIST_LABEL_CCOMP
    )
    painted = (away <= wide + 0.5) & (dark > 0)
    count = int(owner.max()) + 1
    size = np.bincount(owner[painted], minlength=count)
    deepest = np.zeros(count, np.float32)
    np.maximum.at(deepest, owner[core].astype(np.int64), depth[core])
    middle = core & (depth >= cv2.dilate(depth, np.ones((3, 3), np.uint8)))
    crest = np.bincount(owner[middle], minlength=count)
    mean_depth = np.bincount(owner[middle], depth[middle], minlength=count) / np.maximum(crest, 1)
    width = 2 * deepest
    is_line = (size > _LONG * width**2) & (mean_depth > _EVEN * deepest) & (width < stroke)
    is_area = (deepest > widest) & ~is_line
    return (painted & is_area[owner]).astype(np.uint8)


def _distance_to(place: Array) -> Array:
    return cv2.distanceTransform((~place).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5)


def _outlines(area: Array, soft: Array) -> list[Fill]:
    contours, tree = cv2.findContours(area, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    rings = _on_the_edge([c.reshape(-1, 2) for c in contours], soft)
    fills: list[Fill] = []
    for index, (_, _, child, parent) in enumerate(tree[0].tolist()):
        outer = rings[index]
        if parent >= 0 or outer is None:
            continue
        holes = []
        while child >= 0:
            holes.append(rings[child])
            child = tree[0][child][0]
        fills.append((outer, *(hole for hole in holes if hole is not None)))
    return fills


def _on_the_edge(contours: list[Array], soft: Array) -> list[Array | None]:
    """Move rings of border pixels to where the ink is half dark, and smooth them."""
    every = np.concatenate(contours).astype(np.float32) + np.float32(0.5)
    slope = np.stack(
        [cv2.Sobel(soft, cv2.CV_32F, *axis, scale=1 / 8) for axis in ((1, 0), (0, 1))], -1
    )
    place = every
    for _ in range(3):
        value = sample(soft, place, cv2.BORDER_CONSTANT)
        normal = sample(slope, place, cv2.BORDER_CONSTANT)
        steep = np.maximum((normal**2).sum(1), 0.03**2)
        step = ((0.5 - value) / steep)[:, None] * normal
        place = np.clip(place + np.clip(step, -0.7, 0.7), every - 1.2, every + 1.2)
    starts = np.cumsum([0, *(len(c) for c in contours)])
    return [_smooth(place[a:b]) for a, b in pairwise(starts)]


def _smooth(ring: Array) -> Array | None:
    """A ring without pixel steps, in few points; None when nothing is left of it."""
    if len(ring) < 8:
        return None
    weights = np.array([1, 4, 6, 4, 1], np.float32) / 16
    wrapped = np.concatenate([ring[-2:], ring, ring[:2]])
    even = np.stack([np.convolve(axis, weights, "valid") for axis in wrapped.T], 1)
    few = cv2.approxPolyDP(even.astype(np.float32)[:, None], _DETAIL, True)[:, 0]
    return few if len(few) >= 3 else None
