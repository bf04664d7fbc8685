"""Selected strokes become one line, a line becomes its pencil strokes; both are kept and undone."""

from __future__ import annotations

import numpy as np
import pytest

QUICK = {"provider": "classical", "solids": False, "drawing": "rough"}


BUNDLE = ((30, 80, 330, 84), (60, 84, 320, 81), (30, 87, 200, 87), (80, 150, 80, 220))
PAIR = (*BUNDLE, (95, 150, 95, 220))


@pytest.fixture
def traced(bpy, part, tmp_path):
    return trace(bpy, part, tmp_path, PAIR)


def trace(bpy, part, tmp_path, lines):
    part("engine.scan")  # brings OpenCV
    import cv2

    page = np.full((240, 360), 255, np.uint8)
    for x, y, right, low in lines:
        cv2.line(page, (x, y), (right, low), 0, 2, cv2.LINE_AA)
    cv2.imwrite(str(tmp_path / "page.png"), page)
    bpy.ops.involute.trace(filepath=str(tmp_path / "page.png"), **QUICK)
    return bpy.context.active_object.data


def lines_of(part, data, layer="Black"):
    return part("operators.grease_pencil.cels").read(data.layers[layer].frames[0].drawing)


def select(part, data, numbers, layer="Black"):
    cels = part("operators.grease_pencil.cels")
    column = part("operators.grease_pencil.core.stroke_arrays").column
    for other in data.layers:
        cel = other.frames[0].drawing
        curves = cels.read(cel)
        chosen = np.isin(np.arange(len(curves)), numbers if other.name == layer else [])
        on = column("BOOLEAN", np.repeat(chosen, curves.sizes))
        cels.set_points(cel, ".selection", on)


def upright(part, data, layer="Black"):
    """Numbers of the two upright lines on the left."""
    curves = lines_of(part, data, layer)
    tall = [np.ptp(p, axis=0) for p in np.split(curves.point("position"), curves.offsets[1:-1])]
    return [k for k, size in enumerate(tall) if size[2] > 3 * size[0]]


def test_selected_lines_become_one(bpy, part, traced):
    before = len(lines_of(part, traced))
    pair = upright(part, traced)
    assert len(pair) == 2
    select(part, traced, pair)
    assert bpy.ops.involute.merge_lines() == {"FINISHED"}
    curves = lines_of(part, traced)
    assert len(curves) == before - 1
    (one,) = upright(part, traced)
    points = curves.point("position")[curves.offsets[one] : curves.offsets[one + 1]]
    assert np.ptp(points[:, 2]) > 1.8 * 60 / 240
    # In the middle of the two, which are 15 px apart.
    middle = (87.5 - 180) * 2 / 240
    assert np.abs(points[:, 0] - middle).max() < 3 * 2 / 240
    # It is a stroke by hand: another trace leaves it, and the two stay gone.
    assert curves.mark(".involute_trace")[one] == 0
    assert bpy.ops.involute.trace_again(smoothing=0.9) == {"FINISHED"}
    assert len(upright(part, traced)) == 1


def test_pencil_strokes_become_one_and_stay(bpy, part, traced):
    pencil = len(lines_of(part, traced, "Pencil"))
    before = len(lines_of(part, traced))
    select(part, traced, upright(part, traced, "Pencil"), "Pencil")
    assert bpy.ops.involute.merge_lines() == {"FINISHED"}
    assert len(lines_of(part, traced, "Pencil")) == pencil
    assert len(lines_of(part, traced)) == before + 1


def test_a_line_becomes_its_pencil_strokes(bpy, part, tmp_path):
    traced = trace(bpy, part, tmp_path, BUNDLE)
    curves = lines_of(part, traced)
    halves = curves.mark(".involute_half")
    of = lines_of(part, traced, "Pencil").mark("involute_line")
    bundle = int(np.argmax([(of == half).sum() for half in halves]))
    half = halves[bundle]
    select(part, traced, [bundle])
    assert bpy.ops.involute.split_line() == {"FINISHED"}
    after = lines_of(part, traced)
    assert len(after) == len(curves) - 1 + (of == half).sum() > len(curves)
    assert half not in after.mark(".involute_half")
    # Split strokes can be put together again.
    hand = np.flatnonzero(after.mark(".involute_trace") == 0)
    assert len(hand) == (of == half).sum()
    select(part, traced, hand)
    assert bpy.ops.involute.merge_lines() == {"FINISHED"}
    assert len(lines_of(part, traced)) == len(curves)


def test_what_is_not_selected_stays(bpy, part, traced):
    select(part, traced, [])
    with pytest.raises(RuntimeError, match="Select"):
        bpy.ops.involute.merge_lines()
    with pytest.raises(RuntimeError, match="Select"):
        bpy.ops.involute.split_line()
    assert len(upright(part, traced)) == 2
