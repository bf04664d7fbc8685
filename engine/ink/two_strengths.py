"""Two media of one page told apart by how strong they are: pencil, and the ink over it.

A page has both when the strengths of its lines form two clusters, one much fainter than the other,
with the less between them the less they differ. One cluster, however wide, is one medium: hardly
and firmly drawn pencil stays together.
"""

from __future__ import annotations

from ..arrays.two_clusters import Split, best_split
from ..values import Array

# Of 8 pages in three media (benchmarks.pencil_under_ink), strengths seen along lines and in
# pixels: ink over pencil has up to 0.62 and 0.06 between, pencil of uneven pressure alone 0.65 and
# more.
_FAINTER = 0.635  # of the ink's strength: what pencil under it is at most
_BETWEEN = (0.225, 0.8)  # how much may be neither: 0.225 for each 1 below 0.8 of the ink's
_LEAST = 0.1  # what either must have; less may be dirt, or badly printed


def split_strengths(strength: Array, weight: Array) -> Split | None:
    """Where the strengths of two media part; None for one medium.

    Args:
        strength: (N,) and weight: (N,) how much each counts, > 0.
    """
    split = best_split(strength, weight)
    return split if split is not None and _is_of_two_media(split) else None


def _is_of_two_media(split: Split) -> bool:
    ratio = split.low / split.high
    apart = split.between < _BETWEEN[0] * (_BETWEEN[1] - ratio)
    return ratio < _FAINTER and apart and split.share > _LEAST
