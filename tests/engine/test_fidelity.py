"""The drawing compared with its page."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from involute.engine import Drawing, Settings, vectorize
from involute.engine.fidelity import Fidelity, fidelity, warnings
from involute.engine.scan import paper, read_scan
from involute.engine.values import Stroke

SHAPE = (120, 160)


def stroke(points, width=4.0, closed=False):
    points = np.asarray(points, np.float32)
    ones = np.ones(len(points), np.float32)
    return Stroke(points, width * ones, ones, closed, (0, 0, 0), np.zeros(1, np.int32))


def ink_of(*lines, width=4):
    image = np.zeros(SHAPE, np.uint8)
    for a, b in lines:
        cv2.line(image, a, b, 255, width, cv2.LINE_AA)
    return image.astype(np.float32) / 255


ONE, TWO = ((20, 30), (140, 30)), ((20, 90), (140, 90))


def drawn(line, scale=1.0):
    return stroke([[(x + 0.5) * scale, (y + 0.5) * scale] for x, y in line], 4 * scale)


@given(st.sampled_from([0.5, 1.0, 2.35]))
@settings(max_examples=5, deadline=None)
def test_a_faithful_drawing_loses_and_invents_nothing(scale):
    found = fidelity([drawn(ONE, scale), drawn(TWO, scale)], [], ink_of(ONE, TWO), scale)
    assert found == Fidelity(0.0, 0.0)
    assert warnings(found, light=False) == ()


def test_half_lost_and_half_invented_and_where():
    lost = fidelity([drawn(ONE)], [], ink_of(ONE, TWO), 1.0)
    assert lost.lost == pytest.approx(0.5, abs=0.02)
    (box,) = lost.lost_at
    assert 80 < box[1] < 92
    assert "50% of the ink" in warnings(lost, light=False)[0]
    made_up = fidelity([drawn(ONE), drawn(TWO)], [], ink_of(ONE), 1.0)
    assert (made_up.lost, made_up.invented) == (0, pytest.approx(0.5, abs=0.02))
    assert "--polarity dark" in warnings(made_up, light=True)[0]


def test_a_fill_covers_its_area_without_its_hole():
    ink = np.zeros(SHAPE, np.float32)
    ink[20:100, 20:140] = 1
    ring = np.float32([[20, 20], [140, 20], [140, 100], [20, 100]])
    hole = np.float32([[60, 40], [100, 40], [100, 80], [60, 80]])
    assert fidelity([], [(ring,)], ink, 1.0).lost == 0
    assert 0.1 < fidelity([], [(ring, hole)], ink, 1.0).lost < 1 / 6


def test_wider_strokes_on_purpose_cover_no_more():
    thick = stroke([[20, 30], [140, 30]], 40.0)
    ink = ink_of(ONE, ((20, 45), (140, 45)))
    assert fidelity([thick], [], ink, 1.0).lost == 0
    assert fidelity([thick], [], ink, 1.0, width_scale=10.0).lost > 0.4


def test_ink_that_was_taken_for_paper_is_lost_too(monkeypatch):
    rng = np.random.default_rng(4)
    flow = np.clip(0.5 + 0.25 * cv2.GaussianBlur(rng.normal(size=(240, 320)), (0, 0), 1) * 3, 0, 1)
    page = np.zeros((240, 320))
    for y in range(60, 180, 6):
        cv2.line(page, (80, y), (240, y), 1, 5)
    cv2.line(page, (30, 20), (40, 220), 1, 4)
    gray = 255 * 0.9 * (1 - cv2.GaussianBlur(page * flow, (0, 0), 1.0))
    picture = np.clip(gray + rng.normal(0, 2, page.shape), 0, 255).astype(np.uint8)
    fast = Settings(provider="classical", router="geometric")
    assert read_scan(picture, fast).overlooked is None
    monkeypatch.setattr(paper, "_HATCHED", (99.0, 9.0))
    scan, drawing = read_scan(picture, fast), vectorize(picture, fast)
    assert np.count_nonzero(scan.overlooked) > 500
    blind = drawing.compared_with(replace(scan, overlooked=None))
    assert drawing.fidelity.lost > blind.fidelity.lost + 0.05
    assert "of the ink is not in the drawing" in drawing.warnings[0]


@pytest.mark.parametrize("curve", ["polyline", "bezier"])
def test_a_trace_is_checked_and_the_figures_are_kept_in_its_file(curve, tmp_path):
    page = np.full((200, 240), 255, np.uint8)
    cv2.circle(page, (120, 100), 60, 0, 4, cv2.LINE_AA)
    fast = {"provider": "classical", "router": "geometric", "curve": curve}
    drawing = vectorize(page, Settings(**fast))
    assert drawing.fidelity.lost == drawing.fidelity.invented == 0
    drawing.save(tmp_path / "page.json")
    again = Drawing.load(tmp_path / "page.json")
    assert again.fidelity == drawing.fidelity
    assert (again.notes, again.warnings) == (drawing.notes, drawing.warnings)


def test_a_drawing_saved_before_there_were_figures_still_opens(tmp_path):
    page = np.full((64, 64), 255, np.uint8)
    cv2.line(page, (10, 10), (50, 50), 0, 3)
    path = tmp_path / "page.json"
    vectorize(page, Settings(provider="classical", router="geometric")).save(path)
    import json

    document = json.loads(path.read_text("utf-8"))
    for name in ("fidelity", "notes", "warnings"):
        del document[name]
    path.write_text(json.dumps(document), "utf-8")
    assert Drawing.load(path).fidelity is None
