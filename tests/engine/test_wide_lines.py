"""Broad pens beside fine ones, and where a line ends to be one."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from involute.engine import Settings, vectorize
from involute.engine.arrays.two_clusters import finer_pen
from involute.engine.scan import read_scan
from involute.engine.scan.wide_lines import find_wide_lines


def page(broad=22, grain=False):
    """Two broad strokes, and three of a pen of about 5 px."""
    image = np.full((420, 520), 255, np.uint8)
    cv2.line(image, (60, 60), (60 + 6 * broad, 110), 0, broad, cv2.LINE_AA)
    cv2.ellipse(image, (360, 140), (80, 70), 0, 20, 300, 0, broad, cv2.LINE_AA)
    if grain:
        noise = cv2.GaussianBlur(np.random.default_rng(1).normal(0, 1, image.shape), (0, 0), 1)
        image = np.maximum(image, np.uint8(np.clip(120 * noise / noise.std(), 0, 160)))
    for y in (280, 330, 380):
        cv2.line(image, (30, y), (490, y - 25), 0, 4, cv2.LINE_AA)
    return image


@pytest.mark.parametrize("grain", [False, True])
@pytest.mark.parametrize("broad", [14, 22])
def test_every_stroke_of_either_pen_is_one_stroke(broad, grain):
    drawing = vectorize(page(broad, grain), Settings(router="geometric"))
    widths = sorted(float(np.median(stroke.widths)) for stroke in drawing.strokes)
    assert len(widths) == 5, widths
    assert not drawing.fills
    assert np.allclose(widths[:3], 5, atol=1)  # as wide as OpenCV draws 4 px
    assert np.allclose(widths[3:], broad, rtol=0.2)
    assert drawing.fidelity.lost < 0.01


def test_a_brush_that_swells_and_one_of_twelve_pens_are_lines_of_their_width():
    image = np.full((700, 700), 255, np.uint8)
    for x in range(60, 640):  # 20 to 34 px wide
        cv2.circle(image, (x, 150), round(10 + 7 * np.sin((x - 60) / 580 * np.pi)), 0, -1)
    cv2.line(image, (80, 330), (620, 380), 0, 56, cv2.LINE_AA)
    for y in (480, 540, 600):
        cv2.line(image, (30, y), (660, y + 30), 0, 4, cv2.LINE_AA)
    drawing = vectorize(image, Settings(router="geometric"))
    widths = sorted(float(np.median(stroke.widths)) for stroke in drawing.strokes)
    assert not drawing.fills
    assert np.allclose(widths, [5, 5, 5, 30, 57], rtol=0.2), widths
    assert drawing.fidelity.lost < 0.01


def test_a_line_that_runs_into_a_shape_is_no_broad_line():
    image = page(22)
    cv2.circle(image, (140, 90), 45, 0, -1, cv2.LINE_AA)
    wide = find_wide_lines(read_scan(image, Settings()), Settings())
    assert len(wide.widths) == 2  # the bow alone


def test_the_user_says_from_which_width_on_it_is_an_area():
    drawing = vectorize(page(22), Settings(solid_width=15, router="geometric"))
    assert len(drawing.strokes) == 3
    assert len(drawing.fills) == 2


def test_one_pen_has_no_wide_lines_and_blots_are_none():
    thin = np.full((300, 300), 255, np.uint8)
    cv2.circle(thin, (150, 150), 100, 0, 5, cv2.LINE_AA)
    assert not find_wide_lines(read_scan(thin, Settings()), Settings()).any
    cv2.circle(thin, (150, 150), 40, 0, -1, cv2.LINE_AA)
    assert not find_wide_lines(read_scan(thin, Settings()), Settings()).any


def test_two_pens_are_told_apart_and_a_swelling_brush_is_one():
    rng = np.random.default_rng(0)
    fine, broad = rng.normal(4, 0.3, 300), rng.normal(22, 1, 200)
    assert finer_pen(np.concatenate([broad, fine])).max() < 6
    brush = np.linspace(2, 14, 400)
    assert len(finer_pen(brush)) == 400
    assert len(finer_pen(fine)) == 300


@pytest.mark.parametrize("broad", [26, 38])
def test_the_pen_of_coarse_pencil_is_its_line_and_not_its_grain(broad):
    line = np.zeros((760, 900), np.uint8)
    for ends in ([(80, 80), (800, 160)], [(90, 300), (820, 250)], [(80, 400), (600, 680)]):
        cv2.line(line, *ends, 255, broad, cv2.LINE_AA)
    cv2.circle(line, (730, 560), 110, 255, broad, cv2.LINE_AA)
    noise = cv2.GaussianBlur(np.random.default_rng(2).normal(0, 1, line.shape), (0, 0), 3)
    ink = line / 255 * np.clip(0.55 + 0.35 * noise / noise.std(), 0.05, 1)
    scan = read_scan((1 - 0.9 * ink).astype(np.float32), Settings())
    assert scan.pen_width * scan.scale == pytest.approx(broad, rel=0.25)


def test_the_pen_of_hatching_is_that_of_its_lines():
    page = np.full((700, 700), 255, np.uint8)
    for x in range(-600, 700, 14):
        cv2.line(page, (x, 50), (x + 600, 650), 0, 2, cv2.LINE_AA)
        cv2.line(page, (x + 600, 50), (x, 650), 0, 2, cv2.LINE_AA)
    assert 2 < read_scan(page, Settings()).pen_width < 4
