"""Solid black areas: taken out of the scan before tracing, kept as closed outlines.

Hair, boots and hats are areas, not lines: a centerline through them would be a scribble.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import cv2
import numpy as np

from ..arrays import distance
from ..arrays.components import components
from ..arrays.sampling import sample
from ..settings import Settings
from ..values import Array, Scan

Fill = tuple[Array, ...]
"""One area: its outer ring, then the rings of its holes; each (N, 2) float32, closed, px."""

_WIDE, _WIDEST = (3.2, 7.0), (5.0, 10.0)  # diameters in pen widths, and at least in px
_NARROWER = 0.7  # of the width from which on it is an area, that the rest of it has at least
_REACH = 2.0  # widest diameters; how far an area goes on from its widest parts
_LONG, _EVEN, _STROKE = 4.0, 0.8, 16.0  # a line is so many widths long, so even, and so wide in px
_WHOLE = 0.98  # of a piece of ink that is area: nothing is left of it
_LETTER, _LETTERS = 0.3, 3  # of the area in a black box, that one letter takes at most; how many
_PAINTED, _INKED = 0.4, 0.55  # of a box's ink that is area, of a box that is ink, at least
_SQUARE = 0.92  # of the rectangle around it, that a box takes up
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
    area |= _rest_of_boxes(dark, area, wide / 2)
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


def _rest_of_boxes(dark: Array, area: Array, wide: float) -> Array:
    """The dark pixels between the letters of black boxes, (H, W) uint8, 0 or 1.

    What is left of such a box between and around white lettering is too narrow to be an area by
    itself. With its letters filled in, a box is a solid rectangle; most of it is dark, and much of
    that wide enough to be an area. Hatching, hair and hats are not.
    """
    rest = np.zeros_like(area)
    count, label, stats, _ = components(dark)
    much = np.bincount(label[area > 0], minlength=count)
    share = much / np.maximum(stats[:, cv2.CC_STAT_AREA], 1)
    for piece in np.flatnonzero((share > 0) & (share < _WHOLE)).tolist():
        x, y, width, height = stats[piece, :4].tolist()
        there = np.s_[y : y + height, x : x + width]
        own = np.pad((label[there] == piece).view(np.uint8), 1)
        _, white, sizes, _ = cv2.connectedComponentsWithStats(1 - own, connectivity=4)
        small = sizes[:, cv2.CC_STAT_AREA] < _LETTER * much[piece]
        small[[0, white[0, 0]]] = False
        letters = np.where(small[white], white, 0)
        if np.count_nonzero(small) < _LETTERS:
            continue
        side = 2 * int(np.ceil(wide)) + 1
        disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (side, side))
        # With what a letter encloses.
        around, _ = cv2.findContours(
            (letters > 0).view(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE
        )
        whole = cv2.drawContours(own.copy(), around, -1, 1, cv2.FILLED)
        solid = cv2.morphologyEx(whole, cv2.MORPH_OPEN, disc)
        boxes, box, _, _ = cv2.connectedComponentsWithStats(solid)
        inked, painted = (np.pad(of[there], 1) > 0 for of in (dark, area))
        for number in range(1, boxes):
            inside = box == number
            if _is_box(inside, inked, painted & inside, letters):
                rest[there] |= (inside & inked)[1:-1, 1:-1].view(np.uint8)
    return rest


def _is_box(inside: Array, inked: Array, painted: Array, letters: Array) -> bool:
    """Whether what is solid with its letters is a box.

    Args:
        inside, inked, painted: (H, W) bool; what is to be judged, what is dark, what is an area.
        letters: (H, W) the number of the white piece that each pixel is in, 0 for none.
    """
    whole, dark = np.count_nonzero(inside), np.count_nonzero(inside & inked)
    if np.count_nonzero(painted) < _PAINTED * dark or dark < _INKED * whole:
        return False
    if len(np.unique(letters[inside])) <= _LETTERS:
        return False
    outlines, _ = cv2.findContours(inside.view(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    _, sides, _ = cv2.minAreaRect(np.concatenate(outlines))
    return bool(whole > _SQUARE * (sides[0] + 1) * (sides[1] + 1))


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
