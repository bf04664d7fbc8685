"""Rows of different lengths in one array."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from involute.engine.arrays import ragged

sizes = st.lists(st.integers(0, 7), max_size=9)


@given(sizes)
def test_rows_count_up_and_know_their_owner(counts: list[int]) -> None:
    offsets = ragged.offsets_of(counts)
    rows = [np.arange(n) for n in counts]
    joined = np.concatenate([np.zeros(0, int), *rows])
    assert np.array_equal(ragged.count_up(np.array(counts, int)), joined)
    assert offsets[-1] == sum(counts)
    owners = np.concatenate([np.zeros(0, int), *(np.full(n, k) for k, n in enumerate(counts))])
    assert np.array_equal(ragged.owners(offsets), owners)
    first = np.arange(len(counts)) * 10
    assert np.array_equal(ragged.ranges(first, np.array(counts, int)), joined + 10 * owners)


lines = st.lists(
    arrays(np.float64, st.tuples(st.integers(2, 6), st.just(2)), elements=st.floats(-50, 50)),
    min_size=1,
    max_size=5,
)


@given(lines)
def test_one_axis_holds_all_lines(polylines: list[np.ndarray]) -> None:
    points, offsets = np.concatenate(polylines), ragged.offsets_of([len(p) for p in polylines])
    axis = ragged.end_to_end(points, offsets)
    for line, first, last in zip(polylines, offsets[:-1], offsets[1:], strict=True):
        assert np.allclose(axis[first:last] - axis[first], ragged.arc(line), atol=1e-9)
    assert np.allclose(np.diff(axis)[offsets[1:-1] - 1], 1.0)


@given(lines)
def test_places_along_a_line(polylines: list[np.ndarray]) -> None:
    line = polylines[0]
    way = ragged.arc(line)
    assert np.allclose(ragged.along(line, way[[0, -1]]), line[[0, -1]])
    assert np.allclose(ragged.along(line, np.array([-1.0, way[-1] + 1])), line[[0, -1]])


def test_nothing_has_no_steps() -> None:
    assert len(ragged.steps(np.zeros((0, 2)), np.zeros(1, int))) == 0
