"""Where the line lies that several pencil strokes mean: each stroke moves to the middle of those
beside it that mean the same.

Like a mean shift across the bundle: every sample goes to the mean of the strokes of its bundle at
that place, weighed by how dark they are; the shift runs on smoothly along the strokes and through
the junctions of the graph, so that what ended on a stroke goes on doing so.
"""

from __future__ import annotations

import numpy as np

from ..values import Array
from .beside import Rungs
from .sampled import Sampled

_ROUNDS = 6
_SMOOTH = 8  # times that neighbours are averaged: sigma of about 4 px
_STILL = 0.03  # how much a sample without rungs holds to its place


def consensus(strokes: Sampled, rungs: Rungs, one: Array) -> Array:
    """(N, 2) where the samples lie when all strokes of each bundle are one line.

    Args:
        one: (K,) in [0, 1], for each rung: whether both its strokes mean one line.
    """
    count = len(strokes.points)
    a, b, normal = rungs.a, rungs.b, strokes.normal
    weight = np.clip(strokes.strength, 0.05, 1.0) ** 2
    pull = one * weight[b]
    total = weight + np.bincount(a, pull, count)
    held = np.bincount(a, one, count)
    trust = np.where(held > 0, np.minimum(held, 1.0), _STILL)
    moved = np.zeros((count, 2))
    for _ in range(_ROUNDS):
        apart = ((strokes.points + moved)[b] - (strokes.points + moved)[a]) * normal[a]
        shift = np.bincount(a, pull * apart.sum(1), count) / total
        moved = _spread(strokes, moved + shift[:, None] * normal, trust)
    return strokes.points + moved


def _spread(strokes: Sampled, moved: Array, trust: Array) -> Array:
    """The shifts, smoothed along strokes and through vertices, where they can be trusted."""
    values = np.column_stack([moved * trust[:, None], trust])
    at_vertex = np.flatnonzero(strokes.vertex >= 0)
    vertex = strokes.vertex[at_vertex]
    size = np.bincount(vertex)
    for _ in range(_SMOOTH):
        values = 0.5 * values + 0.25 * (values[strokes.back] + values[strokes.ahead])
        mean = np.stack([np.bincount(vertex, values[at_vertex, k]) for k in range(3)], 1)
        values[at_vertex] = (mean / np.maximum(size, 1)[:, None])[vertex]
    return values[:, :2] / np.maximum(values[:, 2:], 1e-12)
