"""Lines that the pen broke off for a moment go on.

A dry pen, rough paper or a worn print leaves gaps in a line. Two free ends that look at each other
across no more than about the width of the pen are one line; the stems of a dashed line or of
hatching are farther apart than that. (The paper leaves gaps to its network.)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..arrays.sampling import sample
from ..settings import Settings
from ..values import Array, PlanarGraph
from .evidence import Evidence
from .limits import LIMITS
from .nearby import near_pairs
from .topology import lengths

BACK = 8  # points that tell which way an end looks


def bridge_gaps(graph: PlanarGraph, evidence: Evidence, settings: Settings) -> PlanarGraph:
    """Add a branch across every small gap between two free ends that run on into each other.

    Reads: the smoothed centerline map and the width of the pen; points about 1 px apart.
    Promises: more branches, of two points each; the ends they link have degree two now.
    """
    value, pen_width = evidence.value, evidence.pen_width
    free = np.flatnonzero(graph.degrees[graph.half_vertex] == 1)
    reach = max(LIMITS.gap_least, LIMITS.gap_widest * pen_width)
    tips, outward = looks(graph, free)
    a, b = near_pairs(tips, reach).T
    # Both ends of one short piece look away from each other, but see each other all the same.
    a, b = (v[free[a] >> 1 != free[b] >> 1] for v in (a, b))
    way = tips[b] - tips[a]
    gap = np.hypot(*way.T)
    ahead = np.minimum((outward[a] * way).sum(1), -(outward[b] * way).sum(1))
    aside = np.maximum(_cross(outward[a], way), _cross(outward[b], way))
    facing = -(outward[a] * outward[b]).sum(1)
    shorter = np.minimum(*(lengths(graph)[free[v] >> 1] for v in (a, b)))
    fits = (
        (facing > np.cos(np.radians(LIMITS.gap_straight)))
        & (ahead > 0)
        & (aside < LIMITS.gap_aside * gap + 0.5)
    )
    # What is brighter in the middle than at the ends is another line.
    light = sample(value, tips)
    fits &= sample(value, (tips[a] + tips[b]) / 2) < np.minimum(light[a], light[b])
    fits &= (gap < reach) & (gap < 2 * shorter + LIMITS.gap_least)
    a, b, cost = a[fits], b[fits], (gap + 2 * aside)[fits]
    best = mutual(a, b, cost, len(free))
    links = graph.half_vertex[free[np.stack([a[best], b[best]], -1)]]
    return bridged(graph, links, list(graph.vertices[links])) if len(links) else graph


def bridged(graph: PlanarGraph, links: Array, lines: Sequence[Array]) -> PlanarGraph:
    """An unmeasured graph with one branch more for each link (K, 2) of two vertices: a line (N, 2)
    from one to the other."""
    offsets = graph.offsets[-1] + np.cumsum([len(line) for line in lines])
    return replace(
        graph,
        points=np.concatenate([graph.points, *lines]).astype(np.float32),
        offsets=np.concatenate([graph.offsets, offsets]).astype(np.int32),
        ends=np.concatenate([graph.ends, links]).astype(np.int32),
    )


def linked(graph: PlanarGraph, links: Array) -> PlanarGraph:
    """The graph with a straight branch between the vertices of each link, (K, 2); it has the
    widths and the ink of what ends there."""
    tip = np.zeros(len(graph.vertices), np.int64)
    tip[graph.ends.ravel()] = np.stack([graph.offsets[:-1], graph.offsets[1:] - 1], 1).ravel()

    def longer(values: Array | None) -> Array | None:
        return None if values is None else np.concatenate([values, values[tip[links.ravel()]]])

    return replace(
        bridged(graph, links, list(graph.vertices[links])),
        widths=longer(graph.widths),
        strength=longer(graph.strength),
        colors=longer(graph.colors),
    )


def looks(graph: PlanarGraph, free: Array) -> tuple[Array, Array]:
    """Where free half-branches end (N, 2), and the unit direction in which each would go on."""
    branch, last = free >> 1, free & 1
    tip = np.where(last, graph.offsets[branch + 1] - 1, graph.offsets[branch])
    room = np.minimum(np.diff(graph.offsets)[branch] - 1, BACK)
    inner = graph.points[tip + np.where(last, -1, 1) * room].astype(np.float64)
    tips = graph.points[tip].astype(np.float64)
    outward = tips - inner
    return tips, outward / np.maximum(np.hypot(*outward.T), 1e-9)[:, None]


def _cross(a: Array, b: Array) -> Array:
    return np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def mutual(a: Array, b: Array, cost: Array, count: int) -> Array:
    """Indices of the pairs that are the cheapest one for both of their ends."""
    least = np.full(count, np.inf)
    np.minimum.at(least, a, cost)
    np.minimum.at(least, b, cost)
    return np.flatnonzero((cost <= least[a]) & (cost <= least[b]))
