"""Learning which branches nobody drew."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("torch", reason="training needs torch")
pytest.importorskip("scipy", reason="training needs SciPy")

from involute.engine.graph.removal.undrawn import FEATURES, probability
from involute.engine.values import PlanarGraph
from involute.training.undrawn.train_undrawn import _on_dots, _stipple, train


def test_what_is_trained_is_what_the_engine_runs(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    rows = rng.normal(0, 1, (3000, FEATURES)).astype(np.float32)
    labels = rows[:, 3] + rows[:, 5] > 1
    net, figures = train(rows[:2000], labels[:2000], rows[2000:], labels[2000:], 400, 1, tmp_path)
    stated = probability(rows[2000:], net)
    assert ((stated > 0.5) == labels[2000:]).mean() > 0.95
    found = figures["above 0.5"]["found"]
    assert found == pytest.approx((stated > 0.5)[labels[2000:]].mean(), abs=0.01)


def test_dots_keep_away_from_lines_and_are_known_again() -> None:
    line = np.stack([np.linspace(0, 300, 200), np.linspace(0, 200, 200)], 1)
    dots = _stipple(np.random.default_rng(2), [line])
    assert len(dots) > 5
    middles = np.array([dot.mean(0) for dot in dots])
    assert np.hypot(*(middles[:, None] - line).reshape(-1, 2).T).min() > 8
    ends = np.array([[0, 1], [2, 3]], np.int32)
    places = np.array([middles[0] - 1, middles[0] + 1, [0, 0], [2, 0]], np.float32)
    graph = PlanarGraph(places, places, np.array([0, 2, 4], np.int32), ends)
    assert _on_dots(graph, dots).tolist() == [True, False]
