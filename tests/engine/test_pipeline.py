"""The whole method, from a picture to strokes."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from involute.engine import Cancelled, InvoluteError, Settings, vectorize

SIZE = 400


def drawn(lines: list[np.ndarray], size: tuple[int, int] = (SIZE, SIZE), width: float = 3.0):
    """An (H, W) uint8 page: dark, anti-aliased lines on white."""
    fine = np.zeros((size[1] * 4, size[0] * 4), np.uint8)
    for line in lines:
        points = np.rint(np.asarray(line) * 4 * 16).astype(np.int32)
        cv2.polylines(fine, [points], False, 255, round(width * 4), cv2.LINE_AA, 4)
    return 255 - cv2.resize(fine, size, interpolation=cv2.INTER_AREA)


def wave(y: float, swing: float, turns: float) -> np.ndarray:
    x = np.linspace(30, SIZE - 30, 120)
    return np.stack([x, y + swing * np.sin(x / SIZE * 2 * np.pi * turns)], -1)


def ring(x: float, y: float, radius: float) -> np.ndarray:
    angle = np.linspace(0, 2 * np.pi, 90)
    return np.stack([x + radius * np.cos(angle), y + radius * np.sin(angle)], -1)


CROSS = [np.array([[60.0, 100], [340, 300]]), np.array([[60.0, 320], [340, 90]])]
SCENE = [
    *CROSS,
    wave(70, 25, 2),
    wave(330, 20, 1.5),
    ring(200, 200, 60),
    ring(80, 200, 25),
    np.array([[200.0, 260], [210, 380]]),  # a stem that ends on the ring and crosses the wave
    np.array([[330.0, 150], [370, 150], [370, 250], [330, 250]]),  # two corners
]


@pytest.fixture(scope="module")
def scene():
    return vectorize(drawn(SCENE))


def test_two_lines_that_cross_are_two_strokes_with_their_width_and_place():
    drawing = vectorize(drawn(CROSS))
    found = len(drawing.strokes)
    assert found == 2
    assert len(drawing.junctions) == 1
    np.testing.assert_allclose(drawing.junctions[0].position, (200, 202.5), atol=6)
    assert drawing.junctions[0].degree == 4
    for line in CROSS:
        # Every true point lies on one and the same stroke.
        truth = np.linspace(line[0], line[1], 50)
        away = [
            max(-cv2.pointPolygonTest(s.points.reshape(-1, 1, 2), p, True) for p in truth.tolist())
            for s in drawing.strokes
        ]
        assert min(away) < 1.5
    for stroke in drawing.strokes:
        assert not stroke.closed
        assert np.median(stroke.widths) == pytest.approx(3.0, abs=0.7)
        # No kink: a straight line stays within half a pixel of its chord.
        chord = stroke.points[-1] - stroke.points[0]
        across = np.array([-chord[1], chord[0]]) / np.hypot(*chord)
        offset = (stroke.points - stroke.points[0]) @ across
        assert np.ptp(offset) < 0.6


def test_the_scene_has_the_strokes_that_were_drawn(scene):
    found = len(scene.strokes)
    assert found == len(SCENE)
    assert sum(stroke.closed for stroke in scene.strokes) == 2


def test_strokes_partition_the_branches(scene):
    walked = np.concatenate([stroke.branches >> 1 for stroke in scene.strokes])
    assert sorted(walked) == list(range(scene.graph.branch_count))


def test_the_routing_is_an_involution_inside_junctions(scene):
    partner, graph = scene.routing.partner, scene.graph
    np.testing.assert_array_equal(partner[partner], np.arange(len(partner)))
    np.testing.assert_array_equal(graph.half_vertex[partner], graph.half_vertex)


@pytest.mark.parametrize("turns", [1, 2, 3])
def test_a_turned_page_has_the_same_strokes(scene, turns):
    turned = vectorize(np.ascontiguousarray(np.rot90(drawn(SCENE), turns)))
    found, expected = len(turned.strokes), len(scene.strokes)
    assert abs(found - expected) <= 0.02 * expected
    length, other = (
        sum(np.hypot(*np.diff(s.points, axis=0).T).sum() for s in d.strokes)
        for d in (scene, turned)
    )
    assert other == pytest.approx(length, rel=0.01)


@pytest.mark.parametrize(
    "change",
    [
        pytest.param(lambda page: 255 - page, id="light on dark"),
        pytest.param(lambda page: page.astype(np.float32) / 255, id="float"),
        pytest.param(lambda page: page.astype(np.uint16) * 257, id="16 bit"),
        pytest.param(lambda page: cv2.cvtColor(page, cv2.COLOR_GRAY2RGB), id="colour"),
        pytest.param(lambda page: (page * 0.7 + 40).astype(np.uint8), id="faint"),
    ],
)
def test_the_same_strokes_however_the_page_is_given(scene, change):
    found, expected = len(vectorize(change(drawn(SCENE))).strokes), len(scene.strokes)
    assert found == expected


def test_tracing_twice_gives_the_same(scene):
    again = vectorize(drawn(SCENE))
    for a, b in zip(scene.strokes, again.strokes, strict=True):
        np.testing.assert_array_equal(a.points, b.points)
        np.testing.assert_array_equal(a.widths, b.widths)


def test_a_larger_scan_of_the_same_page_gives_the_same_strokes_larger(scene):
    page = drawn([line * 2 for line in SCENE], (2 * SIZE, 2 * SIZE), 6.0)
    large = vectorize(page)
    assert large.size == (2 * SIZE, 2 * SIZE)
    found, expected = len(large.strokes), len(scene.strokes)
    assert found == expected
    longest = max(large.strokes, key=lambda s: len(s.branches))
    assert np.median(longest.widths) == pytest.approx(6.0, abs=1.2)


@pytest.mark.parametrize("suffix", [".json", ".svg"])
def test_saved_and_loaded_it_is_the_same_drawing(scene, tmp_path, suffix):
    scene.save(tmp_path / f"a{suffix}")
    loaded = type(scene).load(tmp_path / f"a{suffix}")
    assert loaded.size == scene.size
    for a, b in zip(scene.strokes, loaded.strokes, strict=True):
        assert a.closed == b.closed
        assert a.color == b.color
        np.testing.assert_allclose(a.points, b.points, atol=1e-3)
        np.testing.assert_allclose(a.widths, b.widths, atol=2e-2)


def test_a_blank_page_is_an_empty_drawing():
    drawing = vectorize(np.full((64, 80), 255, np.uint8))
    assert drawing.strokes == ()
    assert drawing.junctions == ()
    assert drawing.size == (80, 64)


def test_progress_only_grows_and_ends_near_one():
    told: list[tuple[str, float]] = []
    vectorize(drawn(CROSS), progress=lambda stage, fraction: told.append((stage, fraction)))
    fractions = [fraction for _, fraction in told]
    assert fractions == sorted(fractions)
    assert 0 <= fractions[0] < fractions[-1] <= 1
    stages = list(dict.fromkeys(stage for stage, _ in told))
    assert stages == ["scan", "solids", "centerline", "graph", "routing", "strokes", "check"]


def test_cancelling():
    def stop(stage: str, fraction: float) -> None:
        if stage == "graph":
            raise Cancelled

    with pytest.raises(Cancelled):
        vectorize(drawn(CROSS), progress=stop)


def test_what_cannot_be_traced_is_told_in_one_sentence(tmp_path):
    text = tmp_path / "notes.png"
    text.write_text("no picture")
    for bad in (tmp_path / "none.png", text, np.full((64, 64), np.nan), np.zeros((1, 1), np.uint8)):
        with pytest.raises(InvoluteError) as caught:
            vectorize(bad)
        assert "\n" not in str(caught.value)
        assert str(caught.value).endswith(".")


def test_settings_are_checked():
    with pytest.raises(InvoluteError, match="polarity"):
        Settings(polarity="sideways")
    with pytest.raises(InvoluteError, match="smoothing"):
        Settings(smoothing=2.0)


def test_paper_is_no_picture_of_centerlines():
    """Thinning a white page of 8 megapixels took most of a minute."""
    with pytest.raises(InvoluteError, match="not of centerlines"):
        vectorize(drawn(SCENE), Settings(provider="given"))
    white = 255 - drawn(SCENE, width=1.5)
    assert len(vectorize(white, Settings(provider="given")).strokes) > 5
