"""autotrace's centre lines (Inkscape's too), as PyPI's pyautotrace runs them."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from ..judged_pages import picture

Array = np.ndarray


def trace(path: str | PathLike[str]) -> list[Array]:
    """The strokes of a scan, in px."""
    from autotrace import Bitmap, Color, TraceOptions

    grey = picture(Path(path))
    # It takes every shade for a region of its own; ink and paper are told apart for it.
    _, page = cv2.threshold(grey, 0, 255, cv2.THRESH_BINARY | cv2.THRESH_OTSU)
    options = TraceOptions(centerline=True, background_color=Color(255, 255, 255))
    colored: Any = cv2.cvtColor(page, cv2.COLOR_GRAY2RGB)
    vector = Bitmap(colored).trace(options=options)
    # Its y axis points up, and starts half a pixel lower.
    return [_line(p) * (1, -1) + np.array([0, grey.shape[0] - 0.5]) for p in vector.paths if len(p)]


def _line(path: Any) -> Array:
    """The points of a path of splines, about 1 px apart."""
    parts = []
    for spline in path.splines:
        corners = np.array([(p.x, p.y) for p in spline.points])
        if int(spline.degree) == 1:
            parts.append(corners[[0, 3]])
            continue
        length = np.hypot(*np.diff(corners, axis=0).T).sum()
        t = np.linspace(0, 1, int(length) + 3)[:, None]
        weights = np.hstack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3])
        parts.append(weights @ corners)
    return np.vstack(parts)
