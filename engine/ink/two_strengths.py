"""Two media of one page told apart by how strong they are: pencil, and the ink over it.

A page has both when the strengths of its lines form two clusters, one much fainter than the other,
with the less between them the less they differ. One cluster, however wide, is one medium: hardly
and firmly drawn pencil stays together.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..values import Array

# Of 12 pages (benchmarks.pencil_under_ink), strengths seen along lines and in pixels: ink over
# pencil has up to 0.62 and 0.06 between, pencil of uneven pressure alone 0.65 and more.
_FAINTER = 0.635  # of the ink's strength: what pencil under it is at most
_BETWEEN = (0.3, 0.8)  # how much may be neither: 0.3 for each 1 below 0.8 of the ink's strength
_LEAST = 0.1  # what either must have; less may be dirt, or badly printed


@dataclass(frozen=True)
class Split:
    """level: the strongest of the fainter medium; faint, strong: the mean of either;
    share: of all, what the smaller of them has; between: of all, what is neither clearly."""

    level: float
    faint: float
    strong: float
    share: float
    between: float

    @property
    def is_of_two_media(self) -> bool:
        ratio = self.faint / self.strong
        apart = self.between < _BETWEEN[0] * (_BETWEEN[1] - ratio)
        return ratio < _FAINTER and apart and self.share > _LEAST


def split_strengths(strength: Array, weight: Array) -> Split | None:
    """The split that leaves the least variance on both sides (Otsu 1979); None for one medium.

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
    split = Split(
        level=float(value[at]),
        faint=low,
        strong=high,
        share=float(min(below[at], above[at]) / below[-1]),
        between=float(between / below[-1]),
    )
    return split if split.is_of_two_media else None
