"""Take away dust and scratches: small pieces of line that hang on nothing, and are no stroke."""

from __future__ import annotations

import numpy as np

from ..settings import Settings
from ..values import PlanarGraph
from .topology import lengths, select

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
    piece = np.unique(_pieces(graph)[graph.ends[:, 0]], return_inverse=True)[1]
    length = lengths(graph)
    width, dark = _means(graph, graph.widths), _means(graph, graph.strength) / full
    weight = length + width  # caps included
    mass = np.bincount(piece, weight)
    cap = np.bincount(piece, weight * width) / mass
    share = np.bincount(piece, weight * dark) / mass
    shortest = settings.min_length * np.maximum(_FAINT / np.maximum(share, 0.01), 1.0) ** 2
    stays = np.bincount(piece, length) + cap >= (shortest + _SPECK) * pen
    return select(graph, stays[piece])


def _means(graph: PlanarGraph, values: Array) -> Array:
    """(B,) the mean of (P,) values on each branch."""
    return np.add.reduceat(values.astype(np.float64), graph.offsets[:-1]) / np.diff(graph.offsets)


def _pieces(graph: PlanarGraph) -> Array:
    """(V,) the lowest vertex of the connected piece that each vertex belongs to."""
    label = np.arange(len(graph.vertices))
    a, b = graph.ends.T
    while True:
        low = np.minimum(label[a], label[b])
        joined = label.copy()
        np.minimum.at(joined, label[a], low)
        np.minimum.at(joined, label[b], low)
        while not np.array_equal(joined, joined[joined]):
            joined = joined[joined]
        if np.array_equal(joined, label):
            return label
        label = joined
