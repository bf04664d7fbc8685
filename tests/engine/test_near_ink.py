"""The finest layers of the network only where there is ink: the same answer there."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from involute.engine import onnx_file, runtimes, weights
from involute.engine.centerline import learned, near_ink
from involute.engine.centerline.backends import INPUT
from involute.engine.onnx_file import Network, Node

LOAD = runtimes.RUNTIMES[-1].load  # OpenCV, which is always there
_cells = arrays.arrays(bool, arrays.array_shapes(min_dims=2, max_dims=2, max_side=40))


def page(height: int, width: int, lines: int, faintest: float = 0.3) -> np.ndarray:
    """(1, 1, height, width) ink: pen strokes on white paper."""
    rng = np.random.default_rng(lines)
    ink = np.zeros((height, width), np.uint8)
    for _ in range(lines):
        ends = rng.uniform(0, (width * 16, height * 16), (2, 2)).astype(int)
        ink_of_it = int(255 * rng.uniform(faintest, 1))
        cv2.line(ink, *map(tuple, ends.tolist()), ink_of_it, 3, cv2.LINE_AA, 4)
    return ink[None, None].astype(np.float32) / 255


@pytest.fixture(scope="module", params=[learned.WEIGHTS, learned.LEAN], ids=["default", "lean"])
def networks(request):
    """The whole network, and the same near ink."""
    content = weights.read(request.param)
    network = onnx_file.read(content).without_casts()
    whole = LOAD(content)
    return lambda ink: whole({INPUT: ink}, 1)[0], near_ink.near_ink(network, LOAD)


@pytest.mark.parametrize("faintest", [0.3, 0.01])
@pytest.mark.parametrize(("height", "width", "lines"), [(512, 768, 3), (256, 256, 1), (64, 640, 2)])
def test_near_the_ink_the_answer_is_that_of_the_whole_network(
    networks, height, width, lines, faintest
):
    whole, near = networks
    ink = page(height, width, lines, faintest)
    expected, found = whole(ink), near(ink)
    assert found.shape == expected.shape
    side = 2 * near_ink.NEAR + 1
    close = cv2.dilate((ink[0, 0] > 0).view(np.uint8), np.ones((side, side), np.uint8)) > 0
    np.testing.assert_allclose(found[..., close], expected[..., close], atol=runtimes.SAME)
    assert not found[..., cv2.dilate(close.view(np.uint8), np.ones((65, 65), np.uint8)) == 0].any()


@pytest.mark.parametrize("ink", [page(16, 16, 0), page(256, 512, 0), page(16, 48, 1)])
def test_blank_and_small_windows(networks, ink):
    whole, near = networks
    found = near(ink)
    assert found.shape == whole(ink).shape
    if not ink.any():
        assert not found.any()


def test_white_paper_is_hardly_looked_at():
    """A line across a page: the finest layers see less than a third of it."""
    seen: list[int] = []

    def load(content):
        net = LOAD(content)

        def counted(inputs, count):
            seen.extend(values.shape[2] * values.shape[3] for values in inputs.values())
            return net(inputs, count)

        return counted

    network = onnx_file.read(weights.read(learned.WEIGHTS)).without_casts()
    look = near_ink.near_ink(network, load)
    seen.clear()
    look(page(1024, 1024, 1))
    assert max(seen) < 1024**2 / 8


def test_a_network_without_levels_looks_at_everything():
    sides = {"kernel_shape": [3, 3], "pads": [1] * 4, "strides": [1, 1], "dilations": [1, 1]}
    conv = Node("Conv", [INPUT, "kernel", "bias"], ["maps"], {**sides, "group": [1]})
    weight = {"kernel": np.ones((1, 1, 3, 3), np.float32), "bias": np.zeros(1, np.float32)}
    network = Network([conv], weight, [INPUT], ["maps"])
    assert near_ink.cut(network) is None
    ink = page(64, 64, 2)[0, 0]
    found = near_ink.near_ink(network, LOAD)(ink[None, None])[0, 0]
    sums = cv2.boxFilter(ink, -1, (3, 3), normalize=False, borderType=cv2.BORDER_CONSTANT)
    np.testing.assert_allclose(found[ink > 0], sums[ink > 0], atol=1e-4)


@given(_cells, st.sampled_from([0.25, 1.0, 2.0]))
def test_rectangles_cover_every_cell_once(cells, rims):
    rectangles, cost = near_ink.cover(cells, rims)
    times = np.zeros(cells.shape, int)
    for top, left, bottom, right in rectangles:
        times[top:bottom, left:right] += 1
        assert cells[top:bottom, left:right].any()
    assert times.max(initial=0) <= 1
    assert (times[cells] == 1).all()
    alone = near_ink.cover(np.ones((1, 1), bool), rims)[1]
    assert cost <= cells.sum() * alone + 1e-6
    assert (cost > 0) == cells.any()
