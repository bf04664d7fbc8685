"""What colour an ink has, whatever share of paper a pixel of it holds.

A pixel of a thin line is ink mixed with paper. Its optical density (-log of the reflectance) is
about a multiple of the ink's own, so that inks differ in the direction of their density.
"""

from __future__ import annotations

import numpy as np

from ..values import PlanarGraph

Array = np.ndarray

NEUTRAL = 0.3  # greatest chroma of black ink
_END = 0.2  # of a branch, at either end
_DARKER = 0.35  # of its points: how many are darker than the colour it is given


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
    """A darker colour of the inner part of each branch, (B, 3) float, 0..255.

    Where the pen touched the paper fully, it is the ink's own. At its ends, and where lines cross,
    a branch runs into other ink, which must not count however dark it is.
    """
    count = np.diff(graph.offsets)
    branch = np.repeat(np.arange(graph.branch_count), count)
    place = np.arange(len(graph.points)) - graph.offsets[branch]
    outer = (_END * count).astype(np.int64)[branch]
    inner = np.flatnonzero((place >= outer) & (place < count[branch] - outer))
    held = np.bincount(branch[inner], minlength=graph.branch_count)
    taken = np.cumsum(held) - held + (_DARKER * held).astype(np.int64)
    colors = np.empty((graph.branch_count, 3))
    for channel in range(3):
        values = graph.colors[inner, channel].astype(np.float64)
        colors[:, channel] = values[np.lexsort((values, branch[inner]))][taken]
    return colors
