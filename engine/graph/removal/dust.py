"""Take away dust and scratches: small pieces of line that hang on nothing, and are no stroke."""

from __future__ import annotations

import numpy as np

from ...arrays.two_clusters import finer_pen
from ...settings import Settings
from ...values import PlanarGraph
from ..evidence import Evidence
from ..limits import LIMITS
from ..topology import connected, lengths, means, select


def remove_dust(graph: PlanarGraph, evidence: Evidence, settings: Settings) -> PlanarGraph:
    """Drop every connected piece of a measured graph with too little ink to be a stroke.

    The fainter a piece is, beside the other lines of the page, the longer it must be: a pencil
    line is long, a scratch or a fold of the paper rarely is. A dot of full ink, nearly as wide as
    the pen, is drawn.

    Reads: Settings.min_length, Settings.dots; widths and strength.
    Promises: the branches that are left are as they were, measures included.
    """
    if graph.branch_count == 0:
        return graph
    assert graph.widths is not None, "dust is looked for in a measured graph"
    assert graph.strength is not None
    pen = float(np.median(finer_pen(graph.widths)))
    full = max(float(np.percentile(graph.strength, LIMITS.dust_full)), 1e-3)
    label = connected(len(graph.vertices), graph.ends)
    piece = np.unique(label[graph.ends[:, 0]], return_inverse=True)[1]
    length = lengths(graph)
    width, dark = means(graph, graph.widths), means(graph, graph.strength) / full
    weight = length + width  # caps included
    mass = np.bincount(piece, weight)
    cap = np.bincount(piece, weight * width) / mass
    share = np.bincount(piece, weight * dark) / mass
    shortest = (
        settings.min_length * np.maximum(LIMITS.dust_faint / np.maximum(share, 0.01), 1.0) ** 2
    )
    stays = np.bincount(piece, length) + cap >= (shortest + LIMITS.dust_speck) * pen
    if settings.dots:
        round_ = np.bincount(piece, length) <= cap
        wide = cap >= LIMITS.dot_narrowest * settings.min_length * pen
        stays |= round_ & wide & (share >= LIMITS.dot_solid)
    stays &= np.bincount(piece, length) > LIMITS.dust_point
    return select(graph, stays[piece])
