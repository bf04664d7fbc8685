"""Centerlines without learning: ridges of the ink at several scales (Steger 1998, Lindeberg 1998).

The fallback when there are no weights, and the baseline that the network has to beat.
"""

from __future__ import annotations

from collections.abc import Callable

import cv2
import numpy as np

from ..values import Array, LineMaps, Scan

_WIDTHS = (0.5, 0.8, 1.25, 2.0)  # scales of the ridge filter, in pen widths


def classical(scan: Scan, tick: Callable[[float], None]) -> LineMaps:
    """Find the ridges of the ink; see `LineMaps.centerline`."""
    strength = np.zeros_like(scan.ink)
    offset = np.full_like(scan.ink, 9.0)
    for step, factor in enumerate(_WIDTHS):
        tick(step / len(_WIDTHS))
        _keep_stronger(strength, offset, *_ridge(scan.ink, max(0.8, factor * scan.pen_width / 2)))
    centerline = np.clip(strength * 1.5, 0, 1) * np.exp(-(offset**2))
    tick(1.0)
    return LineMaps(centerline)


def _keep_stronger(strength: Array, offset: Array, new: Array, new_offset: Array) -> None:
    better = new > strength
    strength[better] = new[better]
    offset[better] = new_offset[better]


def _ridge(ink: Array, sigma: float) -> tuple[Array, Array]:
    """Normalised ridge strength, and each pixel's distance to the crest across the ridge, px."""
    smooth = cv2.GaussianBlur(ink, (0, 0), sigma)
    dx = cv2.Sobel(smooth, cv2.CV_32F, 1, 0, scale=1 / 8)
    dy = cv2.Sobel(smooth, cv2.CV_32F, 0, 1, scale=1 / 8)
    xx = cv2.Sobel(smooth, cv2.CV_32F, 2, 0, scale=1 / 4)
    yy = cv2.Sobel(smooth, cv2.CV_32F, 0, 2, scale=1 / 4)
    xy = cv2.Sobel(smooth, cv2.CV_32F, 1, 1, scale=1 / 4)
    half = (xx - yy) / 2
    root = np.sqrt(half**2 + xy**2)
    across = (xx + yy) / 2 - root  # the most negative curvature
    # Its direction: the eigenvector of the smaller eigenvalue.
    angle = 0.5 * np.arctan2(xy, half) + np.pi / 2
    nx, ny = np.cos(angle), np.sin(angle)
    slope = dx * nx + dy * ny
    offset = np.abs(slope) / np.maximum(-across, 1e-6)
    return np.maximum(-across, 0) * sigma**2, offset
