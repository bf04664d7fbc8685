"""Printed rules and grids leave a page; what is drawn stays."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from involute.engine import Settings
from involute.engine.pipeline import vectorize
from involute.engine.scan import read_scan, ruling
from involute.engine.scan.paper import flatten_paper
from involute.engine.scan.ruling import without_rules

SIZE = 640


def sheet(pitch: float, turn: float, tone: float, grid: bool) -> np.ndarray:
    """Darkness of rules about 2 px wide, turned by some radians; float32."""
    y, x = np.mgrid[:SIZE, :SIZE].astype(np.float32) + 0.5
    ways = [y - turn * x, x + turn * y][: 1 + grid]
    away = [np.abs((way % pitch) - pitch / 2) for way in ways]
    return (tone * np.clip(1.5 - np.min(away, 0), 0, 1)).astype(np.float32)


def drawing() -> np.ndarray:
    """Darkness of a circle and a slanted line."""
    ink = np.zeros((SIZE, SIZE), np.uint8)
    cv2.circle(ink, (300, 320), 170, 255, 3, cv2.LINE_AA)
    cv2.line(ink, (60, 70), (560, 590), 255, 3, cv2.LINE_AA)
    return ink.astype(np.float32) / 255


def together(*layers: np.ndarray) -> np.ndarray:
    return 1 - np.prod([1 - layer for layer in layers], 0, dtype=np.float32)


@pytest.mark.parametrize("grid", [False, True])
@pytest.mark.parametrize("turn", [0.0, 0.013, -0.04])
@pytest.mark.parametrize("pitch", [11.0, 29.3, 80.0])
def test_rules_go_and_ink_stays(pitch, turn, grid):
    ink = drawing()
    left = without_rules(together(0.9 * ink, sheet(pitch, turn, 0.3, grid)))
    assert left[ink == 0].mean() < 0.004
    assert left[ink == 1].min() > 0.6


def test_a_pencil_line_as_pale_as_the_rules_stays():
    ink = drawing()
    left = without_rules(together(0.3 * ink, sheet(29.0, 0.01, 0.3, grid=False)))
    assert np.median(left[ink == 1]) > 0.25
    assert left[ink == 0].mean() < 0.004


def test_a_rule_hidden_by_the_drawing_goes_too():
    ink = drawing()
    for x in range(20, 420, 8):  # a fence over one of the rules
        ink[280:320, x : x + 3] = 1
    page = together(0.9 * ink, sheet(40.0, 0.0, 0.3, grid=False))
    assert without_rules(page)[280:320, 480:][ink[280:320, 480:] == 0].max() < 0.1


@pytest.mark.parametrize("between", [13.0, 17.0, 21.0])
def test_the_rules_of_the_back_that_show_through_go_too(between):
    ink = drawing()
    back = np.roll(sheet(42.0, 0.0, 0.12, grid=False), round(between), 0)
    page = together(0.9 * ink, sheet(42.0, 0.0, 0.35, grid=False), back)
    left = without_rules(page)
    assert left[ink == 0].mean() < 0.006
    assert left[ink == 1].min() > 0.6


def test_rules_can_be_kept_and_are_told():
    page = 1 - together(0.9 * drawing(), sheet(40.0, 0.0, 0.3, grid=False))
    scan = read_scan(page, Settings())
    assert scan.notes == ("Printed rules were left out.",)
    kept = read_scan(page, Settings(rules=False))
    assert not kept.notes
    assert (kept.ink > 0.2).sum() > 2 * (scan.ink > 0.2).sum()


def test_a_bare_ruled_sheet_is_bare():
    gray = 0.9 - 0.9 * sheet(40.0, 0.01, 0.25, grid=True)
    assert flatten_paper(gray).mean() < 0.002
    assert not vectorize(gray).strokes


@pytest.mark.parametrize("count", [2, 4])
def test_a_few_long_lines_are_a_drawing(count):
    page = 0.3 * drawing()
    for k in range(count):
        page[100 + 120 * k : 102 + 120 * k] = 0.3
    assert without_rules(page) is page


def test_uneven_dark_and_short_lines_are_a_drawing():
    rows = np.cumsum([60, 40, 75, 35, 90, 50, 120, 45])
    uneven, dark, short = np.zeros((3, SIZE, SIZE), np.float32)
    uneven[rows] = uneven[rows + 1] = 0.3
    dark[30::40] = dark[31::40] = 0.9  # as dark as ink: somebody has drawn a grid
    short[30::40, 150:400] = 0.3
    for page in (uneven, dark, short):
        assert without_rules(page) is page


def test_hatching_is_a_drawing():
    page = np.zeros((SIZE, SIZE), np.float32)
    page[40:240:10, 20:620] = 0.5  # even and long, but on a third of the page
    assert without_rules(together(page, drawing())).sum() >= page.sum()


def test_lines_that_cross_each_other_are_no_rules():
    """Two lines with one place: the distance between them is no pitch."""
    at = np.array([10, 14, 31, 60, 71, 99, 140, 171], float)
    stray = np.zeros((len(at), 5), np.float32)
    stray[0], stray[1] = 2, -2
    assert ruling._families(ruling._Lines(at, stray, np.ones(len(at)), 0.0), 200) == []
