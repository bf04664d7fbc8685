"""Widths, darkness and colour of the ink along the branches."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from involute.engine import Settings
from involute.engine.graph import Evidence, run_passes
from involute.engine.graph.measure import measure
from involute.engine.values import LineMaps, PlanarGraph, Scan

LINE = np.array([[14.5, 20.0], [104.0, 61.0]])


def stroke(width: float, shade: float = 1.0) -> np.ndarray:
    scale = 16
    big = np.zeros((80 * scale, 120 * scale), np.uint8)
    ends = np.rint(LINE * scale - 0.5).astype(int)
    cv2.line(big, *map(tuple, ends.tolist()), 255, round(width * scale))
    return cv2.resize(big, (120, 80), interpolation=cv2.INTER_AREA).astype(np.float32) / 255 * shade


def scan(ink: np.ndarray, color: np.ndarray | None = None) -> Scan:
    return Scan(ink, color, 1.0, ink.shape[::-1], 3.0)


def measured(page: Scan, maps: LineMaps) -> PlanarGraph:
    """The lines of a map, measured on a page."""
    return run_passes(Evidence.of(page, maps), Settings(), until="pencil")


def middle(graph: PlanarGraph, values: np.ndarray) -> np.ndarray:
    """The values of the longest branch, away from its ends."""
    return values[8:-8] if graph.branch_count == 1 else values[:0]


@pytest.mark.parametrize("width", [1.5, 2.0, 3.0, 5.0, 8.0])
def test_widths_from_the_ink(width: float) -> None:
    maps = LineMaps(stroke(1.0))
    graph = measured(scan(stroke(width)), maps)
    assert abs(np.median(middle(graph, graph.widths)) - width) < 0.25 + 0.03 * width


def test_widths_from_the_network() -> None:
    maps = LineMaps(stroke(1.0), half_width=np.full((80, 120), 1.75, np.float32))
    graph = measured(scan(stroke(3.0)), maps)
    assert np.allclose(middle(graph, graph.widths), 3.5, atol=0.05)


def test_strength_and_color() -> None:
    maps = LineMaps(stroke(1.0))
    color = np.full((80, 120, 3), 255, np.uint8)
    color[stroke(4.0) > 0] = (200, 30, 40)
    graph = measured(scan(stroke(4.0, 0.6), color), maps)
    assert abs(np.median(middle(graph, graph.strength)) - 0.6) < 0.05
    assert np.abs(np.median(middle(graph, graph.colors), axis=0) - (200, 30, 40)).max() < 8


def test_a_grey_page_has_no_colors() -> None:
    maps = LineMaps(stroke(1.0))
    assert measured(scan(stroke(3.0)), maps).colors is None


def test_an_empty_graph_stays_empty() -> None:
    maps = LineMaps(np.zeros((80, 120), np.float32))
    page = Evidence.of(scan(np.zeros((80, 120), np.float32)), maps)
    graph = measure(PlanarGraph.empty(), page, Settings())
    assert graph.branch_count == 0
