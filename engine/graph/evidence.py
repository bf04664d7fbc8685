"""What is known of a page while its graph is made: seen once, read by every pass."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import cv2
import numpy as np

from ..values import Array, LineMaps, Scan
from .limits import LIMITS
from .ridge import Ridge


@dataclass(frozen=True, eq=False)
class Evidence:
    """One page as the passes see it. Maps are (H, W) float32; what they share is made once.

    maps: what the centerline provider saw.
    pen_width: typical width of a line in the ink, px.
    scan: the page itself, or None where there is only a centerline: then nothing is measured.
    partner: (2B,) the half-branch in which each one continues, once the graph has been routed.
    ridge_width: width of a line in the centerline map, px.
    """

    maps: LineMaps
    pen_width: float
    scan: Scan | None = None
    partner: Array | None = None
    ridge_width: float = LIMITS.ridge_width

    @staticmethod
    def of(scan: Scan, maps: LineMaps) -> Evidence:
        """All that is known of a scanned page."""
        return Evidence(maps, scan.pen_width, scan)

    def routed(self, partner: Array) -> Evidence:
        """The same page, for the passes that look at the strokes of a graph."""
        return replace(self, partner=partner)

    @property
    def shape(self) -> tuple[int, int]:
        """Height and width of the page, px."""
        height, width = self.maps.centerline.shape
        return height, width

    @cached_property
    def ridge(self) -> Ridge:
        return Ridge.of(self.maps.centerline)

    @property
    def value(self) -> Array:
        """The smoothed centerline map."""
        return self.ridge.value

    @cached_property
    def seen_ends(self) -> Array | None:
        """The surest sign of an end within 3 px of each pixel; None without such a map."""
        return _nearby(self.maps.endpoints, 7)

    @cached_property
    def seen_junctions(self) -> Array | None:
        """The surest sign of a junction within 2 px of each pixel; None without such a map."""
        return _nearby(self.maps.junctions, 5)


def _nearby(heat: Array | None, size: int) -> Array | None:
    """The brightest value of a map within a square of `size` px."""
    return None if heat is None else cv2.dilate(heat, np.ones((size, size), np.uint8))
