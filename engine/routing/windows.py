"""Large drawings in parts, so that the memory of the routing network does not grow with them.

The junctions are cut into groups by their place, and a group is looked at together with what its
branches lead to within `HOPS` steps; the mean token of the page is that of the part. On 4,452
junctions of 18 traced pages, in parts of a tenth of the size, 4 % were decided otherwise, and 0.594
were right for 0.591 of the whole pages.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..values import Array
from .encoding import Encoding

MOST = 40_000  # pairs of slots that are looked at together: some 250 MB in the network
HOPS = 2  # junctions that are seen around a group, along the branches


@dataclass(frozen=True, eq=False)
class Window:
    """Some junctions of an encoding as an encoding of its own.

    rows: (K,) int64, which junctions are answered; the first K of the part. slots: D of the part.
    """

    rows: Array
    part: Encoding

    @property
    def slots(self) -> int:
        return self.part.halves.shape[1]


def windows(encoding: Encoding, places: Array, most: int = MOST) -> Iterator[Window]:
    """Cut an encoding into parts of at most about `most` pairs of slots, its context not counted.

    Args:
        places: (J, 2) px, where the junctions are.
    """
    count, slots = encoding.halves.shape
    leads = np.where(encoding.sibling < count * slots, encoding.sibling // max(slots, 1), -1)
    for rows in _groups(places, encoding.mask.sum(1), np.arange(count), most):
        inside = np.zeros(count, bool)
        inside[rows] = True
        for _ in range(HOPS):
            found = leads[inside].ravel()
            inside[found[found >= 0]] = True
        inside[rows] = False
        yield Window(rows, _part(encoding, np.concatenate([rows, np.flatnonzero(inside)])))


def _groups(places: Array, degree: Array, rows: Array, most: int) -> list[Array]:
    """Junctions by place: halved along the longer side until each group is small enough."""
    if len(rows) < 2 or len(rows) * degree[rows].max() ** 2 <= most:
        return [rows] if len(rows) else []
    axis = int(np.ptp(places[rows], axis=0).argmax())
    order = rows[np.argsort(places[rows, axis], kind="stable")]
    half = len(order) // 2
    return [
        group
        for side in (order[:half], order[half:])
        for group in _groups(places, degree, side, most)
    ]


def _part(encoding: Encoding, rows: Array) -> Encoding:
    """The encoding of some of its junctions, with no more slots than they need."""
    count, slots = encoding.halves.shape
    fewer = int((encoding.halves[rows] >= 0).sum(1).max())
    number = np.full(count, -1)
    number[rows] = np.arange(len(rows))
    sibling = encoding.sibling[rows, :fewer]
    there = sibling < count * slots
    row, slot = np.divmod(np.where(there, sibling, 0), slots)
    there &= number[row] >= 0
    sibling = np.where(there, number[row] * fewer + slot, len(rows) * fewer)
    return Encoding(
        encoding.halves[rows, :fewer],
        np.ascontiguousarray(encoding.tokens[rows, :fewer]),
        np.ascontiguousarray(encoding.pairs[rows, :fewer, :fewer]),
        sibling.astype(np.int32),
    )
