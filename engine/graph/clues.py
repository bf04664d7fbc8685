"""What the picture says about a lift at each corner, in the few numbers that a drawing keeps.

The first round of a small network, `lifts` makes its input; `routing.lifting` has the second, which
looks at all corners of a page. training/corners makes the weights of both.
"""

from __future__ import annotations

import numpy as np

from .. import weights
from ..perceptron import forward, load
from ..values import Array

WEIGHTS = weights.FOLDER / "corners.npz"


def available() -> bool:
    """Whether the weights are there."""
    return WEIGHTS.exists()


def clues(evidence: Array) -> Array:
    """(C, K) float32 what was seen at each of C corners, (C, F).

    Raises:
        InvoluteError: the weights are missing or damaged.
    """
    net = load(WEIGHTS)
    rows = (evidence.astype(np.float64) - net["mean"]) / net["spread"]
    return np.tanh(forward(np.clip(rows, -5, 5), net, "see_")).astype(np.float32)
