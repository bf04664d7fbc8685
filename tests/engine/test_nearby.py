"""Near points: all pairs within reach, found by cells."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from involute.engine.graph.nearby import near_between


@settings(deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(0, 40), st.integers(0, 60), st.floats(0.5, 30))
def test_all_pairs_within_reach_are_found_and_no_others(seed, some, others, reach):
    rng = np.random.default_rng(seed)
    a, b = (rng.uniform(-50, 50, (count, 2)) for count in (some, others))
    one, other = near_between(a, b, reach)
    away = np.hypot(*(a[:, None] - b[None]).transpose(2, 0, 1))
    expected = set(zip(*np.nonzero(away <= reach), strict=True))
    assert len(one) == len(set(zip(one.tolist(), other.tolist(), strict=True)))
    assert set(zip(one.tolist(), other.tolist(), strict=True)) == {
        (int(i), int(j)) for i, j in expected
    }
