"""The sheet in a photograph: what lies beyond it (cloth, desk, a finger) is no drawing.

The sheet is the one large light piece of the picture, with straight sides. Beyond it everything is
clearly darker, up to the edge of the picture. A drawn black ground is neither: it is as dark as
ink, smooth, and lines reach into it.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from ..values import Array
from .picture import as_bytes, darkest_gray

_SIDE = 512  # px; the picture is looked at so small
_DARKER = 0.75  # of the sheet's lightness, that what lies beyond has at most
_LARGEST, _LEAST = 0.98, 0.25  # of the picture, that the sheet takes up
_STRAIGHT = 0.97  # of its hull, that the sheet fills: its sides are straight
_THICK = 0.03  # of the picture's side: what is beyond is thicker than any line
_BLACK, _SMOOTH = 60, 8.0  # lightness and its spread: darker and smoother is black ink, not cloth
_MARGIN = 0.006  # of the picture's side: so much within the sheet's edge goes too


@dataclass(frozen=True, eq=False)
class Sheet:
    """outline: (N, 2) float32, convex, px of the picture; beyond: (H, W) bool, small;
    share: of the picture, what lies beyond."""

    outline: Array
    beyond: Array
    share: float


def find_sheet(picture: Array) -> Sheet | None:
    """The sheet of a photographed page; None where the page fills the picture.

    Args:
        picture: (H, W) or (H, W, 3), dark lines on light.
    """
    shrink = max(1.0, max(picture.shape[:2]) / _SIDE)
    if min(picture.shape[:2]) < 2 * shrink:  # a strip is no photograph of a sheet
        return None
    small = cv2.resize(picture, None, fx=1 / shrink, fy=1 / shrink, interpolation=cv2.INTER_AREA)
    gray = as_bytes(darkest_gray(small))
    # Lines are closed, so that a sheet is one light piece however much is drawn on it.
    reach = 2 * int(_THICK * max(gray.shape) / 2) + 1
    smooth = cv2.medianBlur(gray, 5)
    level, _ = cv2.threshold(smooth, 0, 255, cv2.THRESH_BINARY | cv2.THRESH_OTSU)
    bright = (smooth > level).view(np.uint8)
    light = cv2.morphologyEx(bright, cv2.MORPH_CLOSE, np.ones((reach, reach), np.uint8))
    light = cv2.morphologyEx(light, cv2.MORPH_OPEN, np.ones((reach, reach), np.uint8))
    _, label, stats, _ = cv2.connectedComponentsWithStats(light)
    if len(stats) < 2:
        return None
    largest = 1 + int(stats[1:, cv2.CC_STAT_AREA].argmax())
    outlines, _ = cv2.findContours(
        (label == largest).view(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE
    )
    outline = max(outlines, key=cv2.contourArea)
    hull = cv2.convexHull(outline)
    inside = cv2.fillPoly(np.zeros_like(gray), [hull], 1) > 0
    share = float(inside.mean())
    straight = cv2.contourArea(outline) > _STRAIGHT * cv2.contourArea(hull)
    if not (_LEAST < share < _LARGEST and straight and _is_other(gray, inside)):
        return None
    margin = max(1, round(_MARGIN * max(gray.shape)))
    side = 2 * margin + 1
    # Where the sheet runs out of the picture it has no edge.
    framed = cv2.copyMakeBorder(
        inside.view(np.uint8), margin, margin, margin, margin, cv2.BORDER_REPLICATE
    )
    kept = cv2.erode(framed, np.ones((side, side), np.uint8))[margin:-margin, margin:-margin]
    points = (hull[:, 0].astype(np.float32) + 0.5) * np.float32(shrink)
    return Sheet(points, kept == 0, 1 - share)


def without_surroundings(picture: Array, sheet: Sheet) -> Array:
    """The picture with the colour of the sheet, as it is nearby, beyond its edge."""
    small = sheet.beyond.shape
    paper = cv2.resize(picture, small[::-1], interpolation=cv2.INTER_AREA)
    reach = 2 * max(3, round(_THICK * max(small))) + 1
    lit = np.where(_like(sheet.beyond, paper), np.zeros_like(paper), paper)
    lit = cv2.dilate(lit, np.ones((reach, reach), np.uint8))
    lit = np.where(
        _like(sheet.beyond & (lit.reshape(*small, -1).max(2) == 0), lit),
        np.median(paper[~sheet.beyond], axis=0).astype(paper.dtype),
        lit,
    )
    ground = cv2.resize(lit, picture.shape[1::-1], interpolation=cv2.INTER_LINEAR)
    beyond = cv2.resize(
        sheet.beyond.view(np.uint8), picture.shape[1::-1], interpolation=cv2.INTER_NEAREST
    )
    return np.where(_like(beyond > 0, picture), ground, picture)


def _like(mask: Array, picture: Array) -> Array:
    """A mask that goes with a picture, grey or coloured."""
    return mask if picture.ndim == 2 else mask[..., None]


def _is_other(gray: Array, inside: Array) -> bool:
    """Whether what is outside is neither paper nor drawn: clearly darker, thick, and no ink."""
    outside = ~inside
    core = cv2.erode(outside.view(np.uint8), np.ones((5, 5), np.uint8), borderValue=1) > 0
    if core.sum() < 0.01 * core.size:
        return False
    thick = cv2.distanceTransform(
        np.pad(outside, 1, constant_values=True).view(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5
    ).max()
    there, paper = gray[core].astype(np.float32), float(np.median(gray[inside]))
    darker = np.median(there) < _DARKER * paper
    ink = np.median(there) < _BLACK and np.ptp(np.percentile(there, (10, 90))) < 4 * _SMOOTH
    sides = sum(
        edge.mean() > 0.9 for edge in (outside[0], outside[-1], outside[:, 0], outside[:, -1])
    )
    return bool(darker and thick > _THICK * max(gray.shape) and (not ink or sides >= 3))
