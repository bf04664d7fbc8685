"""Distances to the paper."""

from __future__ import annotations

import cv2
import numpy as np
from involute.engine.arrays.distance import depth, may_be_deeper
from scipy.ndimage import distance_transform_edt


def test_distances_are_exact_to_the_last_bit_wherever_they_lie_in_memory() -> None:
    kept = []  # so that every result lies at another address
    for size in range(60, 160):
        dark = (np.random.default_rng(size).random((size, size)) < 0.99).astype(np.uint8)
        kept.append(depth(dark))
        assert (kept[-1] == distance_transform_edt(dark).astype(np.float32)).all()


def test_a_page_without_paper_is_dark_everywhere() -> None:
    assert depth(np.ones((20, 30), np.uint8)).min() >= 50


def test_where_no_depth_is_expected_there_is_none() -> None:
    told = []
    for seed in range(60):
        rng = np.random.default_rng(seed)
        dark = np.zeros((60, 70), np.uint8)
        for _ in range(3):
            a, b = rng.integers(-5, 75, (2, 2)).tolist()
            cv2.line(dark, a, b, 1, int(rng.integers(1, 14)))
        deepest = float(depth(dark).max())
        for radius in (deepest - 0.01, deepest / 2):
            assert may_be_deeper(dark, radius)
        told.append(not may_be_deeper(dark, 1.5 * deepest + 1))
    assert all(told)
    assert may_be_deeper(np.ones((20, 30), np.uint8), 40.0)
