"""Planar graphs from true strokes: cut where lines meet, with the routing that gives them back."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from involute.engine.strokes import walk
from involute.engine.values import PlanarGraph
from involute.synthesis.true_graph import graph_from_strokes


def _line(*points: tuple[float, float]) -> np.ndarray:
    return np.array(points, float)


def _ring(x: float, y: float, radius: float) -> np.ndarray:
    t = np.linspace(0, 2 * np.pi, 60)
    return np.stack([x + radius * np.cos(t), y + radius * np.sin(t)], 1)


def _lengths(graph: PlanarGraph, partner: np.ndarray) -> list[float]:
    size = [np.hypot(*np.diff(graph.branch(b), axis=0).T).sum() for b in range(graph.branch_count)]
    return sorted(float(sum(size[h >> 1] for h in w.halves)) for w in walk(partner))


def _degrees(graph: PlanarGraph) -> list[int]:
    return sorted(graph.degrees.tolist())


def test_a_grid_comes_back_as_its_lines() -> None:
    across = [_line((0, y), (100, y)) for y in (20, 40, 60)]
    down = [_line((x, 0), (x, 90)) for x in (15, 50, 80, 95)]
    graph, partner = graph_from_strokes([*across, *down])
    assert (graph.degrees == 4).sum() == 12
    assert _lengths(graph, partner) == pytest.approx([90] * 4 + [100] * 3, abs=1e-3)


@pytest.mark.parametrize("gap", [-1.2, 0.0, 1.2])
def test_an_end_near_a_line_touches_it(gap: float) -> None:
    graph, partner = graph_from_strokes([_line((0, 50), (100, 50)), _line((40, 0), (40, 50 + gap))])
    assert _degrees(graph) == [1, 1, 1, 3]
    np.testing.assert_allclose(graph.vertices[graph.junctions], [[40, 50]], atol=1e-4)
    assert _lengths(graph, partner) == pytest.approx([50, 100], abs=1e-3)


def test_two_ends_that_meet_are_one_line() -> None:
    graph, partner = graph_from_strokes([_line((0, 0), (50, 0)), _line((50.5, 0), (50, 40))])
    assert _degrees(graph) == [1, 1]
    assert len(walk(partner)) == 1


def test_three_ends_that_meet_are_a_junction_where_all_end() -> None:
    rays = [_line((50, 50), (50 + 40 * np.cos(a), 50 + 40 * np.sin(a))) for a in (0, 2, 4)]
    graph, partner = graph_from_strokes(rays)
    assert _degrees(graph) == [1, 1, 1, 3]
    np.testing.assert_array_equal(partner, np.arange(6))


def test_a_circle_is_a_closed_stroke() -> None:
    graph, partner = graph_from_strokes([_ring(50, 50, 30)])
    assert partner.tolist() == [1, 0]
    assert graph.ends[0, 0] == graph.ends[0, 1]
    (only,) = walk(partner)
    assert only.closed


def test_a_circle_with_a_line_through_it_stays_closed() -> None:
    graph, partner = graph_from_strokes([_ring(50, 50, 30), _line((0, 50), (100, 50))])
    assert _degrees(graph) == [1, 1, 4, 4]
    assert sorted(w.closed for w in walk(partner)) == [False, True]


def test_a_line_that_crosses_itself() -> None:
    t = np.linspace(0, 2 * np.pi, 100, endpoint=False)
    eight = np.stack([50 + 40 * np.sin(t), 50 + 30 * np.sin(2 * t)], 1)
    graph, partner = graph_from_strokes([np.vstack([eight, eight[:1]])])
    assert _degrees(graph) == [4]
    (only,) = walk(partner)
    assert only.closed
    assert len(only.halves) == 2


def test_a_line_drawn_twice_is_kept_once() -> None:
    long, short = _line((0, 50), (100, 50)), _line((30, 50.4), (70, 50.4))
    graph, partner = graph_from_strokes([short, long])
    assert _lengths(graph, partner) == pytest.approx([100], abs=1e-3)
    graph, _ = graph_from_strokes([short, long], doubled=0)
    assert graph.branch_count == 4


def test_a_line_that_joins_another_ends_where_they_meet() -> None:
    graph, partner = graph_from_strokes(
        [_line((0, 50), (140, 50)), _line((0, 0), (50, 49.8), (95, 49.8))]
    )
    assert _degrees(graph) == [1, 1, 1, 3]
    assert max(_lengths(graph, partner)) == pytest.approx(140, abs=0.01)


def test_every_point_has_the_values_of_its_stroke() -> None:
    graph, _ = graph_from_strokes(
        [_line((0, 50), (100, 50)), _line((50, 0), (50, 100))],
        widths=[2, 5],
        strength=[0.5, 1],
        colors=[(255, 0, 0), (0, 0, 255)],
    )
    upright = np.ptp(graph.points[:, 0][graph.widths == 5]) == 0
    assert upright
    assert set(graph.strength[graph.widths == 2].tolist()) == {0.5}
    assert graph.colors[graph.widths == 2].tolist() == [[255, 0, 0]] * int(
        (graph.widths == 2).sum()
    )


def test_nothing_gives_an_empty_graph() -> None:
    for strokes in ([], [np.zeros((0, 2))], [np.zeros((5, 2))], [np.full((3, 2), np.nan)]):
        graph, partner = graph_from_strokes(strokes)
        assert graph.branch_count == len(partner) == 0


@settings(deadline=None, max_examples=30)
@given(st.integers(0, 2**32 - 1), st.integers(1, 15))
def test_random_scribbles_give_sound_graphs(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    strokes = []
    for _ in range(count):
        step = np.cumsum(rng.normal(0, 1, (int(rng.integers(12, 40)), 2)), 0)
        strokes.append(rng.uniform(20, 180, 2) + rng.uniform(1, 6) * np.cumsum(step, 0) / 3)
    graph, partner = graph_from_strokes(strokes)
    halves = np.arange(2 * graph.branch_count)
    assert (partner[partner] == halves).all()
    vertex = graph.half_vertex
    assert (vertex[partner] == vertex).all()
    assert (graph.degrees > 0).all()
    loop = graph.degrees[vertex] == 2
    assert (partner[loop] == halves[loop] ^ 1).all()
    assert (graph.ends[loop.reshape(-1, 2).all(1)] @ [1, -1] == 0).all()
    first, last = graph.offsets[:-1], graph.offsets[1:] - 1
    np.testing.assert_array_equal(graph.points[first], graph.vertices[graph.ends[:, 0]])
    np.testing.assert_array_equal(graph.points[last], graph.vertices[graph.ends[:, 1]])
    # Nothing drawn is lost, and nothing is where nothing was drawn.
    drawn = shapely.union_all([shapely.LineString(s) for s in strokes])
    lines = [shapely.LineString(graph.branch(b)) for b in range(graph.branch_count)]
    found = shapely.union_all(lines)
    for a, b in ((drawn, found), (found, drawn)):
        points = shapely.points(shapely.get_coordinates(shapely.segmentize(a, 2.0)))
        assert (shapely.distance(points, b) > 4).mean() < 0.02
