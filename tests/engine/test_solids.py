"""Solid blacks leave the scan as outlines; lines stay lines."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from involute.engine import Settings, vectorize
from involute.engine.fills.solids import split_solids
from involute.engine.scan import read_scan
from involute.engine.values import Scan

SETTINGS = Settings()


def scan_of(*shapes, size: tuple[int, int] = (400, 300), pen: float = 3.0) -> Scan:
    """Filled polygons and (line, width) pairs, anti-aliased, as a flattened page."""
    fine = np.zeros((size[1] * 8, size[0] * 8), np.uint8)
    for shape in shapes:
        outline, color = shape if isinstance(shape, tuple) else (shape, 255)
        cv2.fillPoly(fine, [np.round(np.asarray(outline) * 8 - 0.5).astype(np.int32)], color)
    ink = cv2.resize(fine, size, interpolation=cv2.INTER_AREA).astype(np.float32) / 255
    return Scan(ink, None, 1.0, size, pen)


def disc(x: float, y: float, radius: float) -> np.ndarray:
    angle = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    return np.stack([x + radius * np.cos(angle), y + radius * np.sin(angle)], 1)


def bar(x0: float, y0: float, x1: float, y1: float, width: float) -> np.ndarray:
    a, b = np.array([x0, y0]), np.array([x1, y1])
    across = np.array([a[1] - b[1], b[0] - a[0]]) / np.hypot(*(b - a)) * width / 2
    return np.stack([a + across, b + across, b - across, a - across])


def test_a_disc_becomes_a_smooth_outline():
    _, fills = split_solids(scan_of(disc(203.3, 148.7, 40)), SETTINGS)
    ((ring,),) = fills
    radius = np.hypot(*(ring - [203.3, 148.7]).T)
    assert np.abs(radius - 40).max() < 0.4
    assert cv2.contourArea(ring) == pytest.approx(np.pi * 40**2, rel=0.01)
    assert len(ring) < 120
    assert ring.dtype == np.float32


def test_what_is_left_holds_nothing_of_the_area():
    lines, _ = split_solids(scan_of(disc(200, 150, 40)), SETTINGS)
    assert lines.ink.max() < 0.05


def test_a_line_that_touches_an_area_ends_at_its_border():
    lines, fills = split_solids(scan_of(disc(200, 150, 40), bar(20, 150, 200, 150, 3)), SETTINGS)
    assert len(fills) == 1
    assert lines.ink[150, 25:155].min() > 0.9
    assert lines.ink[150, 163:].max() < 0.05


def test_a_hole_stays_a_hole():
    _, fills = split_solids(scan_of(disc(200, 150, 60), (disc(215, 150, 20), 0)), SETTINGS)
    ((outer, hole),) = fills
    assert np.abs(np.hypot(*(outer - [200, 150]).T) - 60).max() < 0.4
    assert np.abs(np.hypot(*(hole - [215, 150]).T) - 20).max() < 0.4


@pytest.mark.parametrize(
    "shapes",
    [
        [bar(20, 30, 380, 250, 3)],
        [bar(20, 30, 380, 250, 14)],  # one fat line among thin ones
        [bar(20, 150, 380, 160, 4), bar(20, 160, 380, 150, 4)],  # a blot at a flat crossing
        [disc(100, 100, 5)],  # a dot
    ],
)
def test_lines_and_dots_are_no_areas(shapes):
    scan = scan_of(*shapes)
    lines, fills = split_solids(scan, SETTINGS)
    assert fills == []
    np.testing.assert_array_equal(lines.ink, scan.ink)


def test_a_drawing_with_a_marker_has_no_areas(tmp_path):
    scan = scan_of(bar(30, 40, 370, 60, 22), bar(60, 30, 80, 280, 22), bar(60, 250, 360, 240, 22))
    page = ((1 - scan.ink) * 255).astype(np.uint8)
    assert split_solids(read_scan(page, SETTINGS), SETTINGS)[1] == []


def test_areas_can_be_kept():
    scan = scan_of(disc(200, 150, 40))
    assert split_solids(scan, Settings(solids=False)) == (scan, [])
    assert split_solids(scan, Settings(provider="given")) == (scan, [])


def test_a_blank_page_has_no_areas():
    assert split_solids(scan_of(), SETTINGS)[1] == []


def test_an_area_over_the_border_of_the_page():
    _, fills = split_solids(scan_of(disc(0, 150, 60)), SETTINGS)
    ((ring,),) = fills
    assert cv2.contourArea(ring) == pytest.approx(np.pi * 60**2 / 2, rel=0.03)


def test_areas_with_a_very_long_border():
    """More border pixels than OpenCV samples in one row (32,767)."""
    teeth = [bar(30 + 30 * k, 10, 30 + 30 * k, 1990, 22) for k in range(12)]
    _, fills = split_solids(scan_of(*teeth, size=(400, 2000)), SETTINGS)
    assert len(fills) == 12
    assert all(cv2.contourArea(fill[0]) == pytest.approx(22 * 1980, rel=0.02) for fill in fills)


def lettered(ground: int = 15, letter: int = 245) -> np.ndarray:
    """A black box with white lettering in two sizes, a ring and a line; (H, W) uint8."""
    image = np.full((500, 700), 245, np.uint8)
    cv2.rectangle(image, (60, 60), (560, 200), ground, -1)
    font = cv2.FONT_HERSHEY_SIMPLEX
    cv2.putText(image, "SHERIFF", (90, 150), font, 2.6, letter, 4, cv2.LINE_AA)
    cv2.putText(image, "OPEN DAY AND NIGHT", (90, 185), font, 0.8, letter, 2, cv2.LINE_AA)
    cv2.ellipse(image, (300, 350), (180, 90), 0, 0, 360, 15, 3, cv2.LINE_AA)
    cv2.line(image, (40, 300), (660, 470), 15, 3, cv2.LINE_AA)
    return image


def test_white_lettering_in_a_black_box_is_a_fill_with_holes():
    drawing = vectorize(lettered())
    assert len(drawing.strokes) == 2
    box = max(drawing.fills, key=len)
    # 7 + 15 letters; what an O encloses is an area of its own.
    assert len(box) == 1 + 22
    assert cv2.contourArea(box[0]) == pytest.approx(501 * 141, rel=0.01)
    assert drawing.fidelity.lost < 0.001
    assert drawing.fidelity.invented < 0.001


def test_a_box_that_hangs_on_a_frame_is_one_all_the_same():
    image = lettered()
    cv2.line(image, (560, 100), (690, 100), 15, 3, cv2.LINE_AA)
    cv2.line(image, (60, 200), (20, 490), 15, 3, cv2.LINE_AA)
    drawing = vectorize(image)
    assert len(drawing.strokes) == 4
    assert len(max(drawing.fills, key=len)) == 1 + 22


def test_dark_hatching_is_no_box():
    image = np.full((400, 500), 245, np.uint8)
    for k in range(30):
        cv2.line(image, (60 + 10 * k, 60), (60 + 10 * k, 240), 15, 5, cv2.LINE_AA)
    for k in range(5):
        cv2.line(image, (58, 70 + 40 * k), (352, 70 + 40 * k), 15, 5, cv2.LINE_AA)
    cv2.circle(image, (90, 90), 22, 15, -1)
    scan = read_scan(image, SETTINGS)
    _, fills = split_solids(scan, SETTINGS)
    assert sum(cv2.contourArea(fill[0]) for fill in fills) < 2 * np.pi * 22**2
