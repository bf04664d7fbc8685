"""Stubs between and on lines go; everything that stands out of the lines stays."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from involute.engine import Settings
from involute.engine.graph import Evidence
from involute.engine.graph.removal.stubs import remove_stubs
from involute.engine.graph.topology import lengths
from involute.engine.routing import route
from involute.engine.values import LineMaps, PlanarGraph
from involute.synthesis.true_graph import graph_from_strokes

from tests.engine.scribbles import scribbles

PEN = 3.0
GEOMETRIC = Settings(router="geometric")
RAILS = [[(20.0, 50.0), (200.0, 50.0)], [(20.0, 55.0), (200.0, 55.0)]]


def measured(*strokes) -> tuple[PlanarGraph, np.ndarray]:
    """The graph of strokes of one pen, and how they run through it."""
    graph, partner = graph_from_strokes([np.asarray(s, float) for s in strokes])
    return replace(graph, widths=np.full(len(graph.points), PEN, np.float32)), partner


def trim(graph: PlanarGraph, partner: np.ndarray, settings: Settings) -> PlanarGraph:
    """The graph without its stubs."""
    page = Evidence(LineMaps(np.zeros((1, 1), np.float32)), PEN)
    return remove_stubs(graph, page.routed(partner), settings)


def test_a_rung_between_two_lines_goes():
    graph, partner = measured(*RAILS, [(100.0, 50.0), (100.0, 55.0)])
    assert graph.branch_count == 5
    assert trim(graph, partner, Settings()).branch_count == 2


def test_a_long_stem_stays_and_a_nub_goes():
    stem, nub = [(60.0, 50.0), (60.0, 44.0)], [(120.0, 50.0), (120.0, 46.0)]
    graph, partner = measured(RAILS[0], stem, nub)
    left = trim(graph, partner, Settings())
    assert sorted(np.round(lengths(left))) == [6, 40, 140]


def test_a_short_piece_of_a_longer_stroke_stays():
    graph, partner = measured(*RAILS, [(100.0, 20.0), (100.0, 90.0)])
    assert trim(graph, partner, Settings()) is graph


@pytest.mark.parametrize("shortest", [0.0, 1.0, 4.0])
def test_the_setting_says_how_short(shortest):
    graph, partner = measured(*RAILS, [(100.0, 50.0), (100.0, 55.0)])
    left = trim(graph, partner, Settings(min_length=shortest))
    assert left.branch_count == (5 if shortest == 0 else 2)


def test_nothing_to_trim():
    empty = PlanarGraph.empty()
    assert trim(empty, np.zeros(0, np.int32), Settings()) is empty


@given(scribbles(12))
def test_only_stubs_go(scribble, drawn):
    graph, _ = scribble(drawn)
    graph = replace(graph, widths=np.full(len(graph.points), PEN, np.float32))
    partner = route(graph, GEOMETRIC).partner
    left = trim(graph, partner, Settings())
    assert left.branch_count <= graph.branch_count
    gone = lengths(graph).sum() - lengths(left).sum()
    ends = int(
        ((partner == np.arange(len(partner))) & (graph.degrees[graph.half_vertex] > 2)).sum()
    )
    assert -1e-3 <= gone <= 2 * PEN * ends + 1e-3
