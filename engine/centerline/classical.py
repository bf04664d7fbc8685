"""Centerlines without learning: the ridge of the distance to the paper.

The fallback when there are no weights, and the baseline that the network has to beat. The distance
to the edge of the ink is a roof whose crest is the middle of the line, however wide that is. How
sharply it bends tells a crest between opposite edges from one at a mere corner or bump, as the
outward flux does in Siddiqi et al., "Hamilton-Jacobi skeletons" (2002).
"""

from __future__ import annotations

from collections.abc import Callable

import cv2
import numpy as np

from ..arrays.distance import depth
from ..values import Array, LineMaps, Scan

_TILE = 1024  # px; pages are worked in tiles, so that memory does not grow with them
_FINE = 2  # the edge of the ink is found at this many times the resolution
_SOFTEN = 0.2  # pen widths; against rough edges and the grain of a pencil
_EDGE = 0.35  # of the darkest ink around; there is the edge of a line
_FAINTEST = 0.1  # ink
_SPECK = 0.6  # squared pen widths; smaller islands are dirt, smaller holes are grain
_CREST = 0.8  # px; standard deviation of the ridge that comes out
_ROOF = (0.45, 0.9)  # curvature of a crest, 1 = between parallel edges: from nothing to certain


def classical(scan: Scan, tick: Callable[[float], None]) -> LineMaps:
    """Find the middle of the lines in the ink of a scan."""
    height, width = scan.ink.shape
    centerline = np.zeros_like(scan.ink)
    margin = int(12 * scan.pen_width) + 16
    corners = [(y, x) for y in range(0, height, _TILE) for x in range(0, width, _TILE)]
    for done, (y, x) in enumerate(corners):
        tick(done / len(corners))
        top, left = max(0, y - margin), max(0, x - margin)
        ink = scan.ink[top : y + _TILE + margin, left : x + _TILE + margin]
        if ink.max() <= _FAINTEST:
            continue
        ridge = _ridge(_dark(ink, scan.pen_width), ink.shape)
        part = ridge[y - top : y - top + _TILE, x - left : x - left + _TILE]
        centerline[y : y + _TILE, x : x + _TILE] = part
    tick(1.0)
    return LineMaps(centerline)


def _dark(ink: Array, pen: float) -> Array:
    """The lines as 0 and 1 at `_FINE` times the resolution, against the ink around them."""
    soft = cv2.GaussianBlur(ink, (0, 0), max(0.6, _SOFTEN * pen))
    reach = int(4 * pen) | 1
    around = cv2.blur(cv2.dilate(soft, np.ones((reach, reach), np.uint8)), (reach, reach))
    above = soft - np.maximum(_EDGE * around, _FAINTEST)
    fine = cv2.resize(above, None, fx=_FINE, fy=_FINE, interpolation=cv2.INTER_LINEAR)
    dark = (fine > 0).astype(np.uint8)
    smallest = _SPECK * (pen * _FINE) ** 2
    for value, connectivity in ((0, 4), (1, 8)):
        place = (dark == value).astype(np.uint8)
        _, label, stats, _ = cv2.connectedComponentsWithStats(place, connectivity=connectivity)
        small = stats[:, cv2.CC_STAT_AREA] < smallest
        small[0] = False  # all that is not `place`
        dark[small[label]] = 1 - value
    return dark


def _ridge(dark: Array, shape: tuple[int, ...]) -> Array:
    """The crest of the signed distance to the edge, as a ridge in [0, 1] of the given shape."""
    inside = depth(dark)
    outside = depth(1 - dark)
    sigma = _CREST * _FINE
    roof = cv2.GaussianBlur(inside - outside, (0, 0), sigma)
    xx = cv2.filter2D(roof, -1, np.array([[1, -2, 1]], np.float32))
    yy = cv2.filter2D(roof, -1, np.array([[1], [-2], [1]], np.float32))
    xy = cv2.filter2D(roof, -1, np.array([[1, 0, -1], [0, 0, 0], [-1, 0, 1]], np.float32) / 4)
    across = (xx + yy) / 2 - np.hypot((xx - yy) / 2, xy)  # the most negative curvature
    # Slopes of 1 that meet, smoothed, curve by twice the Gaussian's height.
    curvature = across * (-sigma * np.sqrt(np.pi / 2))
    low, high = _ROOF
    ridge = np.clip((curvature - low) / (high - low), 0, 1) * dark
    return cv2.resize(ridge, shape[::-1], interpolation=cv2.INTER_AREA)
