"""The routing network as the engine runs it: what it sees, what it decides, what it is told."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from involute.engine import InvoluteError, Settings, runtimes, weights
from involute.engine.routing import geometric, network, route
from involute.engine.routing.candidates import candidate_pairs
from involute.engine.routing.encoding import MAX_DEGREE, encode
from involute.engine.routing.windows import windows
from involute.engine.values import PlanarGraph
from involute.synthesis.true_graph import graph_from_strokes

from tests.engine.scribbles import scribbles

NETWORK = Settings(router="network")
Scribble = Callable[..., tuple[PlanarGraph, np.ndarray]]


def _scores(graph: PlanarGraph) -> dict[tuple[int, int], float]:
    pairs = candidate_pairs(graph)
    return dict(zip(map(tuple, pairs.tolist()), network.score(graph, pairs).tolist(), strict=True))


def _line(*points: tuple[float, float]) -> np.ndarray:
    corners = np.array(points, float)
    t = np.linspace(0, len(points) - 1, 30 * (len(points) - 1) + 1)
    return np.stack([np.interp(t, np.arange(len(points)), corners[:, c]) for c in (0, 1)], 1)


def _star(arms: int) -> PlanarGraph:
    angle = np.arange(arms) * 2 * np.pi / arms
    lines = [_line((100, 100), (100 + 60 * np.cos(a), 100 + 60 * np.sin(a))) for a in angle]
    return graph_from_strokes(lines)[0]


def _warped(graph: PlanarGraph) -> PlanarGraph:
    """The graph with all symmetry taken away."""

    def bend(points: np.ndarray) -> np.ndarray:
        return (points + 3 * np.sin(points[:, ::-1] / [23, 31] + [1, 2])).astype(np.float32)

    return replace(graph, vertices=bend(graph.vertices), points=bend(graph.points))


@given(scribbles(), st.floats(0, 6.28), st.floats(-500, 500))
@settings(max_examples=10)
def test_turning_and_moving_the_page_changes_nothing(
    scribble: Scribble, drawn: list[int], angle: float, shift: float
) -> None:
    graph = _warped(scribble(drawn)[0])
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    moved = replace(
        graph,
        vertices=(graph.vertices @ turn + shift).astype(np.float32),
        points=(graph.points @ turn + shift).astype(np.float32),
    )
    before, after = _scores(graph), _scores(moved)
    assert before.keys() == after.keys()
    # Rounding may decide a tie between two directions anew; the other pairs notice nothing.
    change = np.array([abs(before[pair] - after[pair]) for pair in before])
    assert not len(change) or np.median(change) < 0.02


@given(scribbles())
@settings(max_examples=10)
def test_the_direction_of_a_branch_does_not_matter(scribble: Scribble, drawn: list[int]) -> None:
    graph = _warped(scribble(drawn)[0])
    order = np.concatenate(
        [np.arange(a, b)[::-1] for a, b in zip(graph.offsets, graph.offsets[1:], strict=False)]
    )
    values = {name: getattr(graph, name)[order] for name in ("points", "widths", "strength")}
    backward = replace(graph, ends=graph.ends[:, ::-1].copy(), colors=graph.colors[order], **values)
    before, after = _scores(graph), _scores(backward)
    other = {(min(a ^ 1, b ^ 1), max(a ^ 1, b ^ 1)): value for (a, b), value in before.items()}
    change = np.array([abs(after[pair] - other[pair]) for pair in after])
    assert not len(change) or np.median(change) < 0.02


def test_a_crossing_runs_straight_and_a_stem_ends_at_its_bar() -> None:
    strokes = [_line((20, 60), (180, 60)), _line((60, 10), (60, 150)), _line((140, 60), (140, 150))]
    graph, partner = graph_from_strokes(strokes)
    routing = route(graph, NETWORK)
    np.testing.assert_array_equal(routing.partner, partner)


def test_a_shallow_crossing_of_curves_keeps_both_lines() -> None:
    t = np.linspace(0, 1, 80)
    strokes = [np.stack([20 + 260 * t, 100 + s * 60 * (t - 0.5) ** 3 * 8], 1) for s in (1, -1)]
    strokes[1][:, 1] += 40 * (t - 0.5)
    graph, partner = graph_from_strokes(strokes)
    assert len(graph.junctions) >= 1
    np.testing.assert_array_equal(route(graph, NETWORK).partner, partner)


def test_random_drawings_are_routed_better_than_by_geometry(scribble: Scribble) -> None:
    wrong = {"network": 0, "geometric": 0}
    for seed in range(30):
        graph, partner = scribble(seed, 12)
        for router in wrong:
            found = route(graph, Settings(router=router)).partner
            wrong[router] += int((found != partner).sum())
    assert wrong["network"] < wrong["geometric"]


def test_what_the_user_fixed_stays_and_is_seen(scribble: Scribble) -> None:
    graph, _ = scribble(3, 12)
    first = route(graph, NETWORK)
    fixed = {0: first.alternatives[0][1].pairs}
    again = route(graph, NETWORK, fixed)
    for a, b in fixed[0]:
        assert again.partner[a] == b
    assert again.locked[0]
    assert not np.array_equal(first.pair_score, again.pair_score)


def test_empty_slots_and_other_pages_sizes_change_no_score(scribble: Scribble) -> None:
    graph, _ = scribble(5, 10)
    narrow, wide = encode(graph), encode(graph, slots=MAX_DEGREE)
    slots = narrow.halves.shape[1]
    np.testing.assert_array_equal(narrow.halves, wide.halves[:, :slots])
    assert (wide.halves[:, slots:] == -1).all()
    np.testing.assert_array_equal(narrow.tokens, wide.tokens[:, :slots])
    np.testing.assert_array_equal(narrow.pairs, wide.pairs[:, :slots, :slots])


@given(scribbles(12), st.integers(2, 400))
@settings(max_examples=20, deadline=None)
def test_a_drawing_in_parts_is_the_whole_drawing(
    scribble: Scribble, drawn: list[int], most: int
) -> None:
    graph, _ = scribble(drawn)
    if not len(graph.junctions):
        return
    whole = encode(graph)
    places = graph.vertices[graph.half_vertex[whole.halves[:, 0]]]
    parts = list(windows(whole, places, most))
    rows = np.concatenate([window.rows for window in parts])
    assert sorted(rows.tolist()) == list(range(len(whole.halves)))
    for window in parts:
        part, few = window.part, window.slots
        own = (whole.halves[window.rows] >= 0).sum(1)
        assert len(own) == 1 or len(own) * own.max() ** 2 <= most
        np.testing.assert_array_equal(part.halves[: len(own)], whole.halves[window.rows, :few])
        # The other end of a branch is the other end of that branch, or out of sight.
        flat = np.append(part.halves.reshape(-1), -1)
        there = (part.halves >= 0) & (part.sibling < part.halves.size)
        np.testing.assert_array_equal(flat[part.sibling[there]], part.halves[there] ^ 1)


def test_one_part_is_all_of_a_small_drawing(scribble: Scribble) -> None:
    graph, _ = scribble(5, 10)
    whole = encode(graph)
    (window,) = windows(whole, graph.vertices[graph.half_vertex[whole.halves[:, 0]]])
    for name in ("halves", "tokens", "pairs", "sibling"):
        np.testing.assert_array_equal(getattr(window.part, name), getattr(whole, name))


def test_a_stem_that_tapers_or_fades_towards_its_junction_is_seen() -> None:
    graph, _ = graph_from_strokes([_line((20, 60), (180, 60)), _line((100, 60), (100, 150))])
    flat = np.full(len(graph.points), 4.0, np.float32)
    below = graph.points[:, 1] - 60
    thin = (flat * np.clip(0.3 + below / 20, 0, 1)).astype(np.float32)
    inks = {
        "plain": replace(graph, widths=flat, strength=flat / 8),
        "unknown": replace(graph, widths=None, strength=None),
        "tapered": replace(graph, widths=np.where(below > 0, thin, flat), strength=flat / 8),
        "faded": replace(graph, widths=flat, strength=np.where(below > 0, thin, flat) / 8),
    }
    encoded = {name: encode(ink) for name, ink in inks.items()}
    rise = {name: e.tokens[0, :, -2:] for name, e in encoded.items()}
    stem = graph.points[graph.offsets[1:] - 1, 1][encoded["plain"].halves[0] >> 1] > 100
    assert stem.sum() == 1
    np.testing.assert_allclose(rise["plain"], 0, atol=1e-5)
    np.testing.assert_array_equal(rise["unknown"], 0)
    assert rise["tapered"][stem, 0] < -0.5
    assert rise["faded"][stem, 1] < -0.5
    np.testing.assert_allclose(rise["tapered"][~stem], 0, atol=0.02)


def test_a_star_of_too_many_arms_gets_its_geometric_score() -> None:
    graph = _star(MAX_DEGREE + 1)
    pairs = candidate_pairs(graph)
    np.testing.assert_array_equal(network.score(graph, pairs), geometric.score(graph, pairs))


@pytest.mark.parametrize("arms", range(3, MAX_DEGREE + 1))
def test_every_degree_gets_finite_scores(arms: int) -> None:
    graph = _star(arms)
    assert np.isfinite(network.score(graph, candidate_pairs(graph))).all()


@pytest.mark.parametrize("seed", [3, 8])
def test_numpy_makes_of_the_weights_what_opencv_does(scribble: Scribble, seed: int) -> None:
    encoding = encode(scribble(seed, 14)[0])
    given = (encoding.tokens, encoding.pairs, encoding.sibling, encoding.mask)
    found = network.load(weights.FOLDER)[0](*given)
    opencv = runtimes.RUNTIMES[-1].load(weights.read(weights.FOLDER / "routing.onnx"))
    inputs = dict(zip(("tokens", "pairs", "sibling", "mask"), given, strict=True))
    inputs["sibling"] = encoding.sibling.reshape(-1).astype(np.int64)
    filled = encoding.halves >= 0
    there = filled[:, :, None] & filled[:, None]
    assert len(encoding.halves) > 5
    np.testing.assert_allclose(found[there], opencv(inputs, 1)[0][there], atol=1e-4)
    assert not found[~there].any()


def test_a_page_without_junctions_has_no_scores() -> None:
    graph, _ = graph_from_strokes([_line((0, 0), (50, 10))])
    assert len(network.score(graph, candidate_pairs(graph))) == 0
    assert len(network.score(PlanarGraph.empty(), np.zeros((0, 2), np.int32))) == 0


def test_missing_or_damaged_weights_are_said_in_a_sentence(tmp_path: Path) -> None:
    with pytest.raises(InvoluteError, match="routing network"):
        network.load(tmp_path)
    (tmp_path / "routing.json").write_text("{}")
    (tmp_path / "routing.onnx").write_bytes(b"no network")
    with pytest.raises(InvoluteError, match="routing network"):
        network.load(tmp_path)


def test_any_number_of_threads_gives_the_same_scores() -> None:
    """NumPy's matrix products round by how many threads share the work."""
    program = """
import os
import cv2
import numpy as np
from involute.engine import Settings
from involute.engine.routing import route
from involute.synthesis.true_graph import graph_from_strokes
cv2.setNumThreads(int(os.environ["OMP_NUM_THREADS"]))
for seed in range(8):
    ends = np.random.default_rng(seed).uniform(10, 390, (6 + 4 * seed, 2, 2))
    graph, _ = graph_from_strokes([np.linspace(a, b, 60) for a, b in ends])
    print(route(graph, Settings(router="network")).pair_score.tobytes().hex())
"""

    def scores(threads: int) -> str:
        surroundings = {**os.environ, "OMP_NUM_THREADS": str(threads)}
        command = [sys.executable, "-c", program]
        done = subprocess.run(command, env=surroundings, capture_output=True, text=True, check=True)
        return done.stdout

    assert scores(1) == scores(2) == scores(3)
