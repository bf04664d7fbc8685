"""The two stages that ask for the best involution get the same answer."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from involute.engine.graph.continuations import pairs_within
from involute.engine.involution import LARGEST_EXACT, best_matching, least_cost

ALONE = 1.0


@given(st.lists(st.integers(1, LARGEST_EXACT), min_size=1, max_size=4), st.data())
def test_the_cheapest_pairs_are_the_best_matching(sizes: list[int], data: st.DataObject) -> None:
    group = np.repeat(np.arange(len(sizes)), sizes)
    pairs = pairs_within(group)
    # Whole hundredths: no two ways cost almost the same.
    cents = st.lists(st.integers(0, 300), min_size=len(pairs), max_size=len(pairs))
    cost = np.array(data.draw(cents), float) / 100
    chosen = least_cost(group, pairs, cost, ALONE)
    assert np.bincount(pairs[chosen].ravel(), minlength=len(group)).max() <= 1
    saved = 0.0
    for k in range(len(sizes)):
        mine = group[pairs[:, 0]] == k
        score = np.zeros((len(group), len(group)))
        a, b = pairs[mine].T
        score[a, b] = score[b, a] = 2 * ALONE - cost[mine]
        partner = best_matching(score)
        saved += score[np.arange(len(group)), partner].sum() / 2
    assert np.isclose((2 * ALONE - cost[chosen]).sum(), saved)
