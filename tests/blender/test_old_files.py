"""Files that earlier versions saved still open with their junctions, and can be worked on."""

from __future__ import annotations

from pathlib import Path

import pytest

from .test_splicing import apart, assert_same, drawing_of, strokes_in

# 6 junctions; the first was rerouted, the third locked. Saved by version 0.1.0 in Blender 5.0.
REROUTED = Path(__file__).parent / "data" / "rerouted.blend"


@pytest.fixture
def opened(bpy, part):
    if bpy.app.version < (5, 0, 0):
        pytest.skip("saved by a newer Blender")
    bpy.ops.wm.open_mainfile(filepath=str(REROUTED), load_ui=False)
    obj = bpy.data.objects["lines"]
    bpy.context.view_layer.objects.active = obj
    obj.data.layers.remove(obj.data.layers["Solids"])  # lines only: see `assert_same`
    entry = next(iter(obj.data["involute"]["traces"].values()))
    return obj, part("operators.grease_pencil.core.pixel_map").PixelMap.from_list(
        entry["placement"]
    )


def test_junctions_and_decisions_are_there(part, opened):
    obj, pixel_map = opened
    drawing = drawing_of(part, obj)
    assert [j.locked for j in drawing.junctions] == [True, False, True, False, False, False]
    first = drawing.junctions[0]
    assert first.pairs == first.alternatives[1].pairs
    assert_same(strokes_in(part, obj, pixel_map), drawing.strokes)


def test_they_can_be_rerouted(bpy, part, opened):
    obj, pixel_map = opened
    for junction in range(6):
        assert bpy.ops.involute.reroute(junction=junction, alternative=2) == {"FINISHED"}
    drawing = drawing_of(part, obj)
    assert all(j.pairs == j.alternatives[2].pairs for j in drawing.junctions)
    found = strokes_in(part, obj, pixel_map)
    assert len(found) == len(drawing.strokes)
    for stroke in drawing.strokes:  # smoothed by another version: near, not the same points
        assert min(apart(points, stroke, closed) for points, closed in found) < 1.5
    assert bpy.ops.involute.ask_again() == {"FINISHED"}
