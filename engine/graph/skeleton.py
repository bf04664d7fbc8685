"""From a mask of lines to chains of pixels between the skeleton's ends and branchings."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from ..arrays.ragged import offsets_of, owners
from ..values import Array
from .chains import follow

# The 8 neighbours (row, column): right, down, left, up, then the diagonals between them.
_STEPS = np.array([(0, 1), (1, 0), (0, -1), (-1, 0), (1, 1), (1, -1), (-1, -1), (-1, 1)])

# The bit of each neighbour in the code of a pixel, clockwise from the north.
_AROUND = np.array([[128, 1, 2], [64, 0, 4], [32, 16, 8]], np.float32)


@dataclass(frozen=True, eq=False)
class Chains:
    """A skeleton as a graph of pixels.

    rows, columns: (N,) int32, the skeleton's pixels.
    node: (N,) int32, for a pixel that is an end, a dot or part of a branching: the number of its
        node; else -1. Touching branch pixels share one node.
    node_count: how many nodes there are.
    pixels: (P,) int32 pixel ids, chain by chain; offsets: (C + 1,) int32. The first and last pixel
        of a chain belong to nodes; those between belong to none.
    """

    rows: Array
    columns: Array
    node: Array
    node_count: int
    pixels: Array
    offsets: Array


def thin(mask: Array) -> Array:
    """The skeleton (H, W) uint8 of a mask; one pixel wide, same connectivity (Guo and Hall, 1989).

    The same as OpenCV's `ximgproc.thinning`, in under half the time.
    """
    left: Array = (mask > 0).view(np.uint8)
    left = cv2.copyMakeBorder(left, 1, 1, 1, 1, cv2.BORDER_CONSTANT, value=0)
    peeled = 1
    while peeled:
        peeled = 0
        for table in _PEELS:
            gone = cv2.bitwise_and(cv2.LUT(cv2.filter2D(left, cv2.CV_8U, _AROUND), table), left)
            cv2.subtract(left, gone, dst=left)
            peeled += cv2.countNonZero(gone)
    return np.ascontiguousarray(left[1:-1, 1:-1]) * np.uint8(255)


def _peel(south_east: bool) -> Array:
    """(1, 256) uint8: whether a pixel goes, by the code of its neighbours (see `_AROUND`), when
    lines are peeled from the south and east, or from the north and west."""
    n, ne, e, se, s, sw, w, nw = np.arange(256) >> np.arange(8)[:, None] & 1
    pieces = (1 - n & (ne | e)) + (1 - e & (se | s)) + (1 - s & (sw | w)) + (1 - w & (nw | n))
    pairs = (nw | n) + (ne | e) + (se | s) + (sw | w), (n | ne) + (e | se) + (s | sw) + (w | nw)
    size = np.minimum(*pairs)
    held = (s | sw | 1 - nw) & w if south_east else (n | ne | 1 - se) & e
    goes = (pieces == 1) & (size >= 2) & (size <= 3) & (held == 0)
    return goes[None].astype(np.uint8)


_PEELS = _peel(south_east=True), _peel(south_east=False)


def trace(skeleton: Array) -> Chains:
    """Follow the pixels of a skeleton (H, W) from node to node.

    A diagonal step counts only where no pixel beside it makes the same step in two, so that a
    staircase has no false branchings. All chains are ordered at once by pointer doubling, in
    n log n.
    """
    rows, columns = (a.astype(np.int32) for a in np.nonzero(skeleton))
    number = np.full(np.add(skeleton.shape, 2), -1, np.int32)
    number[rows + 1, columns + 1] = np.arange(len(rows), dtype=np.int32)
    around = np.stack([number[rows + 1 + dy, columns + 1 + dx] for dy, dx in _STEPS], -1)
    side = around[:, :4] >= 0
    around[:, 4:][side | np.roll(side, -1, axis=1)] = -1
    degree = (around >= 0).sum(1)

    # Half-edges, numbered by source pixel; `back` is the same edge the other way.
    source, slot = np.nonzero(around >= 0)
    source = source.astype(np.int32)
    target = around[source, slot]
    index = np.full(around.shape, -1, np.int32)
    index[source, slot] = np.arange(len(source), dtype=np.int32)
    opposite = np.array([2, 3, 0, 1, 6, 7, 4, 5])[slot]
    edges, edge_offsets = follow(source, index[target, opposite], degree != 2)
    # A chain of k edges has k + 1 pixels: the sources of its edges, then the last target.
    counts = np.diff(edge_offsets)
    offsets = offsets_of(counts + 1).astype(np.int32)
    pixels = np.empty(offsets[-1], np.int32)
    chain = owners(edge_offsets)
    pixels[np.arange(len(edges)) + chain] = source[edges]
    pixels[offsets[1:] - 1] = target[edges[edge_offsets[1:] - 1]]

    is_node = degree != 2
    is_node[pixels[offsets[:-1]]] = True  # where rings were cut
    node, node_count = _nodes(skeleton.shape, rows, columns, is_node, degree)
    return Chains(rows, columns, node, node_count, pixels, offsets)


def _nodes(
    shape: tuple[int, ...], rows: Array, columns: Array, is_node: Array, degree: Array
) -> tuple[Array, int]:
    """Number the node pixels; touching branch pixels get one number."""
    branching = np.zeros(shape, np.uint8)
    picked = degree >= 3
    branching[rows[picked], columns[picked]] = 1
    count, labels = cv2.connectedComponents(branching, connectivity=8, ltype=cv2.CV_32S)
    node = np.full(len(rows), -1, np.int32)
    node[picked] = labels[rows[picked], columns[picked]] - 1
    single = np.flatnonzero(is_node & ~picked)
    node[single] = count - 1 + np.arange(len(single), dtype=np.int32)
    return node, count - 1 + len(single)
