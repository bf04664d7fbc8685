"""Two strokes on one ridge: a run of a stroke carries a second one, or it does not."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from involute.engine import Drawing, Settings, vectorize
from involute.engine.decisions import carried
from involute.engine.graph.topology import repeated
from involute.engine.routing import route, second_lines
from involute.engine.routing.double_runs import find_runs
from involute.engine.routing.second_lines import with_second_lines
from involute.engine.soundness import check_graph, check_routing
from involute.engine.values import PlanarGraph, Routing, Scan
from involute.synthesis.shared_runs import with_shared_runs
from involute.synthesis.true_graph import graph_from_strokes

SIZE = 500


def _traced(strokes: list[np.ndarray]) -> tuple[PlanarGraph, Routing]:
    """What a tracer sees of strokes, lines that run together once, with its true routing."""
    many = len(strokes)
    graph, partner = graph_from_strokes(
        strokes, touch=2.5, merge=2.5, doubled=2.5, widths=[3.0] * many, strength=[0.9] * many
    )
    return graph, replace(route(graph, Settings(router="geometric")), partner=partner)


def _pairs(seed: int) -> list[np.ndarray]:
    rng = np.random.default_rng(seed)
    crossing = [np.array([[20.0, y], [480.0, y + 30]]) for y in (150.0, 330.0)]
    return with_shared_runs(rng, crossing, SIZE, 3.0, 4)[0]


def _judged(monkeypatch: pytest.MonkeyPatch, seed: int) -> None:
    """A scorer that says anything."""

    def anything(rows: np.ndarray) -> np.ndarray:
        return np.random.default_rng(seed).dirichlet([0.3, 0.7, 0.7], len(rows))

    monkeypatch.setattr(second_lines, "probabilities", anything)


@given(st.integers(0, 10_000), st.integers(0, 10_000))
@settings(max_examples=30, deadline=None)
def test_a_second_line_is_inside_a_longer_stroke_and_nothing_is_lost(seed: int, said: int) -> None:
    graph, routing = _traced(_pairs(seed))
    with pytest.MonkeyPatch.context() as monkeypatch:
        _judged(monkeypatch, said)
        longer, routed = with_second_lines(graph, routing, Settings())
    check_graph(longer)
    check_routing(longer, routed)
    old = graph.branch_count
    np.testing.assert_array_equal(longer.points[: len(graph.points)], graph.points)
    np.testing.assert_array_equal(longer.ends[:old], graph.ends)
    new = np.arange(2 * old, 2 * longer.branch_count)
    assert (routed.partner[new] != new).all()
    assert (routed.partner[new] < 2 * old).all()
    # A half-branch that went on in another one still goes on.
    went_on = routing.partner != np.arange(2 * old)
    assert (routed.partner[: 2 * old] != np.arange(2 * old))[went_on].all()
    np.testing.assert_array_equal(np.flatnonzero(repeated(longer)), np.unique(new >> 1))


def test_without_sharing_nothing_changes() -> None:
    graph, routing = _traced(
        [np.array([[20.0, 60.0], [480.0, 70.0]]), np.array([[200.0, 20.0], [210.0, 480.0]])]
    )
    assert with_second_lines(graph, routing, Settings()) == (graph, routing)
    assert len(find_runs(graph, routing.partner)) == 0


def _drawing(monkeypatch: pytest.MonkeyPatch) -> Drawing:
    """A drawing with second lines, whatever the weights say."""
    graph, routing = _traced(_pairs(2))
    monkeypatch.setattr(
        second_lines, "probabilities", lambda rows: np.tile([0.1, 0.6, 0.3], (len(rows), 1))
    )
    graph, routing = with_second_lines(graph, routing, Settings())
    scan = Scan(np.zeros((SIZE, SIZE), np.float32), None, 1.0, (SIZE, SIZE), 3.0)
    assert repeated(graph).any()
    return Drawing.from_routing(graph, routing, scan, Settings())


def _same_strokes(a: Drawing, b: Drawing) -> bool:
    return [s.branches.tolist() for s in a.strokes] == [s.branches.tolist() for s in b.strokes]


def test_a_drawing_keeps_its_second_lines(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    drawing = _drawing(monkeypatch)
    drawing.save(tmp_path / "drawing.json")
    opened = Drawing.load(tmp_path / "drawing.json")
    assert _same_strokes(opened, drawing)
    np.testing.assert_array_equal(repeated(opened.graph), repeated(drawing.graph))
    np.testing.assert_array_equal(repeated(drawing.graph.scaled(1.7)), repeated(drawing.graph))


def test_where_a_second_line_ends_the_artist_decides(monkeypatch: pytest.MonkeyPatch) -> None:
    drawing = _drawing(monkeypatch)
    graph = drawing.graph
    half = 2 * int(np.flatnonzero(repeated(graph))[0])
    there = drawing.place(int(graph.place_at[graph.half_vertex[half]]))
    assert half in {h for pair in there.pairs for h in pair}
    assert there.pairs == there.alternatives[0].pairs
    ended = drawing.reroute(there.index, [pair for pair in there.pairs if half not in pair])
    assert ended.routing.partner[half] == half
    assert _same_strokes(ended.reroute(there.index, there.pairs), drawing)


def test_decisions_are_carried_to_other_second_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    drawing = _drawing(monkeypatch)
    again = replace(drawing, graph=drawing.graph.moved(lambda points: points + np.float32(0.1)))
    for number in range(len(drawing.junctions)):
        decided = drawing.reroute(number, drawing.place(number).pairs[:1])
        found = carried(decided, again)
        assert found.lost == 0
        np.testing.assert_array_equal(found.drawing.routing.partner, decided.routing.partner)


def test_asked_again_second_lines_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    drawing = _drawing(monkeypatch)
    own = 2 * np.flatnonzero(repeated(drawing.graph))[:, None] + [0, 1]
    for number in range(len(drawing.junctions)):
        before = drawing.lock(number)
        for again in (before.ask_again(), before.ask_around(drawing)):
            assert (again.routing.partner[own] != own).all()


def test_regions_do_not_see_second_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    drawing = _drawing(monkeypatch)
    graph, _ = _traced(_pairs(2))
    bare = replace(drawing, graph=graph)
    assert [len(ring) for area in drawing.regions for ring in area] == [
        len(ring) for area in bare.regions for ring in area
    ]


def _page(lines: list[np.ndarray]) -> np.ndarray:
    page = np.full((400, 600), 255, np.uint8)
    for line in lines:
        cv2.polylines(page, [np.rint(line * 16).astype(np.int32)], False, 0, 4, cv2.LINE_AA, 4)
    return page


def test_two_lines_that_run_together_are_two_strokes() -> None:
    x = np.arange(30.0, 570.0, 3.0)
    away = np.maximum(np.abs(x - 300) - 60, 0) ** 2 / 350
    lines = [np.stack([x, 200 + sign * away], 1) for sign in (1, -1)]
    drawing = vectorize(_page(lines), Settings(drawing="clean"))
    whole = [s for s in drawing.strokes if np.ptp(s.points[:, 0]) > 500]
    assert len(whole) == len(drawing.strokes) == 2
