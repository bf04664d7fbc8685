"""LineMaps -> PlanarGraph: one vertex per junction, one polyline per branch.

ridge -> skeleton -> junctions -> clean-up -> smoothing        (build_graph)
widths, strength and colour of the ink along every branch      (measure)
"""

from __future__ import annotations

import numpy as np

from ..settings import Settings
from ..values import LineMaps, PlanarGraph
from .cleanup import prune
from .junctions import resolve
from .measure import measure
from .ridge import Ridge
from .skeleton import Chains, thin, trace
from .topology import select


def build_graph(maps: LineMaps, pen_width: float, settings: Settings) -> PlanarGraph:
    """Turn line maps into a planar graph.

    Args:
        maps: what the centerline provider saw, (H, W) each.
        pen_width: typical width of a line in px.
        settings: how clean the drawing shall be.

    Returns:
        A valid graph for any input; empty for a blank page.
    """
    ridge = Ridge.of(maps.centerline)
    chains = trace(thin(ridge.mask()))
    if len(chains.pixels) == 0:
        return PlanarGraph.empty()
    graph = _pixel_graph(chains, ridge.crest(chains.rows, chains.columns))
    graph = prune(graph, 3.0)
    return resolve(graph, ridge.value, 2.0)


def _pixel_graph(chains: Chains, crest: np.ndarray) -> PlanarGraph:
    """The skeleton as a graph; touching branch pixels and what short links join is one vertex."""
    starts, stops = chains.offsets[:-1], chains.offsets[1:] - 1
    ends = np.stack([chains.node[chains.pixels[starts]], chains.node[chains.pixels[stops]]], -1)
    label = np.arange(chains.node_count)
    degree = np.bincount(ends.ravel(), minlength=chains.node_count)
    short = (np.diff(chains.offsets) <= 2) & (degree[ends] >= 3).all(1)
    while True:
        low = np.minimum(label[ends[short, 0]], label[ends[short, 1]])
        before = label.copy()
        np.minimum.at(label, ends[short, 0], low)
        np.minimum.at(label, ends[short, 1], low)
        if np.array_equal(before, label):
            break
    group = label[chains.node]
    on_node = chains.node >= 0
    count = np.maximum(np.bincount(group[on_node], minlength=chains.node_count), 1)
    vertices = np.stack(
        [
            np.bincount(group[on_node], crest[on_node, k], minlength=chains.node_count) / count
            for k in (0, 1)
        ],
        -1,
    )
    points = crest[chains.pixels]
    ends = label[ends]
    points[starts], points[stops] = vertices[ends[:, 0]], vertices[ends[:, 1]]
    graph = PlanarGraph(
        vertices.astype(np.float32),
        points.astype(np.float32),
        chains.offsets,
        ends.astype(np.int32),
    )
    return select(graph, ~((ends[:, 0] == ends[:, 1]) & (np.diff(chains.offsets) <= 6)))


__all__ = ["build_graph", "measure"]
