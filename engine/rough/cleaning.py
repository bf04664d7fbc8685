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

from ..routing import route
from ..settings import Settings
from ..values import Array, PlanarGraph, Routing
from . import grouping
from .beside import Rungs, rungs
from .consensus import consensus
from .meant import meant_lines
from .redrawn import Bundles
from .sampled import Sampled

ROUGH = 0.08  # share of the length that runs beside itself, from which on a page is rough
_ONE = 0.5  # probability from which on two strokes mean one line
_OWN_WIDTH = 0.35  # quantile of the widths that is a single pencil stroke's: bundles are wider
_REACH = (3.0, 4.0, 24.0)  # pens, and px more, and px at most, between strokes of one line


@dataclass(frozen=True, eq=False)
class Bundled:
    """Pencil strokes, with the rungs between them and which of these join strokes of one line.

    one: (K,) bool, for each rung. share: of the length of all strokes, what runs beside another
    stroke of the same line.
    """

    strokes: Sampled
    rungs: Rungs
    one: Array
    pen: float

    @property
    def share(self) -> float:
        held = np.zeros(len(self.strokes.points), bool)
        held[self.rungs.a[self.one]] = True
        return float(held.mean()) if len(held) else 0.0


@dataclass(frozen=True, eq=False)
class Cleaned:
    """The lines of a rough drawing: graph and routing in working pixels, and (K, 2) int32 which
    pencil strokes say which branches of the graph."""

    graph: PlanarGraph
    routing: Routing
    said: Array


def reach_of(pen: float) -> float:
    """How far apart two strokes of one line may lie, px; pen: the width of one, px."""
    times, more, most = _REACH
    return min(times * pen + more, most)


def beside_each_other(graph: PlanarGraph, partner: Array, shape: tuple[int, int]) -> Bundled:
    """All that runs beside each other on a page, none of it judged yet.

    Args:
        graph, partner: of the pencil strokes, measured. shape: (height, width), px.
    """
    strokes = Sampled.of(graph, partner)
    pen = max(float(np.median(strokes.width)), 1.0)
    found = rungs(strokes, shape, reach_of(pen))
    return Bundled(strokes, found, np.zeros(len(found.a), bool), pen)


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
    one = grouping.probability(rows, "same", net) > _ONE
    return replace(found, one=one[found.rungs.stretch])


def is_rough(bundles: Bundled, settings: Settings) -> bool:
    """Whether a drawing is rough: as the user says, or as most of its lines are drawn."""
    if settings.drawing != "auto":
        return settings.drawing == "rough"
    return bundles.share > ROUGH


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
    graph = meant_lines(graph, bundles, found.pen)
    routing = route(graph, settings, rough=True)
    return Cleaned(graph, routing, bundles.said(graph))
