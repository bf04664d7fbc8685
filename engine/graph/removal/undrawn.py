"""Branches that nobody drew: rungs between close lines, hooks at thick ends, crumbs of grain.

`spurs` and `rungs` are what a rule can name. What is left is judged by a small network from how
long and how bright a branch is, how it lies to its neighbours, and what the other maps see at its
ends. It was trained on traced pages whose true strokes are known (training/undrawn), and says for
every branch how probable it is that no stroke made it.
"""

from __future__ import annotations

from collections.abc import Mapping

import cv2
import numpy as np

from ... import perceptron, weights
from ...arrays.sampling import sample
from ...settings import Settings
from ...values import Array, PlanarGraph
from ..at_vertices import AtVertices
from ..evidence import Evidence
from ..limits import LIMITS
from ..topology import join, lengths, means, select

WEIGHTS = weights.FOLDER / "undrawn.npz"
FEATURES = 11 + 2 * 11  # of a branch: its own, and those of its two ends
_LOOK = 6  # points of a branch that tell its direction
_AROUND = 25  # px; side of the square in which junctions are counted


def remove_undrawn(graph: PlanarGraph, evidence: Evidence, settings: Settings) -> PlanarGraph:
    """Drop the short branches that were most probably never drawn.

    Without the maps of a network, or without weights, the graph stays as it is.

    Reads: all maps and the width of the pen; points about 1 px apart.
    Promises: no vertices of degree two but those of rings.

    Raises:
        InvoluteError: the weights are damaged.
    """
    maps = evidence.maps
    needed = (maps.junctions, maps.endpoints, maps.half_width, maps.solid)
    unseen = any(seen is None for seen in needed)
    if graph.branch_count == 0 or unseen or not WEIGHTS.exists():
        return graph
    false = probability(features(graph, evidence)) > LIMITS.undrawn_sure
    false &= lengths(graph) < LIMITS.undrawn_longest * evidence.pen_width
    return join(select(graph, ~false)) if false.any() else graph


def probability(rows: Array, net: Mapping[str, Array] | None = None) -> Array:
    """(B,) that no stroke made a branch, from its (B, F) features; net: other weights."""
    net = net or perceptron.load(WEIGHTS)
    scaled = (rows - net["mean"]) / net["spread"]
    return perceptron.probability(perceptron.forward(scaled, net)[:, 0])


def features(graph: PlanarGraph, evidence: Evidence) -> Array:
    """(B, F) float64: what tells a branch that was drawn from one that was not."""
    value, maps, pen_width = evidence.value, evidence.maps, evidence.pen_width
    length = lengths(graph)
    bright = sample(value, graph.points).astype(np.float64)
    mean = means(graph, bright)
    least, most = (how.reduceat(bright, graph.offsets[:-1]) for how in (np.minimum, np.maximum))
    assert maps.half_width is not None, "it is asked only what the network saw"
    assert maps.solid is not None
    width = 2 * means(graph, sample(maps.half_width, graph.points)) / pen_width
    solid = means(graph, sample(maps.solid, graph.points))
    chord = np.hypot(*(graph.vertices[graph.ends[:, 0]] - graph.vertices[graph.ends[:, 1]]).T)
    ends = _at_ends(graph, mean, length, evidence)
    # Both ends tell the same things: the smaller and the larger of each.
    both = ends.reshape(-1, 2, ends.shape[1])
    alone = [
        np.log(np.maximum(length, 0.5)),
        np.log(np.maximum(length, 0.5) / pen_width),
        mean,
        least,
        most,
        least / np.maximum(mean, 1e-3),
        width,
        solid,
        chord / np.maximum(length, 1e-3),
        (graph.ends[:, 0] == graph.ends[:, 1]),
        np.log(np.full(len(length), pen_width)),
    ]
    return np.column_stack([*alone, both.min(1), both.max(1)])


def _at_ends(graph: PlanarGraph, mean: Array, length: Array, evidence: Evidence) -> Array:
    """(2B, E): how each half-branch lies at its vertex, and what is seen there."""
    vertex = graph.half_vertex
    degree = graph.degrees[vertex]
    there = AtVertices.of(graph, _LOOK, least=3)
    bright = there.most(mean)
    own = np.repeat(mean, 2) / np.maximum(np.where(bright > 0, bright, np.repeat(mean, 2)), 1e-3)
    assert evidence.seen_junctions is not None
    assert evidence.seen_ends is not None
    place = graph.vertices[vertex]
    return np.column_stack(
        [
            degree == 1,
            degree == 3,
            degree >= 5,
            sample(evidence.seen_junctions, place),
            sample(evidence.seen_ends, place),
            there.straight,
            there.beside,
            there.past,
            own,
            np.log1p(there.most(length)),
            sample(_crowd(graph, evidence.shape), place),
        ]
    )


def _crowd(graph: PlanarGraph, shape: tuple[int, ...]) -> Array:
    """(H, W) float32: log of how many junctions there are around."""
    count = np.zeros(shape, np.float32)
    column, row = graph.vertices[graph.junctions].astype(np.int64).T
    np.add.at(count, (np.clip(row, 0, shape[0] - 1), np.clip(column, 0, shape[1] - 1)), 1)
    return np.log1p(cv2.boxFilter(count, -1, (_AROUND, _AROUND), normalize=False))
