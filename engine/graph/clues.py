"""What the picture says about a lift at each corner, in the few numbers that a drawing keeps.

The first round of a small network, `lifts` makes its input; `routing.lifting` has the second, which
looks at all corners of a page. training/corners makes the weights of both.
"""

from __future__ import annotations

import io
from collections.abc import Mapping
from functools import cache

import numpy as np

from .. import weights
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
    rows = (evidence.astype(np.float64) - net()["mean"]) / net()["spread"]
    return np.tanh(forward(np.clip(rows, -5, 5), net(), "see")).astype(np.float32)


def forward(rows: Array, net: Mapping[str, Array], name: str) -> Array:
    """Rows through the layers NAME_weight0, NAME_bias0, ... of a network, with ReLU between."""
    layer = 0
    while f"{name}_weight{layer}" in net:
        rows = rows if layer == 0 else np.maximum(rows, 0.0)
        rows = rows @ net[f"{name}_weight{layer}"] + net[f"{name}_bias{layer}"]
        layer += 1
    return rows


@cache
def net() -> dict[str, Array]:
    """The weights of both rounds."""
    with np.load(io.BytesIO(weights.read(WEIGHTS))) as file:
        return {name: file[name].astype(np.float64) for name in file.files}
