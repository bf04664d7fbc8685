"""Ink that was taken for paper, found in another way: so that the drawing's check sees it, too.

Paper is what a closing wider than any line leaves, and full ink what most dark pixels have; neither
looks at grain, nor at what the page's blocks look like.
"""

from __future__ import annotations

import cv2
import numpy as np

from ..values import Array

_WIDE = 12  # of the page's shorter side: lines and gaps between them are narrower
_DARK, _FULL = 0.25, 0.8  # darker than the paper is ink; quantile of it that is full ink
_PALEST = 0.15  # of black; a paler page has no ink
_CLEAR, _NONE = 0.5, 0.12  # of full ink: surely drawn; taken for paper
_BESIDE = 5  # px across; the edge of what was seen as ink
_LARGE = 24_000_000  # px; a larger page is not looked at twice


def overlooked(gray: Array, ink: Array) -> Array | None:
    """(H, W) bool: clear ink of a page of which nothing is in its ink; None where there is none.

    Args:
        gray: (H, W) float32 luminance in [0, 1] of dark lines.
        ink: (H, W) float32 in [0, 1], what was taken for ink.
    """
    if gray.size > _LARGE:
        return None
    side = max(5, min(gray.shape) // _WIDE // 4 | 1)
    small = cv2.resize(gray, None, fx=0.25, fy=0.25, interpolation=cv2.INTER_AREA)
    small = cv2.copyMakeBorder(small, side, side, side, side, cv2.BORDER_REFLECT)
    paper = cv2.morphologyEx(small, cv2.MORPH_CLOSE, np.ones((side, side), np.uint8))
    paper = cv2.GaussianBlur(paper, (0, 0), side / 2)[side:-side, side:-side]
    paper = cv2.resize(paper, gray.shape[::-1], interpolation=cv2.INTER_LINEAR)
    dark = 1 - gray / np.maximum(paper, 1 / 255)
    strong = dark[dark > _DARK]
    if not strong.size:
        return None
    full = max(float(np.quantile(strong, _FULL)), _PALEST)
    seen = cv2.dilate((ink > _NONE).view(np.uint8), np.ones((_BESIDE, _BESIDE), np.uint8))
    left: Array = (dark > _CLEAR * full) & (seen == 0)
    return left if left.any() else None
