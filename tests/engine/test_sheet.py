"""The sheet in a photograph, and what lies beyond it."""

from __future__ import annotations

import re

import cv2
import numpy as np
import pytest
from involute.engine import Settings
from involute.engine.scan import read_scan
from involute.engine.scan.sheet import find_sheet

HEIGHT, WIDTH = 600, 480


def photo(corners, cloth=True, seed=0):
    """A sheet with a drawing on cloth, or on a black desk; (H, W, 3) uint8."""
    rng = np.random.default_rng(seed)
    rough = cv2.GaussianBlur(rng.normal(0, 1, (HEIGHT, WIDTH)).astype(np.float32), (0, 0), 4)
    ground = 70 + 25 * rough / rough.std() if cloth else np.full((HEIGHT, WIDTH), 20.0)
    image = np.repeat(ground[..., None], 3, 2) * (1.0, 0.9, 0.8)
    sheet = np.zeros((HEIGHT, WIDTH), np.uint8)
    cv2.fillPoly(sheet, [np.int32(corners)], 1)
    image[sheet > 0] = (225, 220, 210)
    image = np.clip(image, 0, 255).astype(np.uint8)
    cv2.circle(image, (240, 260), 90, (30, 30, 30), 4, cv2.LINE_AA)
    cv2.line(image, (150, 400), (330, 380), (30, 30, 30), 4, cv2.LINE_AA)
    return image, sheet > 0


SHEETS = {
    "strip below": [(-1, -1), (WIDTH, -1), (WIDTH, 480), (-1, 486)],
    "askew": [(40, 50), (440, 30), (455, 545), (60, 560)],
    "from one side": [(90, -1), (WIDTH, -1), (WIDTH, HEIGHT), (60, HEIGHT)],
}


@pytest.mark.parametrize("name", SHEETS)
def test_nothing_beyond_the_sheet_is_ink_and_all_on_it_is(name):
    image, sheet = photo(SHEETS[name])
    scan = read_scan(image, Settings())
    ink = cv2.resize(scan.ink, (WIDTH, HEIGHT), interpolation=cv2.INTER_LINEAR)
    assert ink[~sheet].max() < 0.2
    assert ink[262, 150] > 0.5
    edge = cv2.morphologyEx(np.uint8(sheet), cv2.MORPH_GRADIENT, np.ones((9, 9), np.uint8)) > 0
    assert (ink[edge] > 0.3).mean() < 0.01
    (note,) = scan.notes
    told = int(re.search(r"(\d+)%", note)[1])
    assert told == pytest.approx(100 * (1 - sheet.mean()), abs=1.5)
    kept = read_scan(image, Settings(sheet=False)).ink
    assert (kept > 0.3).sum() > 2 * (scan.ink > 0.3).sum()


def test_a_black_desk_around_the_sheet_goes_too():
    image, sheet = photo(SHEETS["askew"], cloth=False)
    assert read_scan(image, Settings()).ink[~sheet].max() < 0.2


@pytest.mark.parametrize(
    "draw",
    [
        lambda image: cv2.rectangle(image, (0, 400), (WIDTH, HEIGHT), (25, 25, 25), -1),
        lambda image: cv2.rectangle(image, (0, 0), (WIDTH - 1, HEIGHT - 1), (25, 25, 25), 9),
        lambda image: cv2.rectangle(image, (120, 120), (300, 300), (25, 25, 25), -1),
        lambda image: image,
    ],
    ids=["black ground", "frame", "black square", "nothing"],
)
def test_a_drawn_page_has_nothing_beyond(draw):
    image = np.full((HEIGHT, WIDTH, 3), (240, 238, 230), np.uint8)
    cv2.circle(image, (240, 260), 90, (30, 30, 30), 4, cv2.LINE_AA)
    draw(image)
    assert find_sheet(image) is None
