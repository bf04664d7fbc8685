"""Rough drawings: many pencil strokes become one line, a clean drawing stays as it is."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from involute.engine import Drawing, Settings, vectorize
from involute.engine.graph.at_vertices import directions
from involute.engine.rough import around, fronts
from involute.engine.rough.merging import one_line
from involute.engine.routing.candidates import candidate_pairs
from involute.synthesis.true_graph import graph_from_strokes

SIZE = 420
AUTO = Settings(drawing="auto")


def page(strokes: list[np.ndarray], width: int = 2) -> np.ndarray:
    """(SIZE, SIZE) uint8: lines on white paper."""
    image = np.full((SIZE, SIZE), 255, np.uint8)
    for stroke in strokes:
        points = np.round(stroke * 16).astype(np.int32)
        cv2.polylines(image, [points], False, 0, width, cv2.LINE_AA, 4)
    return image


def curve(aside: float, start: float = 0.0, stop: float = 1.0) -> np.ndarray:
    t = np.linspace(start, stop, 60)[:, None]
    angle = 0.4 + 2.2 * t
    return np.array([210, 110]) + (160 + aside) * np.concatenate(
        [np.cos(angle), np.sin(angle)], axis=1
    )


def sketched() -> list[np.ndarray]:
    """One arc said by five strokes, and a line said by four."""
    arc = [curve(-4, 0, 0.6), curve(3.5, 0.1, 0.9), curve(0, 0.3, 1), curve(-1, 0, 0.4)]
    x = np.linspace(40, 380, 50)
    bar = [np.stack([x, np.full(50, 60 + y)], 1) for y in (0.0, 4.0)]
    bar += [np.stack([x[:30], 60 + 7 - x[:30] / 60], 1), np.stack([x[20:], 57 + x[20:] / 90], 1)]
    return [*arc, curve(4, 0.6, 1), *bar]


@pytest.fixture(scope="module")
def rough() -> Drawing:
    return vectorize(page(sketched()), Settings(drawing="rough"))


def length(points: np.ndarray) -> float:
    return float(np.hypot(*np.diff(points, axis=0).T).sum())


def test_a_bundle_becomes_one_line(rough):
    long = [s for s in rough.strokes if length(s.points) > 60]
    assert len(long) == 2
    arc = max(long, key=lambda s: s.points[:, 1].max())
    away = np.hypot(*(arc.points - [210, 110]).T) - 160
    assert np.abs(away).max() < 4.5
    assert np.abs(np.median(away)) < 2.5
    assert abs(length(arc.points) - 2.2 * 160) < 0.12 * 2.2 * 160


def test_the_pencil_strokes_are_kept_and_known(rough):
    assert rough.pencil is not None
    assert len(rough.pencil.strokes) > len(rough.strokes)
    for number in range(len(rough.strokes)):
        assert rough.pencil_of(number)
    assert (rough.line_of_pencil > 0).mean() > 0.7
    assert "rough drawing" in rough.notes[-1]


def test_it_has_the_width_of_the_pencil(rough):
    widths = np.concatenate([s.widths for s in rough.strokes])
    assert 1.0 < np.median(widths) < 4.5
    clean = vectorize(page(sketched()), Settings(drawing="rough", even_width=True))
    assert all(np.ptp(s.widths) < 1e-4 for s in clean.strokes)


def test_automatic_tells_rough_from_clean():
    assert vectorize(page(sketched()), AUTO).pencil is not None
    x = np.linspace(40, 380, 50)
    lines = [curve(0), np.stack([x, np.full(50, 60.0)], 1), np.stack([x[::-1], x], 1)]
    once = vectorize(page(lines), AUTO)
    assert once.pencil is None
    assert not any("rough" in note for note in once.notes)


def test_automatic_leaves_a_clean_page_with_lines_beside_each_other():
    path = Path(__file__).parents[2] / "benchmarks" / "data" / "openclipart_uccello_profil.jpg"
    assert vectorize(path, AUTO).pencil is None


def test_hatching_stays():
    """Parallel strokes of equal length at even distances are no bundle."""
    x = np.linspace(60, 300, 40)
    hatch = [np.stack([x, 80 + 9.0 * k + 0.3 * x], 1) for k in range(16)]
    drawing = vectorize(page(hatch), Settings(drawing="rough"))
    assert sum(length(s.points) > 200 for s in drawing.strokes) >= 13


def test_clean_is_never_bundled():
    drawing = vectorize(page(sketched()), Settings(drawing="clean"))
    assert drawing.pencil is None


@pytest.mark.parametrize("suffix", ["json", "svg"])
def test_files_keep_the_lines(rough, tmp_path, suffix):
    path = tmp_path / f"drawing.{suffix}"
    rough.save(path)
    again = Drawing.load(path)
    assert len(again.strokes) == len(rough.strokes)
    if suffix == "json":
        assert again.pencil is not None
        assert (again.pencil.said == rough.pencil.said).all()
        for a, b in zip(again.pencil.strokes, rough.pencil.strokes, strict=True):
            assert (a.points == b.points).all()
        assert again.pencil_of(0) == rough.pencil_of(0)


def test_lines_can_be_rerouted(rough):
    if rough.junctions:
        first = rough.junctions[0]
        changed = rough.reroute(first.index, first.alternatives[-1].pairs)
        assert changed.pencil is rough.pencil
    assert rough.ask_again().pencil is rough.pencil


def test_a_blank_page_is_no_rough_drawing():
    blank = np.full((200, 200), 255, np.uint8)
    assert vectorize(blank, Settings(drawing="rough")).strokes == ()


@pytest.mark.parametrize(
    ("parts", "closed"),
    [
        ([(0, 0.6, -2), (0.4, 1, 2), (0.2, 0.8, 0)], False),  # over each other
        ([(0, 0.45, 0), (0.55, 1, 1)], False),  # end to end, with a gap
        ([(0, 1, 0)], False),
        ([(0, 1.5, 0), (1.4, 2.9, 1)], True),  # all around, 2.2 times 2.86 radians
    ],
)
def test_strokes_that_the_artist_merges_become_one_line(parts, closed):
    strokes = [curve(aside, start, stop) for start, stop, aside in parts]
    strokes[0] = strokes[0][::-1]
    points, widths, is_closed = one_line([(s, np.full(len(s), 3.0)) for s in strokes])
    assert is_closed == closed
    assert np.abs(np.hypot(*(points - [210, 110]).T) - 160).max() < 3.5
    whole = 2 * np.pi if closed else 2.2
    assert abs(length(points) - whole * 160) < 0.04 * whole * 160
    assert len(widths) == len(points)
    assert (widths == 3.0).all()


def test_lines_go_on_over_a_gap():
    """Two bundles that face each other are one line, the straight way between them its middle."""
    x = np.linspace(30, 390, 90)
    bars = [np.stack([x, np.full(90, 200.0 + y)], 1) for y in (-2.0, 1.0, 3.0)]
    left = [bar[:43] for bar in bars]
    right = [bar[45:] for bar in bars]
    drawing = vectorize(page([*left, *right, *sketched()]), Settings(drawing="rough"))
    across = [s for s in drawing.strokes if abs(np.median(s.points[:, 1]) - 200) < 6]
    assert max(length(s.points) for s in across) > 330


def test_the_rim_of_what_is_in_front_goes_on() -> None:
    """A box hides two lines behind it; a third one meets its corner, straight on from its edge."""
    box = np.array([[100, 100], [300, 100], [300, 300], [100, 300], [100, 100]], float)
    behind = [np.array([[20, y], [100, y]], float) for y in (160, 230)]
    behind.append(np.array([[300, 100], [400, 104]], float))
    graph, true = graph_from_strokes([box, *behind])
    pairs = candidate_pairs(graph)
    a, b = pairs.T
    way = directions(graph, 8)
    turn = np.arccos(np.clip(-(way[a] * way[b]).sum(1), -1, 1))
    corner = np.hypot(*(graph.vertices[graph.half_vertex[a]] - [300, 100]).T) < 2
    assert corner.sum() == 3
    straightest = np.where(corner, turn == turn[corner].min(), turn < 0.1)
    share = fronts.fronts(graph, pairs, turn, straightest, 2.0)[0]
    rim = corner & (true[a] == b)
    assert not straightest[rim]
    assert share[rim] == 1.0
    assert share[corner & ~rim].max() < 0.6


def test_a_line_closes_round_the_face_that_it_bounds() -> None:
    """At one corner of a box nobody can tell what goes on; the others around its face can."""
    box = np.array([[100, 100], [300, 100], [300, 300], [100, 300], [100, 100]], float)
    behind = [
        np.array([a, b], float) for a, b in (([20, 160], [100, 160]), ([300, 230], [380, 230]))
    ]
    behind.append(np.array([[300, 100], [400, 104]], float))
    graph, true = graph_from_strokes([box, *behind])
    pairs = candidate_pairs(graph)
    pairs = pairs[graph.degrees[graph.half_vertex[pairs[:, 0]]] >= 3]
    a, b = pairs.T
    right = true[a] == b
    corner = np.hypot(*(graph.vertices[graph.half_vertex[a]] - [300, 100]).T) < 2
    one = np.where(corner, 0.4, np.where(right, 0.95, 0.02))
    rows = around.features(graph, pairs, one, 2.0)
    assert rows.shape == (len(pairs), around.FEATURES)
    closes, others_go_on = rows[:, 12] > 0, rows[:, -2]
    assert (closes == (corner & right)).all()
    assert others_go_on[corner & right] == 1.0
    assert others_go_on[corner & ~right].max() < 0.7
