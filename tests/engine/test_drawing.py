"""The drawing: rerouting changes what it must and nothing else."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from involute.engine import Drawing, InvoluteError, Settings
from involute.engine.drawing import DOUBTFUL
from involute.engine.routing import network, route
from involute.engine.values import Scan

from tests.engine.scribbles import scribbles

GEOMETRIC = Settings(router="geometric", min_length=0.0)


def _drawing(scribble, drawn: int | list[int], count: int = 8, scale: float = 1.0) -> Drawing:
    graph, _ = scribble(drawn, count)
    scan = Scan(np.zeros((200, 200), np.float32), None, scale, (200, 200), 3.0)
    ring = np.array([[0, 0], [10, 0], [10, 10]], np.float32)
    return Drawing.from_routing(graph, route(graph, GEOMETRIC), scan, GEOMETRIC, [(ring,)])


def _same(a: Drawing, b: Drawing) -> None:
    assert len(a.strokes) == len(b.strokes)
    for s, t in zip(a.strokes, b.strokes, strict=True):
        np.testing.assert_array_equal(s.branches, t.branches)
        np.testing.assert_array_equal(s.points, t.points)
        np.testing.assert_array_equal(s.widths, t.widths)
        assert (s.closed, s.color) == (t.closed, t.color)


def _some_way(halves: tuple[int, ...], rng: np.random.Generator) -> list[tuple[int, int]]:
    order = rng.permutation(halves).tolist()
    count = int(rng.integers(0, len(order) // 2 + 1))
    return [(order[2 * k], order[2 * k + 1]) for k in range(count)]


@given(scribbles(), st.integers(0, 2**32 - 1))
def test_reroutes_and_their_inverses_give_the_same_strokes(
    scribble, drawn: list[int], luck: int
) -> None:
    first = drawing = _drawing(scribble, drawn)
    rng = np.random.default_rng(luck)
    steps = []
    for _ in range(6):
        if not drawing.junctions:
            return
        junction = drawing.junctions[rng.integers(len(drawing.junctions))]
        steps.append((junction.index, junction.pairs))
        drawing = drawing.reroute(junction.index, _some_way(junction.half_branches, rng))
        fresh = {id(s) for s in drawing.strokes}
        assert len(fresh) == len(drawing.strokes)
    for index, pairs in reversed(steps):
        drawing = drawing.reroute(index, pairs)
    _same(first, drawing)


@given(scribbles(), st.integers(0, 2**32 - 1))
def test_a_reroute_touches_only_the_strokes_through_its_junction(scribble, drawn, luck) -> None:
    before = _drawing(scribble, drawn)
    if not before.junctions:
        return
    rng = np.random.default_rng(luck)
    junction = before.junctions[rng.integers(len(before.junctions))]
    after = before.reroute(junction.index, _some_way(junction.half_branches, rng))
    here = {half >> 1 for half in junction.half_branches}
    old = {id(s) for s in before.strokes}
    for stroke in before.strokes:
        if here.isdisjoint((stroke.branches >> 1).tolist()):
            assert any(stroke is s for s in after.strokes)
    for stroke in after.strokes:
        if id(stroke) not in old:
            assert not here.isdisjoint((stroke.branches >> 1).tolist())
    branches = np.concatenate([s.branches >> 1 for s in after.strokes])
    assert sorted(branches.tolist()) == list(range(before.graph.branch_count))
    # The strokes of a reroute are those of the same routing made at once.
    scan = Scan(np.zeros((1, 1), np.float32), None, 1.0, (200, 200), 3.0)
    _same(after, Drawing.from_routing(before.graph, after.routing, scan, GEOMETRIC))


def test_what_the_user_routed_is_locked_and_survives_asking_again(scribble) -> None:
    drawing = _drawing(scribble, 4, 10)
    junction = drawing.junctions[0]
    other = junction.alternatives[1].pairs
    changed = drawing.reroute(0, other)
    assert changed.junctions[0].locked
    assert changed.junctions[0].pairs == other
    assert changed.junctions[0].doubt == 0
    again = changed.ask_again()
    assert again.junctions[0].pairs == other
    assert again.junctions[0].locked
    freed = again.unlock(0).ask_again()
    assert freed.junctions[0].pairs == junction.pairs
    _same(freed, drawing)


def test_asking_again_judges_lengths_as_the_trace_did(scribble) -> None:
    drawing = _drawing(scribble, 4, 10, scale=3.5)
    _same(drawing, drawing.ask_again())
    np.testing.assert_allclose(
        drawing.ask_again().routing.pair_score, drawing.routing.pair_score, atol=0.02
    )


def test_drawings_are_in_input_pixels(scribble) -> None:
    small, large = _drawing(scribble, 7), _drawing(scribble, 7, scale=2.0)
    np.testing.assert_allclose(large.graph.vertices, 2 * small.graph.vertices, rtol=1e-6)
    np.testing.assert_allclose(large.fills[0][0], 2 * small.fills[0][0])
    assert len(small.strokes) == len(large.strokes)
    for a, b in zip(small.strokes, large.strokes, strict=True):
        assert b.widths.mean() == pytest.approx(2 * a.widths.mean(), rel=1e-3)
    assert large.junctions[0].position == pytest.approx(
        tuple(2 * x for x in small.junctions[0].position), rel=1e-5
    )


def test_doubtful_are_the_junctions_whose_answer_matters_the_most_costly_first(scribble) -> None:
    drawing = _drawing(scribble, 11, 12)
    assert drawing.graph.widths is not None
    least = DOUBTFUL * np.median(drawing.graph.widths)
    asked = list(drawing.doubtful)
    assert (np.diff(drawing.costs[asked]) <= 0).all()
    assert sorted(asked) == np.flatnonzero(drawing.costs >= least).tolist()
    assert all(drawing.costs[j.index] == 0 for j in drawing.junctions if j.doubt == 0)
    sure = drawing.accept_above(0.6)
    for before, after in zip(drawing.junctions, sure.junctions, strict=True):
        assert after.locked == (1 - before.doubt >= 0.6)
    assert not set(sure.doubtful) & {j.index for j in sure.junctions if j.locked}
    assert all(a is b for a, b in zip(drawing.strokes, sure.strokes, strict=True))


def test_locks_change_nothing_else(scribble) -> None:
    drawing = _drawing(scribble, 2)
    locked = drawing.lock(1)
    assert locked.junctions[1].locked
    assert not drawing.junctions[1].locked
    assert not locked.unlock(1).junctions[1].locked
    assert locked.strokes is drawing.strokes


@pytest.mark.parametrize("junction", [-1, 10_000])
def test_unknown_junctions_are_refused(scribble, junction: int) -> None:
    drawing = _drawing(scribble, 2)
    for change in (lambda: drawing.reroute(junction, []), lambda: drawing.lock(junction)):
        with pytest.raises(InvoluteError, match="no junction"):
            change()


def test_pairs_of_other_junctions_are_refused(scribble) -> None:
    drawing = _drawing(scribble, 2)
    foreign = drawing.junctions[1].half_branches[0]
    own = drawing.junctions[0].half_branches
    for pairs in ([(own[0], foreign)], [(own[0], own[1]), (own[1], own[2])], [(own[0], own[0])]):
        with pytest.raises(InvoluteError, match="half-branches"):
            drawing.reroute(0, pairs)


def test_a_saved_drawing_reroutes_like_the_one_in_memory(scribble, tmp_path) -> None:
    drawing = _drawing(scribble, 5)
    path = tmp_path / "drawing.json"
    drawing.save(path)
    loaded = Drawing.load(path)
    _same(drawing, loaded)
    way = drawing.junctions[0].alternatives[1].pairs
    _same(drawing.reroute(0, way), loaded.reroute(0, way))
    assert loaded.scale == drawing.scale


def test_a_blank_page_is_an_empty_drawing() -> None:
    from involute.engine.values import PlanarGraph

    scan = Scan(np.zeros((20, 20), np.float32), None, 1.0, (20, 20), 3.0)
    graph = PlanarGraph.empty()
    drawing = Drawing.from_routing(graph, route(graph, GEOMETRIC), scan, GEOMETRIC)
    assert drawing.strokes == ()
    assert drawing.junctions == ()
    assert drawing.doubtful == ()
    assert drawing.ask_again().strokes == ()


@pytest.mark.skipif(not network.available(), reason="needs the routing network")
def test_a_decision_teaches_its_neighbours_and_taking_it_back_unteaches_them(scribble) -> None:
    graph, _ = scribble(7, 12)
    settings = Settings(router="network", min_length=0.0)
    scan = Scan(np.zeros((200, 200), np.float32), None, 1.0, (200, 200), 3.0)
    drawing = Drawing.from_routing(graph, route(graph, settings), scan, settings)
    number = max(drawing.junctions, key=lambda j: j.degree).index
    other = drawing.place(number).alternatives[1].pairs
    decided = drawing.reroute(number, other)
    asked = decided.ask_around(drawing)
    assert asked.place(number).pairs == other
    assert asked.place(number).locked
    np.testing.assert_allclose(asked.doubts, [j.doubt for j in asked.junctions], atol=1e-12)
    changed = np.flatnonzero(asked.routing.pair_score != decided.routing.pair_score)
    assert len(changed) < len(asked.routing.pairs)
    for place in asked.junctions:
        if not place.locked and place.alternatives != drawing.place(place.index).alternatives:
            assert place.pairs == place.alternatives[0].pairs
    back = asked.unlock(number).ask_around(asked)
    np.testing.assert_allclose(back.routing.pair_score, drawing.routing.pair_score, atol=1e-4)
    assert drawing.ask_around(drawing) is drawing
