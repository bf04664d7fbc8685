"""Drawings for tests, made from strokes whose true course is known."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import settings
from involute.engine.values import PlanarGraph
from involute.synthesis.true_graph import graph_from_strokes

# The machine's speed is no property of the code.
settings.register_profile("engine", deadline=None, max_examples=40)
settings.load_profile("engine")


def _random_strokes(seed: int, count: int) -> list[np.ndarray]:
    """Lines, arcs, waves, circles and lines that end on others, on a page of 200 px."""
    rng = np.random.default_rng(seed)
    strokes: list[np.ndarray] = []
    for _ in range(count):
        t = np.linspace(0, 1, 40)[:, None]
        a, b = rng.uniform(10, 190, (2, 2))
        kind = rng.integers(4)
        if kind == 0 and strokes:
            other = strokes[rng.integers(len(strokes))]
            a = other[rng.integers(len(other))]
        if kind == 1:
            angle = 2 * np.pi * t
            strokes.append(a + rng.uniform(8, 40) * np.hstack([np.cos(angle), np.sin(angle)]))
            continue
        across = np.array([a[1] - b[1], b[0] - a[0]])
        strokes.append(a + t * (b - a) + rng.uniform(0, 0.2) * np.sin(4 * t) * across)
    return strokes


@pytest.fixture(scope="session")
def scribble() -> Callable[..., tuple[PlanarGraph, np.ndarray]]:
    """(seed, count) -> a planar graph with 3 px wide lines, and its true involution."""

    def make(seed: int, count: int = 8) -> tuple[PlanarGraph, np.ndarray]:
        strokes = _random_strokes(seed, count)
        return graph_from_strokes(
            strokes, widths=[3.0] * count, strength=[1.0] * count, colors=[(20, 20, 20)] * count
        )

    return make
