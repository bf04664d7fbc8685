"""Which redrawn lines go on in which where they meet, learnt twice.

The second network has the answers of the first one to the pairs around. On pages that it learnt
from, these would be better than they ever are: so those come from two networks, each of which has
seen the other half of the pages.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from involute.engine.rough import continuing
from involute.engine.rough.grouping import probability
from involute.engine.rough.redrawn import Bundles
from involute.engine.routing.candidates import candidate_pairs
from involute.engine.values import PlanarGraph

from ..routing import labels
from .fitting import Net, Rows
from .rough_pages import RoughPage

Array = np.ndarray

_NEAR = (3.5, 1.5)  # px, and times the spread, that a redrawn line may lie off the stroke it is


@dataclass(frozen=True, eq=False)
class Meetings:
    """All pairs of half-branches at the junctions of one graph.

    pairs: (K, 2). rows: (K, F) features. label: (K,) bool, one line. known: (K,) bool; not what is
    left of no line, which goes on in none.
    """

    graph: PlanarGraph
    pairs: Array
    rows: Array
    label: Array
    known: Array

    @staticmethod
    def of(graph: PlanarGraph, page: RoughPage, bundles: Bundles) -> Meetings | None:
        """Those of some redrawn lines of a page; None where none meet."""
        pairs = candidate_pairs(graph)
        pairs = pairs[graph.degrees[graph.half_vertex[pairs[:, 0]]] >= 3]
        if graph.branch_count < 2 or not len(pairs):
            return None
        least, strays = _NEAR
        truth = labels.labelled(graph, page.lines, max(least, strays * page.spread))
        owned = truth.stroke[graph.offsets[:-1]] >= 0
        label = np.asarray(truth.partner)[pairs[:, 0]] == pairs[:, 1]
        rows = continuing.features(graph, pairs, bundles)
        return Meetings(graph, pairs, rows, label, owned[pairs >> 1].any(1))

    @property
    def first(self) -> Rows:
        """What the first network learns from."""
        return self.rows[self.known], self.label[self.known]

    def second(self, net: Net) -> Rows:
        """What the second one learns from, after a first look with `net`."""
        wide = {name: values.astype(np.float64) for name, values in net.items()}
        seen = probability(self.rows, "goes_on", wide)
        rows = continuing.seen_again(self.graph, self.pairs, self.rows, seen)
        return rows[self.known], self.label[self.known]


def second_rows(pages: Sequence[Meetings], fit: Callable[[list[Rows]], Net]) -> list[Rows]:
    """What the second network learns from on pages that the first one learns from, too.

    Args:
        fit: makes a first network from some rows.
    """
    halves = pages[::2], pages[1::2]
    found: list[Rows] = []
    for seen, other in (halves, halves[::-1]):
        net = fit([page.first for page in seen])
        found += [page.second(net) for page in other]
    return found
