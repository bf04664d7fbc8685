"""Routing: an involution inside junctions, the best one, with honest alternatives."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from involute.engine import InvoluteError, Settings
from involute.engine.involution import best_matching, involutions, pair_matrix
from involute.engine.routing import route
from involute.engine.routing.alternatives import neighbourhood, ranked_alternatives
from involute.engine.routing.candidates import candidate_pairs
from involute.engine.routing.features import half_features
from involute.engine.values import PlanarGraph
from involute.synthesis.true_graph import graph_from_strokes

from tests.engine.scribbles import scribbles

GEOMETRIC = Settings(router="geometric")


def _line(*points: tuple[float, float]) -> np.ndarray:
    corners = np.array(points, float)
    t = np.linspace(0, len(points) - 1, 20 * (len(points) - 1) + 1)
    return np.stack([np.interp(t, np.arange(len(points)), corners[:, c]) for c in (0, 1)], 1)


def _scores(seed: int, degree: int) -> np.ndarray:
    upper = np.triu(np.random.default_rng(seed).normal(0, 3, (degree, degree)), 1)
    return upper + upper.T


def _total(score: np.ndarray, partner: np.ndarray) -> float:
    return float(score[np.arange(len(score)), partner].sum() / 2)


@pytest.mark.parametrize(("degree", "count"), [(3, 4), (4, 10), (5, 26), (6, 76), (8, 764)])
def test_every_involution_is_listed_once(degree: int, count: int) -> None:
    ways = involutions(degree)
    assert len(np.unique(ways, axis=0)) == len(ways) == count
    assert (np.take_along_axis(ways, ways.astype(int), 1) == np.arange(degree)).all()


@given(st.integers(0, 2**32 - 1), st.integers(2, 9))
def test_enumeration_and_blossom_find_the_same_optimum(seed: int, degree: int) -> None:
    score = _scores(seed, degree)
    totals = pair_matrix(degree) @ score[np.triu_indices(degree, 1)]
    assert _total(score, best_matching(score)) == pytest.approx(totals.max(), abs=1e-4)


@given(st.integers(0, 2**32 - 1), st.integers(2, 14))
def test_the_neighbourhood_of_the_best_way_is_sound(seed: int, degree: int) -> None:
    score = _scores(seed, degree)
    best = best_matching(score)
    ways, totals = neighbourhood(score, best)
    assert (np.take_along_axis(ways, ways, 1) == np.arange(degree)).all()
    assert len(np.unique(ways, axis=0)) == len(ways)
    np.testing.assert_allclose(totals, [_total(score, way) for way in ways], atol=1e-9)
    assert (np.diff(totals) <= 1e-9).all()
    np.testing.assert_array_equal(ways[0], best)


def test_a_star_too_large_to_list_is_still_routed_best() -> None:
    angles = np.linspace(0, np.pi, 7, endpoint=False)
    rays = [_line((50, 50), (50 + 40 * np.cos(a), 50 + 40 * np.sin(a))) for a in angles]
    rays += [_line((50, 50), (50 - 40 * np.cos(a), 50 - 40 * np.sin(a))) for a in angles]
    graph, _ = graph_from_strokes(rays, widths=[3.0] * 14)
    routing = route(graph, GEOMETRIC)
    assert graph.degrees.max() == 14
    direction = half_features(graph).near.line
    for a, b in routing.alternatives[0][0].pairs:
        assert direction[a] @ direction[b] == pytest.approx(-1, abs=1e-3)
    assert len(routing.alternatives[0][0].pairs) == 7


@given(scribbles(12))
def test_routing_is_an_involution_inside_junctions(scribble, drawn: list[int]) -> None:
    graph, _ = scribble(drawn)
    routing = route(graph, GEOMETRIC)
    halves = np.arange(2 * graph.branch_count)
    assert (routing.partner[routing.partner] == halves).all()
    vertex = graph.half_vertex
    assert (vertex[routing.partner] == vertex).all()
    loop = graph.degrees[vertex] == 2
    assert (routing.partner[loop] == halves[loop] ^ 1).all()
    assert (routing.partner[graph.degrees[vertex] == 1] == halves[graph.degrees[vertex] == 1]).all()
    for ways in routing.alternatives:
        probability = [w.probability for w in ways]
        assert probability == sorted(probability, reverse=True)
        assert 0 < sum(probability) <= 1 + 1e-6


@given(scribbles())
def test_candidate_pairs_are_all_pairs_at_junctions(scribble, drawn: list[int]) -> None:
    graph, _ = scribble(drawn)
    pairs = {tuple(p) for p in candidate_pairs(graph).tolist()}
    vertex = graph.half_vertex
    every = {
        (a, b)
        for a in range(len(vertex))
        for b in range(a + 1, len(vertex))
        if vertex[a] == vertex[b]
    }
    assert pairs == every


def test_probabilities_are_those_of_all_involutions() -> None:
    graph, _ = graph_from_strokes([_line((0, 50), (100, 50)), _line((50, 0), (50, 100))])
    score = np.array([1.0, -2.0, 0.5, 0.3, -1.0, 2.0], np.float32)
    (ways,) = ranked_alternatives(graph, score)
    weight = np.exp(pair_matrix(4) @ score)
    best = np.sort(weight / weight.sum())[::-1]
    np.testing.assert_allclose([w.probability for w in ways], best[: len(ways)], rtol=1e-5)


def test_a_cross_runs_through_and_a_stem_ends() -> None:
    graph, truth = graph_from_strokes(
        [_line((0, 50), (100, 50)), _line((50, 0), (50, 100)), _line((20, 50), (20, 90))],
        widths=[3.0] * 3,
    )
    np.testing.assert_array_equal(route(graph, GEOMETRIC).partner, truth)


def test_lines_of_different_ink_are_not_joined() -> None:
    strokes = [_line((0, 50), (50, 50)), _line((50, 50), (100, 50)), _line((50, 50), (50, 100))]
    graph, _ = graph_from_strokes(
        strokes, widths=[3.0] * 3, colors=[(200, 20, 20), (20, 20, 20), (20, 20, 20)]
    )
    partner = route(graph, GEOMETRIC).partner
    red = [h for h in range(6) if graph.colors[graph.offsets[h >> 1] + 5, 0] > 100]
    joined = [h for h in red if partner[h] != h]
    assert not joined


@example(25, 0.4833, 1.0)  # two half-branches leave a junction in exactly one direction
@given(st.integers(0, 200), st.floats(0, 2 * np.pi), st.floats(0.5, 4))
def test_routing_ignores_where_how_large_and_which_way_round(
    scribble, seed: int, angle: float, size: float
) -> None:
    graph, _ = scribble(seed)
    turn = size * np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    moved = PlanarGraph(
        (graph.vertices @ turn + 7).astype(np.float32),
        (graph.points @ turn + 7).astype(np.float32),
        graph.offsets,
        graph.ends,
        np.float32(size) * graph.widths,
    )
    plain = PlanarGraph(graph.vertices, graph.points, graph.offsets, graph.ends, graph.widths)
    a, b = (route(g, GEOMETRIC).pair_score for g in (plain, moved))
    assert np.abs(a - b).max(initial=0) < 0.3


def test_a_blank_page_has_nothing_to_route() -> None:
    routing = route(PlanarGraph.empty(), GEOMETRIC)
    assert routing.partner.shape == (0,)
    assert routing.pairs.shape == (0, 2)
    assert routing.alternatives == ()


def test_fixed_pairs_are_kept_and_locked() -> None:
    graph, _ = graph_from_strokes([_line((0, 50), (100, 50)), _line((50, 0), (50, 100))])
    a, b, c, d = (int(h) for h in graph.halves_of(graph.junctions[0]))
    best = route(graph, GEOMETRIC).alternatives[0][0].pairs
    other = next(p for p in [((a, b), (c, d)), ((a, c), (b, d)), ((a, d), (b, c))] if p != best)
    routing = route(graph, GEOMETRIC, fixed={0: other})
    assert routing.locked.tolist() == [True]
    assert all(routing.partner[x] == y for x, y in other)
    assert other in [way.pairs for way in routing.alternatives[0]]


@pytest.mark.parametrize("pairs", [((0, 99),), ((0, 0),), ((0, 3), (3, 4))])
def test_fixed_pairs_must_fit_their_junction(pairs) -> None:
    graph, _ = graph_from_strokes([_line((0, 50), (100, 50)), _line((50, 0), (50, 100))])
    with pytest.raises(InvoluteError, match="half-branches"):
        route(graph, GEOMETRIC, fixed={0: pairs})


def test_an_unknown_junction_can_not_be_fixed() -> None:
    with pytest.raises(InvoluteError, match="no junction"):
        route(PlanarGraph.empty(), GEOMETRIC, fixed={0: ()})


@pytest.mark.parametrize("router", ["geometric", "network"])
def test_a_blue_line_does_not_go_on_as_a_black_one(router) -> None:
    arms = [_line((50, 50), (100, 50)), _line((50, 50), (0, 50)), _line((50, 50), (62, 100))]
    inks = [(20, 20, 20), (30, 60, 200), (20, 20, 20)]
    graph, _ = graph_from_strokes(arms, widths=[3.0] * 3, strength=[1.0] * 3, colors=inks)
    black = replace(graph, colors=np.full_like(graph.colors, 20))
    east, west, south = (int(h) for x in (1, -1, 0) for h in _halves_towards(graph, x))
    assert route(black, Settings(router=router)).partner[east] == west
    assert route(graph, Settings(router=router)).partner[west] == west
    assert route(graph, Settings(router=router)).partner[east] in (east, south)


def _halves_towards(graph: PlanarGraph, x: int) -> list[int]:
    """The half-branches that leave the only junction to the right (1), left (-1) or neither."""
    ways = [(h, graph.half_branch(h)) for h in graph.halves_of(graph.junctions[0])]
    return [h for h, points in ways if np.sign(np.trunc((points[-1] - points[0])[0] / 20)) == x]
