"""Take away dust and scratches: small pieces of line that hang on nothing, and are no stroke."""

from __future__ import annotations

import numpy as np

from ...settings import Settings
from ...values import PlanarGraph
from ..topology import connected, lengths, means, select

Array = np.ndarray

_SPECK = 0.25  # pen widths of ink that a piece needs beyond Settings.min_length
_FULL_INK = 80  # percentile of strength that counts as the full ink of the page
_FAINT = 0.5  # share of the full ink below which a piece is as likely a scratch as a line


def sweep(graph: PlanarGraph, settings: Settings) -> PlanarGraph:
    """Drop every connected piece of a measured graph with too little ink to be a stroke.

    The fainter a piece is, beside the other lines of the page, the longer it must be: a pencil
    line is long, a scratch or a fold of the paper rarely is.
    """
    if graph.branch_count == 0:
        return graph
    pen = float(np.median(graph.widths))
    full = max(float(np.percentile(graph.strength, _FULL_INK)), 1e-3)
    label = connected(len(graph.vertices), graph.ends)
    piece = np.unique(label[graph.ends[:, 0]], return_inverse=True)[1]
    length = lengths(graph)
    width, dark = means(graph, graph.widths), means(graph, graph.strength) / full
    weight = length + width  # caps included
    mass = np.bincount(piece, weight)
    cap = np.bincount(piece, weight * width) / mass
    share = np.bincount(piece, weight * dark) / mass
    shortest = settings.min_length * np.maximum(_FAINT / np.maximum(share, 0.01), 1.0) ** 2
    stays = np.bincount(piece, length) + cap >= (shortest + _SPECK) * pen
    return select(graph, stays[piece])
