"""Distances to the paper."""

from __future__ import annotations

import numpy as np
from involute.engine.arrays.distance import depth
from scipy.ndimage import distance_transform_edt


def test_distances_are_exact_to_the_last_bit_wherever_they_lie_in_memory() -> None:
    kept = []  # so that every result lies at another address
    for size in range(60, 160):
        dark = (np.random.default_rng(size).random((size, size)) < 0.99).astype(np.uint8)
        kept.append(depth(dark))
        assert (kept[-1] == distance_transform_edt(dark).astype(np.float32)).all()


def test_a_page_without_paper_is_dark_everywhere() -> None:
    assert depth(np.ones((20, 30), np.uint8)).min() >= 50
