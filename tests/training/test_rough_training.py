"""Learning how many pencil strokes become one line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("torch", reason="training needs torch")
pytest.importorskip("scipy", reason="training needs SciPy")

from involute.engine import perceptron
from involute.synthesis.composed_pages import Library
from involute.training.rough import rough_pages, train_rough

BOX = np.array([[200.0, 200.0], [700.0, 200.0], [700.0, 700.0], [200.0, 700.0], [200.0, 200.0]])
STEM = np.array([[700.0, 450.0], [950.0, 500.0]])


def a_library(folder: Path) -> Library:
    """Some boxes with stems, as a folder of drawings."""
    rng = np.random.default_rng(0)
    lines = []
    for _ in range(40):
        lines += [one * rng.uniform(0.5, 1.0) for one in (BOX, STEM, BOX * [0.5, 0.9], STEM + 40)]
    points = np.concatenate(lines)
    np.savez(
        folder / "openclipart.npz",
        points=(points * 32).astype(np.uint16),
        stroke_offsets=np.cumsum([0] + [len(line) for line in lines]),
        drawing_offsets=np.arange(0, len(lines) + 1, 4),
        scale=1 / 32,
    )
    return Library.load(folder, held_out=False)


def test_lines_of_a_page_meet_where_they_met(tmp_path, monkeypatch) -> None:
    """Every line of a page had a scale of its own, so that none of them met."""
    monkeypatch.setattr(rough_pages, "_FIGURES", dict.fromkeys(rough_pages.KINDS, 0.0))
    monkeypatch.setattr(rough_pages, "endless", lambda rng, library: iter([[BOX, STEM]]))
    library = a_library(tmp_path)
    page = rough_pages.rough_page(
        np.random.default_rng(3), library, rough_pages.KINDS.index("clean")
    )
    assert page is not None
    box, stem = page.lines
    assert abs(stem[0, 0] - box[:, 0].max()) < 0.01
    assert box[:, 1].min() < stem[0, 1] < box[:, 1].max()


def test_one_command_makes_the_weights(tmp_path) -> None:
    a_library(tmp_path)
    out = tmp_path / "rough.npz"
    asked = ["--data", str(tmp_path), "--run", str(tmp_path / "run"), "--pages", "8"]
    train_rough.main([*asked, "--held-out", "8", "--steps", "20", "--out", str(out)])
    net = perceptron.load(out)
    shipped = perceptron.load(train_rough.grouping.WEIGHTS)
    assert {name: of.shape for name, of in net.items()} == {
        name: of.shape for name, of in shipped.items()
    }
