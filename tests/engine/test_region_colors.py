"""Fills of closed regions take the colour that was painted there."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from involute.engine import Drawing, Settings, vectorize

PAPER, RED, BLUE = (246, 240, 226), (236, 150, 140), (150, 190, 232)
PAINTED = Settings(provider="classical", router="geometric", regions=True, solids=False)


def painted(shade: float = 0.0) -> np.ndarray:
    """Three boxes in ink, two of them painted, (300, 400, 3) RGB."""
    page = np.full((300, 400, 3), PAPER, np.float64)
    for left, color in ((40, RED), (160, PAPER), (280, BLUE)):
        cv2.rectangle(page, (left, 90), (left + 80, 210), color, cv2.FILLED)
        cv2.rectangle(page, (left, 90), (left + 80, 210), (30, 30, 30), 3, cv2.LINE_AA)
    page *= 1 - shade * np.linspace(0, 1, 400)[None, :, None]
    page = cv2.GaussianBlur(page, (0, 0), 0.6) + np.random.default_rng(0).normal(0, 2, page.shape)
    return np.clip(page, 0, 255).astype(np.uint8)


def colors_by_place(drawing: Drawing) -> list[np.ndarray]:
    """From left to right."""
    order = np.argsort([region[0][:, 0].mean() for region in drawing.regions])
    assert len(order) == 3
    return list(drawing.region_colors[order].astype(int))


@pytest.mark.parametrize("shade", [0.0, 0.15])
def test_regions_take_the_colour_that_is_painted_there(shade: float) -> None:
    red, white, blue = colors_by_place(vectorize(painted(shade), PAINTED))
    assert tuple(white) == (255, 255, 255)
    for found, color in ((red, RED), (blue, BLUE)):
        assert np.abs(found - 255 * np.array(color) / PAPER).max() < 40
    assert red[0] - red[2] > 50
    assert blue[2] - blue[0] > 50


def test_a_grey_page_and_one_without_regions_have_no_colours() -> None:
    assert vectorize(painted()[..., 1], PAINTED).region_colors is None
    assert vectorize(painted(), Settings(provider="classical")).region_colors is None
    blank = np.full((64, 64, 3), PAPER, np.uint8)
    assert vectorize(blank, PAINTED).region_colors is None


def test_svg_has_the_regions_below_and_reads_back_without_them(tmp_path) -> None:
    drawing = vectorize(painted(), PAINTED)
    drawing.save(tmp_path / "out.svg")
    text = (tmp_path / "out.svg").read_text("utf-8")
    assert text.index('id="regions"') < text.index('id="strokes"')
    fills = [line.split('fill="')[1][:7] for line in text.splitlines() if "data-region" in line]
    assert fills == ["#" + bytes(color.tolist()).hex() for color in drawing.region_colors]
    assert len(Drawing.load(tmp_path / "out.svg").strokes) == len(drawing.strokes)
    plain = vectorize(painted(), Settings(provider="classical", solids=False))
    plain.save(tmp_path / "plain.svg")
    assert "data-region" not in (tmp_path / "plain.svg").read_text("utf-8")


def test_json_keeps_the_colours(tmp_path) -> None:
    drawing = vectorize(painted(), PAINTED)
    drawing.save(tmp_path / "out.json")
    again = Drawing.load(tmp_path / "out.json")
    assert np.array_equal(again.region_colors, drawing.region_colors)
    assert np.array_equal(drawing.accept_above(0.5).region_colors, drawing.region_colors)
