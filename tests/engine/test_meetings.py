"""Curves of one cluster are compared where they come near each other, and only there."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from involute.engine.graph.continuations import SAMPLES, pairs_within
from involute.engine.graph.junctions import _close_by
from involute.engine.graph.limits import LIMITS


@given(st.integers(0, 2**32 - 1), st.integers(2, 40))
def test_only_curves_that_can_not_meet_are_left_out(seed, count):
    random = np.random.default_rng(seed)
    start, way = random.uniform(0, 90, (count, 1, 2)), random.normal(0, 15, (count, 1, 2))
    curves = start + way * np.linspace(0, 1, SAMPLES)[None, :, None]
    pairs = pairs_within(np.zeros(count, np.int64))
    left = {tuple(pair) for pair in _close_by(curves, pairs).tolist()}
    for a, b in pairs.tolist():
        apart = np.hypot(*np.moveaxis(curves[a][:, None] - curves[b][None], -1, 0)).min()
        if apart < LIMITS.junction_stray:
            assert (a, b) in left


def test_few_are_compared_in_a_large_cluster():
    count = 900
    place = np.stack(np.divmod(np.arange(count), 30), -1)[:, None] * 40.0
    curves = place + np.linspace(0, 20, SAMPLES)[None, :, None]
    assert len(_close_by(curves, pairs_within(np.zeros(count, np.int64)))) == 0
