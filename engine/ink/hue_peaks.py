"""The few hues round which the coloured lines of a page gather."""

from __future__ import annotations

from typing import TypeVar

import numpy as np

from ..values import Array

Angle = TypeVar("Angle", float, Array)

_HUES = 36  # bins round the colour circle


def hue_peaks(hue: Array, weight: Array, smallest: float) -> Array:
    """(K,) hues of inks, in radians.

    Args:
        hue: (N,) radians, of lines or pixels, and weight: (N,) how much each counts.
        smallest: what an ink must weigh.
    """
    share = np.bincount(
        ((hue + np.pi) / (2 * np.pi) * _HUES).astype(int) % _HUES, weight, minlength=_HUES
    )
    near = share + np.roll(share, 1) + np.roll(share, -1)
    # Two bins of one ink can't both be the highest of their neighbourhood of seven.
    around = np.max([np.roll(near + 1e-9 * share, k) for k in (-3, -2, -1, 1, 2, 3)], axis=0)
    top = (near + 1e-9 * share > around) & (near >= smallest)
    return (np.flatnonzero(top) + 0.5) / _HUES * 2 * np.pi - np.pi


def turn(angle: Angle) -> Angle:
    """The same angle in [-pi, pi)."""
    return (angle + np.pi) % (2 * np.pi) - np.pi
