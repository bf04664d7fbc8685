"""LineMaps -> PlanarGraph: one vertex per junction, one polyline per branch.

    ridge       where lines run, to the sub-pixel
    skeleton    chains of pixels between ends and branchings
    cleanup     spurs and rungs go
    tips        sharp bends and the tips of Vs
    halves      the course of every half-branch, outside its blob
    blobs       which branchings belong together
    curves      smooth curves through a blob
    twins       two of them on one ridge, told apart by the picture
    junctions   the graph with its junctions where these curves meet
    ends        free ends where the line ends
    gaps        lines go on where the pen broke off
    smoothing   even, smooth points
    undrawn     what most probably nobody drew goes
    planar      a vertex wherever two branches still cross
                                                                    all of that is build_graph
    measure     width, darkness and colour of the ink along every branch
    ignored     pencil under ink goes, if it is not wanted (without_pencil)
    dust        what is too small or too faint to be a stroke goes (sweep)
    stubs       once routed: strokes too short to stand out of the lines they hang on go (trim)

All of it works on flat arrays, in NumPy and OpenCV only: fast enough (about 0.3 ms a junction)
without a compiled helper, which would need a wheel for every Python and platform.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..settings import Settings
from ..values import LineMaps, PlanarGraph
from .ends import place_ends
from .gaps import bridge
from .junctions import resolve
from .measure import measure
from .planarity import planarized
from .removal.dust import sweep
from .removal.pencil_lines import without_pencil
from .removal.spurs import prune, unbridge
from .removal.stubs import trim
from .removal.undrawn import drop_undrawn
from .ridge import Ridge
from .skeleton import Chains, thin, trace
from .smoothing import even, smooth
from .tips import open_tips, split_bends
from .topology import contract, join, select


def build_graph(maps: LineMaps, pen_width: float, settings: Settings) -> PlanarGraph:
    """Turn line maps into a planar graph.

    Args:
        maps: what the centerline provider saw, (H, W) each.
        pen_width: typical width of a line in px.
        settings: how clean the drawing shall be.

    Returns:
        A valid graph for any input; empty for a blank page.
    """
    graph, value = all_lines(maps, pen_width, settings)
    graph = planarized(drop_undrawn(graph, value, maps, pen_width), value.shape)
    # A curve that was continued must not leave the page.
    page = np.array(value.shape[::-1], np.float32)
    return replace(
        graph, vertices=np.clip(graph.vertices, 0, page), points=np.clip(graph.points, 0, page)
    )


def all_lines(
    maps: LineMaps, pen_width: float, settings: Settings
) -> tuple[PlanarGraph, np.ndarray]:
    """The graph with all that looks like a line, drawn or not; and the (H, W) smoothed centerline
    map that it follows."""
    ridge = Ridge.of(maps.centerline)
    chains = trace(thin(ridge.mask()))
    if len(chains.rows) == 0:
        return PlanarGraph.empty(), ridge.value
    graph, value = _pixel_graph(chains, ridge), ridge.value
    del ridge, chains
    graph = prune(contract(graph, 2.0), 3.0, maps)
    graph = unbridge(graph, value, maps)
    graph = split_bends(open_tips(graph, value, 2.0))
    graph = even(resolve(graph, value, 2.0))
    graph = bridge(place_ends(graph, value), value, pen_width)
    return join(even(smooth(even(graph), round(10 * settings.smoothing)))), value


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
    # What remains inside a branching, links between touching pixels of one vertex, goes.
    keep = ~((ends[:, 0] == ends[:, 1]) & (np.diff(chains.offsets) <= 3))
    # A dot has no length; it becomes a line just long enough to have a direction.
    dots = np.setdiff1d(np.arange(chains.node_count), ends[keep])
    tips = vertices[dots, None] + np.array([[-0.25, 0.0], [0.25, 0.0]])
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


__all__ = ["all_lines", "build_graph", "measure", "sweep", "trim", "without_pencil"]
