"""The one list of passes: their order, what they say of themselves, and what they keep of it."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from involute.engine import Settings
from involute.engine.centerline import provider_for
from involute.engine.errors import InvoluteError
from involute.engine.graph import PASSES, Evidence, run_passes, traced
from involute.engine.graph.passes import ROUTED
from involute.engine.graph.smoothing import even
from involute.engine.routing import route
from involute.engine.values import PlanarGraph, Scan

SETTINGS = Settings(router="geometric")
NAMES = [one.name for one in PASSES]
ORDER = [
    "skeleton", "forks", "spurs", "rungs", "tips", "bends", "junctions", "spacing", "ends",
    "dashes", "gaps", "smoothing", "joining", "undrawn", "planarity", "page", "measure", "pencil",
    "measure-inked", "dust", "stubs", "measure-strokes", "lifts",
]  # fmt: skip


def page_of(seed: int, count: int, size: int = 160) -> Evidence:
    """Pen strokes on a page, and what the classical provider sees of them."""
    rng = np.random.default_rng(seed)
    ink = np.zeros((size, size), np.uint8)
    for _ in range(count):
        line = rng.uniform(8, size - 8, (3, 2)) * 16
        cv2.polylines(ink, [np.rint(line).astype(np.int32)], False, 255, 3, cv2.LINE_AA, 4)
    scan = Scan(ink.astype(np.float32) / 255, None, 1.0, (size, size), 3.0)
    maps = provider_for(Settings(provider="classical"))(scan, lambda fraction: None)
    return Evidence.of(scan, maps)


def test_the_order_of_the_passes() -> None:
    assert ORDER == NAMES


@pytest.mark.parametrize("one", PASSES, ids=NAMES)
def test_every_pass_says_what_it_reads_and_promises(one) -> None:
    lines = [line.strip() for line in (one.run.__doc__ or "").splitlines()]
    assert [line.split(":")[0] for line in lines if ": " in line[:12]] == ["Reads", "Promises"]


@settings(max_examples=15, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 9))
@example(324, 7)
def test_every_pass_keeps_its_promises(seed: int, count: int) -> None:
    page, graph = page_of(seed, count), None
    for here, following in zip(NAMES, [*NAMES[1:], None], strict=True):
        if here == ROUTED and graph is not None:
            page = page.routed(route(graph, SETTINGS).partner)
        graph = run_passes(page, SETTINGS, graph, start=here, until=following)
        ends = [graph.points[graph.offsets[:-1]], graph.points[graph.offsets[1:] - 1]]
        assert np.array_equal(np.stack(ends, 1), graph.vertices[graph.ends])
        assert np.diff(graph.offsets).min(initial=2) >= 2
        if here in ("spacing", "smoothing"):
            again = even(graph)
            # A fold of few px is shorter between its new points: one point, and another half.
            assert np.abs(np.diff(graph.offsets) - np.diff(again.offsets)).max(initial=0) <= 2
        if here in ("spurs", "rungs", "joining", "undrawn", "planarity"):
            assert np.isin(np.flatnonzero(graph.degrees == 2), rings(graph)).all()
        if ORDER.index(here) >= ORDER.index("page"):
            assert (graph.points >= 0).all()
            assert (graph.points <= page.shape[::-1]).all()
        if here.startswith("measure"):
            assert graph.branch_count == 0 or len(graph.widths) == len(graph.points)


def rings(graph: PlanarGraph) -> np.ndarray:
    return graph.ends[graph.ends[:, 0] == graph.ends[:, 1], 0]


@pytest.mark.parametrize("name", [one.name for one in PASSES if one.optional])
def test_any_optional_pass_can_be_left_out(name: str) -> None:
    graph, routing = traced(page_of(3, 8), SETTINGS, route, without=[name])
    assert graph.branch_count > 8
    assert len(routing.partner) == 2 * graph.branch_count


def test_a_list_cut_in_two_is_the_whole_list() -> None:
    page = page_of(5, 9)
    whole = run_passes(page, SETTINGS)
    halves = run_passes(page, SETTINGS, run_passes(page, SETTINGS, until="gaps"), start="gaps")
    assert np.array_equal(whole.points, halves.points)
    assert np.array_equal(whole.ends, halves.ends)


@pytest.mark.parametrize("cut", [{"until": "blobs"}, {"start": "x"}, {"without": ["measure"]}])
def test_passes_that_are_none(cut: dict) -> None:
    with pytest.raises(InvoluteError):
        run_passes(page_of(1, 1), SETTINGS, **cut)


def test_a_blank_page_has_an_empty_graph() -> None:
    graph, routing = traced(page_of(0, 0), SETTINGS, route)
    assert graph.branch_count == len(routing.partner) == 0
