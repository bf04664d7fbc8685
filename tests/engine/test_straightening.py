"""The perspective of a photographed sheet is taken out, when its corners are sure."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from involute.engine import Settings
from involute.engine.scan import read_scan
from involute.engine.scan.sheet import find_sheet
from involute.engine.scan.straightening import corners_of, straightened

ON = Settings(straighten=True)


def photo(
    turn: tuple[float, float, float], sheet: tuple[float, float] = (210, 297), size=(900, 1100)
) -> tuple[np.ndarray, np.ndarray]:
    """A sheet (mm) with a circle and a square on cloth, as a lens sees it; and its corners, px."""
    fine = 4  # px per mm
    page = np.full((round(sheet[1] * fine), round(sheet[0] * fine), 3), (212, 220, 226), np.uint8)
    middle = np.array(page.shape[1::-1]) // 2
    cv2.circle(page, tuple(map(int, middle)), 250, (40, 30, 30), 8, cv2.LINE_AA)
    low, high = middle - 320, middle + 320
    cv2.rectangle(page, tuple(map(int, low)), tuple(map(int, high)), (40, 30, 30), 8, cv2.LINE_AA)
    way, _ = cv2.Rodrigues(np.radians(turn))
    focal, width, height = 1.1 * max(size), *size
    box = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]) * [*sheet, 0] / 2
    placed = box @ way.T + [0, 0, 390]
    corners = placed[:, :2] / placed[:, 2:] * focal + np.array(size) / 2
    h, w = page.shape[:2]
    flat = np.float32([(0, 0), (w, 0), (w, h), (0, h)]) - 0.5
    view = cv2.getPerspectiveTransform(flat, corners.astype(np.float32) - np.float32(0.5))
    rng = np.random.default_rng(1)
    rough = cv2.GaussianBlur(rng.normal(0, 1, (height, width)).astype(np.float32), (0, 0), 4)
    cloth = np.clip(70 + 25 * rough / rough.std(), 0, 255)[..., None] * (1.0, 0.9, 0.8)
    seen = cv2.warpPerspective(page, view, size, flags=cv2.INTER_AREA)
    there = cv2.warpPerspective(np.ones((h, w), np.uint8), view, size)
    return np.where(there[..., None] > 0, seen, cloth).astype(np.uint8), corners


@pytest.mark.parametrize("turn", [(25, 0, 0), (-14, 14, 3), (10, -20, -8), (0, 0, 6)])
@pytest.mark.parametrize("sheet", [(210, 297), (180, 180)])
def test_a_circle_is_round_again_and_a_square_is_square(turn, sheet):
    image, _ = photo(turn, sheet)
    scan = read_scan(image, ON)
    assert scan.size == (image.shape[1], image.shape[0])
    assert any("was straightened" in note for note in scan.notes)
    assert any("left out" in note for note in scan.notes)
    ink = (scan.as_it_lay().ink > 0.4).astype(np.uint8)
    _, label, stats, _ = cv2.connectedComponentsWithStats(ink)
    largest = 1 + np.argsort(-stats[1:, cv2.CC_STAT_WIDTH])[:2]  # the square, the circle in it
    for piece in largest:
        assert stats[piece, 2] / stats[piece, 3] == pytest.approx(1, abs=0.015)
    _, y, _, high = stats[largest[0], :4]
    row = (label == largest[0]).argmax(1)[y + high // 4 : y + 3 * high // 4]
    assert np.ptp(row) <= 3  # upright
    assert len(stats) == 3  # and nothing else


def test_the_corners_are_found_to_a_pixel_or_two():
    for turn in [(25, 0, 0), (-14, 14, 3), (10, -20, -8)]:
        image, corners = photo(turn)
        found = corners_of(find_sheet(image), image)
        assert np.abs(found - corners).max() < 3.0


def test_without_being_asked_the_drawing_lies_on_the_photo():
    image, _ = photo((25, 0, 0))
    plain = read_scan(image, Settings())
    assert not any("straightened" in note for note in plain.notes)
    assert (plain.ink > 0.3).sum() > 3000


def test_what_is_not_sure_stays_as_it_is():
    image, corners = photo((25, 0, 0))
    cut = np.ascontiguousarray(image[:, : int(corners[:, 0].max()) - 120])  # two corners are off
    seen, plain = read_scan(cut, ON), read_scan(cut, Settings())
    assert np.array_equal(seen.ink, plain.ink)
    assert any("not sure" in note for note in seen.notes)
    bent = image.copy()  # a dog-ear as large as a hand
    ear = np.array([corners[0], corners[0] + (160, 0), corners[0] + (0, 160)])
    cv2.fillPoly(bent, [np.int32(ear)], (60, 55, 50))
    sheet = find_sheet(bent)
    assert sheet is None or corners_of(sheet, bent) is None


def test_a_sheet_seen_from_above_stays():
    image, _ = photo((0, 0, 0))
    sheet = find_sheet(image)
    found = corners_of(sheet, image)
    flat, _ = straightened(image, sheet, found)
    inside = np.s_[250:850, 250:650]
    assert np.abs(flat[inside].astype(int) - image[inside]).mean() < 6
