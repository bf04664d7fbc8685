"""Chains of edges that run through points of degree two, all followed at once.

Pixels of a skeleton and branches of a graph need the same walk: go on from edge to edge until a
node stops you. Done by pointer doubling on flat arrays: n log n, and no Python loop over points.
"""

from __future__ import annotations

import numpy as np

from ..arrays.ragged import offsets_of
from ..values import Array


def follow(source: Array, back: Array, is_node: Array) -> tuple[Array, Array]:
    """Join half-edges to maximal chains.

    Args:
        source: (E,) the point that each half-edge leaves.
        back: (E,) the same edge the other way round.
        is_node: (N,) bool, the points where chains end; all points of a degree other than two
            must be nodes. A ring without a node is cut open at its lowest point.

    Returns:
        (K,) half-edges of every chain in walking order, each chain in one direction only, and the
        chains' (C + 1,) offsets into them.
    """
    source = source.astype(np.int32)
    is_node = is_node.copy()
    is_node[source[source == source[back]]] = True  # an edge from a point to itself
    rings = _ring_starts(source, _next(source, back, is_node))
    is_node[rings] = True

    jump = _next(source, back, is_node)
    left = (jump != np.arange(len(jump))).astype(np.int32)
    moving = np.flatnonzero(left)
    while len(moving):
        farther = jump[jump[moving]]
        left[moving] += left[jump[moving]]
        goes_on = farther != jump[moving]
        jump[moving] = farther
        moving = moving[goes_on]
    # jump now leads to the chain's last half-edge; keep the direction whose last one is lower.
    first = np.flatnonzero(is_node[source])
    first_of = np.zeros(len(source), np.int32)
    first_of[jump[first]] = first
    kept = np.flatnonzero(jump < back[first_of[jump]])
    last, size = jump[kept], np.bincount(jump[kept], minlength=len(jump))
    order = np.empty(len(kept), np.int32)
    order[np.cumsum(size)[last] - 1 - left[kept]] = kept
    return order, offsets_of(size[size > 0]).astype(np.int32)


def _next(source: Array, back: Array, is_node: Array) -> Array:
    """For each half-edge the one that follows it; itself where it arrives at a node."""
    own = np.arange(len(source), dtype=np.int64)
    # Of the two half-edges that leave a point, their sum minus the one we came by.
    leaving = np.bincount(source, weights=own, minlength=len(is_node)).astype(np.int64)
    target = source[back]
    return np.where(is_node[target], own, leaving[target] - back).astype(np.int32)


def _ring_starts(source: Array, jump: Array) -> Array:
    """The lowest point of every ring that passes no node."""
    following, jump, lowest, reach = jump, jump.copy(), source.copy(), 1
    moving = np.arange(len(source))
    # Whoever has come to rest stands on a half-edge that follows itself; in a ring nobody does.
    while len(moving := moving[following[jump[moving]] != jump[moving]]) and reach <= len(source):
        ahead = jump[moving]
        lowest[moving] = np.minimum(lowest[moving], lowest[ahead])
        jump[moving] = jump[ahead]
        reach *= 2
    return np.unique(lowest[moving])
