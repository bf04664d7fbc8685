"""Dust and scratches go; dots, long faint lines and whatever hangs on a line stay."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from involute.engine import Settings, vectorize
from involute.engine.graph import Evidence
from involute.engine.graph.removal.dust import remove_dust
from involute.engine.values import LineMaps, PlanarGraph
from involute.synthesis.true_graph import graph_from_strokes

LINE = np.array([[10.0, 150], [190, 150]])


def _swept(
    strokes: list[np.ndarray], widths: list[float], strength: list[float], settings: Settings
) -> PlanarGraph:
    graph, _ = graph_from_strokes(strokes)
    size = np.diff(graph.offsets)
    graph = replace(
        graph,
        widths=np.repeat(widths, size).astype(np.float32),
        strength=np.repeat(strength, size).astype(np.float32),
    )
    page = Evidence(LineMaps(np.zeros((1, 1), np.float32)), 4.0)
    return remove_dust(graph, page, settings)


def test_dust_goes_and_dots_stay() -> None:
    dust, dot = np.array([[50.0, 50], [51.5, 50]]), np.array([[90.0, 90], [91.5, 90]])
    strokes, widths, ink = [dust, dot, LINE], [2.0, 7.0, 4.0], [1.0, 1.0, 1.0]
    kept = _swept(strokes, widths, ink, Settings())
    assert sorted(set(kept.widths.tolist())) == [4.0, 7.0]
    assert _swept(strokes, widths, ink, Settings(min_length=0.0)).branch_count == 3


def test_a_point_is_no_stroke() -> None:
    """A speck that thinning has shrunk to nothing, beside a dot with a length."""
    point, dot = np.array([[50.0, 50], [51.5, 50]]), np.array([[90.0, 90], [91.5, 90]])
    graph, _ = graph_from_strokes([point, dot, LINE])
    size = np.diff(graph.offsets)
    points, vertices = graph.points.copy(), graph.vertices.copy()
    points[points[:, 0] < 60 - 10 * (points[:, 1] > 100)] = (50.0, 50.0)
    vertices[(vertices[:, 0] > 45) & (vertices[:, 0] < 60)] = (50.0, 50.0)
    measures = {name: np.full(size.sum(), 4.0, np.float32) for name in ("widths", "strength")}
    graph = replace(graph, points=points, vertices=vertices, **measures)
    assert not np.ptp(graph.branch(0), axis=0).any()
    page = Evidence(LineMaps(np.zeros((1, 1), np.float32)), 4.0)
    assert remove_dust(graph, page, Settings()).branch_count == 2


def test_scratches_go_and_faint_lines_stay() -> None:
    scratch = np.array([[50.0, 50], [70.0, 50]])
    faint = np.array([[10.0, 100], [190, 100]])
    short = np.array([[90.0, 70], [110.0, 70]])
    kept = _swept([scratch, faint, short, LINE], [4.0] * 4, [0.15, 0.15, 0.9, 1.0], Settings())
    assert kept.branch_count == 3
    assert not (kept.points[:, 1] == 50).any()


def test_a_page_of_nothing_but_faint_lines_keeps_them() -> None:
    hatching = [np.array([[10.0, y], [30.0, y]]) for y in range(10, 100, 10)]
    assert _swept(hatching, [4.0] * 9, [0.15] * 9, Settings()).branch_count == 9


def test_short_lines_that_hang_on_something_stay() -> None:
    bar, stem = np.array([[0.0, 50], [100, 50]]), np.array([[50.0, 50], [50, 52.5]])
    kept = _swept([bar, stem], [4.0] * 3, [1.0] * 3, Settings(min_length=5.0))
    assert kept.branch_count == 3


@pytest.mark.parametrize("pen", [2.5, 4.0, 6.0])
def test_round_dots_are_kept_wherever_they_lie(pen: float) -> None:
    """Their skeleton is two pixels with one crest, or one pixel: neither makes them dust."""
    rng = np.random.default_rng(7)
    dots = [(50.0 + 54 * i, 40.0 + 60 * j) for i in range(11) for j in range(3)]
    middle = np.array(dots) + rng.uniform(-1, 1, (len(dots), 2))
    across = pen * np.tile(np.linspace(1.2, 2.2, 11), (3, 1)).T.ravel()
    fine = np.full((8 * 320, 8 * 660), 240, np.uint8)
    for place, wide in zip(middle, across, strict=True):
        at, half = np.round(16 * (8 * place)).astype(int), round(16 * 4 * wide)
        cv2.circle(fine, at.tolist(), half, 25, -1, cv2.LINE_AA, 4)
    for row in (220, 280):
        cv2.line(fine, (240, 8 * row), (8 * 620, 8 * row + 90), 25, round(8 * pen), cv2.LINE_AA)
    page = cv2.resize(fine, None, fx=1 / 8, fy=1 / 8, interpolation=cv2.INTER_AREA)
    strokes = [s for s in vectorize(page, Settings()).strokes if np.ptp(s.points, axis=0).max() < 9]
    at = np.array([s.points.mean(0) for s in strokes])
    off = np.hypot(*(middle[:, None] - at).T).T
    found = off.min(1) < 1.5
    assert found.sum() >= 31
    wide = np.array([s.widths.mean() for s in strokes])[off.argmin(1)]
    assert np.median(np.abs(wide / across - 1)[found]) < 0.15
