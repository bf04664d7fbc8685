"""Which side of a picture is ink: dark lines on light, or light ones on dark."""

from __future__ import annotations

import cv2
import numpy as np

from ..errors import InvoluteError
from ..settings import Settings
from ..values import Array
from .picture import as_bytes, darkest_gray, row_strips, white_of

_ODD = 2.0  # times more light than dark on a light page, before it counts as light on dark
_DOUBTLESS = 4.0  # times more on one side than it takes


def is_light_on_dark(picture: Array, settings: Settings) -> bool:
    """Whether the lines are lighter than what is around them."""
    if settings.polarity != "auto":
        return settings.polarity == "light"
    # Thin lines would fade in a reduced picture: take every n-th pixel instead.
    step = max(1, max(picture.shape[:2]) // 1024)
    small = as_bytes(darkest_gray(np.ascontiguousarray(picture[::step, ::step])))
    if small.max() < 26:
        raise InvoluteError(
            "The picture is black all over; scan the page again, or choose polarity 'light' if "
            "it is an empty blackboard."
        )
    # Wide medians take time: where a quarter of the pixels leave no doubt, they decide.
    light, dark, most = _sides(np.ascontiguousarray(small[::2, ::2]), 127)
    if light > _DOUBTLESS * most * dark or dark > _DOUBTLESS * light / most:
        return light > most * dark
    light, dark, most = _sides(small, 255)
    return light > most * dark


def _sides(small: Array, widest: int) -> tuple[int, int, float]:
    """How much is lighter than what is around it (`widest` px at most), and how much darker; and
    how many times more light than dark there is at least where the lines are light."""
    # The median is the paper wherever lines cover less than half of the surroundings. Mirrored at
    # the picture's edge: OpenCV would repeat the edge, and a line there would be the paper.
    reach = max(3, min(widest, min(small.shape) // 2 | 1))
    margin = reach // 2
    around = cv2.copyMakeBorder(small, margin, margin, margin, margin, cv2.BORDER_REFLECT)
    paper = cv2.medianBlur(around, reach)[margin:-margin, margin:-margin]
    away = small.astype(np.int16) - paper
    grain = 3 * float(np.median(np.abs(away))) + 8
    light, dark = (int(np.maximum(side - grain, 0).sum(dtype=np.int64)) for side in (away, -away))
    # White on light paper would be odd: grain alone, as much of it either way, doesn't make it so.
    return light, dark, _ODD if np.median(paper) > 127 else 1.0


def with_lightness_inverted(picture: Array) -> Array:
    """White becomes black and black white; red stays red."""
    top = picture.dtype.type(white_of(picture))
    if picture.ndim == 2:
        return top - picture
    out = np.empty_like(picture)
    for rows in row_strips(picture):
        part = picture[rows]
        # Unsigned arithmetic wraps around, and back again: the result always fits.
        out[rows] = part + (top - part.max(axis=2, keepdims=True) - part.min(axis=2, keepdims=True))
    return out
