"""What did not move from one frame to the next is joined and ended alike."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from involute.engine import Drawing, Settings, vectorize
from involute.engine.arrays.ragged import along, arc
from involute.engine.routing import route
from involute.engine.sequence.follow import Follower
from involute.engine.sequence.steady import steadied
from involute.engine.values import Scan, Stroke
from involute.synthesis.true_graph import graph_from_strokes
from scipy.spatial import cKDTree

GEOMETRIC = Settings(router="geometric", min_length=0.0)
EXAMPLES = Path(__file__).parents[2] / "examples"


def drawn(lines: Sequence[Sequence[tuple[float, float]]]) -> Drawing:
    count = len(lines)
    graph, _ = graph_from_strokes(
        [np.array(line, float) for line in lines],
        widths=[3.0] * count,
        strength=[1.0] * count,
        colors=[(20, 20, 20)] * count,
    )
    scan = Scan(np.zeros((300, 300), np.float32), None, 1.0, (300, 300), 3.0)
    return Drawing.from_routing(graph, route(graph, GEOMETRIC), scan, GEOMETRIC)


def moved(strokes: Sequence[Stroke], by: tuple[float, float]) -> list[Stroke]:
    return [replace(s, points=s.points + np.float32(by)) for s in strokes]


def courses(strokes: Sequence[Stroke]) -> set[frozenset[int]]:
    return {frozenset((s.branches >> 1).tolist()) for s in strokes}


def off(stroke: Stroke, point: tuple[float, float]) -> float:
    return float(cKDTree(dense(stroke)).query(point)[0])


def dense(stroke: Stroke) -> np.ndarray:
    line = np.vstack([stroke.points, stroke.points[:1]]) if stroke.closed else stroke.points
    whole = arc(line)[-1]
    return along(line, np.linspace(0, whole, max(2, int(whole) + 1)))


GRID = [[(20, y), (280, y + 9)] for y in (60, 120, 180, 240)] + [
    [(x, 20), (x + 12, 280)] for x in (50, 110, 170, 230)
]


@given(st.integers(0, 2**32 - 1))
def test_every_junction_is_routed_as_in_the_frame_before(luck):
    drawing = before = drawn(GRID)
    rng = np.random.default_rng(luck)
    for junction in drawing.junctions:
        order = rng.permutation(junction.half_branches).tolist()
        count = int(rng.integers(0, 3))
        before = before.reroute(
            junction.index, [(order[2 * k], order[2 * k + 1]) for k in range(count)]
        )
    found = steadied(drawing, moved(before.strokes, (0.7, -0.6)))
    np.testing.assert_array_equal(found.routing.partner, before.routing.partner)
    assert courses(found.strokes) == courses(before.strokes)
    # What the picture itself says of it can still be seen.
    for own, here in zip(drawing.junctions, found.junctions, strict=True):
        assert own.alternatives[0] == here.alternatives[0]
        assert here.pairs in [way.pairs for way in here.alternatives]
        assert not here.locked


def test_a_line_that_ended_and_began_anew_does_so_again():
    drawing = drawn(GRID)
    before = drawing.cut(0, (80.0, 62.0))
    found = steadied(drawing, moved(before.strokes, (0.5, 0.5)))
    assert len(found.strokes) == len(before.strokes) == len(drawing.strokes) + 1
    ends = np.array([p for s in found.strokes for p in (s.points[0], s.points[-1])])
    assert (np.hypot(*(ends - (80, 62)).T) < 3).sum() == 2


def test_a_gap_that_was_bridged_is_bridged_again():
    broken = drawn([*GRID[1:], [(20, 60), (70, 62)], [(77, 62), (280, 69)]])
    whole = drawn([*GRID[1:], [(20, 60), (70, 62), (77, 62), (280, 69)]])
    assert len(broken.strokes) == len(whole.strokes) + 1
    found = steadied(broken, whole.strokes)
    assert len(found.strokes) == len(whole.strokes)
    assert steadied(broken, broken.strokes).strokes == broken.strokes


@pytest.mark.parametrize("cuts", [[70], [82], [70, 82]])
def test_a_gap_that_is_seen_as_a_line_now_is_one_again(cuts):
    # The pen faded there: what is seen in the gap ends at corners, through which a line runs.
    whole = drawn([*GRID[1:], [(20, 60), (280, 69)]])
    broken = drawn([*GRID[1:], [(20, 60), (70, 61.7)], [(82, 62.1), (280, 69)]])
    for x in cuts:
        line = next(k for k, s in enumerate(whole.strokes) if off(s, (x, 62)) < 1)
        whole = whole.cut(line, (x, 62.0))
    for corner in whole.corners:
        whole = whole.reroute(corner.index, [corner.half_branches]).unlock(corner.index)
    assert len(whole.strokes) == len(GRID)
    found = steadied(whole, moved(broken.strokes, (0.4, -0.3)))
    assert len(found.strokes) == len(GRID) + 1
    assert not any(off(s, (60, 61)) < 3 and off(s, (95, 63)) < 3 for s in found.strokes)


def test_what_moved_or_was_decided_by_hand_stays_as_it_is():
    drawing = drawn(GRID)
    junction = drawing.junctions[5]
    before = drawing.reroute(junction.index, [])
    elsewhere = drawn(
        [[(y, x) for x, y in line[:1]] + [(x + 31, y) for x, y in line[1:]] for line in GRID]
    )
    assert (
        steadied(drawing, elsewhere.strokes).routing.partner.tolist()
        == drawing.routing.partner.tolist()
    )
    locked = drawing.lock(junction.index)
    found = steadied(locked, before.strokes)
    assert found.junctions[junction.index].pairs == junction.pairs
    assert steadied(drawing, []) is drawing


def found_again(first: Sequence[Stroke], second: Sequence[Stroke], least: float = 12.0) -> float:
    """The share of strokes, one to one: 2.5 px apart on average, lengths within a fifth."""
    here, there = ([dense(s) for s in strokes] for strokes in (first, second))
    here = sorted((line for line in here if len(line) >= least), key=len, reverse=True)
    trees, left, hits = [cKDTree(line) for line in there], set(range(len(there))), 0
    for line in here:
        tree = cKDTree(line)
        like = [k for k in left if abs(len(there[k]) - len(line)) <= 0.2 * max(len(line), 20)]
        off = {k: max(trees[k].query(line)[0].mean(), tree.query(there[k])[0].mean()) for k in like}
        best = min(off, key=off.__getitem__, default=None)
        if best is not None and off[best] <= 2.5:
            left.discard(best)
            hits += 1
    return hits / max(len(here), 1)


def test_two_scans_of_one_cel_give_more_of_the_same_strokes():
    picture = cv2.imread(str(EXAMPLES / "max_und_moritz.jpg"), cv2.IMREAD_GRAYSCALE)
    picture = picture[200:600, 200:600]
    scans = []
    for seed in (1, 2):
        noise = np.random.default_rng(seed).normal(0, 4, picture.shape)
        scans.append(np.clip(picture + noise, 0, 255).astype(np.uint8))
    one, other = (vectorize(scan, turn=False) for scan in scans)
    follower = Follower()
    first, second = follower(one), follower(other)
    lost, left = (1 - found_again(a.strokes, b.strokes) for a, b in ((one, other), (first, second)))
    assert lost > 0.12
    assert left < 0.8 * lost
