"""New kinds of pages: what is ink has a target, what only looks like it has none."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

pytest.importorskip("torch", reason="training needs torch")

from involute.synthesis import extra_marks, held_out_pages, pencilling, tone_dots
from involute.synthesis.line_art import Library, _spline
from involute.synthesis.media import DIGITAL, MEDIA, NUDGE, draw, nearest
from involute.synthesis.media import sample as samples_of
from involute.synthesis.pen_lifts import Habit
from involute.training.centerline import training_page
from involute.training.centerline.lines_together import UNKNOWN, doubled
from involute.training.centerline.pen_ends import lit_ends
from involute.training.centerline.targets import ridge, targets
from involute.training.centerline.training_page import CHANNELS, KINDS, Layer, page

CHANNEL = {name: number for number, name in enumerate(CHANNELS)}


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> Library:
    """Sixty drawings of a few smooth strokes."""
    rng = np.random.default_rng(4)
    drawings = [[_spline(rng, 900) for _ in range(rng.integers(2, 6))] for _ in range(60)]
    strokes = [stroke for drawing in drawings for stroke in drawing]
    folder: Path = tmp_path_factory.mktemp("drawings")
    np.savez(
        folder / "openclipart.npz",
        points=np.clip(np.concatenate(strokes) * 32, 0, 65535).astype(np.uint16),
        scale=1 / 32,
        stroke_offsets=np.cumsum([0] + [len(s) for s in strokes]),
        drawing_offsets=np.cumsum([0] + [len(d) for d in drawings]),
    )
    return Library.load(folder)


def line(x0: float, y0: float, x1: float, y1: float) -> np.ndarray:
    return np.linspace((x0, y0), (x1, y1), 40).astype(np.float32)


@pytest.mark.parametrize("kind", list(KINDS))
def test_every_kind_repeats_and_draws_where_its_target_says(library: Library, kind: str) -> None:
    pages = [page(np.random.default_rng((k, 1)), library, 160, kind=kind) for k in range(8)]
    again = page(np.random.default_rng((0, 1)), library, 160, kind=kind)
    np.testing.assert_array_equal(pages[0], again)
    ink = np.concatenate([p[0].ravel() for p in pages]).astype(float)
    ridges = np.concatenate([p[CHANNEL["centerline"]].ravel() for p in pages])
    assert (ridges > 200).any()
    assert ink[ridges > 200].mean() > 2 * ink[ridges == 0].mean()


@pytest.mark.parametrize("width", [1.0, 2.0, 3.0, 4.0])
@pytest.mark.parametrize("ends", [(5, 20, 90, 20), (20.5, 5, 20.5, 90), (5, 8, 90, 71.3)])
def test_lines_of_one_bit_have_no_grey_and_no_gap(width: float, ends: tuple[float, ...]) -> None:
    samples = samples_of([line(*ends) + NUDGE], 96)
    ink, half = draw(np.random.default_rng(0), samples, DIGITAL["one bit"], width, 96)
    assert set(np.unique(ink)) == {0.0, 1.0}
    assert half == pytest.approx(max(width / 2, 0.505))
    count, _ = cv2.connectedComponents(ink.astype(np.uint8), connectivity=8)
    assert count == 2
    length = np.hypot(ends[2] - ends[0], ends[3] - ends[1])
    assert ink.sum() == pytest.approx(length * width, rel=0.35)


def test_printed_rules_are_lines(library: Library) -> None:
    rng = np.random.default_rng(3)
    layer = training_page._printed(rng, 192)
    maps, means, _ = training_page._targets([layer], layer.ink)
    assert (maps.centerline > 0.6).sum() > 192
    np.testing.assert_array_equal(means, maps.centerline)


def test_rules_taken_out_of_the_page_leave_nothing_where_they_cross_the_drawing() -> None:
    size, layers = 192, []
    for stroke, pen in ((line(10, 10, 180, 170), 4.0), (line(-5, 96, 197, 96), 1.5)):
        drawn = samples_of([stroke], size)
        ink, half = draw(np.random.default_rng(1), drawn, DIGITAL["crisp"], pen, size)
        layers.append(Layer(drawn, half, ink))
    maps, _, _ = training_page._targets(layers, layers[0].ink)
    np.testing.assert_array_equal(maps.centerline, ridge(layers[0].samples, size))


def test_screentone_has_no_target_and_lines_through_it_keep_theirs() -> None:
    dots = tone_dots.screentone(np.random.default_rng(1), 192, hard=True)
    assert dots.any()
    samples = samples_of([line(10, 96, 180, 96)], 192)
    ink, half = draw(np.random.default_rng(0), samples, DIGITAL["one bit"], 3.0, 192)
    alone, _, _ = training_page._targets([Layer(samples, half, ink)], np.maximum(ink, dots))
    np.testing.assert_array_equal(alone.centerline, ridge(samples, 192))


def test_rough_strokes_cover_the_line_and_stay_near_it() -> None:
    rng = np.random.default_rng(2)
    true = line(20, 60, 230, 110)
    hand = pencilling.Hand(4.0, 2.0, 1.0, 80.0, 4.0)
    strokes, press = pencilling.pencilled(rng, [true], hand)
    assert len(strokes) == len(press) > 4
    assert 0 < press.min() <= press.max() <= 1
    points = np.concatenate(strokes)
    along = (points - true[0]) @ (true[-1] - true[0]) / np.hypot(*(true[-1] - true[0])) ** 2
    covered = np.histogram(along, np.linspace(0, 1, 21))[0]
    assert (covered > 0).all()
    normal = np.array([-(true[-1] - true[0])[1], (true[-1] - true[0])[0]])
    away = np.abs((points - true[0]) @ normal / np.hypot(*normal))
    assert np.quantile(away, 0.95) < 4 * hand.spread + 2 * hand.drift


def test_a_sketch_means_its_true_lines_and_construction_means_nothing() -> None:
    size, true = 128, samples_of([line(10, 64, 118, 64)], 128)
    pencil = samples_of([line(10, 62, 80, 63), line(50, 65, 118, 66)], size)
    axis = samples_of([line(64, 5, 64, 120)], size)
    layers = []
    for drawn, means in ((pencil, true), (axis, None)):
        ink, half = draw(np.random.default_rng(1), drawn, MEDIA["technical pen"], 2.0, size)
        layers.append(Layer(drawn, half, ink, means, is_rough=True))
    ink = np.maximum(layers[0].ink, layers[1].ink)
    maps, means, lit = training_page._targets(layers, ink)
    np.testing.assert_array_equal(means, ridge(true, size))
    assert maps.centerline[100, 62:66].max() > 0.8
    assert maps.centerline[61:64, 30].max() > 0.8
    # The ends of a sketch are those of its true lines; construction has none.
    assert lit[63:66, 12].max() > 0.6
    assert lit[63:66, 116].max() > 0.6
    assert lit[60:68, 40:90].max() == lit[:40].max() == lit[90:].max() == 0


@pytest.mark.parametrize(("gap", "pen"), [(2.0, 2.0), (3.0, 4.0), (5.0, 7.0)])
def test_lines_in_one_mass_of_ink_are_doubled(gap: float, pen: float) -> None:
    strokes = [line(5, 40, 123, 40), line(60, 40 + gap, 123, 40 + gap)]
    samples = samples_of(strokes, 128)
    maps = targets(samples, np.full(len(samples), pen / 2), 128)
    assert maps.doubled[40, 90] == 1
    assert maps.apart[40, 90] == pytest.approx(gap, abs=0.1)
    assert maps.doubled[40, 20] == 0


def test_crossings_are_not_doubled_and_coinciding_lines_are_unknown() -> None:
    cross = samples_of([line(5, 40, 123, 40), line(64, 5, 64, 120)], 128)
    assert not doubled(cross, np.full(len(cross), 2.0))[0].any()
    twice = samples_of([line(5, 40, 123, 40), line(5, 40.2, 123, 40.2)], 128)
    state, _ = doubled(twice, np.full(len(twice), 2.0))
    assert np.median(state) == UNKNOWN


def lit_of(*strokes: np.ndarray, half: float = 1.5, inked: np.ndarray | None = None) -> np.ndarray:
    samples = samples_of(list(strokes), 128)
    return lit_ends(samples, np.full(len(samples), half), 128, inked)


def test_of_a_touch_the_stem_is_lit_of_a_crossing_nothing() -> None:
    lit = lit_of(line(0, 40.5, 128, 40.5), line(60.5, 40.5, 60.5, 128), line(90.5, -9, 90.5, 140))
    stem = lit[40:60, 60]
    assert stem[0] > 0.9
    assert (np.diff(stem[1:12]) <= 0).all()
    assert stem[5] == pytest.approx(0.5, abs=0.05)
    assert stem[12:].max() < 0.02
    assert lit[40, 64:].max() < 0.01  # the line that goes on
    assert lit[:, 84:].max() < 0.01  # two that cross, and go off the page


def test_a_corner_is_lit_where_the_pen_was_lifted_on_both_sides() -> None:
    arms = line(20.5, 30.5, 70.5, 30.5), line(70.5, 30.5, 70.5, 100.5)
    lifted, round_it = lit_of(*arms), lit_of(np.concatenate([arms[0], arms[1][1:]]))
    for row, column in ((30, 65), (35, 70)):
        assert lifted[row, column] > 0.4
        assert round_it[row, column] == 0
    assert round_it[30, 20] > 0.8


def test_a_seam_that_meets_is_no_end_one_that_misses_is() -> None:
    corners = np.array([(20, 20), (100, 20), (100, 100), (20, 100), (20, 20)], np.float32)
    assert not lit_of(corners).any()
    corners[-1] = 20, 26
    assert lit_of(corners)[17:32, 17:32].max() > 0.9


def test_short_strokes_are_lit_whole_and_broad_ones_farther() -> None:
    dash = lit_of(line(50, 64.5, 58, 64.5))
    assert dash[64, 50:58].min() > 0.5
    broad = lit_of(line(10, 64.5, 120, 64.5), half=8.0)
    assert broad[64, 22] > 0.3
    assert broad[64, 40:90].max() == 0


def test_an_end_without_ink_or_off_the_page_is_none() -> None:
    inked = np.ones((128, 128), bool)
    inked[:, :20] = False
    lit = lit_of(line(10, 64.5, 100, 64.5), line(60.5, -3, 60.5, 40), inked=inked)
    assert lit[64, :40].max() == 0
    assert lit[64, 98] > 0.7
    assert lit[:10].max() == 0
    assert lit[39, 60] > 0.8


def test_hands_that_lift_the_pen_cut_at_corners() -> None:
    box = np.array([(30, 30), (98, 30), (98, 98), (30, 98), (30, 30)], np.float32)
    hand = Habit(corners=1.0, seams=0.0, along=0.3, across=0.3, over=0.0, exact=0.0)
    sides = training_page._by_hand(np.random.default_rng(1), [box], hand, 3.0)
    assert len(sides) == 4
    for side in sides:
        assert 60 < np.hypot(*(side[-1] - side[0])) < 76
    chosen = [training_page._habit(np.random.default_rng(k)) for k in range(200)]
    share = sum(habit is not None for habit in chosen) / len(chosen)
    assert 0.3 < share < 0.5


@pytest.mark.parametrize("first", range(0, 24, 3))
def test_a_short_piece_of_a_broad_line_is_drawn(first: int) -> None:
    """A brush is drawn with few samples, even where only some in its middle are as wide."""
    line = samples_of([np.array([[5.0, 30], [55, 30]])], 60)
    piece = line.take(slice(40 + first, 43 + first))
    distance, owner = nearest(piece, np.full(3, 12.0), 60, 1.0)
    assert (owner >= 0).any()
    assert distance.min() == pytest.approx(-12, abs=1)


def test_what_lies_long_under_a_wide_pen_has_no_target() -> None:
    size = 192
    layers = []
    for stroke, pen in ((line(10, 96, 182, 96), 24.0), (line(10, 98, 182, 98), 2.0)):
        drawn = samples_of([stroke], size)
        ink, half = draw(np.random.default_rng(1), drawn, DIGITAL["crisp"], pen, size)
        layers.append(Layer(drawn, half, ink))
    hidden = training_page._hidden(layers[1], layers)
    assert hidden[60:-60].all()
    across = samples_of([line(96, 10, 96, 182)], size)
    assert not training_page._hidden(
        Layer(across, np.full(len(across), 1.0), layers[1].ink), layers
    ).any()


@pytest.mark.parametrize("kind", [*extra_marks.MARKS, extra_marks.printed])
def test_marks_are_strokes_near_the_page(kind) -> None:
    for seed in range(20):
        strokes, widest = kind(np.random.default_rng(seed), 384)
        assert strokes
        assert widest >= 1
        for stroke in strokes:
            assert stroke.dtype == np.float32
            assert len(stroke) > 1
            assert np.isfinite(stroke).all()


def test_rows_lie_along_pixels_more_often_than_not() -> None:
    exact = 0
    for seed in range(40):
        strokes, _ = extra_marks.rows(np.random.default_rng(seed), 384)
        step = strokes[0][-1] - strokes[0][0]
        exact += bool(np.abs(step).min() < 1e-3 * np.abs(step).max())
    assert exact > 15


@pytest.mark.parametrize("kind", list(held_out_pages._LOOKS))
def test_held_out_pages_show_their_strokes(kind: str) -> None:
    strokes = [line(40, 60, 400, 90), line(60, 300, 380, 40)]
    image, style = held_out_pages._LOOKS[kind](np.random.default_rng(3), strokes, 1, 3.0)
    assert image.shape == (324, 424)
    assert "," in style
    if kind == "one bit":
        assert set(np.unique(image)) == {0, 255}
    places = np.concatenate(strokes).astype(int)
    near = cv2.erode(image, np.ones((9, 9), np.uint8))[places[:, 1], places[:, 0]]
    assert near.mean() < np.median(image) - 20
