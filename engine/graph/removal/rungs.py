"""Take away rungs: bridges of grain between two lines that don't meet."""

from __future__ import annotations

import numpy as np

from ...arrays.sampling import sample
from ...settings import Settings
from ...values import PlanarGraph
from ..evidence import Evidence
from ..limits import LIMITS
from ..topology import join, lengths, rank_at_vertex, select


def remove_rungs(graph: PlanarGraph, evidence: Evidence, settings: Settings) -> PlanarGraph:
    """Drop short, faint branches between two forks at which no junction is seen.

    Reads: the map of junctions (without one, all stay) and the smoothed centerline map.
    Promises: no vertices of degree two but those of rings.
    """
    if evidence.seen_junctions is None:
        return graph
    unseen = sample(evidence.seen_junctions, graph.vertices) < LIMITS.junction_seen
    unseen &= graph.degrees == 3
    short = lengths(graph) < LIMITS.rung_longest * evidence.ridge_width
    short &= graph.ends[:, 0] != graph.ends[:, 1]
    dimmest = np.minimum.reduceat(sample(evidence.value, graph.points), graph.offsets[:-1])
    rank = rank_at_vertex(graph.half_vertex, graph.degrees, np.repeat(dimmest, 2)).reshape(-1, 2)
    rung = unseen[graph.ends].all(1) & short & (rank == 2).all(1)
    return join(select(graph, ~rung)) if rung.any() else graph
