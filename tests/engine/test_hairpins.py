"""Hairpins: both lines run on to the tip, though their ink is one long before it."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from involute.engine import Settings, vectorize

SETTINGS = Settings(router="geometric")


def drawn(lines: list[np.ndarray], pen: int, shape: tuple[int, int]) -> np.ndarray:
    image = np.full(shape, 255, np.uint8)
    for line in lines:
        points = np.round(line * 16).astype(np.int32)
        cv2.polylines(image, [points], False, 0, pen, cv2.LINE_AA, 4)
    return cv2.GaussianBlur(image, (0, 0), 0.6)


@pytest.mark.parametrize("pen", [2, 3, 4])
@pytest.mark.parametrize("degrees", [10, 12, 16, 22])
def test_a_scribble_of_hairpins_is_one_stroke_up_to_its_tips(degrees: int, pen: int) -> None:
    step = 150 * 2 * np.tan(np.radians(degrees) / 2) / np.cos(np.radians(degrees) / 2)
    line = np.stack([30.3 + np.arange(9) * step, np.where(np.arange(9) % 2, 40.0, 190.0)], 1)
    drawing = vectorize(drawn([line], pen, (230, int(line[-1, 0]) + 30)), SETTINGS)
    (stroke,) = drawing.strokes
    for tip in line:
        assert np.hypot(*(stroke.points - tip).T).min() < 6
    away = np.hypot(*np.diff(stroke.points, axis=0).T).sum()
    assert away == pytest.approx(np.hypot(*np.diff(line, axis=0).T).sum(), rel=0.06)


@pytest.mark.parametrize("stem", [16, 30, 60])
def test_a_line_that_forks_keeps_its_stem(stem: int) -> None:
    fork = np.array([200.0, 100.0])
    away = 150 * np.array([[-np.cos(0.1), np.sin(0.1)], [-np.cos(0.1), -np.sin(0.1)]])
    first = np.array([fork + away[0], fork, fork + np.array([stem, 0])])
    drawing = vectorize(drawn([first, np.array([fork + away[1], fork])], 3, (200, 300)), SETTINGS)
    assert len(drawing.strokes) == 2
    assert max(stroke.points[:, 0].max() for stroke in drawing.strokes) > fork[0] + stem - 4
    assert len(drawing.junctions) == 1
