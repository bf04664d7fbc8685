"""What colour the page has inside each closed region: white, or what was painted there."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np

from ..ink.bare_paper import is_paper
from ..values import Array, PlanarGraph, Scan
from .faces import Region

_LINE = 2.0  # line widths that are left out around the middle of a line
_BITS = 4  # of a pixel, as OpenCV draws


def region_colors(regions: Sequence[Region], graph: PlanarGraph, scan: Scan) -> Array | None:
    """The colour that each region was painted in, relative to the paper around the drawing.

    Args:
        regions: the largest first, and graph: both in px of the input.

    Returns:
        (R, 3) uint8 sRGB, 255 where it is bare paper; None for a grey page.
    """
    if scan.color is None or not regions:
        return None
    label = np.zeros(scan.ink.shape, np.int32)
    for number, rings in enumerate(regions, 1):
        cv2.fillPoly(label, [_fixed(ring, scan) for ring in rings], number, shift=_BITS)
    lines = [_fixed(graph.branch(b), scan) for b in range(graph.branch_count)]
    thick = max(1, round(_LINE * scan.pen_width))
    cv2.polylines(label, lines, False, -1, thick, shift=_BITS)
    paper = np.median(scan.color[label == 0].reshape(-1, 3)[::7], axis=0)
    inside = label > 0
    count = np.bincount(label[inside], minlength=len(regions) + 1)[1:]
    colors = np.ones((len(regions), 3))
    for channel in range(3):
        value = scan.color[..., channel][inside]
        total = np.bincount(label[inside], value, len(regions) + 1)[1:]
        colors[:, channel] = np.where(count > 0, total / np.maximum(count, 1), paper[channel])
    colors = np.clip(colors / np.maximum(paper, 1.0), 0.0, 1.0)
    return np.where(is_paper(colors)[:, None], 255, np.rint(colors * 255)).astype(np.uint8)


def same_colors(before: Sequence[Region], colors: Array, now: Sequence[Region]) -> Array:
    """(R, 3) uint8: the colour of regions after lines have changed, of the most alike before.

    Args:
        before, now: the regions, and colors: (Q, 3) uint8 those of the first.
    """
    if not before or not now:
        return np.full((len(now), 3), 255, np.uint8)
    old, new = (np.array([_box(rings[0]) for rings in some]) for some in (before, now))
    alike = [int(np.abs(old - box).sum(1).argmin()) for box in new]
    return colors[alike]


def _box(ring: Array) -> Array:
    return np.concatenate([ring.min(0), ring.max(0)])


def _fixed(points: Array, scan: Scan) -> Array:
    """Working pixels in OpenCV's fixed numbers; its pixel centres are whole numbers."""
    return np.round((points / scan.scale - 0.5) * (1 << _BITS)).astype(np.int32)
