"""Frames of a sequence: what has not changed is not looked at again, and drawn as it was."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from involute.engine import Settings, vectorize
from involute.engine.centerline import learned, tiles
from involute.engine.centerline.frame_before import FrameBefore
from involute.engine.drawing import Drawing
from involute.engine.scan import read_scan

pytestmark = pytest.mark.skipif(not learned.available(), reason="needs the centerline network")
NEAR = 0.1  # px
NEAR_MAPS = 0.01
SIDE = 576


def frame(move: int, grain: int = 1) -> np.ndarray:
    """(SIDE, SIDE) uint8: a held wheel, and an arm that turns in the lower right corner."""
    page = np.full((SIDE, SIDE), 250, np.uint8)
    for k in range(6):
        spoke = (int(130 + 90 * np.cos(k)), int(130 + 90 * np.sin(k)))
        cv2.line(page, (130, 130), spoke, 20, 3, cv2.LINE_AA)
    cv2.circle(page, (130, 130), 90, 20, 3, cv2.LINE_AA)
    cv2.line(page, (60, 300), (300, 60), 20, 3, cv2.LINE_AA)
    cv2.line(page, (440, 440), (520, 430 + move), 20, 3, cv2.LINE_AA)
    cv2.circle(page, (440, 440), 30, 20, 3, cv2.LINE_AA)
    noise = np.random.default_rng(grain).normal(0, 2, page.shape)
    return np.clip(page + noise, 0, 255).astype(np.uint8)


def _lines(drawing: Drawing) -> np.ndarray:
    return np.concatenate([stroke.points for stroke in drawing.strokes])


def _apart(a: Drawing, b: Drawing) -> float:
    """How far any point of a drawing is from the lines of another, px."""
    lines = [s.points for s in b.strokes]
    starts, ends = (np.concatenate([p[part] for p in lines])
                    for part in (slice(None, -1), slice(1, None)))  # fmt: skip
    way = ends - starts
    points = _lines(a)[:, None]
    along = ((points - starts) * way).sum(2) / np.maximum((way**2).sum(1), 1e-9)
    near = starts + np.clip(along, 0, 1)[..., None] * way
    return float(np.hypot(*(points - near).transpose(2, 0, 1)).min(1).max())


@pytest.fixture
def looked(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The pixels of every window that a network looks at, as they come."""
    areas: list[int] = []
    window = tiles.Tile.window

    def note(tile: tiles.Tile, *of: object) -> tuple[slice, slice]:
        rows, columns = window(tile, *of)
        areas.append((rows.stop - rows.start) * (columns.stop - columns.start))
        return rows, columns

    monkeypatch.setattr(tiles.Tile, "window", note)
    return areas


def test_only_what_changed_is_looked_at(looked: list[int]) -> None:
    before = FrameBefore()
    vectorize(frame(0), turn=False, before=before)
    whole = sum(looked)
    looked.clear()
    vectorize(frame(8), turn=False, before=before)
    assert 0 < sum(looked) < 0.5 * whole
    looked.clear()
    vectorize(frame(8), turn=False, before=before)
    assert not looked


def test_a_frame_is_drawn_as_it_is_alone() -> None:
    before = FrameBefore()
    for move in (0, 8, 16):
        drawing = vectorize(frame(move), turn=False, before=before)
        alone = vectorize(frame(move), turn=False)
        assert len(drawing.strokes) == len(alone.strokes)
        assert max(_apart(drawing, alone), _apart(alone, drawing)) < NEAR


def test_the_maps_are_those_of_the_whole_frame() -> None:
    before, settings = FrameBefore(), Settings()
    first, second = (read_scan(frame(move), settings) for move in (0, 8))
    before.look(first, settings, lambda _: None)
    maps = before.look(second, settings, lambda _: None)
    whole = learned.at(settings)(second.ink, lambda _: None, tiles.shift_of(first.ink), None)
    assert 0 < before.looked_at < 0.5
    assert np.abs(maps.centerline - whole.centerline).max() < NEAR_MAPS


@pytest.mark.parametrize("other", [frame(0, grain=2)[:, ::-1].copy(), frame(0)[: SIDE - 40]])
def test_another_page_is_looked_at_whole(other: np.ndarray) -> None:
    before = FrameBefore()
    vectorize(frame(0), turn=False, before=before)
    drawing = vectorize(other, turn=False, before=before)
    alone = vectorize(other, turn=False)
    assert before.looked_at == 1.0
    np.testing.assert_array_equal(_lines(drawing), _lines(alone))
