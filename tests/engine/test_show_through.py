"""What shows through from the back of a sheet goes; pencil under ink stays."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from involute.engine import Settings, vectorize
from involute.engine.scan import read_scan
from involute.engine.scan.show_through import without_show_through

SIZE = 500


def front() -> np.ndarray:
    """(H, W) ink of three pen lines."""
    ink = np.zeros((SIZE, SIZE), np.uint8)
    cv2.circle(ink, (250, 240), 150, 255, 4, cv2.LINE_AA)
    cv2.line(ink, (40, 60), (460, 400), 255, 4, cv2.LINE_AA)
    cv2.line(ink, (60, 440), (440, 90), 255, 4, cv2.LINE_AA)
    return ink / 255


def behind() -> np.ndarray:
    """(H, W) ink of five lines of writing."""
    ink = np.zeros((SIZE, SIZE), np.uint8)
    for row in range(5):
        place = (30, 90 + 80 * row)
        cv2.putText(ink, "Dear Sir, as I", place, cv2.FONT_HERSHEY_SCRIPT_SIMPLEX, 1.8, 255, 3)
    return ink / 255


def scanned(drawn: np.ndarray, other: np.ndarray) -> np.ndarray:
    page = 240 - 215 * (1 - (1 - drawn) * (1 - other))
    page = cv2.GaussianBlur(page, (0, 0), 0.7)
    grain = np.random.default_rng(3).normal(0, 1.5, page.shape)
    return np.clip(page + grain, 0, 255).astype(np.uint8)


def shining(soft: float, tone: float) -> np.ndarray:
    """A sheet with writing on its back, which is seen mirrored."""
    back = cv2.GaussianBlur(behind()[:, ::-1], (0, 0), soft)
    return scanned(front(), tone * back / back.max())


@pytest.mark.parametrize(("soft", "tone"), [(2.5, 0.4), (3.0, 0.4), (3.5, 0.35)])
def test_the_back_goes_and_the_front_stays(soft, tone):
    drawing = vectorize(shining(soft, tone))
    assert len(drawing.strokes) == 3
    assert any("shows through from the back" in note for note in drawing.notes)
    assert drawing.fidelity.lost < 0.01
    assert drawing.fidelity.invented < 0.005


def test_it_is_traced_by_whoever_wants_it():
    page = shining(2.5, 0.4)
    settings = Settings(show_through=False)
    scan = read_scan(page, settings)
    assert without_show_through(scan, settings) is scan
    assert len(vectorize(page, settings).strokes) > 12


def test_pencil_under_ink_is_no_back():
    scan = read_scan(scanned(front(), 0.4 * behind()), Settings())
    assert without_show_through(scan, Settings()) is scan


@pytest.mark.parametrize("drawn", [front(), 0.4 * front(), cv2.GaussianBlur(front(), (0, 0), 2.0)])
def test_a_page_of_one_strength_has_no_back(drawn):
    scan = read_scan(scanned(drawn, np.zeros_like(drawn)), Settings())
    assert without_show_through(scan, Settings()) is scan
