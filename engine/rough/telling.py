"""Whether a page is rough: how its strokes lie beside each other, and how they end.

Rough drawings say lines twice, and overshoot. Hatching and fur lie beside each other as well, but
mean many lines, and have other ends: a small network tells these apart from what is rough.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..graph.topology import lengths
from ..values import Array, PlanarGraph
from .beside import Rungs
from .sampled import Sampled

FEATURES = 6  # of a page
# A page may be rough when so much of its length runs beside itself; or less, when lines often run
# on beyond their ends, too ...
_SHARE, _HARDLY = 0.1, 0.018  # of the length
_OVERSHOT = 0.7  # loose ends that stick out of another line, in 100 pens of length
# ... and the network does not find that improbable. Of 96 held-out pages of drawings and hatching 5
# are called rough (9 without it), of 55 quick sketches in single lines 1 (1); of 80 animators'
# figures, most of them nearly clean, 0.19 (0.19), of 47 other rough pages 0.77 (0.79).
ROUGH = 0.4  # probability
_ONE, _TWO = 0.5, 0.2  # probabilities beyond which two strokes mean one line, or two
_STICKS_OUT = (1.5, 8.0)  # pens; length of an end that sticks out of another line
_LITTLE, _FEW = 0.003, 0.1  # share of the length, and ends in 100 pens, that are told from none


@dataclass(frozen=True)
class Signs:
    """What tells of a page whether it is rough.

    one, beside, two: share of the length that runs beside another stroke of the same line, beside
    any, and beside one of another line. overshot, loose: ends that stick out of another line, and
    all that end loosely, in 100 pens of length. junctions: share of those with an end that sticks
    out.
    """

    one: float
    beside: float
    two: float
    overshot: float
    junctions: float
    loose: float

    @staticmethod
    def of(strokes: Sampled, rungs: Rungs, told: Array, graph: PlanarGraph, pen: float) -> Signs:
        """Those of a page with rungs.

        Args:
            told: (K,) how probable it is that each rung joins strokes of one line, on any page.
            graph: of the pencil strokes. pen: px.
        """
        one, beside, two = (
            _share(strokes, rungs.a[k]) for k in (told > _ONE, told >= 0, told < _TWO)
        )
        length = lengths(graph) / pen
        degree = graph.degrees[graph.ends]
        loose = degree.min(1) == 1
        least, most = _STICKS_OUT
        out = loose & (degree.max(1) >= 3) & (length > least) & (length < most)
        per = 100 / max(float(length.sum()), 1e-6)
        at_junctions = _with_short_ends(graph, length < most)
        overshot, all_loose = float(per * out.sum()), float(per * loose.sum())
        return Signs(one, beside, two, overshot, at_junctions, all_loose)

    @property
    def may_be_rough(self) -> bool:
        """Whether enough runs beside itself."""
        return self.one > _SHARE or (self.one > _HARDLY and self.overshot > _OVERSHOT)

    @property
    def row(self) -> Array:
        """(1, F) float64: for the network."""
        shares = np.log(np.array([self.one, self.beside, self.two]) + _LITTLE)
        overshot, loose = np.log(np.array([self.overshot, self.loose]) + _FEW)
        return np.array([[*shares, overshot, self.junctions, loose]])


def _share(strokes: Sampled, samples: Array) -> float:
    """Of the length of all strokes, some samples of them."""
    held = np.zeros(len(strokes.points), bool)
    held[samples] = True
    return float(held.mean())


def _with_short_ends(graph: PlanarGraph, short: Array) -> float:
    """Share of the junctions out of which a short loose end sticks."""
    if not len(graph.junctions):
        return 0.0
    halves = np.arange(2 * graph.branch_count)
    loose = (graph.degrees[graph.half_vertex[halves ^ 1]] == 1) & short[halves >> 1]
    number = np.bincount(graph.half_vertex, loose, len(graph.vertices))
    return float((number[graph.junctions] > 0).mean())
