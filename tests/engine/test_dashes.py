"""Dashed and dotted lines are one stroke each, when the user asks for it."""

from __future__ import annotations

import re

import cv2
import numpy as np
import pytest
from involute.engine import Drawing, Settings, vectorize
from involute.engine.formats import drawing_json, svg

SIZE, FINE = 500, 4
ON = Settings(dashes=True)
# Pixels of ink, of paper, and of the pen. A dash of 0 px is a dot.
DASHED = [(14, 8, 4), (20, 12, 3), (6, 8, 3), (8, 14, 2), (0, 12, 4), (0, 9, 5)]


def page(dash: float, gap: float, pen: float, lines: bool = True) -> np.ndarray:
    """A dashed wave and a dashed ring, and two plain lines through both; (H, W) uint8."""
    image = np.full((SIZE * FINE, SIZE * FINE), 255, np.uint8)
    t = np.linspace(0, 1, 6000)
    wave = np.stack([40 + 420 * t, 90 + 35 * np.sin(6 * t)], 1)
    angle = 2 * np.pi * t
    ring = np.stack([250 + 150 * np.cos(angle), 310 + 130 * np.sin(angle)], 1)
    for line in (wave, ring):
        arc = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
        count = round(arc[-1] / (dash + gap))
        for start in np.arange(count) * arc[-1] / count:
            part = line[(arc >= start) & (arc <= start + max(dash, 0.5))]
            cv2.polylines(image, [np.int32(part * FINE)], False, 0, round(pen * FINE))
    for ends in ([(70, 30), (400, 470)], [(20, 250), (480, 290)]) if lines else ():
        cv2.line(image, *(tuple(v * FINE for v in end) for end in ends), 0, round(pen * FINE))
    return cv2.resize(image, (SIZE, SIZE), interpolation=cv2.INTER_AREA)


def long(drawing: Drawing) -> list[float]:
    return [float(np.hypot(*np.diff(s.points, axis=0).T).sum()) for s in drawing.strokes]


@pytest.mark.parametrize("kind", DASHED)
def test_a_dashed_line_is_one_stroke_that_says_how_it_is_dashed(kind):
    dash, gap, pen = kind
    drawing = vectorize(page(*kind, lines=False), ON)
    assert len(drawing.strokes) == 2
    for stroke in drawing.strokes:
        assert stroke.dash is not None
        # OpenCV's lines have round ends.
        assert stroke.dash == pytest.approx((dash + pen, gap - pen), abs=1.8)
        assert stroke.opacity.min() == 1.0
    assert drawing.fidelity.lost < 0.01
    assert drawing.fidelity.invented < 0.005
    assert max(long(drawing)) == pytest.approx(880, abs=40)


@pytest.mark.parametrize("kind", DASHED[1::2])
def test_it_runs_on_through_junctions(kind):
    drawing = vectorize(page(*kind), ON)
    assert len(drawing.strokes) <= 6
    dashed = [n for n, s in zip(long(drawing), drawing.strokes, strict=True) if s.dash]
    assert sum(dashed) > 1150  # of 440 and 880 px
    plain = [n for n, s in zip(long(drawing), drawing.strokes, strict=True) if not s.dash]
    assert sorted(plain)[-2:] == pytest.approx([462, 550], abs=12)


def test_without_being_asked_every_dash_stays_a_stroke():
    drawing = vectorize(page(20, 22, 3, lines=False))
    assert len(drawing.strokes) > 30
    assert not any(stroke.dash for stroke in drawing.strokes)


@pytest.mark.parametrize("seed", range(2))
def test_what_is_not_even_is_not_joined(seed):
    """Grass, rain and scattered dots are none of it."""
    rng = np.random.default_rng(seed)
    image = np.full((SIZE, SIZE), 255, np.uint8)
    for x, y in rng.uniform(20, 480, (90, 2)):
        turn, half = rng.normal(1.4, 0.3), rng.uniform(0, 14)
        way = half * np.array([np.cos(turn), np.sin(turn)])
        ends = [tuple(np.int32((np.array([x, y]) + s * way) * 16)) for s in (-1, 1)]
        cv2.line(image, *ends, 0, 3, cv2.LINE_AA, 4)
    plain, joined = vectorize(image), vectorize(image, ON)
    assert len(joined.strokes) >= len(plain.strokes) - 4
    assert not any(stroke.dash for stroke in joined.strokes)


def test_files_keep_how_a_stroke_is_dashed(tmp_path):
    drawing = vectorize(page(14, 12, 3), ON)
    own = [stroke.dash for stroke in drawing.strokes]
    for name in ("page.json", "page.svg"):
        drawing.save(tmp_path / name)
        kept = [s.dash for s in Drawing.load(tmp_path / name).strokes]
        assert [bool(dash) for dash in kept] == [bool(dash) for dash in own]
        assert [d for d in kept if d] == [pytest.approx(d, abs=0.001) for d in own if d]
    # Where a stroke begins with a dash, one of its own length and gap is drawn.
    drawn, blank = map(float, re.search(r'dasharray="(\S+) (\S+)"', svg.dumps(drawing)).groups())
    assert drawn + blank == pytest.approx(26, abs=1.5)


def test_a_plain_drawing_has_nothing_of_it_in_its_file():
    text = drawing_json.dumps(vectorize(page(14, 12, 3)))
    assert '"bare"' not in text
    assert '"dash"' not in text


def test_a_rerouted_line_stays_dashed():
    drawing = vectorize(page(14, 12, 3), ON)
    crossed = next(j for j in drawing.junctions if len(j.alternatives) > 1)
    other = drawing.reroute(crossed.index, crossed.alternatives[1].pairs)
    assert sum(bool(s.dash) for s in other.strokes) >= sum(bool(s.dash) for s in drawing.strokes)
