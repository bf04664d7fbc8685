"""However a page lies on the scanner, its drawing is the same."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from involute.engine import Settings, vectorize
from involute.engine.scan.pose import pose_of
from involute.engine.values import Pose

POSES = [Pose(*ways) for ways in np.ndindex(2, 2, 2)]


def page(pen: int = 3) -> np.ndarray:
    """Crossings, near tangents, a curl, a solid; nothing in it is symmetric. RGB on paper."""
    found = np.full((420, 340, 3), 244, np.uint8)
    for k in range(5):
        cv2.line(
            found, (20 + 9 * k, 30 + 50 * k), (300 - 13 * k, 60 + 31 * k), (20, 20, 24), pen, 16
        )
        cv2.line(found, (40 + 55 * k, 20), (70 + 40 * k, 300), (160, 30, 30), pen, 16)
    t = np.linspace(0, 11, 90)
    curl = np.stack([170 + (8 + 9 * t) * np.cos(t), 300 + (5 + 7 * t) * np.sin(t)], 1)
    cv2.polylines(found, [np.round(curl * 16).astype(np.int32)], False, (20, 20, 24), pen, 16, 4)
    cv2.circle(found, (290, 370), 6 + 4 * pen, (20, 20, 24), -1, 16)
    noise = np.random.default_rng(4).normal(0, 4, found.shape)
    return np.clip(found + noise, 0, 255).astype(np.uint8)


def assert_same(found, wanted, pose: Pose, size: tuple[int, int], near: float) -> None:
    """Every stroke and area of one drawing lies in the other, once it is turned back."""
    assert len(found.strokes) == len(wanted.strokes)
    for ours, theirs in zip(found.strokes, wanted.strokes, strict=True):
        back = pose.points_back(ours.points, size)
        np.testing.assert_allclose(back, theirs.points, atol=near)
        np.testing.assert_allclose(ours.widths, theirs.widths, rtol=1e-3)
        assert ours.color == theirs.color
    assert len(found.fills) == len(wanted.fills)
    for area, other in zip(found.fills, wanted.fills, strict=True):
        np.testing.assert_allclose(pose.points_back(area[0], size), other[0], atol=near)
    assert [j.pairs for j in found.junctions] == [j.pairs for j in wanted.junctions]


@pytest.mark.parametrize("pose", POSES[1:], ids=str)
@pytest.mark.parametrize("pen", [3, 13])  # the second is worked on smaller than it is
def test_a_turned_page_gives_the_same_drawing(pen, pose):
    picture = page(pen)
    size = picture.shape[1], picture.shape[0]
    wanted = vectorize(picture)
    assert wanted.junctions
    assert (wanted.scale > 1) == (pen == 13)
    found = vectorize(pose.turned(picture))
    assert found.size == (size[::-1] if pose.transposed else size)
    assert_same(found, wanted, pose, size, 0.01)
    assert found.fidelity.lost == pytest.approx(wanted.fidelity.lost, abs=0.01)


@pytest.mark.parametrize("move", [(1, 1), (2, 5), (0, -7)])
def test_a_drawing_is_the_same_wherever_it_lies_on_its_sheet(move):
    picture = page()
    wanted, found = vectorize(picture), vectorize(np.roll(picture, move, (0, 1)))
    assert len(found.strokes) == len(wanted.strokes)
    for ours, theirs in zip(found.strokes, wanted.strokes, strict=True):
        np.testing.assert_allclose(ours.points - move[::-1], theirs.points, atol=0.05)


def test_a_page_may_be_looked_at_as_it_lies():
    picture = page()
    pose = pose_of(picture)
    upright = pose.turned(picture)
    assert pose_of(upright) == Pose()
    settings = Settings(provider="classical", router="geometric")
    as_it_lies, turned = (vectorize(upright, settings, turn=turn) for turn in (False, True))
    assert_same(as_it_lies, turned, Pose(), upright.shape[1::-1], 0)


def test_noise_does_not_turn_a_page():
    picture = page()
    for seed in range(3):
        noise = np.random.default_rng(seed).normal(0, 3, picture.shape)
        noisy = np.clip(picture + noise, 0, 255).astype(np.uint8)
        assert pose_of(noisy) == pose_of(picture)


def test_light_lines_and_other_values_lie_alike():
    picture = page()
    gray = cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY)
    assert pose_of(255 - picture) == pose_of(picture)
    assert pose_of(gray) == pose_of(gray.astype(np.uint16) * 257) == pose_of(gray / np.float32(255))


@pytest.mark.parametrize("value", [0, 255])
def test_an_empty_page_stays_as_it_lies(value):
    assert pose_of(np.full((40, 60), value, np.uint8)) == Pose()


@given(st.sampled_from(POSES), st.integers(1, 9), st.integers(1, 9), st.data())
def test_what_is_turned_comes_back(pose, height, width, data):
    picture = np.arange(height * width).reshape(height, width)
    turned = pose.turned(picture)
    np.testing.assert_array_equal(pose.back(turned), picture)
    row = data.draw(st.integers(0, turned.shape[0] - 1))
    column = data.draw(st.integers(0, turned.shape[1] - 1))
    middle = np.array([[column + 0.5, row + 0.5]])
    x, y = pose.points_back(middle, (width, height))[0]
    assert picture[int(y), int(x)] == turned[row, column]


@pytest.mark.parametrize("pose", POSES)
def test_a_frame_along_the_edge_of_the_page_is_one_closed_line(pose):
    """The network must not see where the page ends, on whichever side that is."""
    found = np.full((400, 300), 240, np.uint8)
    cv2.rectangle(found, (1, 1), (297, 397), 30, 4)
    cv2.circle(found, (150, 180), 60, 30, 4, cv2.LINE_AA)
    drawing = vectorize(pose.turned(found), Settings(), turn=False)
    width, height = drawing.size
    frames = [s for s in drawing.strokes if np.ptp(s.points, axis=0).min() > 250]
    assert len(drawing.strokes) == 2
    assert len(frames) == 1
    assert frames[0].closed
    rim = np.min([frames[0].points, np.array([width, height]) - frames[0].points], axis=0).min(1)
    assert rim.max() < 8  # a corner is rounded
    assert np.median(rim) < 3
