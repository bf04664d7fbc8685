"""Colours of the overlay, readable for the colour-blind: a scale for doubt, a set for strokes."""

from __future__ import annotations

import numpy as np

Array = np.ndarray
Color = tuple[float, float, float]

# Defaults of the preferences. Blue to yellow differ in lightness, too.
SURE: Color = (0.10, 0.28, 0.62)
DOUBTFUL: Color = (1.00, 0.80, 0.05)
LOCKED: Color = (0.75, 0.75, 0.75)

# Okabe and Ito's set, without black and yellow.
STROKES: tuple[Color, ...] = (
    (0.835, 0.369, 0.000),
    (0.000, 0.447, 0.698),
    (0.000, 0.620, 0.451),
    (0.800, 0.475, 0.655),
    (0.337, 0.706, 0.914),
    (0.902, 0.624, 0.000),
)
LOOSE: Color = (0.45, 0.45, 0.45)

_FULL = 0.5  # doubt at which the scale ends: beyond it another routing is the likelier one


def doubt_colors(doubt: Array, locked: Array, sure: Color, doubtful: Color, fixed: Color) -> Array:
    """(J, 4) RGBA of junctions; certain ones are fainter."""
    share = np.clip(np.asarray(doubt, np.float32) / _FULL, 0.0, 1.0)[:, None]
    rgb = (1 - share) * np.array(sure) + share * np.array(doubtful)
    rgb = np.where(np.asarray(locked)[:, None], np.array(fixed), rgb)
    alpha = np.where(np.asarray(locked)[:, None], 0.6, 0.55 + 0.45 * share)
    return np.concatenate([rgb, alpha], axis=1).astype(np.float32)
