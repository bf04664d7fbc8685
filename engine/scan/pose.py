"""Which way up a drawing is looked at, so that it does not matter how its page was turned.

A network, and what thins a line to pixels, answer a little differently when a page is turned or
mirrored, and a doubtful junction may then be decided otherwise. So a drawing is always looked at
in the same of the eight ways in which a sheet can lie: spread more to the side than down, and with
more of its ink to the right of and below its middle than far away on the other side.
"""

from __future__ import annotations

import cv2
import numpy as np

from ..values import Array, Pose
from .picture import as_bytes

_CLEARLY = 38  # of 255; other than the paper by this much is drawn, whatever the grain
_EVEN = 1e-6  # a skewness below this is one of rounding


def pose_of(picture: Array) -> Pose:
    """The pose in which a page's drawing is looked at.

    All sums are of whole numbers, so that a turned page gives exactly the same ones.

    Args:
        picture: (H, W) or (H, W, 3), uint8, uint16 or float32 in [0, 1].

    Returns:
        What turns this page so; a page without a drawing stays as it lies.
    """
    gray = as_bytes(picture)
    gray = gray if gray.ndim == 2 else cv2.cvtColor(gray, cv2.COLOR_RGB2GRAY)
    count = cv2.calcHist([gray], [0], None, [256], [0, 256]).ravel()
    paper = int(np.searchsorted(np.cumsum(count), gray.size / 2))
    drawn = np.maximum(np.abs(np.arange(256) - paper) - _CLEARLY, 0).astype(np.uint8)
    ink = cv2.LUT(gray, drawn)
    sums = [ink.sum(axis, dtype=np.int64) for axis in (0, 1)]
    if not sums[0].any():
        return Pose()
    (wide, right), (high, down) = (_moments(s) for s in sums)
    transposed = high > wide
    if transposed:
        right, down = down, right
    return Pose(transposed, right < -_EVEN, down < -_EVEN)


def _moments(sums: Array) -> tuple[float, float]:
    """The variance of where ink lies along one side, px², and its skewness."""
    mass = sums / sums.sum()
    place = np.arange(len(sums), dtype=np.float64)
    place -= (mass * place).sum()
    variance = float((mass * place**2).sum())
    return variance, float((mass * place**3).sum()) / max(variance, 1e-9) ** 1.5
