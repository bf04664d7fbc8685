"""What colour an ink has, whatever share of paper a pixel of it holds.

A pixel of a thin line is ink mixed with paper. Its optical density (-log of the reflectance) is
about a multiple of the ink's own, so that inks differ in the direction of their density.
"""

from __future__ import annotations

import numpy as np

Array = np.ndarray


def density(colors: Array) -> Array:
    """(..., 3) optical density of sRGB colours 0..255; 0 = white paper."""
    return -np.log((np.asarray(colors, np.float64) + 8.0) / 263.0)


def tint(colors: Array) -> Array:
    """(..., 2) direction (hue) and distance (chroma) from grey; 0 = black, grey or paper.

    Red ink has a chroma of about 1, black ink in a warm scan 0.1.
    """
    dense = density(colors)
    relative = dense / np.maximum(dense.mean(-1, keepdims=True), 0.05) - 1.0
    across = np.array([[2.0, -1.0, -1.0], [0.0, 3.0**0.5, -(3.0**0.5)]]) / 6.0**0.5
    return relative @ across.T
