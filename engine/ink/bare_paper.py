"""Which colours are paper: bare, or in shade."""

from __future__ import annotations

import numpy as np

from ..values import Array

_PAPER = 0.08  # how far a colour may be from the paper's, as a share of it
_SHADE = (0.06, 0.3)  # the same for paper in shade: how far from grey, and how dark


def is_paper(colors: Array) -> Array:
    """(N,) bool; colors: (N, 3) in [0, 1], 1 = as light as the paper around the drawing."""
    bare = (1 - colors).max(axis=1) < _PAPER
    shaded = (np.ptp(colors, axis=1) < _SHADE[0]) & (colors.min(axis=1) > 1 - _SHADE[1])
    return bare | shaded
