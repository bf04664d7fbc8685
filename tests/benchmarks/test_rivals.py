"""The benchmark's rivals on drawings where it is clear what they should do."""

from __future__ import annotations

import json

import cv2
import numpy as np
import pytest

from benchmarks import quality
from benchmarks.rivals import autotrace, greedy, nijigpen
from benchmarks.rivals.plain_skeleton import pieces, strokes


def skeleton(*rows: str) -> np.ndarray:
    return np.array([[c == "#" for c in row] for row in rows])


@pytest.fixture
def cross(tmp_path):
    page = np.full((200, 200), 255, np.uint8)
    cv2.line(page, (30, 30), (170, 170), 0, 3, cv2.LINE_AA)
    cv2.line(page, (30, 165), (170, 35), 0, 3, cv2.LINE_AA)
    path = tmp_path / "cross.png"
    cv2.imwrite(str(path), page)
    return path


def test_a_line_is_one_piece():
    found = pieces(skeleton("....", ".##.", "...#"))
    assert len(found.paths) == 1
    assert {tuple(p) for p in found.paths[0]} == {(1.5, 1.5), (2.5, 1.5), (3.5, 2.5)}


def test_a_crossing_has_four_pieces_that_meet_at_its_middle():
    found = pieces(skeleton("..#..", "..#..", "#####", "..#..", "..#.."))
    assert len(found.paths) == 4
    centre = np.bincount(found.ends.ravel()).argmax()
    np.testing.assert_allclose(found.nodes[centre], (2.5, 2.5))


def test_a_loop_is_one_closed_piece():
    found = pieces(skeleton(".###.", "#...#", "#...#", ".###."))
    assert len(found.paths) == 1
    np.testing.assert_array_equal(found.paths[0][0], found.paths[0][-1])
    assert found.ends[0, 0] == found.ends[0, 1]


def test_nothing_has_no_pieces():
    assert pieces(np.zeros((5, 5), bool)).paths == []
    assert pieces(skeleton("...", ".#.", "...")).paths == []


def test_strokes_grow_to_both_sides():
    a, b, c = (np.array([[x, 0.0], [x + 1, 0]]) for x in range(3))
    # 1 = end of a, 2 = start of b, 3 = end of b, 4 = start of c; the middle one comes first.
    partner = np.array([4, 3, 2, 1, 0, 5])
    joined = strokes([b, a, c], partner)
    assert len(joined) == 2 or len(joined[0]) == 6


@pytest.mark.parametrize("rival", [greedy, nijigpen])
def test_a_rival_runs_through_a_crossing(rival, cross):
    lines = [line for line in rival.trace(cross) if len(line) > 10]
    assert len(lines) == 2
    assert all(np.hypot(*(line[0] - line[-1])) > 150 for line in lines)


def test_autotrace_finds_the_lines_where_they_are(cross):
    pytest.importorskip("autotrace")
    points = np.vstack(autotrace.trace(cross))
    rising, falling = 165 - (points[:, 0] - 30) * 130 / 140, points[:, 0]
    away = np.minimum(np.abs(points[:, 1] - rising), np.abs(points[:, 1] - falling))
    assert np.median(away) < 1.5


def test_the_table_and_its_file(tmp_path, capsys):
    figures = quality.main(
        ["--every", "40", "--jobs", "1", "--methods", "skeleton + greedy",
         "--json", str(tmp_path / "q.json"), "--svg", str(tmp_path / "svg")]
    )  # fmt: skip
    assert figures["skeleton + greedy"]["drawings"] == 2
    assert figures["skeleton + greedy"]["cpu_s"] > 0
    assert "| skeleton + greedy |" in capsys.readouterr().out
    told = json.loads((tmp_path / "q.json").read_text())["skeleton + greedy"]
    assert told["summary"]["drawings"] == len(told["drawings"]) == 2
    assert told["summary"]["failed"] == 0
    assert len(list((tmp_path / "svg").rglob("*.svg"))) == 2
