"""Which pencil strokes run beside each other: a look across every stroke, to both sides.

The strokes are drawn into a raster of sample numbers; from each sample we walk along the normal
and note what is crossed and runs the same way: a rung. Rungs that follow each other between the
same two strokes make a stretch. Linear in the length of all strokes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..ink.tint import tint
from ..values import Array
from .sampled import SPACING, Sampled

_SAME_WAY = np.cos(np.radians(40))  # cosine between strokes that run the same way
_STEP = 0.7  # px of the walk along the normal
_AGAIN = 3.0  # reaches along one stroke from which on it is another one
_MISSED = 4  # samples without a rung that do not end a stretch
_OTHER_INK = 0.5  # between two tints; strokes of two inks are never one line
_LONGEST = 24  # samples of a stretch


@dataclass(frozen=True, eq=False)
class Rungs:
    """From sample a across to sample b, (K,) each, sorted by stretch and then along the stroke.

    aside: px from a to b along the normal of a, signed. stretch: (K,) ascending from 0.
    whole: (K,) number of the uncut stretch that it belongs to.
    """

    a: Array
    b: Array
    aside: Array
    stretch: Array
    whole: Array


def rungs(strokes: Sampled, shape: tuple[int, int], reach: float) -> Rungs:
    """All rungs of at most `reach` px; shape: (height, width) of the page."""
    a, b = _seen(strokes, _raster(strokes, shape), reach)
    aside = ((strokes.points[b] - strokes.points[a]) * strokes.normal[a]).sum(1)
    # The nearest crossing of each stroke on each side.
    order = np.lexsort((np.abs(aside), aside > 0, strokes.stroke[b], a))
    a, b, aside = a[order], b[order], aside[order]
    new = np.ones(len(a), bool)
    new[1:] = (np.diff(a) != 0) | (np.diff(strokes.stroke[b]) != 0) | (np.diff(aside > 0) != 0)
    a, b, aside = a[new], b[new], aside[new]

    own, other = strokes.stroke[a], strokes.stroke[b]
    order = np.lexsort((strokes.place[a], aside > 0, other, own))
    a, b, aside, own, other = (v[order] for v in (a, b, aside, own, other))
    far = _MISSED * SPACING + 1e-6
    new = np.ones(len(a), bool)
    new[1:] = (np.diff(own) != 0) | (np.diff(other) != 0) | (np.diff(aside > 0) != 0)
    new[1:] |= (np.diff(strokes.place[a]) > far) | (np.abs(np.diff(strokes.place[b])) > far + reach)
    whole = np.cumsum(new) - 1
    first = np.flatnonzero(new)
    size = np.diff(np.append(first, len(a)))
    within = np.arange(len(a)) - first[whole] if len(a) else whole
    parts = -(-size // _LONGEST)
    piece = within * parts[whole] // np.maximum(size[whole], 1)
    stretch = (np.cumsum(parts) - parts)[whole] + piece
    return Rungs(a, b, aside, stretch, whole)


def _raster(strokes: Sampled, shape: tuple[int, int]) -> Array:
    """(H, W) int32: the sample nearest to where a stroke runs through the pixel, or -1."""
    height, width = shape
    raster = np.full(shape, -1, np.int32)
    index = np.arange(len(strokes.points))
    inside = np.ones(len(index), bool)
    inside[strokes.offsets[1:] - 1] = False  # from here to the next one in the branch
    here = index[inside]
    for share in (0.8, 0.6, 0.4, 0.2, 0.0):  # the samples themselves come last
        at = strokes.points[here] * (1 - share) + strokes.points[here + 1] * share
        column = np.clip(at[:, 0], 0, width - 1).astype(int)
        row = np.clip(at[:, 1], 0, height - 1).astype(int)
        raster[row, column] = here + (share > 0.5)
    # A walk must not slip through between two pixels that touch by their corners only.
    thick = raster.copy()
    for shift in ((0, 1), (0, -1), (1, 0), (-1, 0)):
        moved = np.roll(raster, shift, (0, 1))
        thick = np.where(thick < 0, moved, thick)
    return thick


def _seen(strokes: Sampled, raster: Array, reach: float) -> tuple[Array, Array]:
    """Every (a, b) such that a looks across to b, which runs the same way."""
    height, width = raster.shape
    points, normal, tangent = strokes.points, strokes.normal, strokes.tangent
    found: list[Array] = [np.zeros((0, 2), np.int64)]
    everyone = np.arange(len(points))
    for far in np.arange(_STEP, reach + _STEP, _STEP):
        for side in (-far, far):
            at = points + side * normal
            column, row = np.floor(at).astype(int).T
            inside = (column >= 0) & (column < width) & (row >= 0) & (row < height)
            hit = np.full(len(points), -1)
            hit[inside] = raster[row[inside], column[inside]]
            a = everyone[hit >= 0]
            b = hit[a]
            same = np.abs((tangent[a] * tangent[b]).sum(1)) > _SAME_WAY
            other = strokes.stroke[a] != strokes.stroke[b]
            along = np.abs(strokes.place[a] - strokes.place[b])
            again = np.minimum(along, strokes.length[strokes.stroke[a]] - along) > _AGAIN * reach
            good = same & (other | again)
            found.append(np.stack([a[good], b[good]], 1))
    a, b = np.unique(np.concatenate(found), axis=0).T
    if strokes.colors is not None:
        hue = tint(strokes.colors.astype(float))
        one = np.hypot(*(hue[a] - hue[b]).T) < _OTHER_INK
        a, b = a[one], b[one]
    return a, b
