"""What colour an ink has, whatever share of paper a pixel of it holds.

A pixel of a thin line is ink mixed with paper. Its optical density (-log of the reflectance) is
about a multiple of the ink's own, so that inks differ in the direction of their density.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..values import Array, PlanarGraph

NEUTRAL = 0.3  # greatest chroma of black ink
_PAPER = 0.05  # mean density below which paper, not ink, decides the tint
_ACROSS = (np.array([[2.0, -1.0, -1.0], [0.0, 3.0**0.5, -(3.0**0.5)]]) / 6.0**0.5).T
_END = 0.2  # of a branch, at either end
_DARKER = 0.35  # of its points: how many are darker than the colour it is given


def density(colors: Array) -> Array:
    """(..., 3) optical density of sRGB colours 0..255; 0 = white paper.

    float32 stays float32, for whole pages; anything else becomes float64.
    """
    colors = np.asarray(colors)
    if colors.dtype != np.float32:
        colors = colors.astype(np.float64)
    return -np.log((colors + 8.0) / 263.0)


def tint(colors: ArrayLike) -> Array:
    """(..., 2) direction (hue) and distance (chroma) from grey; 0 = black, grey or paper.

    Red ink has a chroma of about 1, black ink in a warm scan 0.1.
    """
    return tint_of(density(np.asarray(colors)))


def tint_of(dense: Array) -> Array:
    """The tint (..., 2) of densities (..., 3)."""
    relative = dense / np.maximum(dense.mean(-1, keepdims=True), _PAPER) - 1.0
    return relative @ _ACROSS


def chroma_and_hue(tints: Array) -> tuple[Array, Array]:
    """(..., 2) tints as chroma (...) and hue (...) in radians."""
    return np.hypot(tints[..., 0], tints[..., 1]), np.arctan2(tints[..., 1], tints[..., 0])


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
    assert graph.colors is not None, "only a measured graph has colours"
    for channel in range(3):
        values = graph.colors[inner, channel].astype(np.float64)
        colors[:, channel] = values[np.lexsort((values, branch[inner]))][taken]
    return colors
