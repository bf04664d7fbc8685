"""Branches meet at vertices: always on a sparse drawing, nearly always in a dense tangle."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from involute.engine import Settings
from involute.engine.graph import build_graph
from involute.engine.values import LineMaps, PlanarGraph

SIZE = 200


def graph_of_random(seed: int, count: int) -> PlanarGraph:
    """The graph of arcs and waves drawn as ideal centerlines."""
    rng = np.random.default_rng(seed)
    t = np.linspace(0, 1, 40)[:, None]
    big = np.zeros((SIZE * 8, SIZE * 8), np.uint8)
    for _ in range(count):
        a, b = rng.uniform(10, SIZE - 10, (2, 2))
        across = np.array([a[1] - b[1], b[0] - a[0]])
        line = a + t * (b - a) + rng.uniform(-0.2, 0.2) * np.sin(4 * t) * across
        fixed = np.rint((line * 8 - 0.5) * 64).astype(np.int32)
        cv2.polylines(big, [fixed.reshape(-1, 1, 2)], False, 255, 8, cv2.LINE_8, 6)
    image = cv2.resize(big, (SIZE, SIZE), interpolation=cv2.INTER_AREA)
    return build_graph(LineMaps(image.astype(np.float32) / 255), 2.0, Settings())


def stray_crossings(graph: PlanarGraph, tolerance: float = 1.5) -> int:
    """Crossings of branches, but for those within `tolerance` px of a vertex that both share."""
    branch = np.repeat(np.arange(graph.branch_count), np.diff(graph.offsets) - 1)
    first = np.delete(np.arange(len(graph.points)), graph.offsets[1:] - 1)
    lines = shapely.linestrings(np.stack([graph.points[first], graph.points[first + 1]], 1))
    a, b = shapely.STRtree(lines).query(lines, "crosses")
    a, b = a[a < b], b[a < b]
    places = shapely.get_coordinates(shapely.centroid(shapely.intersection(lines[a], lines[b])))
    stray = 0
    for place, i, j in zip(places, graph.ends[branch[a]], graph.ends[branch[b]], strict=True):
        shared = graph.vertices[np.intersect1d(i, j)]
        stray += not (np.hypot(*(shared - place).T) <= tolerance).any()
    return stray


@settings(max_examples=40, deadline=None, derandomize=True)
@given(st.integers(0, 2**32 - 1), st.integers(1, 3))
def test_branches_of_a_few_lines_do_not_cross(seed: int, count: int) -> None:
    assert stray_crossings(graph_of_random(seed, count)) == 0


# A known fault: curves fitted through junctions a few px apart can cross each other.
# Measured over 60 drawings each: 0.9 % of the branches with 12 lines, 1.3 % with 25.
@pytest.mark.parametrize(("count", "share"), [(12, 0.02), (25, 0.02)])
def test_branches_of_a_tangle_rarely_cross(count: int, share: float) -> None:
    graphs = [graph_of_random(seed, count) for seed in range(12)]
    stray = sum(map(stray_crossings, graphs))
    assert stray <= share * sum(g.branch_count for g in graphs)
