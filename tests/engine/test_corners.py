"""Corners: where only two lines meet and the pen may have been lifted."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from involute.engine import Drawing, InvoluteError, Settings, vectorize
from involute.engine.formats.drawing_json import dumps, read
from involute.engine.graph.lifts import cut_at_lifts, evidence_size
from involute.engine.graph.topology import join
from involute.engine.routing import route
from involute.engine.routing.lifting import UNSEEN, caution, goes_on, score
from involute.engine.values import LineMaps, PlanarGraph, Scan
from involute.synthesis.true_graph import graph_from_strokes

GEOMETRIC = Settings(router="geometric", min_length=0.0)
BOX = np.array([[40, 40], [160, 40], [160, 120], [40, 120], [40, 40]], float)


def _scan(size: int = 200) -> Scan:
    return Scan(np.zeros((size, size), np.float32), None, 1.0, (size, size), 3.0)


def _drawing(strokes: list[np.ndarray]) -> Drawing:
    graph, _ = graph_from_strokes(strokes, widths=[3.0] * len(strokes))
    return Drawing.from_routing(graph, route(graph, GEOMETRIC), _scan(), GEOMETRIC)


def _dense(line: np.ndarray) -> np.ndarray:
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    at = np.linspace(0, arc[-1], round(arc[-1]) + 1)
    return np.stack([np.interp(at, arc, line[:, k]) for k in (0, 1)], 1)


def _seen(strokes: list[np.ndarray]) -> tuple[PlanarGraph, np.ndarray]:
    """A graph with its corners, from a picture that shows nothing but bright lines."""
    graph, _ = graph_from_strokes([_dense(s) for s in strokes], widths=[3.0] * len(strokes))
    flat = np.full((200, 200), 0.9, np.float32)
    scan = Scan(flat, None, 1.0, (200, 200), 3.0)
    return cut_at_lifts(graph, scan, LineMaps(flat, endpoints=np.zeros_like(flat)))


def _length(drawing: Drawing) -> float:
    return sum(
        float(
            np.hypot(*np.diff(np.vstack([s.points, s.points[:1]][: 1 + s.closed]), axis=0).T).sum()
        )
        for s in drawing.strokes
    )


def test_a_box_has_four_corners_and_a_circle_only_where_it_begins() -> None:
    angle = np.linspace(0, 2 * np.pi, 200)
    circle = 100 + 50 * np.stack([np.cos(angle), np.sin(angle)], 1)
    box, evidence = _seen([BOX])
    assert len(box.corners) == 4
    assert evidence.shape == (4, evidence_size())
    places = sorted(map(tuple, np.rint(box.vertices[box.corners]).astype(int).tolist()))
    assert places == [(40, 40), (40, 120), (160, 40), (160, 120)]
    ring, evidence = _seen([circle])
    assert len(ring.corners) == 1
    assert len(evidence) == 1


@given(st.integers(0, 300))
def test_cutting_at_lifts_changes_no_line_and_no_junction(scribble, seed: int) -> None:
    graph, _ = scribble(seed)
    flat = np.full((200, 200), 0.9, np.float32)
    scan = Scan(flat, None, 1.0, (200, 200), 3.0)
    cut, evidence = cut_at_lifts(graph, scan, LineMaps(flat))
    assert len(evidence) == len(cut.corners)
    assert np.isfinite(evidence).all()
    np.testing.assert_array_equal(cut.vertices[cut.junctions], graph.vertices[graph.junctions])
    whole = join(cut)
    assert sorted(np.diff(whole.offsets).tolist()) == sorted(np.diff(graph.offsets).tolist())
    # A ring may begin elsewhere, and its first point is there twice.
    np.testing.assert_array_equal(np.unique(whole.points, axis=0), np.unique(graph.points, axis=0))


@given(st.integers(0, 200))
def test_corners_change_no_decision_at_junctions(scribble, seed: int) -> None:
    graph, _ = scribble(seed)
    flat = np.full((200, 200), 0.9, np.float32)
    cut, _ = cut_at_lifts(graph, Scan(flat, None, 1.0, (200, 200), 3.0), LineMaps(flat))
    whole, pieces = route(graph, GEOMETRIC), route(cut, GEOMETRIC)
    for a, b in zip(whole.alternatives[: len(graph.junctions)], pieces.alternatives, strict=False):
        np.testing.assert_allclose(
            [w.probability for w in a], [w.probability for w in b], atol=1e-4
        )


def test_a_box_drawn_around_is_one_closed_stroke_and_lifted_four() -> None:
    graph, _ = _seen([BOX])
    drawing = Drawing.from_routing(graph, route(graph, GEOMETRIC), _scan(), GEOMETRIC)
    assert [s.closed for s in drawing.strokes] == [True]
    assert len(drawing.junctions) == 0
    assert len(drawing.corners) == 4
    lifted = drawing.with_corners(1.0)
    assert [s.closed for s in lifted.strokes] == [False] * 4
    again = lifted.with_corners(-1.0)
    assert [s.closed for s in again.strokes] == [True]
    np.testing.assert_array_equal(again.strokes[0].points, drawing.strokes[0].points)


def test_a_bias_decides_by_probability_and_leaves_locked_corners_alone() -> None:
    graph, _ = _seen([BOX])
    routing = route(graph, GEOMETRIC)
    score = np.array([3.0, 0.5, -0.5, -3.0], np.float32)
    drawing = Drawing.from_routing(graph, replace(routing, pair_score=score), _scan(), GEOMETRIC)
    joined = [len(drawing.with_corners(b).strokes) for b in (-1.0, -0.5, 0.0, 0.5, 1.0)]
    assert joined == [1, 1, 2, 3, 4]
    locked = drawing.with_corners(0.0).lock(0)
    assert locked.with_corners(1.0).corners[0].pairs
    assert locked.corners[0].doubt == 0.0
    with pytest.raises(InvoluteError, match="corners"):
        drawing.with_corners(1.5)


def test_every_bias_between_is_between() -> None:
    score = np.linspace(-6, 6, 40)
    before = goes_on(score, -1.0)
    assert before.all()
    assert goes_on(score, 0.0).sum() == 20
    for bias in np.linspace(-1, 1, 11)[1:]:
        now = goes_on(score, float(bias))
        assert not (now & ~before).any()
        before = now


def test_the_less_a_page_looks_lifted_at_its_sharp_corners_the_more_a_lift_must_show() -> None:
    sharp, round_off = np.radians(80.0), np.radians(20.0)
    turns, nothing = np.full(8, sharp), np.zeros(8)
    lifted, joined = np.full(8, -2.0), np.full(8, 3.0)
    assert caution(lifted, nothing, turns) < 0.1
    assert caution(joined, nothing, turns) > 3.9
    # One lift among many corners is not how the page is drawn; bends tell nothing of it.
    assert caution(np.where(np.arange(8) < 1, lifted, joined), nothing, turns) > 3.5
    assert caution(lifted, nothing, np.full(8, round_off)) > 3.9
    # What the artist has decided is certain.
    assert caution(joined, np.where(np.arange(8) < 7, -1.0, 0.0), turns) < 0.1
    assert caution(lifted, np.where(np.arange(8) < 7, 1.0, 0.0), turns) > 3.5
    assert caution(lifted[:0], nothing[:0], turns[:0]) > 3.9


def test_noise_at_a_corner_does_not_change_the_habit_of_its_page() -> None:
    turns, nothing = np.full(12, np.radians(80.0)), np.zeros(12)
    levels = [caution(np.full(12, at), nothing, turns) for at in np.linspace(-3, 3, 301)]
    assert (np.diff(levels) >= 0).all()
    assert np.diff(levels).max() < 0.11


def test_where_nothing_was_seen_the_habit_of_the_page_changes_nothing() -> None:
    graph, _ = _seen([BOX])
    clues = np.full((4, 8), 0.25, np.float32)
    clues[2] = np.nan  # a cut that the artist made
    found = score(replace(graph, clues=clues), {})
    assert found[2] == UNSEEN
    assert np.isfinite(found).all()
    assert (score(replace(graph, clues=np.full((4, 8), np.nan, np.float32)), {}) == UNSEEN).all()


@given(st.integers(0, 200), st.integers(0, 2**32 - 1))
def test_a_cut_ends_two_strokes_there_and_joining_undoes_it(scribble, seed: int, luck: int) -> None:
    graph, _ = scribble(seed)
    before = Drawing.from_routing(graph, route(graph, GEOMETRIC), _scan(), GEOMETRIC)
    rng = np.random.default_rng(luck)
    number = int(rng.integers(len(before.strokes)))
    line = before.strokes[number].points
    point = line[rng.integers(len(line))]
    tips = line[[0, -1]]
    if not before.strokes[number].closed and np.hypot(*(tips - point).T).min() < 4:
        return  # it ends there already
    after = before.cut(number, tuple(point))
    old = {id(s) for s in before.strokes}
    assert len(before.strokes) - 1 <= sum(id(s) in old for s in after.strokes)
    assert len(after.junctions) == len(before.junctions)
    assert after.routing.locked.sum() == 1
    assert after.routing.locked.shape == (len(after.graph.places),)
    assert (
        after.routing.partner[after.routing.partner] == np.arange(2 * after.graph.branch_count)
    ).all()
    assert _length(after) == pytest.approx(_length(before), abs=4.0)
    if after.graph is before.graph:  # decided at a junction
        return
    a, b = after.corners[-1].half_branches
    assert not after.corners[-1].pairs
    undone = after.join(a, b)
    assert undone.corners[-1].pairs == ((a, b),)
    assert [s.closed for s in undone.strokes] == [s.closed for s in before.strokes]
    kept = after.ask_again()
    assert not kept.corners[-1].pairs
    assert kept.corners[-1].locked
    np.testing.assert_array_equal(read(dumps(after)).routing.partner, after.routing.partner)


def test_two_loose_ends_become_one_stroke() -> None:
    drawing = _drawing(
        [np.array([[20, 50], [80, 50]], float), np.array([[90, 52], [160, 52]], float)]
    )
    assert len(drawing.strokes) == 2
    ends = {
        round(float(drawing.graph.vertices[v][0])): h
        for h, v in enumerate(drawing.graph.half_vertex)
    }
    after = drawing.join(ends[80], ends[90])
    assert len(after.strokes) == 1
    points = after.strokes[0].points
    assert points[:, 0].min() == 20
    assert points[:, 0].max() == 160
    assert len(after.corners) == 1
    assert after.corners[0].locked
    assert len(after.cut(0, (90.0, 52.0)).strokes) == 2
    with pytest.raises(InvoluteError, match="ends there already"):
        drawing.cut(0, (20.0, 50.0))
    with pytest.raises(InvoluteError, match="two different ends"):
        drawing.join(ends[80], ends[80])
    with pytest.raises(InvoluteError, match="Only ends can be joined"):
        after.join(ends[80], ends[20])


def test_a_drawing_of_before_corners_were_decided_still_opens() -> None:
    drawing = _drawing([BOX, np.array([[20, 80], [180, 80]], float)])
    circle = 100 + 20 * np.stack([np.cos(t := np.linspace(0, 2 * np.pi, 90)), np.sin(t)], 1)
    for made in (drawing, _drawing([circle])):
        document = json.loads(dumps(made))
        first = len(made.graph.junctions)
        routing = made.routing
        old = replace(
            routing,
            pairs=routing.pairs[: len(routing.pairs) - len(made.corners)],
            pair_score=routing.pair_score[: len(routing.pairs) - len(made.corners)],
            alternatives=routing.alternatives[:first],
            locked=routing.locked[:first],
        )
        document = json.loads(dumps(replace(made, routing=old)))
        del document["graph"]["clues"], document["settings"]["corners"]
        opened = read(json.dumps(document))
        assert len(opened.corners) == len(made.corners)
        assert all(corner.pairs for corner in opened.corners)
        assert [s.closed for s in opened.strokes] == [s.closed for s in made.strokes]
        opened.with_corners(0.5).ask_again()
        restored = opened.with_routing(routing.partner, np.ones(first, bool))
        assert restored.routing.locked.tolist() == [True] * first + [False] * len(made.corners)


def test_clues_are_kept_in_files(tmp_path: Path) -> None:
    graph, _ = _seen([BOX])
    graph = replace(graph, clues=np.full((4, 8), 0.25, np.float32))
    drawing = Drawing.from_routing(graph, route(graph, GEOMETRIC), _scan(), GEOMETRIC)
    drawing.save(tmp_path / "box.json")
    opened = Drawing.load(tmp_path / "box.json")
    np.testing.assert_array_equal(opened.graph.clues, graph.clues)
    np.testing.assert_array_equal(opened.ask_again().routing.partner, drawing.routing.partner)


def test_a_page_is_asked_for_its_corners_only_when_wanted() -> None:
    page = np.full((260, 300), 255, np.uint8)
    cv2.polylines(page, [np.rint(BOX * 1.5).astype(np.int32)], True, 0, 3, cv2.LINE_AA)
    plain = vectorize(page)
    assert [s.closed for s in plain.strokes] == [True]
    lifted = vectorize(page, Settings(corners=1.0))
    assert len(lifted.corners) >= 4
    assert len(lifted.graph.clues) == len(lifted.corners)
    assert len(lifted.strokes) >= 4
    around = lifted.with_corners(-1.0)
    assert [s.closed for s in around.strokes] == [True]
    asked = around.reroute(around.corners[0].index, []).ask_again()
    assert not asked.corners[0].pairs
    assert all(0.0 < way.probability < 1.0 for c in asked.corners for way in c.alternatives)
