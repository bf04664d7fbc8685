"""Values of an image between its pixels."""

from __future__ import annotations

import cv2
import numpy as np

from ..values import Array

_COLUMNS = 16384  # remap takes at most 32767 columns, so long lists are folded


def sample(image: Array, points: Array, beyond: int = cv2.BORDER_REPLICATE) -> Array:
    """Bilinear values of an image (H, W) or (H, W, C) at points (..., 2) in px, float32 or uint8.

    Beyond the border the image goes on as its outermost pixels, or as OpenCV's border mode says.
    """
    shape = points.shape[:-1]
    flat = points.reshape(-1, 2).astype(np.float32) - np.float32(0.5)
    count = len(flat)
    if count == 0:
        return np.zeros((*shape, *image.shape[2:]), image.dtype)
    rows = max(1, -(-count // _COLUMNS))
    padded: Array = np.zeros((rows * _COLUMNS, 2), np.float32) if rows > 1 else flat
    padded[:count] = flat
    values = cv2.remap(  # type: ignore[call-overload]  # one map is enough
        np.ascontiguousarray(image),
        padded.reshape(rows, -1, 2),
        None,
        cv2.INTER_LINEAR,
        borderMode=beyond,
    )
    return values.reshape(-1, *image.shape[2:])[:count].reshape(*shape, *image.shape[2:])
