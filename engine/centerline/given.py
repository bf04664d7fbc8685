"""The provider for an input that already is a centerline image, white on black."""

from __future__ import annotations

from collections.abc import Callable

import cv2
import numpy as np

from ..errors import InvoluteError
from ..values import LineMaps, Scan

_NO_LINE = 64  # px; what is as wide is no centerline, and is thinned for minutes on a large page
_WHITE = 0.5


def given(scan: Scan, tick: Callable[[float], None]) -> LineMaps:
    """Use the picture itself as the centerline map.

    Raises:
        InvoluteError: it has white areas, as a scan of dark lines on paper has.
    """
    white = (scan.ink > _WHITE).view(np.uint8)
    if cv2.erode(white, np.ones((_NO_LINE, _NO_LINE), np.uint8), borderValue=0).any():
        raise InvoluteError(
            "The picture has white areas and is not of centerlines, thin white lines on black; "
            "choose another --provider."
        )
    tick(1.0)
    return LineMaps(scan.ink)
