"""How wide the pen of a page is."""

from __future__ import annotations

import cv2
import numpy as np

from ..arrays.distance import depth
from ..arrays.two_clusters import finer_pen
from ..values import Array
from .paper import flatten_paper
from .picture import unit

_FINEST = 1.5  # px; a finer pen than this beside a broad one is as likely grain
_WINDOW, _WINDOWS = 512, 16  # px and number of the places where the pen is measured


def measure_pen(ink: Array) -> float:
    """Typical full width of the lines in an ink map, px; 0 when it has none."""
    return _typical([_line_widths(ink)])


def measured_pen(gray: Array, ink: Array | None) -> float:
    """The pen where the page has most ink; `ink` is the flattened page when it is small enough."""
    if ink is not None:
        return _typical([_line_widths(ink[window]) for window in _inkiest_windows(-ink)])
    windows = _inkiest_windows(gray)
    return _typical([_line_widths(flatten_paper(unit(gray[window]))) for window in windows])


def _typical(widths: list[Array]) -> float:
    """The mean of the middle half: as robust as a median, but not confined to whole pixels.

    Where a page has two pens, a fine and a broad one, the fine one: it is the harder to see.
    """
    every = np.sort(np.concatenate([np.zeros(0), *widths]))
    finer = finer_pen(every)
    if len(finer) and finer.mean() > _FINEST:
        every = finer
    middle = every[len(every) // 4 : -(-3 * len(every) // 4)]
    return float(middle.mean()) if middle.size else 0.0


def _inkiest_windows(gray: Array) -> list[tuple[slice, slice]]:
    """The windows that are darkest against their own lightest part."""
    found = []
    for top in range(0, gray.shape[0], _WINDOW):
        for left in range(0, gray.shape[1], _WINDOW):
            window = (slice(top, top + _WINDOW), slice(left, left + _WINDOW))
            sample = gray[window][::3, ::3]
            if min(sample.shape) >= 4:
                found.append((float(sample.max()) - float(sample.mean()), window))
    found.sort(key=lambda entry: -entry[0])
    return [window for _, window in found[:_WINDOWS]]


def _line_widths(ink: Array) -> Array:
    """The full width at every pixel along the middle of the lines; dots and blobs do not count.

    Measured at twice the resolution, since half a pixel matters for a thin pen.
    """
    soft = cv2.GaussianBlur(ink, (0, 0), 0.7)
    large = cv2.resize(soft, None, fx=2, fy=2, interpolation=cv2.INTER_LINEAR)
    peak = cv2.dilate(large, np.ones((13, 13), np.uint8))
    dark = (large > np.maximum(0.5 * peak, 0.2)).astype(np.uint8)
    distance = depth(dark)
    middle = (dark > 0) & (distance >= cv2.dilate(distance, np.ones((3, 3), np.uint8)))
    _, label, stats, _ = cv2.connectedComponentsWithStats(dark)
    extent = np.hypot(stats[:, cv2.CC_STAT_WIDTH], stats[:, cv2.CC_STAT_HEIGHT])
    widths, owner = distance[middle], label[middle]
    widths = widths[extent[owner] > np.maximum(12.0, 6.0 * widths)]
    return np.sqrt(np.maximum(widths**2 - 3.0, 1.0))  # less what blur and pixels have added
