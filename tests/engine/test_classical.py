"""The ridge that needs no learning runs along the middle of the lines."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from involute.engine import Cancelled, Settings
from involute.engine.centerline import provider_for
from involute.engine.centerline.classical import classical
from involute.engine.centerline.given import given
from involute.engine.values import Scan


def scan_of(*lines, width: float, size: tuple[int, int] = (300, 200), pen: float = 0) -> Scan:
    """Straight lines (x0, y0, x1, y1) of an exact width, anti-aliased."""
    fine = np.zeros((size[1] * 4, size[0] * 4), np.uint8)
    for x0, y0, x1, y1 in lines:
        a, b = np.array([x0, y0]), np.array([x1, y1])
        across = np.array([a[1] - b[1], b[0] - a[0]]) / np.hypot(*(b - a)) * width / 2
        corners = np.stack([a + across, b + across, b - across, a - across])
        cv2.fillPoly(fine, [np.round((corners * 4 - 0.5) * 16).astype(np.int32)], 255, shift=4)
    ink = cv2.resize(fine, size, interpolation=cv2.INTER_AREA).astype(np.float32) / 255
    return Scan(ink, None, 1.0, size, pen or width)


def ridge_of(scan: Scan) -> np.ndarray:
    return classical(scan, lambda fraction: None).centerline


def crest(ridge: np.ndarray, column: int) -> float:
    """The middle of the one ridge in a column, px."""
    values = ridge[:, column]
    return float(((np.arange(len(values)) + 0.5) * values).sum() / values.sum())


@pytest.mark.parametrize("width", [1.5, 2, 3, 5, 8])
@pytest.mark.parametrize("slope", [0.0, 0.11, 0.5])
def test_the_crest_is_the_middle_of_the_line(width, slope):
    scan = scan_of((10, 40, 290, 40 + 280 * slope), width=width)
    ridge = ridge_of(scan)
    for column in (60, 117, 150, 223):
        # The ink's own middle: OpenCV draws a polygon up to 0.17 px off its place.
        assert abs(crest(ridge, column) - crest(scan.ink, column)) < 0.2
        assert ridge[:, column].max() > 0.5
        assert (ridge[:, column] > 0.3).sum() <= 4


@pytest.mark.parametrize("gap", [2.0, 3.0])
def test_close_parallels_stay_apart(gap):
    ridge = ridge_of(scan_of((10, 80, 290, 80), (10, 83 + gap, 290, 83 + gap), width=3))
    profile = ridge[:, 150]
    assert profile[79:81].max() > 0.6
    assert profile[int(82.5 + gap) : int(84.5 + gap)].max() > 0.6
    assert profile[int(81.5 + gap / 2)] < 0.2


def test_a_crossing_has_no_gap():
    ridge = ridge_of(scan_of((20, 100, 280, 100), (100, 20, 180, 180), width=4))
    assert ridge[99:101, 30:270].max(axis=0).min() > 0.25


def test_rough_edges_grow_no_branches():
    scan = scan_of((10, 100, 290, 100), width=6)
    rough = np.random.default_rng(0).normal(0, 0.25, scan.ink.shape).astype(np.float32)
    ink = np.clip(scan.ink + cv2.GaussianBlur(rough, (0, 0), 0.7) * (scan.ink > 0.05), 0, 1)
    ridge = ridge_of(Scan(ink, None, 1.0, scan.size, 6.0))
    assert np.all(np.abs(np.nonzero(ridge > 0.4)[0] + 0.5 - 100) < 2.5)


def test_large_pages_are_worked_in_tiles_without_a_seam():
    lines = [(10, 500, 2190, 560), (1020, 10, 1030, 990), (10, 10, 2190, 990)]
    scan = scan_of(*lines, width=3, size=(2200, 1000))
    whole = ridge_of(scan)
    part = ridge_of(Scan(scan.ink[:, 900:1900], None, 1.0, (1000, 1000), 3.0))
    np.testing.assert_allclose(whole[100:900, 1000:1800], part[100:900, 100:900], atol=1e-4)


def test_a_blank_page_has_no_ridge():
    assert ridge_of(scan_of(width=3)).max() == 0


def test_it_can_be_cancelled():
    def stop(fraction: float) -> None:
        raise Cancelled

    with pytest.raises(Cancelled):
        classical(scan_of((10, 10, 290, 190), width=3), stop)


def test_a_given_centerline_is_taken_as_it_is():
    scan = scan_of((10, 10, 290, 190), width=1)
    assert provider_for(Settings(provider="given")) is given
    np.testing.assert_array_equal(given(scan, lambda fraction: None).centerline, scan.ink)
    assert provider_for(Settings(provider="classical")) is classical
