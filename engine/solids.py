"""Solid black areas: taken out of the scan before tracing, kept as closed outlines.

Hair, boots and hats are areas, not lines: a centerline through them would be a scribble.
"""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np

from .settings import Settings
from .values import Array, Scan

Fill = tuple[Array, ...]
"""One area: its outer ring first, then the rings of its holes; each (N, 2) float32, px."""

_WIDER = 3.5  # an area is at least this many pen widths wide


def split_solids(scan: Scan, settings: Settings) -> tuple[Scan, list[Fill]]:
    """Take the areas much wider than the pen out of a scan.

    Returns:
        The scan without them, and the areas as rings in working pixels.
    """
    if not settings.solids or settings.provider == "given":
        return scan, []
    dark = (scan.ink > 0.5).astype(np.uint8)
    radius = max(3.0, _WIDER * scan.pen_width / 2)
    inside = cv2.distanceTransform(dark, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    core = (inside > radius).astype(np.uint8)
    if not core.any():
        return scan, []
    outside = cv2.distanceTransform(1 - core, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    area = ((outside <= radius + 0.5) & (dark > 0)).astype(np.uint8)
    contours, tree = cv2.findContours(area, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
    fills: list[Fill] = []
    for index, (_, _, child, parent) in enumerate(tree[0]):
        if parent >= 0:
            continue
        rings = [contours[index]]
        while child >= 0:
            rings.append(contours[child])
            child = tree[0][child][0]
        fills.append(tuple(r.reshape(-1, 2).astype(np.float32) + 0.5 for r in rings))
    gone = cv2.dilate(area, np.ones((3, 3), np.uint8))
    return replace(scan, ink=np.where(gone > 0, np.float32(0), scan.ink)), fills
