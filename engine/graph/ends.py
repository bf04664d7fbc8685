"""Where a stroke begins and ends.

Thinning eats the end of a line, more so the wider it is. Along its own direction the smoothed map
falls off at the true end like a step, so the end is where half of the line's brightness is left.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays.ragged import offsets_of
from ..arrays.sampling import sample
from ..settings import Settings
from ..values import Array, PlanarGraph
from .evidence import Evidence
from .limits import LIMITS

_BACK, _AHEAD, _STEP = 3.0, 3.0, 0.25  # px searched before and after the skeleton's end
_INSIDE = 8  # points of the branch that give its direction and its brightness


def place_ends(graph: PlanarGraph, evidence: Evidence, settings: Settings) -> PlanarGraph:
    """Move every free end along its line to where the line ends.

    Reads: the smoothed centerline map; points about 1 px apart.
    Promises: points about 1 px apart but for the last ones.
    """
    value = evidence.value
    counts = np.diff(graph.offsets)
    free = np.flatnonzero((graph.degrees[graph.half_vertex] == 1) & (np.repeat(counts, 2) > 3))
    if not len(free):
        return graph
    branch, step = free >> 1, np.where(free & 1, -1, 1)
    tip = np.where(free & 1, graph.offsets[branch + 1] - 1, graph.offsets[branch]).astype(np.int64)
    # The other end, when it is free too, must keep its own half.
    room = np.minimum(counts[branch] - 1, _INSIDE)
    far = tip + step * room
    near = tip + step
    inward = graph.points[far].astype(np.float64) - graph.points[near]
    size = np.hypot(*inward.T)
    outward = -inward / np.maximum(size, 1e-9)[:, None]
    level = np.median(
        sample(
            value,
            graph.points[tip[:, None] + step[:, None] * np.minimum(np.arange(2, 7), room[:, None])],
        ),
        axis=1,
    )
    tips = graph.points[tip].astype(np.float64)
    move = _way_to_end(value, tips, outward, level)
    move = np.maximum(move, -0.5 * np.minimum(_BACK, room))
    points, vertices = graph.points.copy(), graph.vertices.copy()
    target = tips + move[:, None] * outward
    keep = np.ones(len(points), bool)
    # When the end moves back, it passes points that are no longer on the line.
    for k in range(1, int(_BACK) + 1):
        passed = (k < room - 1) & (
            ((points[tip + step * np.minimum(k, room)] - target) * outward).sum(1) > -0.25
        )
        keep[(tip + step * k)[passed]] = False
    points[tip] = target
    vertices[graph.half_vertex[free]] = target
    kept = np.add.reduceat(keep, graph.offsets[:-1])
    return replace(
        graph,
        vertices=vertices,
        points=points[keep],
        offsets=offsets_of(kept).astype(np.int32),
    )


def _way_to_end(value: Array, tips: Array, outward: Array, level: Array) -> Array:
    """(N,) px from each tip outward to where its line ends, negative = inward.

    Args:
        value: (H, W) smoothed centerline map.
        tips: (N, 2) px. outward: (N, 2) unit vectors. level: (N,) brightness of the line.
    """
    reach = np.arange(-_BACK, _AHEAD + _STEP / 2, _STEP)
    profile = sample(value, tips[:, None] + reach[:, None] * outward[:, None])
    half = LIMITS.end_left * level[:, None]
    # Where it grows brighter again, another line begins.
    falls = np.diff(profile, axis=1, prepend=profile[:, :1]) < 0.01 * level[:, None]
    lit = (profile > half) & (falls | (reach < 0.5))
    # The first dark sample, seen from inside; exactly where the profile crosses half the level.
    dark = np.where(lit.all(1), len(reach) - 1, np.argmin(lit, axis=1))
    before = np.maximum(dark - 1, 0)
    rows = np.arange(len(tips))
    high, low = profile[rows, before], profile[rows, dark]
    part = np.clip((high - half[:, 0]) / np.maximum(high - low, 1e-6), 0, 1)
    return np.where(dark > 0, reach[before] + part * _STEP, -_BACK)
