"""Learning which runs carry two strokes."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("torch", reason="training needs torch")
pytest.importorskip("scipy", reason="training needs SciPy")

from involute.engine.routing import route
from involute.engine.routing.run_features import FEATURES
from involute.engine.routing.second_lines import probabilities
from involute.engine.settings import Settings
from involute.synthesis.true_graph import graph_from_strokes
from involute.training.second_lines.run_pages import CROSS, ONE, TOUCH, labelled
from involute.training.second_lines.train_second_lines import train


def _line(before: float, after: float) -> np.ndarray:
    """Along y = 200 from x = 180 to 320; leaves it to a side before and after."""
    x = np.arange(20.0, 480.0, 2.0)
    past = np.maximum(np.abs(x - 250) - 70, 0) ** 2 / 300
    return np.stack([x, 200 + np.where(x < 250, before, after) * past], 1)


@pytest.mark.parametrize(
    ("strokes", "carries"),
    [
        ([_line(1, 1), _line(-1, -1)], TOUCH),
        ([_line(1, -1), _line(-1, 1)], CROSS),
        ([_line(1, 1), _line(-1, -1)[:84], _line(-1, -1)[-84:]], ONE),
    ],
)
def test_a_run_carries_what_was_drawn(strokes: list[np.ndarray], carries: int) -> None:
    many = len(strokes)
    graph, partner = graph_from_strokes(
        strokes, touch=2.5, merge=2.5, doubled=2.5, widths=[3.0] * many, strength=[0.9] * many
    )
    routing = replace(route(graph, Settings(router="geometric")), partner=partner)
    rows, labels = labelled(graph, routing, strokes, 3.0)
    assert rows.shape[1] == FEATURES
    assert labels.tolist() == [carries]


def test_what_is_trained_is_what_the_engine_runs(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    rows = rng.normal(0, 1, (3000, FEATURES)).astype(np.float32)
    labels = np.where(rows[:, 3] + rows[:, 5] < 0.5, ONE, np.where(rows[:, 7] > 0, TOUCH, CROSS))
    net, figures = train(
        (rows[:2000], labels[:2000]), (rows[2000:], labels[2000:]), 800, 1, tmp_path
    )
    chance = probabilities(rows[2000:], net)
    two = 1 - chance[:, 0] > 0.5
    assert (two == (labels[2000:] > 0)).mean() > 0.9
    crosses = (chance[:, 2] > chance[:, 1]) != (rows[2000:, -1] < 0)
    right = two & (crosses == (labels[2000:] == CROSS)) & (labels[2000:] > 0)
    assert figures["above 0.5"]["right"] == pytest.approx(right.sum() / two.sum(), abs=0.01)
