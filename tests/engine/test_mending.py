"""The centerline that a network left out, or made up, against the ink."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from involute.engine import Settings, vectorize
from involute.engine.centerline.mending import covered, mended
from involute.engine.values import LineMaps, Scan

SIZE = (160, 200)


def scan_of(*lines, pen=3):
    """A page with straight lines (x0, y0, x1, y1)."""
    image = np.zeros(SIZE, np.uint8)
    for x0, y0, x1, y1 in lines:
        cv2.line(image, (x0, y0), (x1, y1), 255, pen, cv2.LINE_AA)
    return Scan(image.astype(np.float32) / 255, None, 1.0, SIZE[::-1], float(pen))


def maps_of(*lines):
    """What a network would say that sees exactly these lines."""
    crest = scan_of(*lines, pen=2).ink
    return LineMaps(crest, *(np.zeros_like(crest) for _ in range(4)))


ACROSS, DOWN = (20, 80, 180, 80), (100, 20, 100, 140)


def test_a_line_that_was_left_out_is_taken_from_the_ridge_filter():
    maps = mended(maps_of(ACROSS), scan_of(ACROSS, DOWN))
    assert (maps.centerline[25:70, 99:102].max(1) > 0.3).all()
    assert np.isnan(maps.half_width[40, 100])  # nobody has measured it
    np.testing.assert_array_equal(maps.centerline[80, 20:90], maps_of(ACROSS).centerline[80, 20:90])


def test_what_was_seen_well_stays_as_it_is():
    maps = maps_of(ACROSS, DOWN)
    assert mended(maps, scan_of(ACROSS, DOWN)) is maps
    blank = maps_of()
    assert mended(blank, scan_of()) is blank


def test_a_line_over_bare_paper_goes_and_a_bridged_gap_stays():
    bridged = mended(maps_of(ACROSS), scan_of((20, 80, 96, 80), (104, 80, 180, 80)))
    assert bridged.centerline[80, 100] > 0.9
    made_up = mended(maps_of(ACROSS, DOWN), scan_of(ACROSS))
    assert made_up.centerline[25:70].max() == 0
    assert made_up.centerline[80, 20:180].min() > 0.9


def test_a_dot_and_a_dash_that_were_left_out_get_a_crest():
    scan = scan_of((50, 50, 50, 50), (120, 50, 128, 50), pen=4)
    maps = mended(maps_of(), scan)
    assert maps.centerline[50, 50] > 0.9
    assert maps.centerline[50, 120:129].min() > 0.5


@pytest.mark.parametrize("pen", [2, 5, 9])
def test_ink_is_covered_as_far_as_it_is_deep(pen):
    clear = scan_of(ACROSS, pen=pen).ink > 0.5
    crest = np.zeros(SIZE, bool)
    crest[80, 20:181] = True
    assert covered(crest, clear)[clear].all()
    assert not covered(np.roll(crest, 2 * pen + 4, 0), clear)[clear].any()


@pytest.mark.parametrize("step", [8, 12])
def test_crisp_lines_along_the_pixels_are_all_there(step):
    page = np.full((150, 320), 255, np.uint8)
    for x in range(30, 290, step):
        page[20:130, x : x + 2] = 0
    drawing = vectorize(page, Settings(smoothing=0))
    assert len(drawing.strokes) == len(range(30, 290, step))
    assert drawing.fidelity.lost < 0.01
    assert not drawing.warnings


def test_even_crisp_lines_are_whole_where_the_ridge_filter_takes_over():
    """The network sees them faintly here and there: that is no crest to stop beside."""
    fine = np.full((400 * 10, 560 * 10), 255, np.uint8)
    for number in range(30):  # 2.2 px wide, centred on whole pixels
        middle = (100 + 12 * number) * 10
        fine[1000:3000, middle - 11 : middle + 11] = 0
    page = cv2.resize(fine, (560, 400), interpolation=cv2.INTER_AREA)
    drawing = vectorize(page, turn=False)
    assert len(drawing.strokes) == 30
    assert min(np.ptp(stroke.points[:, 1]) for stroke in drawing.strokes) > 195
