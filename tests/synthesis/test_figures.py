"""Figures: what is behind something is hidden by it."""

from __future__ import annotations

import numpy as np
from involute.synthesis import figures
from involute.synthesis.line_art import resample

LOW, HIGH = 300.0, 600.0
SQUARE = np.array([[LOW, LOW], [HIGH, LOW], [HIGH, HIGH], [LOW, HIGH], [LOW, LOW]])


def covered() -> np.ndarray:
    return figures._covered([SQUARE, np.array([[0.0, 0.0], [900.0, 100.0]])])


def test_a_line_behind_ends_where_it_is_hidden() -> None:
    line = resample(np.array([[100.0, 400.0], [900.0, 450.0]], np.float32), 2.0)
    pieces = figures.outside(line, covered())
    assert len(pieces) == 2
    assert abs(pieces[0][-1, 0] - LOW) < 4
    assert abs(pieces[1][0, 0] - HIGH) < 4
    assert (pieces[0][0] == line[0]).all()
    assert (pieces[1][-1] == line[-1]).all()


def test_a_ring_behind_is_one_line_wherever_it_begins() -> None:
    angle = np.linspace(0, 2 * np.pi, 400)
    for start in (0.0, 1.0, 2.5, 4.0):
        way = np.stack([np.cos(angle + start), np.sin(angle + start)], 1)
        pieces = figures.outside((np.array([HIGH, 450.0]) + 100 * way), covered())
        assert len(pieces) == 1
        assert np.abs(pieces[0][[0, -1], 0] - HIGH).max() < 4


def test_what_is_not_hidden_stays() -> None:
    line = np.array([[0.0, 0.0], [900.0, 100.0]])
    (stays,) = figures.outside(line, covered())
    assert stays is line
