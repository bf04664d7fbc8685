"""Drawings for tests, made from strokes whose true course is known."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pytest
from involute.engine.values import PlanarGraph
from involute.synthesis.true_graph import graph_from_strokes


def _stroke(rng: np.random.Generator, drawn: list[np.ndarray]) -> np.ndarray:
    """A line, an arc, a wave, a circle or a line that ends on another, on a page of 200 px."""
    t = np.linspace(0, 1, 40)[:, None]
    a, b = rng.uniform(10, 190, (2, 2))
    kind = rng.integers(4)
    if kind == 0 and drawn:
        other = drawn[rng.integers(len(drawn))]
        a = other[rng.integers(len(other))]
    if kind == 1:
        angle = 2 * np.pi * t
        return a + rng.uniform(8, 40) * np.hstack([np.cos(angle), np.sin(angle)])
    across = np.array([a[1] - b[1], b[0] - a[0]])
    return a + t * (b - a) + rng.uniform(0, 0.2) * np.sin(4 * t) * across


@pytest.fixture(scope="session")
def scribble() -> Callable[..., tuple[PlanarGraph, np.ndarray]]:
    """(numbers of strokes, see `scribbles`) or (seed, count) -> a planar graph with 3 px wide
    lines, and its true involution."""

    def make(drawn: int | Sequence[int], count: int = 8) -> tuple[PlanarGraph, np.ndarray]:
        if isinstance(drawn, int):
            pens = [np.random.default_rng(drawn)] * count
        else:
            pens = [np.random.default_rng(number) for number in drawn]
        strokes: list[np.ndarray] = []
        for rng in pens:
            strokes.append(_stroke(rng, strokes))
        count = len(strokes)
        return graph_from_strokes(
            strokes, widths=[3.0] * count, strength=[1.0] * count, colors=[(20, 20, 20)] * count
        )

    return make
