"""The graph of an ideal centerline has one vertex per junction, where the lines really meet."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from involute.engine import Settings
from involute.engine.graph import Evidence, build_graph, ridge
from involute.engine.graph.ridge import Ridge
from involute.engine.graph.skeleton import thin
from involute.engine.values import LineMaps, PlanarGraph

SIZE = 120
MIDDLE = np.array([60.3, 59.6])


def drawn(*lines: np.ndarray, size: int = SIZE) -> np.ndarray:
    """Lines 1 px wide with exact coverage, (size, size) float32."""
    scale, shift = 8, 6
    big = np.zeros((size * scale, size * scale), np.uint8)
    for line in lines:
        fixed = np.rint((np.asarray(line) * scale - 0.5) * 2**shift).astype(np.int32)
        cv2.polylines(big, [fixed.reshape(-1, 1, 2)], False, 255, scale, cv2.LINE_8, shift)
    return cv2.resize(big, (size, size), interpolation=cv2.INTER_AREA).astype(np.float32) / 255


def graph_of(*lines: np.ndarray, size: int = SIZE, **settings: float) -> PlanarGraph:
    return build_graph(Evidence(LineMaps(drawn(*lines, size=size)), 2.0), Settings(**settings))


def ray(degrees: float, start: float, stop: float, center: np.ndarray = MIDDLE) -> np.ndarray:
    """A straight line along one direction, from one distance of the center to another."""
    way = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
    return center + way * np.array([[start], [stop]])


def circle(radius: float, center: np.ndarray = MIDDLE) -> np.ndarray:
    t = np.linspace(0, 2 * np.pi, 90)[:, None]
    return center + radius * np.concatenate([np.cos(t), np.sin(t)], 1)


def junction_degrees(graph: PlanarGraph) -> list[int]:
    return sorted(graph.degrees[graph.degrees >= 3].tolist())


def off(graph: PlanarGraph, point: np.ndarray) -> float:
    """How far the nearest junction is from a point."""
    return float(np.hypot(*(graph.vertices[graph.degrees >= 3] - point).T).min())


def distance_to(line: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Distance of points from a straight line of two points."""
    way = (line[1] - line[0]) / np.hypot(*(line[1] - line[0]))
    offset = points - line[0]
    return np.abs(offset[:, 0] * way[1] - offset[:, 1] * way[0])


@pytest.mark.parametrize("share", [0.2, 0.5, 0.8])
def test_a_mask_is_thinned_as_opencv_thins_it(share: float) -> None:
    noise = np.random.default_rng(3).random((90, 70)).astype(np.float32)
    mask = (cv2.GaussianBlur(noise, (0, 0), 2) > np.quantile(noise, 0.5)) | (noise < share / 4)
    mask = mask.astype(np.uint8) * np.uint8(255)
    framed = cv2.copyMakeBorder(mask, 1, 1, 1, 1, cv2.BORDER_CONSTANT, value=0)
    expected = cv2.ximgproc.thinning(framed, thinningType=cv2.ximgproc.THINNING_GUOHALL)
    np.testing.assert_array_equal(thin(mask), expected[1:-1, 1:-1])


def test_blank_page() -> None:
    graph = build_graph(Evidence(LineMaps(np.zeros((40, 50), np.float32)), 2.0), Settings())
    assert graph.branch_count == 0
    assert graph.vertices.shape == (0, 2)


@pytest.mark.parametrize("angle", [0, 7, 31, 45, 90, 118])
def test_a_line_lies_where_it_was_drawn(angle: float) -> None:
    line = ray(angle, -40, 40)
    graph = graph_of(line)
    assert graph.branch_count == 1
    assert distance_to(line, graph.branch(0)).mean() < 0.08
    assert distance_to(line, graph.branch(0)).max() < 0.25
    ends = graph.vertices[np.argsort(graph.vertices @ (line[1] - line[0]))]
    assert np.hypot(*(ends - line).T).max() < 0.8


@pytest.mark.parametrize(
    ("angle", "within"), [(12, 1.5), (20, 1.0), (35, 0.6), (60, 0.4), (90, 0.4)]
)
@pytest.mark.parametrize("turn", [3, 50])
def test_a_crossing_is_one_vertex_even_when_shallow(
    angle: float, within: float, turn: float
) -> None:
    graph = graph_of(ray(turn, -45, 45), ray(turn + angle, -45, 45))
    assert junction_degrees(graph) == [4]
    assert off(graph, MIDDLE) < within


@pytest.mark.parametrize("angle", [40, 65, 90])
def test_a_line_ends_on_another_without_gap_or_overshoot(angle: float) -> None:
    bar, stem = ray(10, -45, 45), ray(10 + angle, 0, 40)
    graph = graph_of(bar, stem)
    assert junction_degrees(graph) == [3]
    assert off(graph, MIDDLE) < 0.6
    assert distance_to(bar, graph.vertices[graph.degrees == 3]).max() < 0.2


@pytest.mark.parametrize("degrees", [(0, 130, 250), (10, 100, 190), (5, 75, 150, 220, 290)])
def test_stars_meet_in_one_point(degrees: tuple[float, ...]) -> None:
    graph = graph_of(*(ray(d, 0, 40) for d in degrees))
    assert junction_degrees(graph) == [len(degrees)]
    assert off(graph, MIDDLE) < 0.5


def test_a_star_of_four_lines() -> None:
    graph = graph_of(*(ray(d, -45, 45) for d in (4, 50, 93, 140)))
    assert junction_degrees(graph) == [8]
    assert off(graph, MIDDLE) < 0.6


@pytest.mark.parametrize("side", [1, -1])
def test_two_close_stems_stay_two(side: int) -> None:
    bar = ray(0, -45, 45)
    stems = [
        ray(90, 0, 40, MIDDLE - np.array([4, 0])),
        ray(90, 0, 40 * side, MIDDLE + np.array([4, 0])),
    ]
    graph = graph_of(bar, *stems)
    assert junction_degrees(graph) == [3, 3]
    for stem in stems:
        assert off(graph, stem[0]) < 0.7


@pytest.mark.parametrize("turn", [0, 20, 45])
def test_parallel_lines_three_px_apart_stay_apart(turn: float) -> None:
    across = np.array([-np.sin(np.radians(turn)), np.cos(np.radians(turn))])
    lines = [ray(turn, -40, 40, MIDDLE + k * 3.0 * across) for k in (-1, 0, 1)]
    graph = graph_of(*lines)
    assert graph.branch_count == 3
    assert not junction_degrees(graph)


def test_the_tip_of_a_v_is_no_junction() -> None:
    graph = graph_of(ray(80, 0, 50), ray(98, 0, 50))
    assert not junction_degrees(graph)
    assert np.hypot(*(graph.points - MIDDLE).T).min() < 1.5


@pytest.mark.parametrize("angle", [50, 90, 120])
def test_corners_stay_sharp(angle: float) -> None:
    corner = np.concatenate([ray(15, 40, 0), ray(15 + angle, 0, 40)])
    graph = graph_of(corner)
    assert graph.branch_count == 1
    assert np.hypot(*(graph.points - MIDDLE).T).min() < 1.0


@pytest.mark.parametrize("radius", [4, 10, 40])
def test_a_circle_is_one_closed_branch(radius: float) -> None:
    graph = graph_of(circle(radius))
    assert graph.branch_count == 1
    assert graph.ends[0, 0] == graph.ends[0, 1]
    distance = np.hypot(*(graph.points - MIDDLE).T)
    assert np.abs(distance - radius).mean() < 0.15


def test_hatching_crosses_everywhere() -> None:
    at = np.arange(20.4, 100, 9)
    graph = graph_of(
        *(np.array([[x, 12], [x, 108]]) for x in at), *(np.array([[12, y], [108, y]]) for y in at)
    )
    assert junction_degrees(graph) == [4] * len(at) ** 2
    crossings = np.stack(np.meshgrid(at, at), -1).reshape(-1, 2)
    assert max(off(graph, c) for c in crossings) < 0.5


def test_smoothing_keeps_the_length() -> None:
    t = np.linspace(0, 1, 200)
    wave = np.stack([10 + 100 * t, 60 + 25 * np.sin(9 * t)], -1)
    true = np.hypot(*np.diff(wave, axis=0).T).sum()
    for smoothing in (0.0, 0.3, 1.0):
        points = graph_of(wave, smoothing=smoothing).branch(0)
        assert abs(np.hypot(*np.diff(points, axis=0).T).sum() / true - 1) < 0.012


@pytest.mark.parametrize("length", [0.2, 1.0, 3.0])
def test_dots_are_not_lost(length: float) -> None:
    dots = [ray(70, 0, length), ray(20, 20, 20 + length)]
    graph = graph_of(*dots)
    assert graph.branch_count == 2
    assert not junction_degrees(graph)


@pytest.mark.parametrize("angle", [0.0, 33.0, 77.0])
@pytest.mark.parametrize("gap", [2.6, 3.2, 3.9])
def test_a_small_gap_in_a_line_is_bridged(angle: float, gap: float) -> None:
    ridge = cv2.GaussianBlur(drawn(ray(angle, -40, -gap / 2), ray(angle, gap / 2, 40)), (0, 0), 0.5)
    graph = build_graph(Evidence(LineMaps(np.minimum(1.5 * ridge, 1)), 2.0), Settings())
    assert graph.branch_count == 1
    assert distance_to(ray(angle, -40, 40), graph.points).max() < 0.3


def test_dashes_stay_dashes() -> None:
    dashes = [ray(10.0, start, start + 9) for start in range(-45, 45, 15)]
    assert graph_of(*dashes).branch_count == len(dashes)


def test_ends_that_only_come_near_each_other_stay_apart() -> None:
    parallel = [np.array([[20.0, 30.0], [60.0, 30.0]]), np.array([[60.0, 33.5], [100.0, 33.5]])]
    corner = [np.array([[20.0, 70.0], [60.0, 70.0]]), np.array([[62.5, 72.5], [62.5, 110.0]])]
    assert graph_of(*parallel, *corner).branch_count == 4


def test_shallow_crossings_are_found_along_the_lines() -> None:
    """At six degrees a tenth of a px across the lines is a whole one along them."""
    errors = []
    for turn in np.arange(3.0, 180.0, 22.5):
        t = np.linspace(-48, 48, 80)[:, None]
        way = np.array([np.cos(np.radians(turn)), np.sin(np.radians(turn))])
        side = np.array([-way[1], way[0]])
        slope = np.tan(np.radians(6.0))
        arc = MIDDLE + t * way + (slope * t + 0.0005 * t**2) * side
        graph = graph_of(MIDDLE + t[[0, -1]] * way, arc)
        errors.append(off(graph, MIDDLE))
    assert np.median(errors) < 0.5
    assert max(errors) < 0.8


def spots(*points: tuple[float, float]) -> np.ndarray:
    """A heatmap (SIZE, SIZE) that is bright at some points."""
    heat = np.zeros((SIZE, SIZE), np.float32)
    for x, y in points:
        heat[int(y), int(x)] = 1.0
    return cv2.min(cv2.GaussianBlur(heat, (0, 0), 1.5) * 14, 1.0)


@pytest.mark.parametrize("seen", [True, False])
def test_a_short_stem_stays_only_where_a_junction_is_seen(seen: bool) -> None:
    line = np.array([[20.0, 60.3], [100.0, 60.3]])
    ridge = drawn(line, np.array([[60.3, 60.3], [60.3, 68.0]]))
    maps = LineMaps(ridge, spots((60.3, 60.3)) if seen else np.zeros_like(ridge))
    assert build_graph(Evidence(maps, 2.0), Settings()).branch_count == (3 if seen else 1)


@pytest.mark.parametrize("seen", [True, False])
def test_a_faint_rung_stays_only_where_junctions_are_seen(seen: bool) -> None:
    rails = [np.array([[20.0, y], [100.0, y]]) for y in (50.3, 58.3)]
    rung = np.array([[60.3, 50.3], [60.3, 58.3]])
    ridge = np.maximum(drawn(*rails), 0.6 * drawn(rung))
    heat = spots((60.3, 50.3), (60.3, 58.3)) if seen else np.zeros_like(ridge)
    graph = build_graph(Evidence(LineMaps(ridge, heat), 2.0), Settings())
    assert graph.branch_count == (5 if seen else 2)


def test_bands_of_rows_make_no_difference(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(3)
    image = cv2.GaussianBlur(rng.random((90, 70)).astype(np.float32), (0, 0), 1.5)
    image = (image - image.min()) / np.ptp(image)
    whole = Ridge.of(image)
    rows, columns = np.nonzero(whole.mask())
    points = whole.crest(rows, columns)
    monkeypatch.setattr(ridge, "BAND", 16)
    banded = Ridge.of(image)
    np.testing.assert_array_equal(np.nonzero(banded.mask()), (rows, columns))
    np.testing.assert_array_equal(banded.crest(rows, columns), points)
