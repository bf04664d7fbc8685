"""Take away spurs: what thinning and grain make of the edge of a line.

The paper drops a loose branch shorter than 6 px when its tip is dark. Maps that say where lines end
and where they meet know better than a length: a tip where no end is seen is a spur, one where an
end is seen is a line; a fork where no junction is seen is noise at the edge of a thick line.
"""

from __future__ import annotations

import numpy as np

from ...arrays.sampling import sample
from ...settings import Settings
from ...values import PlanarGraph
from ..evidence import Evidence
from ..limits import LIMITS
from ..topology import join, lengths, rank_at_vertex, select


def remove_spurs(graph: PlanarGraph, evidence: Evidence, settings: Settings) -> PlanarGraph:
    """Drop the short loose branches that hang on a junction.

    Every junction keeps its two longest branches, so that a small cross or star stays. How short
    is halved where an end is seen at the tip and doubled where none is; it is raised where no
    junction is seen at the fork.

    Reads: the maps of endpoints and junctions, where there are any.
    Promises: no vertices of degree two but those of rings.
    """
    tips, forks = evidence.seen_ends, evidence.seen_junctions
    shortest = LIMITS.spur_longest * evidence.ridge_width
    for _ in range(2):
        vertex, degree = graph.half_vertex, graph.degrees
        long = np.repeat(lengths(graph), 2)
        rank = rank_at_vertex(vertex, degree, long)
        tip = vertex[np.arange(len(vertex)) ^ 1]
        limit = np.full(len(vertex), shortest)
        if tips is not None:
            seen = sample(tips, graph.vertices[tip])
            limit *= np.where(
                seen < LIMITS.spur_no_end, 2.0, np.where(seen > LIMITS.spur_end, 0.5, 1.0)
            )
        if forks is not None:
            limit *= np.where(
                sample(forks, graph.vertices[vertex]) < LIMITS.junction_seen,
                LIMITS.spur_unseen,
                1.0,
            )
        spur = (degree[tip] == 1) & (degree[vertex] >= 3) & (rank >= 2) & (long < limit)
        if not spur.any():
            break
        graph = join(select(graph, ~spur.reshape(-1, 2).any(1)))
    return graph
