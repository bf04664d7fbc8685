"""Centerline network: tiles that can't be seen, and lines found where they are."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from involute.engine.centerline import learned, provider_for, tiles
from involute.engine.centerline.backends import _torch_gpu, load
from involute.engine.errors import Cancelled, InvoluteError
from involute.engine.settings import Settings
from involute.engine.values import Scan

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "hippopotamus.jpg"
BEFORE_SLIMMING = Path(__file__).parent / "data" / "centerline_before_slimming.npz"
SLIMMED = 5e-3  # of a map in [0, 1]; on four held-out pages it was 0.004 at most


def silent(fraction: float) -> None:
    pass


def page_of(*lines: tuple[float, float, float, float], size=(256, 256), width=4) -> np.ndarray:
    """White paper with straight lines, (H, W) ink; ends in px."""
    ink = np.zeros(size, np.uint8)
    for x0, y0, x1, y1 in lines:
        # A pixel's centre lies at + 0.5, where OpenCV counts from the centre of the first pixel.
        ends = [(round((x - 0.5) * 16), round((y - 0.5) * 16)) for x, y in ((x0, y0), (x1, y1))]
        cv2.line(ink, *ends, 255, width, cv2.LINE_AA, 4)
    return ink.astype(np.float32) / 255


def trace(ink: np.ndarray):
    scan = Scan(ink, None, 1.0, ink.shape[::-1], 4.0)
    return learned.provider(Settings(device="cpu"))(scan, silent)


@st.composite
def inked_pages(draw) -> np.ndarray:
    height, width = draw(st.integers(20, 1500)), draw(st.integers(20, 1500))
    ink = np.zeros((height, width), np.float32)
    for _ in range(draw(st.integers(0, 6))):
        y, x = draw(st.integers(0, height - 1)), draw(st.integers(0, width - 1))
        h, w = draw(st.integers(2, 400)), draw(st.integers(2, 400))
        ink[y : y + h, x : x + w] = draw(st.floats(0.3, 1.0))
    return ink


@settings(max_examples=40, deadline=None)
@given(inked_pages())
def test_tiles_cover_all_ink_once_and_leave_no_seam(ink):
    active = tiles.active_blocks(ink)
    plan = tiles.plan(active)
    seen = np.zeros(ink.shape, np.uint8)
    for tile in plan:
        rows, columns = tile.window(active, *ink.shape)
        assert (rows.stop - rows.start) * (columns.stop - columns.start) <= tiles.LARGEST
        seen[tile.top : tile.bottom, tile.left : tile.right] += 1
    assert seen.max(initial=0) <= 1
    assert seen[ink > 0].all()
    # Whatever the network answers on ink, the tiles hand on unchanged.
    answer = np.zeros_like(ink)
    tiles.look(ink, lambda window: window[None], [answer], silent)
    np.testing.assert_allclose(answer, ink, atol=1e-6)


def test_white_paper_costs_nothing():
    asked = []
    blank = np.zeros((3000, 3000), np.float32)
    blank[100:110, 100:300] = 1

    def infer(window):
        asked.append(window.size)
        return window[None]

    tiles.look(blank, infer, [np.zeros_like(blank)], silent)
    assert sum(asked) < 0.03 * blank.size


@pytest.mark.parametrize("shift", [(1, 0), (0, 2), (7, 13)])
def test_a_drawing_is_seen_alike_wherever_it_lies(shift):
    """A network that halves its maps must not see where on its sheet a drawing lies."""
    drawing = page_of((20, 30, 230, 60), (60, 20, 80, 235), (200, 40, 90, 220), size=(256, 256))
    maps = []
    for down, right in ((128, 128), (128 + shift[0], 128 + shift[1])):
        sheet = np.zeros((512, 512), np.float32)
        sheet[down : down + 256, right : right + 256] = drawing
        found = trace(sheet)
        assert found.centerline.max() > 0.9
        seen = [m for m in vars(found).values() if m is not None]
        maps.append([m[down : down + 256, right : right + 256] for m in seen])
    for one, other in zip(*maps, strict=True):
        np.testing.assert_allclose(one, other, atol=1e-4)


def test_progress_rises_and_may_cancel():
    ink = np.zeros((3000, 3000), np.float32)
    ink[300::600] = 1
    fractions: list[float] = []
    tiles.look(ink, lambda window: window[None], [np.zeros_like(ink)], fractions.append)
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1
    assert len(fractions) > 2

    def stop(fraction):
        raise Cancelled

    with pytest.raises(Cancelled):
        tiles.look(ink, lambda window: window[None], [np.zeros_like(ink)], stop)


def test_missing_weights_are_named():
    with pytest.raises(InvoluteError, match=r"lost\.onnx"):
        load(Path("lost.onnx"), "cpu")


def test_broken_weights_are_an_error(tmp_path):
    broken = tmp_path / "broken.onnx"
    broken.write_bytes(b"no network")
    with pytest.raises(InvoluteError, match=r"broken\.onnx"):
        load(broken, "cpu")


@pytest.mark.skipif(_torch_gpu() is not None, reason="there is a GPU")
def test_a_gpu_that_is_not_there_is_an_error():
    with pytest.raises(InvoluteError, match="GPU"):
        load(learned.WEIGHTS, "gpu")


def test_blank_page():
    maps = trace(np.zeros((130, 70), np.float32))
    assert maps.centerline.shape == (130, 70)
    assert not maps.centerline.any()


@pytest.mark.parametrize("width", [2, 4, 7])
def test_crest_and_width_of_a_line(width):
    ink = page_of((20, 60.5, 236, 100.5), size=(160, 256), width=width)
    maps = trace(ink)
    column = maps.centerline[:, 128]
    crest = int(column.argmax())
    before, at, after = column[crest - 1 : crest + 2]
    center = crest + 0.5 + 0.5 * (before - after) / (before + after - 2 * at)
    assert at > 0.6
    assert center == pytest.approx(60.5 + 40 * (128.5 - 20) / 216, abs=0.4)
    slope = 40 / 216
    true_width = ink[:, 128].sum() / np.hypot(1, slope)
    assert 2 * maps.half_width[crest, 128] == pytest.approx(true_width, rel=0.1, abs=0.5)


def test_near_parallels_stay_apart():
    maps = trace(page_of((20, 80, 236, 80), (20, 85, 236, 85), width=2))
    across = maps.centerline[70:96, 128]
    crests = np.flatnonzero((across[1:-1] > across[:-2]) & (across[1:-1] >= across[2:])) + 1
    assert (across[crests] > 0.5).sum() == 2


def test_junction_and_ends_of_a_cross():
    maps = trace(page_of((40.5, 50.5, 210.5, 190.5), (60.5, 200.5, 200.5, 40.5)))
    assert maps.junctions is not None
    assert maps.endpoints is not None
    y, x = np.unravel_index(maps.junctions.argmax(), maps.junctions.shape)
    # Where the two lines meet.
    a, b = np.array([[170, 140.0], [140, -160]])
    t = np.linalg.solve(np.stack([a, -b], 1), np.array([20, 150.0]))[0]
    assert np.hypot(*(np.array([x, y]) + 0.5 - (np.array([40.5, 50.5]) + t * a))) < 2
    for cx, cy in ((40, 50), (210, 190), (60, 200), (200, 40)):
        assert maps.endpoints[cy - 4 : cy + 5, cx - 4 : cx + 5].max() > 0.3


def test_size_of_the_tiles_makes_no_difference(monkeypatch):
    rng = np.random.default_rng(3)
    ends = rng.uniform(10, 690, (14, 4))
    ink = page_of(*ends, size=(700, 700), width=3)
    whole = trace(ink)
    monkeypatch.setattr(tiles, "LARGEST", 320**2)
    assert len(tiles.plan(tiles.active_blocks(ink))) > 4
    tiled = trace(ink)
    for name in ("centerline", "junctions", "endpoints", "solid"):
        np.testing.assert_allclose(getattr(tiled, name), getattr(whole, name), atol=1e-3)


def test_the_lean_network_sees_the_same_line_and_what_it_means():
    ink = np.zeros((160, 224), np.float32)
    cv2.line(ink, (20, 120), (200, 40), 1.0, 3, cv2.LINE_AA)
    found = []
    for name in ("network", "lean"):
        look = provider_for(Settings(provider=name))
        maps = look(Scan(ink, None, 1.0, ink.shape[::-1], 3.0), silent)
        found.append(maps.centerline > 0.5)
    there = cv2.dilate(found[0].astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
    assert there[found[1]].all()
    assert found[1].sum() > 0.9 * found[0].sum()
    assert maps.clean is not None
    assert (maps.clean > 0.5)[found[1]].mean() > 0.9


def test_leaving_out_what_the_network_does_not_use_left_the_maps_as_they_were():
    page = cv2.imread(str(EXAMPLE), cv2.IMREAD_GRAYSCALE)[576:672, 864:992]
    with np.load(BEFORE_SLIMMING) as known:
        expected = known["maps"].astype(np.float32)
    assert (expected.max((1, 2)) > (0.9, 0.8, 0.8, 0.5, 0.2)).all()
    found = load(learned.WEIGHTS, "cpu")(1 - page.astype(np.float32) / 255)
    np.testing.assert_allclose(found, expected, atol=SLIMMED)
