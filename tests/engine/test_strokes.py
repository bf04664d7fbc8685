"""Strokes: every branch once, smooth through junctions, sharp at corners, few points."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from involute.engine import Settings, vectorize
from involute.engine.strokes import Page, build, walk
from involute.engine.strokes.bezier import fit
from involute.engine.strokes.simplify import simplify
from involute.engine.values import PlanarGraph, Stroke
from involute.synthesis.true_graph import graph_from_strokes

from tests.engine.scribbles import scribbles

SHARP = Settings(smoothing=0.0, tolerance=0.0, min_length=0.0)


def _drawn(graph: PlanarGraph, partner: np.ndarray, settings: Settings) -> list[Stroke]:
    return build(Page.of(graph, settings), walk(partner))


def _one(strokes: list[np.ndarray], settings: Settings, width: float = 4.0) -> list[Stroke]:
    graph, partner = graph_from_strokes(strokes, widths=[width] * len(strokes))
    return _drawn(graph, partner, settings)


def _circle(radius: float, noise: float = 0.0, seed: int = 0) -> np.ndarray:
    t = np.linspace(0, 2 * np.pi, max(16, int(4 * radius)))
    points = 100 + radius * np.stack([np.cos(t), np.sin(t)], 1)
    points += np.random.default_rng(seed).normal(0, noise, points.shape)
    points[-1] = points[0]
    return points


def _outline(stroke: Stroke) -> np.ndarray:
    """The stroke as a dense polyline, closed strokes with their first point again."""
    points = stroke.points.astype(float)
    if stroke.closed:
        points = np.vstack([points, points[:1]])
    if stroke.handles is None:
        return points
    t = np.linspace(0, 1, 60)[:, None]
    pieces = []
    for i in range(len(points) - 1):
        a, d = points[i], points[i + 1]
        b, c = stroke.handles[i, 1], stroke.handles[(i + 1) % len(stroke.points), 0]
        pieces.append(
            (1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t**2 * (1 - t) * c + t**3 * d
        )
    return np.vstack(pieces)


@given(scribbles(12))
def test_strokes_partition_the_branches(scribble, drawn: list[int]) -> None:
    graph, partner = scribble(drawn)
    walks = walk(partner)
    seen = [half >> 1 for w in walks for half in w.halves]
    assert sorted(seen) == list(range(graph.branch_count))
    for w in walks:
        along = zip(w.halves, w.halves[1:] + (w.halves[:1] if w.closed else ()), strict=False)
        assert all(partner[a ^ 1] == b for a, b in along)
        if not w.closed:
            assert partner[w.halves[0]] == w.halves[0]
            assert partner[w.halves[-1] ^ 1] == w.halves[-1] ^ 1


def test_a_loop_at_a_junction_closes_on_itself_or_runs_on() -> None:
    ring = _circle(30.0)  # starts and ends where the stem touches it
    graph, partner = graph_from_strokes([ring, np.array([[130.0, 100], [190, 100]])])
    assert sorted(graph.degrees.tolist()) == [1, 3]
    assert sorted((len(w.halves), w.closed) for w in walk(partner)) == [(1, False), (1, True)]
    loop = int(np.flatnonzero(graph.ends[:, 0] == graph.ends[:, 1])[0])
    stem = next(int(h) for h in graph.halves_of(graph.junctions[0]) if h >> 1 != loop)
    lasso = np.arange(4)
    lasso[stem], lasso[2 * loop] = 2 * loop, stem
    (only,) = walk(lasso)
    assert not only.closed
    assert sorted(h >> 1 for h in only.halves) == [0, 1]
    (stroke,) = build(Page.of(graph, Settings()), [only])
    assert np.hypot(*(stroke.points - [130, 100]).T).min(initial=9) < 1e-3
    assert np.hypot(*(stroke.points[[0, -1]] - [130, 100]).T).min() < 1e-3


@given(scribbles())
def test_walking_some_branches_gives_their_strokes(scribble, drawn: list[int]) -> None:
    graph, partner = scribble(drawn)
    some = range(0, graph.branch_count, 3)
    expected = [w for w in walk(partner) if any(h >> 1 in some for h in w.halves)]
    assert walk(partner, some) == expected


@given(scribbles(), st.sampled_from([0.0, 0.3, 1.0]), st.sampled_from(["polyline", "bezier"]))
def test_strokes_run_through_their_vertices(
    scribble, drawn: list[int], smoothing: float, curve
) -> None:
    graph, partner = scribble(drawn)
    settings = Settings(smoothing=smoothing, curve=curve, min_length=0.0)
    for stroke in _drawn(graph, partner, settings):
        vertex = graph.half_vertex[stroke.branches]
        vertices = graph.vertices[vertex[graph.degrees[vertex] != 2]]
        away = np.abs(stroke.points[:, None] - vertices[None]).max(-1).min(0)
        assert away.max(initial=0) < 1e-3
        assert len(stroke.points) == len(stroke.widths) == len(stroke.opacity) >= 2
        assert np.isfinite(stroke.points).all()
        assert (stroke.widths > 0).all()
        assert ((stroke.opacity >= 0) & (stroke.opacity <= 1)).all()


@given(scribbles())
def test_a_stroke_does_not_depend_on_the_others(scribble, drawn: list[int]) -> None:
    graph, partner = scribble(drawn)
    page = Page.of(graph, Settings(min_length=0.0))
    walks = walk(partner)
    together = build(page, walks)
    for w, stroke in zip(walks, together, strict=True):
        (alone,) = build(page, [w])
        assert alone.closed == stroke.closed
        np.testing.assert_array_equal(alone.points, stroke.points)
        np.testing.assert_array_equal(alone.widths, stroke.widths)


@given(scribbles(), st.floats(0.05, 2.0))
def test_simplified_strokes_stay_within_the_tolerance(
    scribble, drawn: list[int], tolerance: float
) -> None:
    graph, partner = scribble(drawn)
    fine = _drawn(graph, partner, SHARP)
    coarse = _drawn(graph, partner, replace(SHARP, tolerance=tolerance))
    for a, b in zip(fine, coarse, strict=True):
        line = shapely.LineString(_outline(b))
        assert shapely.distance(shapely.points(a.points), line).max() <= tolerance + 1e-3
        assert len(b.points) <= len(a.points)


@given(scribbles(), st.floats(0.1, 2.0))
def test_curves_stay_within_the_tolerance(scribble, drawn: list[int], tolerance: float) -> None:
    graph, partner = scribble(drawn)
    settings = replace(SHARP, tolerance=tolerance, smoothing=0.3)
    fine = _drawn(graph, partner, replace(settings, tolerance=0.0))
    curves = _drawn(graph, partner, replace(settings, curve="bezier"))
    for a, b in zip(fine, curves, strict=True):
        assert b.handles.shape == (len(b.points), 2, 2)
        line = shapely.LineString(_outline(b))
        assert shapely.distance(shapely.points(a.points), line).max() <= tolerance + 0.05


def test_curves_keep_no_anchor_that_is_not_needed() -> None:
    x = np.arange(800.0)
    wave = np.stack([x, 50 * np.sin(2 * np.pi * x / 300)], 1)
    ends = (x == 0) | (x == 799)
    anchors, _ = fit(wave, np.zeros(800, int), ends, ends, 0.5)
    assert anchors.sum() <= 7  # splitting alone leaves 8


def test_a_line_through_a_crossing_has_no_kink() -> None:
    x = np.linspace(0, 200, 100)
    bent = np.stack([x, 100 + 1.2 * np.exp(-(((x - 100) / 3) ** 2))], 1)  # drawn to the blob
    strokes = _one([bent, np.array([[100.0, 20], [100, 180]])], Settings())
    line = max(strokes, key=lambda s: np.ptp(s.points[:, 0]))
    step = np.diff(line.points, axis=0)
    heading = np.arctan2(step[:, 1], step[:, 0])
    assert np.degrees(np.abs(np.diff(heading))).max() < 15


def test_a_corner_stays_sharp() -> None:
    corner = np.array([[20.0, 20], [100, 20], [100, 120]])
    for settings in (Settings(), Settings(smoothing=1.0), Settings(curve="bezier")):
        (stroke,) = _one([corner], settings)
        assert np.hypot(*(stroke.points - [100, 20]).T).min() < 0.3
        assert len(stroke.points) == 3


@pytest.mark.parametrize("angle", [50.0, 90.0, 120.0])
def test_a_corner_that_the_centerline_rounded_is_sharp_again(angle: float) -> None:
    way = np.radians(180 - angle)
    legs = np.array([[-60.0, 0], [0, 0], [60 * np.cos(way), 60 * np.sin(way)]]) + 100
    t = np.linspace(0, 2, 241)
    dense = np.stack([np.interp(t, [0, 1, 2], legs[:, c]) for c in (0, 1)], 1)
    kernel = np.hanning(7) / np.hanning(7).sum()
    rounded = dense.copy()
    for c in (0, 1):
        rounded[3:-3, c] = np.convolve(dense[:, c], kernel, mode="valid")
    (stroke,) = _one([rounded], Settings())
    assert np.hypot(*(rounded - 100).T).min() > 0.2
    assert np.hypot(*(stroke.points - 100).T).min() < 0.1
    assert len(stroke.points) == 3


def test_a_corner_that_the_page_cuts_off_stays_on_the_page() -> None:
    """The line follows the edge for a few px where the true corner lies beyond it."""
    legs = np.array([[45.0, 100], [58, 204], [75, 100]])
    t = np.linspace(0, 2, 241)
    line = np.stack([np.interp(t, [0, 1, 2], legs[:, c]) for c in (0, 1)], 1)
    line[:, 1] = np.minimum(line[:, 1], 200.0)
    graph, partner = graph_from_strokes([line], widths=[8.0])
    beyond, on_page = (
        build(Page.of(graph, Settings(), size), walk(partner))[0]
        for size in ((np.inf, np.inf), (200, 200))
    )
    assert beyond.points[:, 1].max() > 202
    assert on_page.points[:, 1].max() < 200.5


def test_a_round_corner_stays_round() -> None:
    t = np.linspace(0, np.pi / 2, 30)
    arc = np.stack([100 + 8 * np.sin(t), 28 - 8 * np.cos(t)], 1)
    (stroke,) = _one([np.vstack([[[20.0, 20]], arc, [[108.0, 120]]])], Settings(), width=3.0)
    assert np.hypot(*(stroke.points - [108, 20]).T).min() > 2.5  # 3.3 px on the arc itself


def test_a_corner_at_a_junction_stays_sharp() -> None:
    corner = np.array([[20.0, 100], [100, 100], [100, 180]])
    graph, _ = graph_from_strokes([corner, np.array([[100.0, 100], [170, 40]])], widths=[4.0, 4.0])
    partner = np.arange(6)
    ends = {tuple(np.round(graph.points[graph.offsets[b]])): 2 * b for b in range(3)}
    ends.update(
        {tuple(np.round(graph.points[graph.offsets[b + 1] - 1])): 2 * b + 1 for b in range(3)}
    )
    a, b = ends[20, 100] ^ 1, ends[100, 180] ^ 1
    partner[a], partner[b] = b, a
    strokes = _drawn(graph, partner, Settings())
    joined = next(s for s in strokes if len(s.branches) == 2)
    assert len(joined.points) == 3


@pytest.mark.parametrize("radius", [5.0, 20.0, 60.0])
@pytest.mark.parametrize("curve", ["polyline", "bezier"])
def test_a_noisy_circle_comes_back_round_and_closed(radius: float, curve) -> None:
    (stroke,) = _one([_circle(radius, noise=0.15)], Settings(curve=curve), width=3.0)
    assert stroke.closed
    outline = _outline(stroke)
    away = np.hypot(*(outline - 100).T)
    assert np.abs(away - radius).max() < 0.4
    if stroke.handles is not None:
        left, right = stroke.handles[0] - stroke.points[0]
        turn = np.arctan2(left[0] * right[1] - left[1] * right[0], -left @ right)
        assert np.degrees(abs(turn)) < 1  # no kink where it closes
    assert len(stroke.points) < 12 * np.sqrt(radius)


def test_smoothing_does_not_shrink_a_circle() -> None:
    for smoothing in (0.3, 0.6, 1.0):
        (stroke,) = _one([_circle(30.0)], Settings(smoothing=smoothing, tolerance=0.05))
        away = np.hypot(*(stroke.points - 100).T)
        assert away.mean() == pytest.approx(30.0, abs=0.3)


def test_more_smoothing_gives_a_calmer_line() -> None:
    rng = np.random.default_rng(3)
    wobbly = np.stack([np.linspace(0, 300, 200), 100 + rng.normal(0, 0.6, 200)], 1)
    rough = [np.ptp(_one([wobbly], Settings(smoothing=s))[0].points[5:-5, 1]) for s in (0, 0.3, 1)]
    assert rough[0] > 1.3 * rough[1] > 1.5 * rough[2]


def test_widths_do_not_swell_at_junctions() -> None:
    graph, partner = graph_from_strokes(
        [np.array([[0.0, 100], [200, 100]]), np.array([[100.0, 0], [100, 200]])], widths=[4.0, 4.0]
    )
    graph = _dense(graph)
    near = np.hypot(*(graph.points - [100, 100]).T) < 4
    blob = replace(graph, widths=np.where(near, 9.0, 4.0).astype(np.float32))
    for stroke in _drawn(blob, partner, Settings(tolerance=0.0)):
        assert np.abs(stroke.widths - 4).max() < 0.5


def _dense(graph: PlanarGraph) -> PlanarGraph:
    """The same graph with a point every pixel."""
    lines = []
    for b in range(graph.branch_count):
        line = shapely.segmentize(shapely.LineString(graph.branch(b)), 1.0)
        lines.append(shapely.get_coordinates(line).astype(np.float32))
    offsets = np.concatenate([[0], np.cumsum([len(line) for line in lines])]).astype(np.int32)
    return PlanarGraph(graph.vertices, np.concatenate(lines), offsets, graph.ends)


@pytest.mark.parametrize(("curve", "off"), [("polyline", 0.8), ("bezier", 1.4)])
def test_pressure_keeps_its_points(curve, off: float) -> None:
    x = np.linspace(0, 200, 201)
    line = PlanarGraph(
        np.array([[0, 50], [200, 50]], np.float32),
        np.stack([x, np.full(201, 50.0)], 1).astype(np.float32),
        np.array([0, 201], np.int32),
        np.array([[0, 1]], np.int32),
        widths=(2 + 6 * np.sin(np.pi * x / 200) ** 2).astype(np.float32),
    )
    (stroke,) = _drawn(line, np.arange(2), Settings(curve=curve))
    assert 3 <= len(stroke.points) <= 40
    wide = np.interp(x, stroke.points[:, 0], stroke.widths)
    assert np.abs(wide - line.widths).max() < off


def test_one_ink_is_one_colour() -> None:
    rng = np.random.default_rng(0)
    strokes = [np.array([[10.0, 20 * k], [190, 20 * k + 5]]) for k in range(1, 10)]
    inks = [(200, 30, 40), (25, 22, 20), (40, 60, 180)]
    graph, partner = graph_from_strokes(strokes, widths=[3.0] * 9, strength=[0.9] * 9)
    graph = _dense(graph)
    of_branch = np.arange(graph.branch_count) % 3
    true = np.array(inks)[np.repeat(of_branch, np.diff(graph.offsets))]
    # Thin lines mix with the paper, by a different share at every point.
    share = rng.uniform(0.5, 1.0, (len(true), 1))
    seen = 255 - share * (255 - true) + rng.normal(0, 6, true.shape)
    graph = replace(
        graph,
        colors=np.clip(seen, 0, 255).astype(np.uint8),
        widths=np.full(len(true), 3.0, np.float32),
    )
    strokes = _drawn(graph, partner, Settings())
    found = {tuple(s.color) for s in strokes}
    assert len(found) == 3
    assert (0, 0, 0) in found
    for stroke in strokes:
        ink = np.array(inks[of_branch[stroke.branches[0] >> 1]])
        assert np.abs(np.array(stroke.color) - ink).max() < 50
    assert {s.color for s in _drawn(graph, partner, Settings(inks=False))} == {(0, 0, 0)}


def test_a_blank_page_has_no_strokes() -> None:
    assert _drawn(PlanarGraph.empty(), np.zeros(0, np.int32), Settings()) == []


@given(st.integers(0, 10_000), st.floats(0.01, 3))
def test_simplify_keeps_within_tolerance_and_what_it_must(seed: int, tolerance: float) -> None:
    rng = np.random.default_rng(seed)
    points = np.cumsum(rng.normal(0, 1, (200, 2)), 0)
    keep = np.zeros(200, bool)
    keep[[0, 70, 199]] = True
    kept = simplify(points, keep, tolerance)
    assert kept[[0, 70, 199]].all()
    line = shapely.LineString(points[kept])
    assert shapely.distance(shapely.points(points), line).max() <= tolerance + 1e-9


@pytest.mark.parametrize("smoothing", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("curve", ["polyline", "bezier"])
def test_a_line_that_comes_back_to_where_it_began_has_a_length(smoothing: float, curve) -> None:
    """Out and back by half a pixel, between two vertices in one place."""
    out = np.array([[30, 30], [29.5, 29.9], [30, 30]], np.float32)
    line = np.array([[30, 30], [60, 40], [90, 30]], np.float32)
    graph = PlanarGraph(
        np.array([[30, 30], [30, 30], [90, 30]], np.float32),
        np.concatenate([out, line]),
        np.array([0, 3, 6], np.int32),
        np.array([[0, 1], [1, 2]], np.int32),
        widths=np.full(6, 2.0, np.float32),
    )
    page = Page.of(graph, Settings(smoothing=smoothing, curve=curve))
    for stroke in build(page, walk(np.arange(4, dtype=np.int32))):
        assert np.ptp(_outline(stroke), axis=0).max() > 0.1


@pytest.mark.parametrize("curve", ["polyline", "bezier"])
@pytest.mark.parametrize("alone", [True, False])
@pytest.mark.parametrize("pen", [2.0, 12.0, 300.0])
def test_a_ring_smaller_than_the_pen_has_a_length(curve, alone: bool, pen: float) -> None:
    """Alone, and as a loop that ends in the junction where it began."""
    angle = np.linspace(0, 2 * np.pi, 13)[:, None]
    ring = (np.hstack([np.cos(angle), np.sin(angle)]) * 1.5 + 30).astype(np.float32)
    ring[-1] = ring[0]
    line = np.array([ring[0], [60, 40], [90, 30]], np.float32)
    both = [ring] if alone else [ring, line]
    graph = PlanarGraph(
        np.array([ring[0], [90, 30]], np.float32)[: len(both)],
        np.concatenate(both),
        np.cumsum([0, *map(len, both)]).astype(np.int32),
        np.array([[0, 0], [0, 1]], np.int32)[: len(both)],
        widths=np.full(sum(map(len, both)), pen, np.float32),
    )
    partner = np.array([1, 0] if alone else [0, 1, 2, 3], np.int32)
    page = Page.of(graph, Settings(smoothing=0.3, curve=curve, min_length=0.0))
    for stroke in build(page, walk(partner)):
        places = stroke.points if stroke.handles is None else stroke.handles.reshape(-1, 2)
        assert np.ptp(np.concatenate([stroke.points, places]), axis=0).max() > 0.1


@pytest.mark.parametrize(
    ("seed", "asked"),
    [(0, Settings(provider="given", curve="bezier", smoothing=1.0)), (5, Settings(smoothing=1.0))],
)
def test_every_stroke_of_noise_has_a_length(seed: int, asked: Settings) -> None:
    """Loops of a pixel, as curves and as points; three lines that cross in one place."""
    noise = np.random.default_rng(seed).integers(0, 256, (110, 130), dtype=np.uint8)
    strokes = vectorize(noise, replace(asked, min_length=0.0, corners=-1.0)).strokes
    assert len(strokes) > 40
    assert min(np.ptp(stroke.points, axis=0).max() for stroke in strokes) > 1e-3


@pytest.mark.parametrize("seed", [17, 31, 32, 40])
def test_the_strongest_smoothing_stays_on_the_page(seed: int) -> None:
    """Lines that turn at the edge swung up to 1.9 px beyond it."""
    rng, page = np.random.default_rng(seed), np.zeros((64, 48), np.uint8)
    line = rng.uniform(2, 44, (6, 2))
    line[2], line[3] = (47, rng.uniform(10, 50)), (47, rng.uniform(10, 50))
    line[4] = rng.uniform(5, 40), 62
    cv2.polylines(page, [(line * 16).astype(np.int32)], False, 255, 1, cv2.LINE_AA, 4)
    drawing = vectorize(page, Settings(provider="given", pen_width=3.0, smoothing=1.0))
    points = np.concatenate([stroke.points for stroke in drawing.strokes])
    assert points.min() >= 0
    assert (points <= (48, 64)).all()
