"""Learning how many pencil strokes become one line."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("torch", reason="training needs torch")
pytest.importorskip("scipy", reason="training needs SciPy")

from involute.engine import perceptron
from involute.synthesis import pencilling, rough_drawings
from involute.synthesis.composed_pages import Library
from involute.synthesis.pencilling import Hand
from involute.training.centerline.page_batches import STREAMS
from involute.training.centerline.training_page import CHANNELS
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
    monkeypatch.setattr(rough_drawings, "_FIGURES", dict.fromkeys(rough_pages.KINDS, 0.0))
    monkeypatch.setattr(rough_drawings, "endless", lambda rng, library: iter([[BOX, STEM]]))
    library = a_library(tmp_path)
    page = rough_pages.rough_page(
        np.random.default_rng(3), library, rough_pages.KINDS.index("clean")
    )
    assert page is not None
    box, stem = page.lines
    assert abs(stem[0, 0] - box[:, 0].max()) < 0.01
    assert box[:, 1].min() < stem[0, 1] < box[:, 1].max()


def off_the_middle(hand: Hand, seed: int) -> float:
    """How far the middle of the strokes of a straight line lies off it, px."""
    line = np.array([[0.0, 50.0], [400.0, 50.0]])
    strokes, press = pencilling.keyed(np.random.default_rng(seed), [line], hand)
    weight = np.repeat(press, [len(stroke) for stroke in strokes])
    at, aside = np.concatenate(strokes).T
    moved, all_of_it = (
        np.histogram(at, 10, (0, 400), weights=of)[0] for of in (weight * (aside - 50), weight)
    )
    return float(np.abs(moved / all_of_it).mean())


def test_a_line_lies_amid_its_pencil_strokes() -> None:
    """What the strokes of a line say by themselves is where the line is."""
    hand = Hand(3.0, 5.0, 2.0, 120.0, 0.0)
    amid = replace(hand, centered=20.0)
    off, centered = (np.mean([off_the_middle(h, k) for k in range(8)]) for h in (hand, amid))
    assert centered < 0.4 * off


def test_a_rough_page_shows_strokes_and_means_lines(tmp_path) -> None:
    a_library(tmp_path)
    stream = STREAMS["rough"]
    pages = [
        stream.draw(np.random.default_rng(seed), stream.load(tmp_path), 256, False)
        for seed in range(6)
    ]
    for page in pages:
        assert page.shape == (len(CHANNELS), 256, 256)
        np.testing.assert_array_equal(page[1], page[8])  # what is meant is all there is
    inked, meant = (np.array([(page[c] > 100).sum() for page in pages]) for c in (0, 1))
    assert (inked > meant).any()


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
