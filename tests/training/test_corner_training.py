"""Learning where the pen was lifted."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("torch", reason="training needs torch")
pytest.importorskip("scipy", reason="training needs SciPy")

from involute.engine.graph.clues import WEIGHTS
from involute.engine.graph.lifts import evidence_size
from involute.engine.perceptron import load
from involute.engine.routing.lifting import judged
from involute.training.corners import train_corners
from involute.training.corners.lift_pages import Corners
from involute.training.corners.train_corners import figures, restored, train, untrained, weights

Array = np.ndarray


def _pages(seed: int, pages: int = 160, each: int = 12) -> Corners:
    """Corners whose truth two numbers tell: one of the corner, and one of its whole page."""
    rng = np.random.default_rng(seed)
    page = np.repeat(np.arange(pages, dtype=np.int32), each)
    seen = rng.normal(0, 1, (len(page), evidence_size()))
    seen[:, 70] = rng.normal(0, 1, pages)[page]
    truth = seen[:, 3] + seen[:, 70] > 0
    return Corners(seen.astype(np.float16), truth.astype(np.int8), page, np.arange(pages) % 3 / 2.2)


def _on_page(net: dict[str, Array], seen: Array) -> Array:
    """(C,) log-odds of going on, as the engine makes them, of the corners of one page."""
    rows = np.clip((seen.astype(float) - net["mean"]) / net["spread"], -5, 5)
    for k in range(2):
        rows = (np.maximum(rows, 0) if k else rows) @ net[f"see_weight{k}"] + net[f"see_bias{k}"]
    return judged(np.tanh(rows), np.zeros(len(seen)), net)


def test_what_is_trained_is_what_the_engine_runs() -> None:
    data, held = _pages(1), _pages(2)
    model = train(untrained(data, 0.0), data, held, 200, 5e-3, seed=1)
    net = weights(model)
    right = [
        (_on_page(net, held.evidence[held.page == k]) > 0) == held.truth[held.page == k]
        for k in range(len(held.habit))
    ]
    assert np.mean(right) == pytest.approx(figures(model, held)["all"], abs=1e-3)
    assert np.mean(right) > 0.85


def test_training_goes_on_from_the_weights_that_ship() -> None:
    net, again = load(WEIGHTS), weights(restored(WEIGHTS, 0.3))
    assert set(again) == set(net)
    for name, value in again.items():
        np.testing.assert_array_equal(value, net[name].astype(np.float32), name)
    # Pages that contradict what it knows only make it worse: the weights it began with stay.
    other = _pages(4, 40)
    kept = train(restored(WEIGHTS, 0.3), other, _told_by(other), 3, 1e-2, seed=1)
    np.testing.assert_array_equal(weights(kept)["see_weight0"], again["see_weight0"])


def test_a_narrower_network_says_the_same_when_it_is_widened(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    data = _pages(5, 20)
    with monkeypatch.context() as narrow:
        narrow.setattr(train_corners, "_SEE", (16,))
        narrow.setattr(train_corners, "_JUDGE", (8,))
        small = weights(untrained(data, 0.0))
        np.savez(tmp_path / "narrow.npz", **small)
    wide = weights(restored(tmp_path / "narrow.npz", 0.0))
    assert wide["see_weight0"].shape[1] > 16
    seen = data.evidence[:12]
    np.testing.assert_allclose(_on_page(wide, seen), _on_page(small, seen), atol=1e-5)


def _told_by(data: Corners) -> Corners:
    """The same corners with the truth that the weights that ship say."""
    with_page = [
        _on_page(load(WEIGHTS), data.evidence[data.page == k]) > 0 for k in range(len(data.habit))
    ]
    return Corners(data.evidence, np.concatenate(with_page).astype(np.int8), data.page, data.habit)


def test_a_run_notes_what_it_began_with(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(train_corners, "gathered", lambda path, *_, **__: _pages(len(path.name)))
    (tmp_path / "data").mkdir()
    out = tmp_path / "corners.npz"
    given = ["--data", str(tmp_path / "data"), "--run", str(tmp_path / "run"), "--steps", "2"]
    train_corners.main([*given, "--start", str(WEIGHTS), "--out", str(out)])
    assert np.load(out)["judge_bias1"].shape == (1,)
    config = json.loads((tmp_path / "run" / "config.json").read_text("utf-8"))
    assert config["parent"]["file"] == "corners.npz"
