"""Connected pieces: what OpenCV says of them, without its statistics."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from involute.engine.arrays import components as module
from involute.engine.arrays.components import components


@st.composite
def places(draw) -> np.ndarray:
    """(H, W) uint8 with single pixels and boxes; from nothing at all to nearly everything."""
    shape = draw(st.integers(1, 60)), draw(st.integers(1, 60))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    dark = (rng.random(shape) < draw(st.sampled_from([0, 0.01, 0.1, 0.3, 0.9]))).astype(np.uint8)
    for _ in range(draw(st.integers(0, 3))):
        y, x = draw(st.integers(0, shape[0] - 1)), draw(st.integers(0, shape[1] - 1))
        dark[y : y + draw(st.integers(1, 9)), x : x + draw(st.integers(1, 9))] = 255
    return dark


@settings(deadline=None)
@given(places(), st.sampled_from([4, 8]))
def test_pieces_are_those_of_opencv(dark, connectivity):
    count, label, stats, middle = components(dark, connectivity=connectivity)
    expected = cv2.connectedComponentsWithStats(dark, connectivity=connectivity)
    assert count == expected[0]
    np.testing.assert_array_equal(label, expected[1])
    np.testing.assert_array_equal(stats[1:], expected[2][1:])
    assert stats[0, cv2.CC_STAT_AREA] == expected[2][0, cv2.CC_STAT_AREA]
    np.testing.assert_array_equal(middle[1:], expected[3][1:])


@pytest.mark.parametrize("connectivity", [4, 8])
def test_a_large_light_page_has_the_same_pieces(connectivity):
    page = np.zeros((700, 900), np.uint8)
    for a, b in np.random.default_rng(1).integers(0, (900, 700), (30, 2, 2)).tolist():
        cv2.line(page, a, b, 1, 2)
    assert 0 < page.mean() < 0.1
    count, label, stats, middle = components(page, connectivity=connectivity)
    expected = cv2.connectedComponentsWithStats(page, connectivity=connectivity)
    assert count == expected[0]
    np.testing.assert_array_equal(label, expected[1])
    np.testing.assert_array_equal(stats[1:], expected[2][1:])
    assert stats[0, cv2.CC_STAT_AREA] == expected[2][0, cv2.CC_STAT_AREA]
    np.testing.assert_array_equal(middle[1:], expected[3][1:])


def test_pages_too_large_for_it_take_no_more_memory_than_opencv_does(monkeypatch):
    monkeypatch.setattr(module, "_LARGE", 100)
    monkeypatch.setattr(module.np, "flatnonzero", None)  # the first that would take some
    page = np.zeros((20, 30), np.uint8)
    page[3:5, 4:20] = 1
    assert components(page)[2][1].tolist() == [4, 3, 16, 2, 32]
