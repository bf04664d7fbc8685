"""From rough to clean: the lines that many pencil strokes mean, and whether there are any such.

The pencil strokes are traced as on every page. Then, after StripMaker's order of things (Liu et
al., "StripMaker: Perception-driven Learned Vector Sketch Consolidation", 2023): which stretches of
them mean one line (`grouping`), where that line lies (`consensus`), what of it is meant at all
(`meant`), and which lines go on in which (`continuing`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from ..routing import Fixed, route
from ..routing.geometric import tint_score
from ..settings import Settings
from ..values import Array, PlanarGraph, Routing
from . import continuing, grouping
from .beside import Rungs, rungs
from .bridging import bridged
from .consensus import consensus
from .meant import meant_lines
from .redrawn import Bundles
from .sampled import Sampled, reach_of
from .telling import ROUGH, Signs

ONE = 0.5  # probability from which on two strokes mean one line
_HATCHING = 0.05  # what knows hatching lets less than that pass on no page
_OWN_WIDTH = 0.35  # quantile of the widths that is a single pencil stroke's: bundles are wider


@dataclass(frozen=True, eq=False)
class Bundled:
    """Pencil strokes, with the rungs between them and which of these join strokes of one line.

    one: (K,) bool, for each rung, on a page that is known to be rough; probability: (K,) of that.
    told: (K,) the same probability on a page of which nothing is known.
    named: (N,) bool, samples of which the artist said that they are a line of their own.
    """

    strokes: Sampled
    rungs: Rungs
    one: Array
    told: Array
    pen: float
    probability: Array
    named: Array


@dataclass(frozen=True, eq=False)
class Cleaned:
    """The lines of a rough drawing: graph and routing in working pixels, and (K, 2) int32 which
    pencil strokes say which branches of the graph."""

    graph: PlanarGraph
    routing: Routing
    said: Array


def beside_each_other(graph: PlanarGraph, partner: Array, shape: tuple[int, int]) -> Bundled:
    """All that runs beside each other on a page, none of it judged yet.

    Args:
        graph, partner: of the pencil strokes, measured. shape: (height, width), px.
    """
    return run_beside(Sampled.of(graph, partner), shape)


def run_beside(strokes: Sampled, shape: tuple[int, int]) -> Bundled:
    """The same of strokes that are sampled already."""
    pen = max(float(np.median(strokes.width)), 1.0)
    found = rungs(strokes, shape, reach_of(pen))
    none, unnamed = np.zeros(len(found.a)), np.zeros(len(strokes.points), bool)
    return Bundled(strokes, found, none > 0, none, pen, none, unnamed)


def bundled(
    graph: PlanarGraph, partner: Array, ink: Array, net: Mapping[str, Array] | None = None
) -> Bundled:
    """Which pencil strokes mean one line.

    Args:
        graph, partner: of the pencil strokes, measured. ink: (H, W) of the page.
        net: other weights.

    Raises:
        InvoluteError: the weights are damaged.
        OSError: there are none.
    """
    found = beside_each_other(graph, partner, (ink.shape[0], ink.shape[1]))
    if not len(found.one):
        return found
    rows = grouping.features(found.strokes, found.rungs, ink, found.pen)
    told = grouping.probability(rows, "tells", net)[found.rungs.stretch]
    one = grouping.probability(rows, "same", net)[found.rungs.stretch]
    one = np.minimum(one, told * (ONE / _HATCHING))
    return replace(found, one=one > ONE, told=told, probability=one)


def is_rough(bundles: Bundled, graph: PlanarGraph, settings: Settings) -> bool:
    """Whether a drawing is rough: as the user says, or as its lines are drawn.

    Args:
        graph: of its pencil strokes.
    """
    if settings.drawing != "auto":
        return settings.drawing == "rough"
    if not len(bundles.told):
        return False
    signs = Signs.of(bundles.strokes, bundles.rungs, bundles.told, graph, bundles.pen)
    return signs.may_be_rough and bool(grouping.probability(signs.row, "rough_page")[0] > ROUGH)


def redrawn(
    found: Bundled, settings: Settings, shape: tuple[int, int]
) -> tuple[Bundles, PlanarGraph]:
    """The bundles drawn as one line each, and the graph of all of them, meant or not."""
    moved = consensus(found.strokes, found.rungs, found.one.astype(float))
    bundles = Bundles.of(found.strokes, moved, shape)
    pen = float(np.quantile(found.strokes.width, _OWN_WIDTH))
    return bundles, bundles.graph(pen, settings)


def cleaned(found: Bundled, settings: Settings, shape: tuple[int, int]) -> Cleaned:
    """The lines that the pencil strokes mean.

    Args:
        shape: (height, width) of the page, px.
    """
    bundles, graph = redrawn(found, settings, shape)
    meant = meant_lines(graph, bundles, found.pen, named=found.named)
    graph = bridged(meant, bundles, found.pen)

    def by_bundles(graph: PlanarGraph, pairs: Array, fixed: Fixed) -> Array:
        return continuing.score(graph, pairs, bundles) + tint_score(graph, pairs)

    geometric = settings.router == "geometric"
    routing = route(graph, settings, scorer=None if geometric else by_bundles)
    return Cleaned(graph, routing, bundles.said(graph))
