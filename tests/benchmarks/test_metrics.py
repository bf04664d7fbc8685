"""The benchmark's figures on drawings small enough to count by hand."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from benchmarks.metrics import Strokes, crossings, evaluate, read_svg, recovered, scaled, summarize
from benchmarks.offset import shift

BAR = np.array([[100.0, 200.0], [300.0, 200.0]])
POST = np.array([[200.0, 100.0], [200.0, 300.0]])
CROSS = [BAR, POST]
LEFT, RIGHT = np.array([[100.0, 200.0], [200, 200]]), np.array([[200.0, 200], [300, 200]])
UPPER, LOWER = np.array([[200.0, 100.0], [200, 200]]), np.array([[200.0, 200], [200, 300]])


def circle(x: float, y: float, radius: float) -> np.ndarray:
    angle = np.linspace(0, 2 * np.pi, 200)
    return np.stack([x + radius * np.cos(angle), y + radius * np.sin(angle)], -1)


def test_lines_far_off_the_page_are_refused():
    for far in (1e7, -1e38):
        with pytest.raises(ValueError, match="far off the page"):
            scaled([np.array([[0, 0], [far, 5]])], (100, 100))


def test_a_line_counts_as_found_as_near_to_it_as_asked():
    beside, true = Strokes([BAR + np.array([0, 5]), POST]), Strokes(CROSS)
    assert recovered(beside, true) == 1
    assert recovered(beside, true, within=6.0) == 2
    half = Strokes([LEFT, POST])
    assert recovered(half, true, cover=0.4) == 2
    assert recovered(half, true) == 1


def test_the_truth_itself_is_perfect():
    score = evaluate(CROSS, CROSS)
    assert score.chamfer == 0
    assert score.length_diff == 0
    assert score.density == 1
    assert score.f1 == 1
    assert (score.true_crossings, score.crossings_found) == (1, (1, 1, 1))
    assert (score.true_branching, score.branching_matched) == (1, 1)
    assert (score.continuations, score.continuations_kept) == (2, 2)
    assert (score.wrong_joins, score.wrong_joins_made) == (4, 0)


def test_a_crossing_cut_into_its_arms():
    score = evaluate([LEFT, RIGHT, UPPER, LOWER], CROSS)
    assert score.crossings_found == (1, 1, 1)
    assert score.density == 2
    assert score.f1 == 0
    assert score.continuations_kept == 0
    assert score.wrong_joins_made == 0


def test_a_crossing_joined_the_wrong_way():
    corners = [np.vstack([LEFT, LOWER[1:]]), np.vstack([UPPER, RIGHT[1:]])]
    score = evaluate(corners, CROSS)
    assert score.density == 1
    assert score.continuations_kept == 0
    assert score.wrong_joins_made == 2


def test_one_stroke_of_two_recovered():
    score = evaluate([BAR, UPPER, LOWER], CROSS)
    assert score.recovered == 1
    assert score.f1 == pytest.approx(2 / 5)
    assert score.continuations_kept == 1


def test_a_stem_on_a_bar():
    score = evaluate([BAR, UPPER], [BAR, UPPER])
    assert (score.true_crossings, score.true_branching) == (1, 1)
    assert (score.continuations, score.wrong_joins) == (1, 2)
    bent = [LEFT, np.vstack([UPPER, RIGHT[1:]])]
    assert evaluate(bent, [BAR, UPPER]).wrong_joins_made == 1


def test_a_corner_of_two_strokes_is_a_crossing_without_branches():
    score = evaluate([LEFT, UPPER], [LEFT, UPPER])
    assert (score.true_crossings, score.true_branching) == (1, 0)
    assert score.continuations == score.wrong_joins == 0


@pytest.mark.parametrize(("gap", "count"), [(0.0, 1), (1.4, 1), (1.6, 0)])
def test_an_end_touches_within_one_and_a_half_pixels(gap, count):
    assert len(crossings(Strokes([BAR, UPPER - (0, gap)]))) == count


@pytest.mark.parametrize(("shift", "found"), [(1.0, (1, 1, 1)), (2.0, (0, 1, 1)), (4.0, (0, 0, 1))])
def test_a_shifted_drawing(shift, found):
    score = evaluate([line + np.array([shift, 0]) for line in CROSS], CROSS)
    assert score.crossings_found == found
    # The post is off by the shift; the bar only at its ends and, at the crossing, by nothing.
    assert shift / 2 - 0.1 <= score.chamfer <= shift / 2 + 0.1


def test_closed_strokes():
    assert len(crossings(Strokes([circle(200, 200, 50)]))) == 0
    turn = np.linspace(1, 1 + 2 * np.pi, 200)
    eight = np.stack([200 + 80 * np.sin(turn), 200 + 40 * np.sin(2 * turn)], -1)
    np.testing.assert_allclose(crossings(Strokes([eight])), [[200, 200]], atol=0.5)
    # A ring that starts elsewhere is the same ring.
    ring = circle(200, 200, 50)
    turned = np.vstack([ring[60:], ring[1:61]])
    score = evaluate([turned, BAR], [ring, BAR])
    assert score.f1 == 1
    assert score.continuations_kept == score.continuations == 4


def test_nothing_traced_is_all_wrong():
    score = evaluate([], CROSS, failed=True)
    assert score.chamfer == score.density == np.inf
    assert score.length_diff == 400
    assert score.f1 == 0
    assert score.wrong_joins_made == score.wrong_joins == 4
    figures = summarize([score, evaluate(CROSS, CROSS), evaluate(CROSS, CROSS)])
    assert figures["failed"] == 1
    assert figures["chamfer"] == 0
    assert figures["routing"] == figures["crossings"] == pytest.approx(2 / 3)


def test_an_empty_page_traced_as_empty():
    assert evaluate([], []).true_strokes == 0
    assert evaluate(CROSS, []).crossings == 1


def test_reading_an_svg(tmp_path):
    path = tmp_path / "a.svg"
    path.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="10 0 512 256">'
        '<g fill="black"><path d="M0 0 L9 9 L0 9 Z"/></g>'
        '<g fill="none"><path d="M10 0 L110 0 L110 1e2 Z'
        ' M10 50 C10 77.6142 32.3858 100 60 100"/></g></svg>'
    )
    triangle, arc = read_svg(path)
    np.testing.assert_allclose(triangle, [[0, 0], [200, 0], [200, 200], [0, 0]])
    assert Strokes([arc]).length[0] == pytest.approx(np.pi / 2 * 100, rel=1e-3)
    path.write_text('<svg viewBox="0 0 1 1" transform="scale(2)"></svg>')
    with pytest.raises(ValueError, match="transforms"):
        read_svg(path)


def test_scaling_drops_what_is_no_line():
    lines = scaled([[[0, 0], [0, 0]], [[0, 0], [np.nan, 1], [4, 0]], [[1, 1]]], (8, 4))
    assert len(lines) == 1
    np.testing.assert_allclose(lines[0], [[0, 0], [512, 0]])


point = st.tuples(st.integers(0, 1000), st.integers(0, 1000))
line = st.lists(point, min_size=2, max_size=5)
drawing = st.lists(line, min_size=1, max_size=6)


@settings(deadline=None)  # the machine's speed is no property of the code
# A pen that goes to and fro, and on.
@example([[(746, 74), (283, 41), (746, 74), (283, 41), (193, 552)]])
@example([[(606, 677), (565, 276), (606, 677), (565, 276)], [(918, 904), (606, 677), (918, 904)]])
@given(drawing)
def test_every_drawing_is_its_own_truth(strokes):
    lines = scaled([np.array(s, float) for s in strokes], (1024, 1024))
    score = evaluate(lines, lines)
    assert score.crossings_found == (score.true_crossings,) * 3
    assert score.continuations_kept == score.continuations
    assert score.wrong_joins_made == 0
    assert score.recovered == score.strokes
    upside_down = [line[::-1] * (-1, -1) + 1024 for line in lines[::-1]]
    turned = evaluate(upside_down, upside_down)
    assert turned.true_crossings == score.true_crossings
    assert turned.true_length == pytest.approx(score.true_length)


def test_a_common_shift_is_found():
    t = np.linspace(0, 1, 400)[:, None]
    truth = [np.hstack([100 + 300 * t, 50 + 90 * np.sin(5 * t)]), np.hstack([20 * t, 700 * t])]
    pairs = [(Strokes([line + np.array([0.3, -0.2])]), Strokes([line])) for line in truth]
    np.testing.assert_allclose(shift(pairs), (0.3, -0.2), atol=0.02)
    assert shift([(Strokes([]), Strokes(truth))]) == pytest.approx(0)
