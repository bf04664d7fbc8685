"""Small networks that NumPy alone runs: their weights, and what they make of rows of features."""

from __future__ import annotations

import io
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import numpy as np

from . import weights
from .values import Array


@cache
def load(path: Path) -> dict[str, Array]:
    """The weights in a file, float64, by name.

    Raises:
        InvoluteError: they are damaged.
        OSError: there are none.
    """
    with np.load(io.BytesIO(weights.read(path))) as file:
        return {name: file[name].astype(np.float64) for name in file.files}


def forward(rows: Array, net: Mapping[str, Array], prefix: str = "") -> Array:
    """Rows through the layers PREFIXweight0, PREFIXbias0, ... of a network, with ReLU between."""
    layer = 0
    while f"{prefix}weight{layer}" in net:
        rows = rows if layer == 0 else np.maximum(rows, 0.0)
        rows = rows @ net[f"{prefix}weight{layer}"] + net[f"{prefix}bias{layer}"]
        layer += 1
    return rows


def probability(log_odds: Array) -> Array:
    """What log-odds say as a probability, float64."""
    return 1.0 / (1.0 + np.exp(-np.clip(np.asarray(log_odds, np.float64), -50, 50)))
