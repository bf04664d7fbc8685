"""How dense the ink of a line is, and which lines are pencil under ink."""

from __future__ import annotations

import numpy as np

from ..values import Array, PlanarGraph
from .tint import NEUTRAL, branch_colors, tint
from .two_strengths import split_strengths

_SOFT = 0.8  # px; how far a scanner spreads the ink of a line
_INNER = 0.2  # of a branch at either end: other lines are near


def undimmed(strength: Array, widths: Array) -> Array:
    """(P,) strength of the ink itself: a thin line is not faint because a scanner blurs it.

    Args:
        strength: (P,) darkness in [0, 1] of lines that are `widths` (P,) px wide.
    """
    half = np.maximum(widths, 0.5) / (2**1.5 * _SOFT)
    peak = np.sqrt(1 - np.exp(-half * half * 4 / np.pi))  # erf, to one percent
    return np.asarray(strength, np.float64) / peak


def pencil(graph: PlanarGraph, chosen: Array, length: Array) -> tuple[Array, float]:
    """Tell pencil from the ink that was drawn over it.

    Args:
        chosen: (B,) bool, the branches to look at: black and grey ones.
        length: (B,) px of each branch.

    Returns:
        (B,) bool, the branches that are pencil; and how strong it is beside the ink, 1 = as strong.
    """
    found = np.zeros(graph.branch_count, bool)
    if graph.strength is None or graph.widths is None or chosen.sum() < 2:
        return found, 1.0
    strength = _of_branches(graph)
    split = split_strengths(strength[chosen], length[chosen] + 1e-6)
    if split is None:
        return found, 1.0
    return chosen & (strength <= split.level), split.low / split.high


def neutral(graph: PlanarGraph) -> Array:
    """(B,) bool, the branches that are black or grey."""
    if graph.colors is None or graph.branch_count == 0:
        return np.ones(graph.branch_count, bool)
    return np.hypot(*tint(branch_colors(graph)).T) <= NEUTRAL


def _of_branches(graph: PlanarGraph) -> Array:
    """(B,) the strength in the inner part of each branch."""
    count = np.diff(graph.offsets)
    place = np.arange(len(graph.points)) - np.repeat(graph.offsets[:-1], count)
    share = place / np.repeat(np.maximum(count - 1, 1), count)
    weight = np.where(np.abs(share - 0.5) <= 0.5 - _INNER, 1.0, 1e-6)
    assert graph.strength is not None, "pencil is told by what was measured"
    assert graph.widths is not None
    value = undimmed(graph.strength, graph.widths)
    start = graph.offsets[:-1]
    return np.add.reduceat(weight * value, start) / np.add.reduceat(weight, start)
