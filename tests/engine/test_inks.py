"""Pencil under ink comes to a colour of its own; one medium, however uneven, never does."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from involute.engine import Drawing, Settings, vectorize

BLACK = (0, 0, 0)
# A figure in ink: a wave, a ring, a corner; and its construction: axes and a box around it.
T = np.linspace(0, 1, 60)
INK = [
    np.stack([60 + 280 * T, 200 + 60 * np.sin(9 * T)], 1),
    np.stack([200 + 50 * np.cos(6.3 * T), 110 + 50 * np.sin(6.3 * T)], 1),
    np.array([[90.0, 320], [200, 290], [320, 340]]),
]
PENCIL = [
    np.array([[40.0, 205], [360, 195]]),
    np.array([[195.0, 30], [205, 370]]),
    np.array([[50.0, 45], [350, 50], [355, 355], [45, 350], [50, 45]]),
    np.array([[60.0, 60], [345, 345]]),
]


def page(*drawn: tuple[list[np.ndarray], float], color: bool = False) -> np.ndarray:
    """Lines, each as dark as it says; lines that cross are as dark as both together."""
    paper = np.full((400, 400), 245.0)
    for lines, darkness in drawn:
        for points in lines:
            share = np.zeros(paper.shape, np.uint8)
            cv2.polylines(share, [np.int32(points * 16)], False, 255, 4, cv2.LINE_AA, 4)
            paper *= 1 - darkness * cv2.GaussianBlur(share / 255, (0, 0), 0.7)
    paper += np.random.default_rng(0).normal(0, 2, paper.shape)
    if color:
        paper = paper[..., None] * [1, 0.985, 0.95]
    return np.clip(paper, 0, 255).astype(np.uint8)


def lengths(drawing: Drawing) -> dict[tuple[int, int, int], float]:
    """Length of line in each colour, px."""
    found: dict[tuple[int, int, int], float] = {}
    for stroke in drawing.strokes:
        points = np.vstack([stroke.points, stroke.points[:1]]) if stroke.closed else stroke.points
        length = float(np.hypot(*np.diff(points, axis=0).T).sum())
        found[stroke.color] = found.get(stroke.color, 0.0) + length
    return found


def length_of(lines: list[np.ndarray]) -> float:
    return sum(float(np.hypot(*np.diff(points, axis=0).T).sum()) for points in lines)


@pytest.mark.parametrize("color", [False, True])
@pytest.mark.parametrize("level", [0.25, 0.45])
def test_pencil_under_ink_is_an_ink_of_its_own(color: bool, level: float) -> None:
    found = lengths(vectorize(page((PENCIL, level), (INK, 0.9), color=color)))
    assert set(found) - {BLACK} == {max(found)}
    gray = max(found)
    assert len(set(gray)) == 1
    assert 110 < gray[0] < 230  # what Blender calls Gray
    assert found[BLACK] == pytest.approx(length_of(INK), rel=0.1)
    assert found[gray] == pytest.approx(length_of(PENCIL), rel=0.1)


def test_all_is_black_without_inks() -> None:
    drawing = vectorize(page((PENCIL, 0.4), (INK, 0.9)), Settings(inks=False))
    assert set(lengths(drawing)) == {BLACK}


def test_pencil_of_uneven_pressure_stays_together() -> None:
    lines = [*INK, *PENCIL]
    pressure = np.random.default_rng(2).permutation(np.linspace(0.25, 0.6, len(lines)))
    drawing = vectorize(page(*(([line], p) for line, p in zip(lines, pressure, strict=True))))
    assert len(lengths(drawing)) == 1


def test_a_little_faint_dirt_beside_ink_is_no_pencil() -> None:
    dirt = [np.array([[30.0, 30], [45, 40]]), np.array([[370.0, 380], [385, 372]])]
    assert len(lengths(vectorize(page((dirt, 0.4), (INK, 0.9))))) == 1


def test_pencil_is_as_opaque_in_its_own_layer_as_ink_is() -> None:
    drawing = vectorize(page((PENCIL, 0.35), (INK, 0.9)))
    for color in lengths(drawing):
        opacity = np.concatenate([s.opacity for s in drawing.strokes if s.color == color])
        assert np.median(opacity) > 0.75


@pytest.mark.parametrize("level", [0.25, 0.45])
def test_ignored_pencil_leaves_the_ink(level: float) -> None:
    both = page((PENCIL, level), (INK, 0.9))
    found = lengths(vectorize(both, Settings(ignore_inks=("gray",))))
    assert set(found) == {BLACK}
    assert found[BLACK] == pytest.approx(length_of(INK), rel=0.1)


def test_a_line_does_not_become_black_where_black_ones_end_on_it() -> None:
    paper = np.full((400, 400, 3), 245.0)
    blue = [np.array([[40.0, 100], [360, 105]]), np.array([[40.0, 300], [360, 290]])]
    black = [np.array([[40.0, y], [360, y + 130]]) for y in (20.0, 45, 205, 230)]  # at 22 degrees
    for lines, color in ((blue, (110, 150, 220)), (black, (30, 30, 35))):
        for points in lines:
            share = np.zeros((400, 400), np.uint8)
            cv2.polylines(share, [np.int32(points * 16)], False, 255, 5, cv2.LINE_AA, 4)
            share = cv2.GaussianBlur(share / 255, (0, 0), 0.7)[..., None]
            paper *= 1 - share + share * np.array(color) / 255
    found = lengths(vectorize(np.clip(paper, 0, 255).astype(np.uint8)))
    assert set(found) - {BLACK} == {max(found)}
    assert found[max(found)] == pytest.approx(length_of(blue), rel=0.1)
    assert found[BLACK] == pytest.approx(length_of(black), rel=0.1)
