"""Whatever the image, the graph is valid: no drawing is ever lost."""

from __future__ import annotations

import tracemalloc
from itertools import pairwise

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from involute.engine import Settings
from involute.engine.graph import Evidence, build_graph
from involute.engine.graph.chains import follow
from involute.engine.values import LineMaps, PlanarGraph


def check(graph: PlanarGraph, shape: tuple[int, int]) -> None:
    """Everything that `PlanarGraph` promises."""
    count = len(graph.offsets) - 1
    assert graph.ends.shape == (count, 2)
    assert graph.offsets[0] == 0
    assert graph.offsets[-1] == len(graph.points)
    assert (np.diff(graph.offsets) >= 2).all()
    assert np.isfinite(graph.points).all()
    if not count:
        return
    assert graph.ends.min() >= 0
    assert graph.ends.max() < len(graph.vertices)
    assert np.array_equal(graph.points[graph.offsets[:-1]], graph.vertices[graph.ends[:, 0]])
    assert np.array_equal(graph.points[graph.offsets[1:] - 1], graph.vertices[graph.ends[:, 1]])
    assert (graph.degrees > 0).all()
    loops = graph.ends[graph.ends[:, 0] == graph.ends[:, 1], 0]
    assert set(np.flatnonzero(graph.degrees == 2)) <= set(loops)
    height, width = shape
    assert (graph.points > -8).all()
    assert (graph.points < (width + 8, height + 8)).all()


def traced(image: np.ndarray) -> PlanarGraph:
    return build_graph(Evidence(LineMaps(image.astype(np.float32) / 255), 2.0), Settings())


@pytest.mark.parametrize("shape", [(1, 1), (1, 30), (2, 2), (40, 3), (64, 80)])
@pytest.mark.parametrize("value", [0, 20, 128, 255])
def test_flat_images(shape: tuple[int, int], value: int) -> None:
    check(traced(np.full(shape, value, np.uint8)), shape)


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 70), st.integers(1, 70), st.floats(0, 3))
def test_noise(seed: int, height: int, width: int, blur: float) -> None:
    image = np.random.default_rng(seed).integers(0, 256, (height, width)).astype(np.uint8)
    if blur > 0.3:
        image = cv2.normalize(cv2.GaussianBlur(image, (0, 0), blur), None, 0, 255, cv2.NORM_MINMAX)
    check(traced(image.reshape(height, width)), (height, width))


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 30), st.integers(1, 5))
def test_random_strokes(seed: int, count: int, thickness: int) -> None:
    rng = np.random.default_rng(seed)
    image = np.zeros((90, 110), np.uint8)
    for _ in range(count):
        line = rng.integers(-5, 115, (rng.integers(2, 6), 1, 2)).astype(np.int32)
        shade = int(rng.integers(30, 256))
        cv2.polylines(image, [line], bool(rng.integers(2)), shade, thickness, cv2.LINE_AA)
    check(traced(image), image.shape)


def test_the_same_image_gives_the_same_graph() -> None:
    image = np.random.default_rng(1).integers(0, 256, (60, 60)).astype(np.uint8)
    one, two = traced(image), traced(image)
    assert np.array_equal(one.points, two.points)
    assert np.array_equal(one.ends, two.ends)


@given(st.integers(0, 2**32 - 1), st.integers(1, 40))
@settings(max_examples=40, deadline=None)
def test_chains_use_every_edge_once(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    ends = rng.integers(0, max(2, count // 2), (count, 2))
    source = ends.ravel()
    back = np.arange(2 * count) ^ 1
    is_node = np.bincount(source, minlength=count + 2) != 2
    order, offsets = follow(source, back, is_node)
    assert sorted(order >> 1) == list(range(count))
    for first, last in pairwise(offsets):
        chain = order[first:last]
        assert np.array_equal(source[chain[1:]], source[back[chain[:-1]]])
        assert not is_node[source[chain[1:]]].any()


def test_memory_grows_no_faster_than_the_page() -> None:
    """A page of nothing but crossings (435 MB at 512 px when all mergers were fitted at once)."""
    y, x = np.mgrid[:384, :384]
    image = np.where((x % 9 < 1) | (y % 9 < 1), 255, 0).astype(np.uint8)
    tracemalloc.start()
    graph = traced(image)
    peak = tracemalloc.get_traced_memory()[1] / 2**20
    tracemalloc.stop()
    assert len(graph.junctions) > 1500
    assert peak < 120
