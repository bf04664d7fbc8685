"""Two media of one page told apart by how strong they are: pencil, and the ink over it.

A page has both when the strengths of its lines form two clusters, one much fainter than the other,
with the less between them the less they differ. One cluster, however wide, is one medium: hardly
and firmly drawn pencil stays together.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

Array = np.ndarray


@dataclass(frozen=True)
class Split:
    """level: the strongest of the fainter medium; faint, strong: the mean of either;
    share: of all, what the smaller of them has; between: of all, what is neither clearly."""

    level: float
    faint: float
    strong: float
    share: float
    between: float


def split_strengths(strength: Array, weight: Array) -> Split | None:
    """The split that leaves the least variance on both sides (Otsu 1979); None for one strength.

    Args:
        strength: (N,) and weight: (N,) how much each counts, > 0.
    """
    order = np.argsort(strength, kind="stable")
    value, weight = strength[order], weight[order]
    if len(value) < 2 or value[0] == value[-1]:
        return None
    below, mass = np.cumsum(weight), np.cumsum(weight * value)
    above = below[-1] - below[:-1]
    faint, strong = mass[:-1] / below[:-1], (mass[-1] - mass[:-1]) / above
    at = int((below[:-1] * above * (strong - faint) ** 2).argmax())
    low, high = float(faint[at]), float(strong[at])
    third = (high - low) / 3
    between = weight[(value > low + third) & (value < high - third)].sum()
    return Split(
        level=float(value[at]),
        faint=low,
        strong=high,
        share=float(min(below[at], above[at]) / below[-1]),
        between=float(between / below[-1]),
    )
