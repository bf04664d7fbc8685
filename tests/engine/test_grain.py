"""Grainy lines: looked at from farther away, where that makes the drawing simpler."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from involute.command import sequence_tracing
from involute.command.sequence_tracing import trace_sequence
from involute.engine import Settings, vectorize
from involute.engine.grain import is_decided, is_torn
from involute.engine.pipeline import grain_of
from involute.engine.scan import read_scan
from involute.engine.sequence.frames import number_frames
from involute.engine.values import Stroke
from involute.synthesis.media import MEDIA, draw, sample

SIDE = 480


def page(medium: str, pen: float, seed: int = 3) -> np.ndarray:
    """Four long waves, (SIDE, SIDE) uint8."""
    x = np.linspace(40, SIDE - 40, 200)
    lines = [
        np.stack([x, y + 25 * np.sin(x / 60 + y)], 1).astype(np.float32)
        for y in (90, 190, 290, 390)
    ]
    rng = np.random.default_rng(seed)
    ink, _ = draw(rng, sample(lines, SIDE), MEDIA[medium], pen, SIDE)
    return np.round(255 * (1 - ink)).clip(0, 255).astype(np.uint8)


def apart(strokes: tuple[Stroke, ...], truth: np.ndarray) -> float:
    """How far points of a line are from the nearest stroke, px, at most."""
    share = np.linspace(0, 1, 20)[:, None, None]
    drawn = np.concatenate(
        [(p[:-1] + share * np.diff(p, axis=0)).reshape(-1, 2) for p in (s.points for s in strokes)]
    )
    return float(np.hypot(*(truth[:, None] - drawn[None]).T).min(0).max())


@pytest.fixture(scope="module")
def charcoal() -> np.ndarray:
    return page("charcoal", 5.0, seed=4)


def test_torn_charcoal_is_looked_at_from_farther_away(charcoal: np.ndarray) -> None:
    close, seen = vectorize(charcoal, Settings(grain="fine")), vectorize(charcoal)
    assert len(close.strokes) > 8
    assert len(seen.strokes) == 4
    assert seen.notes == ("The lines are grainy: traced from farther away (--grain coarse).",)
    assert seen.settings == Settings()
    assert seen.size == (SIDE, SIDE)


def test_it_is_the_drawing_of_that_grain(charcoal: np.ndarray) -> None:
    seen, coarse = vectorize(charcoal), vectorize(charcoal, Settings(grain="coarse"))
    assert len(seen.strokes) == len(coarse.strokes)
    for a, b in zip(seen.strokes, coarse.strokes, strict=True):
        np.testing.assert_array_equal(a.points, b.points)
    assert not coarse.notes


def test_lines_lie_in_the_pixels_of_the_page_and_are_as_wide(charcoal: np.ndarray) -> None:
    x = np.linspace(60, SIDE - 60, 50)
    for grain in ("medium", "coarse"):
        drawing = vectorize(charcoal, Settings(grain=grain))
        for y in (90, 190, 290, 390):
            truth = np.stack([x, y + 25 * np.sin(x / 60 + y)], 1)
            assert apart(drawing.strokes, truth) < 4.0
        width = np.median(np.concatenate([s.widths for s in drawing.strokes]))
        assert 2.5 < width < 7.5


def test_clean_lines_are_looked_at_once() -> None:
    pen = page("technical pen", 3.0)
    looks: list[str] = []
    drawing = vectorize(pen, progress=lambda stage, _: looks.append(stage))
    assert not drawing.notes
    assert not is_torn(drawing, read_scan(pen, Settings()))
    scans = [k for k, stage in enumerate(looks) if stage == "scan"]
    assert scans == list(range(len(scans)))  # one run of them, at the beginning


def test_frames_are_looked_at_alike(charcoal: np.ndarray) -> None:
    frame = vectorize(charcoal, turn=False)
    close = vectorize(charcoal, Settings(grain="fine"), turn=False)
    assert [len(s.points) for s in frame.strokes] == [len(s.points) for s in close.strokes]
    assert not frame.notes


def test_only_the_network_on_clean_drawings_looks_again() -> None:
    assert not is_decided(Settings())
    for said in ({"grain": "fine"}, {"drawing": "rough"}, {"provider": "classical"}):
        assert is_decided(Settings(**said))


def test_progress_does_not_go_back_when_a_page_is_looked_at_again(charcoal: np.ndarray) -> None:
    shown: list[float] = []
    vectorize(charcoal, progress=lambda _, fraction: shown.append(fraction))
    assert shown == sorted(shown)


def test_a_tiny_page_is_read_as_it_is() -> None:
    tiny = np.full((20, 24), 255, np.uint8)
    tiny[8:12, 4:20] = 0
    assert read_scan(tiny, Settings(grain="coarse")).ink.shape == (20, 24)


@pytest.mark.parametrize("pen", [0.0, 5.0])
def test_a_pen_width_is_of_the_page_as_it_is(charcoal: np.ndarray, pen: float) -> None:
    close = read_scan(charcoal, Settings(pen_width=pen))
    far = read_scan(charcoal, Settings(pen_width=pen, grain="coarse"))
    assert far.scale == pytest.approx(close.scale / 0.55)
    assert far.pen_width * far.scale == pytest.approx(close.pen_width * close.scale, rel=0.5)


def test_a_sequence_is_looked_at_as_suits_its_first_frame(
    charcoal: np.ndarray, tmp_path: Path
) -> None:
    pen = page("technical pen", 3.0)
    for name, picture in (("a1", charcoal), ("a2", pen), ("b1", pen), ("b2", charcoal)):
        cv2.imwrite(str(tmp_path / f"{name}.png"), picture)
    for first, grain in (("a", "coarse"), ("b", "fine")):
        frames = number_frames(sorted(map(str, tmp_path.glob(f"{first}?.png"))))
        drawings = [drawing for _, drawing in trace_sequence(frames, jobs=1)]
        assert [drawing.settings.grain for drawing in drawings] == [grain, grain]
        assert len(drawings[0].strokes) == (4 if first == "a" else 5)


def test_a_resumed_sequence_does_not_look_at_its_first_frame_again(
    charcoal: np.ndarray, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []

    def counted(*picture: object) -> str:
        asked.append(picture)
        return "medium"

    monkeypatch.setattr(sequence_tracing, "grain_of", counted)
    for picture, times in ((charcoal, 1), (charcoal, 1), (page("technical pen", 3.0), 2)):
        cv2.imwrite(str(tmp_path / "1.png"), picture)
        frames = number_frames([str(tmp_path / "1.png")])
        ((_, drawing),) = trace_sequence(frames, jobs=1, parts=tmp_path / "parts")
        assert drawing.settings.grain == "medium"
        assert len(asked) == times


def test_what_says_how_it_is_seen_is_kept_to(charcoal: np.ndarray) -> None:
    assert grain_of(charcoal, Settings()) == "coarse"
    assert grain_of(charcoal, Settings(grain="medium")) == "medium"


def test_solid_areas_are_not_given_up_for_fewer_strokes() -> None:
    """The trousers, feet and ears of examples/hippopotamus.jpg are solid only from close by."""
    scan = str(Path(__file__).parents[2] / "examples" / "hippopotamus.jpg")
    assert grain_of(scan, Settings()) == "fine"
