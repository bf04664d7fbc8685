"""How far the dark pixels of a page lie from its light ones."""

from __future__ import annotations

import cv2
import numpy as np

from ..values import Array


def depth(dark: Array) -> Array:
    """Euclidean distance to the nearest light pixel, (H, W) float32 px; 0 where it is light.

    The same bits every time: OpenCV's exact transform rounds its square roots differently from
    one memory address to the next, so that a crest (equal neighbours) may come and go. The squares
    are whole numbers, which tells what the roots are.

    Args:
        dark: (H, W) uint8, not 0 = dark.
    """
    distance = cv2.distanceTransform(dark, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    np.minimum(distance, sum(dark.shape), out=distance)  # without any light: endless
    np.square(distance, out=distance)
    np.rint(distance, out=distance)
    return np.sqrt(distance, out=distance)


def may_be_deeper(dark: Array, radius: float) -> bool:
    """Whether `depth` may be above a radius (px) anywhere; False is certain, and found quickly.

    A disc of that radius holds a square, and whether one of these fits is asked by an erosion.
    """
    half = int(radius / 2**0.5)
    square = np.ones((2 * half + 1, 2 * half + 1), np.uint8)
    return bool(cv2.erode((dark > 0).view(np.uint8), square).any())
