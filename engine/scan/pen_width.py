"""How wide the pen of a page is."""

from __future__ import annotations

import cv2
import numpy as np

from ..arrays.components import components
from ..arrays.distance import depth
from ..arrays.two_clusters import finer_pen
from ..values import Array
from .paper import flatten_paper
from .picture import unit

_FINEST = 1.5  # px; a finer pen than this beside a broad one is as likely grain
_WINDOW, _WINDOWS = 512, 16  # px and number of the places where the pen is measured
_FEW = 4  # of these places, where it is seen whether the ink lies in lines
_PLENTY = 4e6  # px of a page that is looked at whole
_DARK = 0.3  # ink
_FAINT, _ROUND_INK = 0.2, 8  # blurred ink that is no line; px around the ink that play a part
# On 60 held-out pages of all media the ink of lines is 0.68 to 0.97 coherent; that of grain, and of
# dense charcoal, 0.22 to 0.67. In smaller pictures broad pencil has 0.62 to 0.85, widths whose
# middle half is within 1.5, and ink on 0.77 and more of them; dense drawings have 1.6 to 5.
_LINES, _CLOSED, _ALIKE, _FULL = 0.7, 0.62, 1.5, 0.75
_COARSE = 2.0  # px of a pen on the grid of its coherence: by 0.004 another one on 22 pages, at most
_BROADER = 1.5  # pens, that broad lines are at least wide
_SMALLEST = 60  # px of a picture in which lines can still be told


def measure_pen(ink: Array) -> float:
    """Typical full width of the lines in an ink map, px; 0 when it has none."""
    return _typical([_line_widths(ink)])


def measured_pen(gray: Array, ink: Array | None) -> float:
    """The pen where the page has most ink; `ink` is the flattened page when it is small enough."""
    if ink is not None:
        parts = [ink[window] for window in _inkiest_windows(-ink)]
    else:
        parts = [flatten_paper(unit(gray[window])) for window in _inkiest_windows(gray)]
    pen = _typical([_line_widths(part) for part in parts])
    if pen and _in_lines(parts[:_FEW], pen) < _LINES:
        shrink = 1.0 if ink is not None else max(1.0, (gray.size / _PLENTY) ** 0.5)
        page = ink if ink is not None else flatten_paper(unit(_reduced(gray, shrink)))
        return max(pen, shrink * _beyond_grain(page, pen / shrink))
    return pen


def _in_lines(parts: list[Array], pen: float) -> float:
    """How far the edges of the ink run in one direction within a few pen widths: 1 for lines, 0.3
    for grain (the coherence of the structure tensor, weighted by its trace)."""
    along = every = 0.0
    for ink in parts:
        soft = cv2.GaussianBlur(ink, (0, 0), max(0.5, pen / 5))
        dx, dy = (cv2.Sobel(soft, cv2.CV_32F, *axis, scale=1 / 8) for axis in ((1, 0), (0, 1)))
        # What a blur so wide leaves is as well seen on a coarser grid.
        coarse = pen / _COARSE if pen > 2 * _COARSE else 1.0
        xx, yy, xy = (_blurred(p, 1.5 * pen, coarse) for p in (dx * dx, dy * dy, dx * dy))
        dark = ink > _DARK
        along += float(np.sqrt((xx - yy) ** 2 + 4 * xy**2)[dark].sum())
        every += float((xx + yy)[dark].sum())
    return along / max(every, 1e-9)


def _blurred(field: Array, sigma: float, coarse: float) -> Array:
    """A field (H, W) after a wide Gaussian blur, px; made on a grid so many times coarser."""
    if coarse == 1.0:
        return cv2.GaussianBlur(field, (0, 0), sigma)
    small = cv2.GaussianBlur(_reduced(field, coarse), (0, 0), sigma / coarse)
    return cv2.resize(small, field.shape[::-1])


def _beyond_grain(ink: Array, pen: float) -> float:
    """The width of broad lines of which `pen` is but the grain, px; 0 when there are none.

    Looked for in ever smaller pictures, in which grain closes: there the page is of lines, all
    about equally wide, and solid.
    """
    shrink = max(2.0, pen / 2)
    while min(ink.shape) / shrink > _SMALLEST:
        small = _reduced(ink, shrink)
        lit = small[small > _DARK]
        if not lit.size:
            break
        # Grain, averaged, is grey: full ink again.
        small = np.clip(small / max(float(np.quantile(lit, 0.7)), _DARK), 0, 1)
        widths = _line_widths(small)
        broad = shrink * _typical([widths])
        if broad > _BROADER * pen and _in_lines([small], broad / shrink) > _CLOSED:
            low, high = np.quantile(widths, (0.25, 0.75))
            dark = cv2.resize(small, ink.shape[::-1], interpolation=cv2.INTER_NEAREST) > 0.5
            if high < _ALIKE * low and (ink[dark] > _DARK).mean() > _FULL:
                return broad
        shrink *= 1.6
    return 0.0


def _reduced(picture: Array, shrink: float) -> Array:
    return cv2.resize(picture, None, fx=1 / shrink, fy=1 / shrink, interpolation=cv2.INTER_AREA)


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
    soft = _inked_part(cv2.GaussianBlur(ink, (0, 0), 0.7))
    large = cv2.resize(soft, None, fx=2, fy=2, interpolation=cv2.INTER_LINEAR)
    peak = cv2.dilate(large, np.ones((13, 13), np.uint8))
    np.multiply(peak, 0.5, out=peak)  # in place: fresh memory costs more than the sums
    dark = (large > np.maximum(peak, _FAINT, out=peak)).view(np.uint8)
    distance = depth(dark)
    middle = (dark > 0) & (distance >= cv2.dilate(distance, np.ones((3, 3), np.uint8)))
    _, label, stats, _ = components(dark)
    extent = np.hypot(stats[:, cv2.CC_STAT_WIDTH], stats[:, cv2.CC_STAT_HEIGHT])
    widths, owner = distance[middle], label[middle]
    widths = widths[extent[owner] > np.maximum(12.0, 6.0 * widths)]
    return np.sqrt(np.maximum(widths**2 - 3.0, 1.0))  # less what blur and pixels have added


def _inked_part(soft: Array) -> Array:
    """As much of a window as has lines in it, with what is around them: all that counts."""
    x, y, width, height = cv2.boundingRect((soft > _FAINT).view(np.uint8))
    rows = slice(max(0, y - _ROUND_INK), y + height + _ROUND_INK)
    part = soft[rows, max(0, x - _ROUND_INK) : x + width + _ROUND_INK]
    return np.ascontiguousarray(part) if width else soft[:1, :1]
