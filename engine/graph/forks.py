"""Forks that all but touch are one vertex."""

from __future__ import annotations

import numpy as np

from ..settings import Settings
from ..values import PlanarGraph
from .evidence import Evidence
from .limits import LIMITS
from .topology import connected, join, lengths, select


def merge_forks(graph: PlanarGraph, evidence: Evidence, settings: Settings) -> PlanarGraph:
    """Make one vertex of forks that a branch shorter than a line is wide links; it goes.

    Reads: nothing but the graph.
    Promises: no branch between two forks is shorter than the ridge is wide, but for rings.
    """
    short = lengths(graph) < LIMITS.fork_touching * evidence.ridge_width
    link = short & (graph.degrees[graph.ends] >= 3).all(1)
    if not link.any():
        return graph
    label = connected(len(graph.vertices), graph.ends[link])
    count = np.maximum(np.bincount(label, minlength=len(label)), 1)
    vertices = np.stack(
        [np.bincount(label, graph.vertices[:, k], len(label)) / count for k in (0, 1)], -1
    ).astype(np.float32)
    ends = label[graph.ends]
    points = graph.points.copy()
    points[graph.offsets[:-1]] = vertices[ends[:, 0]]
    points[graph.offsets[1:] - 1] = vertices[ends[:, 1]]
    return join(select(PlanarGraph(vertices, points, graph.offsets, ends), ~link))
