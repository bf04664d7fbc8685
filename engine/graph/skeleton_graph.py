"""From the ridges of the centerline map to a first graph, as its skeleton has it."""

from __future__ import annotations

import numpy as np

from ..arrays.ragged import owners
from ..settings import Settings
from ..values import Array, PlanarGraph
from .evidence import Evidence
from .ridge import Ridge
from .skeleton import Chains, thin, trace
from .topology import select

# px from its middle; a dot has no length, and becomes a line just long enough to have a direction.
_DOT = np.array([[-0.25, 0.0], [0.25, 0.0]])


def trace_ridges(graph: PlanarGraph, evidence: Evidence, settings: Settings) -> PlanarGraph:
    """The skeleton of the ridges; what was there before does not count.

    Reads: the centerline map.
    Promises: every branching of the skeleton is one vertex, points lie on the crest of the lines.
    """
    ridge = evidence.ridge
    chains = trace(thin(ridge.mask()))
    return _pixel_graph(chains, ridge) if len(chains.rows) else PlanarGraph.empty()


def _pixel_graph(chains: Chains, ridge: Ridge) -> PlanarGraph:
    """The skeleton as a graph: touching branch pixels are one vertex, points lie on the crest."""
    crest = ridge.crest(chains.rows, chains.columns)
    starts, stops = chains.offsets[:-1], chains.offsets[1:] - 1
    ends = np.stack([chains.node[chains.pixels[starts]], chains.node[chains.pixels[stops]]], -1)
    on_node = np.flatnonzero(chains.node >= 0)
    node = chains.node[on_node]
    count = np.bincount(node, minlength=chains.node_count)
    vertices = np.stack(
        [np.bincount(node, crest[on_node, k], chains.node_count) / count for k in (0, 1)], -1
    )
    points = crest[chains.pixels]
    points[starts], points[stops] = vertices[ends[:, 0]], vertices[ends[:, 1]]
    _spread(points, vertices, chains.offsets, ends)
    # What remains inside a branching, links between touching pixels of one vertex, goes.
    keep = ~((ends[:, 0] == ends[:, 1]) & (np.diff(chains.offsets) <= 3))
    dots = np.setdiff1d(np.arange(chains.node_count), ends[keep])
    tips = vertices[dots, None] + _DOT
    far = chains.node_count + np.arange(len(dots))
    vertices[dots] = tips[:, 0]
    graph = PlanarGraph(
        np.concatenate([vertices, tips[:, 1]]).astype(np.float32),
        np.concatenate([points, tips.reshape(-1, 2)]).astype(np.float32),
        np.concatenate([chains.offsets, len(points) + 2 * np.arange(1, len(dots) + 1)]).astype(
            np.int32
        ),
        np.concatenate([ends, np.stack([dots, far], -1)]).astype(np.int32),
    )
    return select(graph, np.concatenate([keep, np.ones(len(dots), bool)]))


def _spread(points: Array, vertices: Array, offsets: Array, ends: Array) -> None:
    """Give the chains that hang on nothing and lie in one place the length of a dot: the pixels
    of a round dot all have its middle for their crest. Changes points (P, 2) and vertices."""
    degree = np.bincount(ends.ravel(), minlength=len(vertices))
    low = np.minimum.reduceat(points, offsets[:-1])
    high = np.maximum.reduceat(points, offsets[:-1])
    round_ = (degree[ends] == 1).all(1) & (ends[:, 0] != ends[:, 1])
    round_ &= np.hypot(*(high - low).T) < np.ptp(_DOT)
    if not round_.any():
        return
    middle = (low + high)[round_] / 2
    vertices[ends[round_]] = middle[:, None] + _DOT
    chain = owners(offsets)
    inside = round_[chain]
    along = (np.arange(len(points)) - offsets[:-1][chain]) / (np.diff(offsets)[chain] - 1)
    place = np.repeat(middle, np.diff(offsets)[round_], 0)
    points[inside] = place + _DOT[0] + along[inside, None] * (_DOT[1] - _DOT[0])
