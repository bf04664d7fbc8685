"""Where two lines share one ridge: touching, running together, or one over the other."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from ...synthesis.line_art import Array
from ...synthesis.media import STEP, Samples

MERGED = 3.2  # px between lines below which their ridges are one (see test of near lines)
UNKNOWN = 0.5  # lines closer than _SAME leave no trace of being two
_SAME = 0.7  # px
_EVERY = 3  # samples; a look at each of them brings nothing
_NEIGHBOURS = 16
_PARALLEL = 0.93  # cosine of the greatest angle between lines that run together
_OWN = 25.0  # px along a stroke after which it counts as another line
_OVER = 13  # looks, about 20 px: crossings are shorter


def doubled(samples: Samples, half_width: Array) -> tuple[Array, Array]:
    """Whether another line runs along within the same ink, (N,) in {0, UNKNOWN, 1}, and how far
    away it is, (N,) px, 0 where there is none.

    half_width: (N,) px.
    """
    looks = np.arange(0, len(samples), _EVERY)
    s, half = samples.take(looks), half_width[looks]
    reach = 2 * float(np.quantile(half, 0.95)) + MERGED
    count = min(_NEIGHBOURS, len(s))
    away, near = cKDTree(s.position).query(s.position, k=count, distance_upper_bound=reach)
    away, near = away.reshape(len(s), -1), near.reshape(len(s), -1)
    found = np.isfinite(away)
    near = np.where(found, near, 0)
    gap = s.position[near] - s.position[:, None]
    tangent = s.tangent[:, None]
    across = np.abs(tangent[..., 0] * gap[..., 1] - tangent[..., 1] * gap[..., 0])
    ahead = np.abs((tangent * gap).sum(-1))
    arc = np.abs(s.arc[near] - s.arc[:, None])
    arc = np.minimum(arc, np.maximum(s.length[:, None] - arc, 0))  # a closed stroke meets itself
    found &= (s.stroke[near] != s.stroke[:, None]) | (arc > _OWN)
    found &= np.abs((tangent * s.tangent[near]).sum(-1)) > _PARALLEL
    found &= ahead < 2 * _EVERY * STEP
    found &= across < np.maximum(MERGED, 0.95 * (half[near] + half[:, None]))
    apart = np.where(found, across, np.inf).min(1)
    two = np.isfinite(apart)
    lasting = np.convolve(two, np.full(_OVER, 1 / _OVER), "same")[: len(two)] > 0.6
    two &= lasting
    apart = np.where(two, apart, 0.0)
    state = np.where(two, np.where(apart < _SAME, UNKNOWN, 1.0), 0.0)
    back = np.arange(len(samples)) // _EVERY
    return state[back].astype(np.float32), apart[back].astype(np.float32)
