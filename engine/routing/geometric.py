"""Log-odds that two half-branches are one line, from their geometry and ink alone.

A log-linear model: the score of a pair is a weighted sum of its features, and the probability of
an involution is proportional to exp(sum of the scores of its pairs). It needs no network and is
the baseline that the network has to beat. `training/routing/geometric_fit.py` made the weights.
"""

from __future__ import annotations

import numpy as np

from ..values import PlanarGraph
from .features import FEATURES, pair_features

Array = np.ndarray

WEIGHTS = {
    "join": 1.66,
    "join, three": 0.33,
    "join, many": -0.69,
    "turn of lines": -0.31,
    "turn of lines over 0.2": 1.37,
    "turn of lines over 0.6": 2.78,
    "turn of lines over 1.3": 0.33,
    "turn of lines, many": -3.60,
    "turn of lines over 0.6, many": 0.30,
    "turn of curves": -1.46,
    "turn of curves over 0.2": -1.05,
    "turn of curves over 0.6": 2.31,
    "turn of curves over 1.3": -0.10,
    "turn of curves, many": 2.37,
    "turn of curves over 0.6, many": -2.36,
    "turn of chords": -1.94,
    "turn of chords over 0.2": -1.33,
    "turn of chords over 0.6": 0.09,
    "turn of chords over 1.3": -0.95,
    "turn of chords, many": 3.07,
    "turn of chords over 0.6, many": -0.39,
    "misfit, middle": -0.94,
    "misfit, far": 0.08,
    "opposite": 0.28,
    "opposite, many": -0.99,
    "short": 0.76,
    "width": -1.50,
    "strength": -1.00,
    "tint": -6.00,
}
_WEIGHTS = np.array([WEIGHTS[name] for name in FEATURES])


def score(graph: PlanarGraph, pairs: Array) -> Array:
    """(K,) float32 log-odds of joining each of the (K, 2) pairs against ending both."""
    return (pair_features(graph, pairs) @ _WEIGHTS).astype(np.float32)
