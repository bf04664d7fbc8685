"""What colour an ink has, whatever share of paper a pixel of it holds.

A pixel of a thin line is ink mixed with paper. Its optical density (-log of the reflectance) is
about a multiple of the ink's own, so that inks differ in the direction of their density.
"""

from __future__ import annotations

import numpy as np

from .values import PlanarGraph

Array = np.ndarray

NEUTRAL = 0.3  # greatest chroma of black ink


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


def branch_colors(graph: PlanarGraph) -> Array:
    """The mean colour of each branch where it is darkest: (B, 3) float, 0..255."""
    weight = density(graph.colors).mean(1) ** 4 + 1e-6
    start = graph.offsets[:-1]
    total = np.add.reduceat(graph.colors * weight[:, None], start, axis=0)
    return total / np.add.reduceat(weight, start)[:, None]
