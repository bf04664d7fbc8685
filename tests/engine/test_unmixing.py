"""Inks that are not to be traced: gone, and what lies over them whole."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from involute.engine import InvoluteError, Settings
from involute.engine.ink.unmixing import without_inks
from involute.engine.scan import read_scan
from involute.engine.settings import INKS

PAPER = (250, 246, 238)
COLORS = {
    "red": (215, 60, 50),
    "orange": (240, 140, 40),
    "green": (60, 150, 70),
    "blue": (90, 120, 215),
    "purple": (140, 70, 180),
    "pink": (240, 120, 190),
    "gray": (165, 165, 165),
}


def page(*lines, noise=2.0):
    """Lines laid over each other as inks are: (color, x0, y0, x1, y1)."""
    image = np.full((240, 320, 3), PAPER, np.float64)
    for color, *ends in lines:
        mask = np.zeros(image.shape[:2], np.uint8)
        cv2.line(mask, ends[:2], ends[2:], 255, 4, cv2.LINE_AA)
        share = mask[..., None] / 255
        image *= 1 - share + share * np.array(color) / 255
    image += np.random.default_rng(0).normal(0, noise, image.shape)
    return np.clip(image, 0, 255).astype(np.uint8)


BLACK = ((30, 30, 30), 20, 120, 300, 120)


def ink_of(image, *ignored):
    scan = read_scan(image, Settings())
    return without_inks(scan, Settings(ignore_inks=ignored)).ink


@pytest.mark.parametrize("name", COLORS)
def test_an_ignored_ink_goes_and_black_over_it_stays_whole(name):
    image = page((COLORS[name], 60, 20, 60, 220), (COLORS[name], 30, 200, 290, 60), BLACK)
    before, after = ink_of(image), ink_of(image, name)
    assert before[40, 58:63].max() > 0.3
    assert after[20:100, 40:80].max() < 0.15
    assert after[140:220, 20:280].max() < 0.15
    assert after[120, 25:296].min() > 0.6


def test_other_colors_stay():
    image = page((COLORS["red"], 60, 20, 60, 220), (COLORS["blue"], 120, 20, 120, 220), BLACK)
    after = ink_of(image, "blue")
    assert after[30:100, 120].max() < 0.15
    assert after[30:100, 60].min() > 0.3
    assert after[140:210, 60].min() > 0.3


@pytest.mark.parametrize("name", INKS)
def test_a_page_without_that_ink_is_left_alone(name):
    image = page(BLACK, ((30, 30, 30), 60, 20, 60, 220))
    assert (ink_of(image, name) == ink_of(image)).mean() > 0.999
    gray = page(BLACK)[..., 1]
    assert (ink_of(gray, name) == ink_of(gray)).mean() > 0.999


def test_a_drawing_in_pencil_alone_is_not_ignored_away():
    image = page((COLORS["gray"], 20, 120, 300, 120), (COLORS["gray"], 60, 20, 60, 220))
    assert ink_of(image, "gray")[120, 30:290].min() > 0.3


def test_there_is_no_such_ink():
    with pytest.raises(InvoluteError, match="can't be 'mauve'; choose from"):
        Settings(ignore_inks=("mauve",))
