"""Decisions made on one trace of a page are made again on another."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from involute.engine import Drawing, Settings
from involute.engine.decisions import carried
from involute.engine.routing import route
from involute.engine.values import PlanarGraph, Scan

GEOMETRIC = Settings(router="geometric", min_length=0.0)
SCAN = Scan(np.zeros((200, 200), np.float32), None, 1.0, (200, 200), 3.0)


def _drawing(graph: PlanarGraph, settings: Settings = GEOMETRIC) -> Drawing:
    return Drawing.from_routing(graph, route(graph, settings), SCAN, settings)


def _decided(drawing: Drawing, luck: int) -> Drawing:
    rng = np.random.default_rng(luck)
    for place in drawing.junctions:
        if rng.random() < 0.6:
            way = place.alternatives[rng.integers(len(place.alternatives))]
            drawing = drawing.reroute(place.index, way.pairs)
    return drawing


@given(st.integers(0, 200), st.integers(0, 2**32 - 1))
def test_the_same_lines_take_all_decisions(scribble, seed: int, luck: int) -> None:
    graph, _ = scribble(seed)
    old = _decided(_drawing(graph), luck)
    line = max(old.strokes, key=lambda s: len(s.points))
    middle = line.points[len(line.points) // 2]
    if np.hypot(*(line.points[[0, -1]] - middle).T).min() > 12:
        old = old.cut(old.strokes.index(line), (float(middle[0]), float(middle[1])))
    new, lost = carried(old, _drawing(graph, replace(GEOMETRIC, smoothing=0.9)))
    assert lost == 0
    np.testing.assert_array_equal(new.routing.partner, old.routing.partner)
    np.testing.assert_array_equal(new.routing.locked, old.routing.locked)


@given(st.integers(0, 200), st.integers(0, 2**32 - 1))
def test_lines_that_lie_a_little_otherwise_do_too(scribble, seed: int, luck: int) -> None:
    graph, _ = scribble(seed)
    old = _decided(_drawing(graph), luck)
    shift = np.float32([0.4, -0.3])
    moved = replace(graph, vertices=graph.vertices + shift, points=graph.points + shift)
    new, lost = carried(old, _drawing(moved))
    count = int(old.routing.locked.sum())
    assert new.routing.locked.sum() + lost >= count - lost
    same = sum(new.place(k).pairs == old.place(k).pairs for k in np.flatnonzero(old.routing.locked))
    assert same >= count - 2 * lost - 2  # of places that lie on one another either may be meant
