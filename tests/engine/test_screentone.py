"""Screentone goes; lines through it, dotted lines, stippling and dots stay."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from involute.engine import Settings
from involute.engine.scan import read_scan
from involute.engine.scan.screentone import without_screentone

SIZE = 300


def page(pitch=0.0, turn=45.0, dot=0.25):
    """A box and a line through it, over a lattice of dots; (SIZE, SIZE) uint8."""
    image = np.full((SIZE, SIZE), 255, np.uint8)
    if pitch:
        a, b = np.mgrid[-200:200:pitch, -200:200:pitch].reshape(2, -1)
        c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
        x, y = 150 + c * a - s * b, 150 + s * a + c * b
        inside = (np.abs(x - 150) < 80) & (np.abs(y - 150) < 80)
        for place in np.stack([x, y], 1)[inside]:
            center = np.int32(np.round(place * 16)).tolist()
            cv2.circle(image, center, max(16, round(16 * dot * pitch)), 0, -1, cv2.LINE_AA, 4)
    cv2.rectangle(image, (60, 60), (240, 240), 0, 3)
    cv2.line(image, (20, 100), (280, 200), 0, 3, cv2.LINE_AA)
    return image


def ink_of(image, **changes):
    settings = Settings(**changes)
    return without_screentone(read_scan(image, settings), settings)


@pytest.mark.parametrize("turn", [0, 15, 45])
@pytest.mark.parametrize("pitch", [6.0, 7.5])
def test_tone_goes_and_lines_stay(pitch, turn):
    scan = ink_of(page(pitch, turn))
    drawn = page() < 128
    near = cv2.dilate(np.uint8(drawn), np.ones((21, 21), np.uint8)) > 0  # dots may touch lines
    left = (scan.ink[~near] > 0.3).sum()
    kept = (ink_of(page(pitch, turn), screentone=False).ink[~near] > 0.3).sum()
    assert left < 0.05 * kept
    assert (scan.ink[drawn] > 0.3).mean() > 0.99
    assert "Screentone" in scan.notes[0]


def _stippled(image):
    rng = np.random.default_rng(0)
    for x, y in rng.uniform(80, 220, (300, 2)).astype(int).tolist():
        cv2.circle(image, (x, y), 1, 0, -1)


def _dotted(image):
    for k in range(8):
        for x in range(20, 280, 6):
            cv2.circle(image, (x, 15 + 6 * (k % 2) + 60 * (k // 2)), 1, 0, -1)


@pytest.mark.parametrize("draw", [_stippled, _dotted], ids=["stippling", "dotted lines"])
def test_dots_that_were_drawn_stay(draw):
    image = page()
    draw(image)
    scan = read_scan(image, Settings())
    assert without_screentone(scan, Settings()) is scan
