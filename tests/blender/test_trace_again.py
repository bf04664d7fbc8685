"""Tracing again in place, and into what is there: the artist's work stays."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from .example_drawings import grid
from .test_splicing import cel_of, drawing_of, move, strokes_in


@pytest.fixture
def scan(part, tmp_path) -> Path:
    """Two lines that cross, and one below."""
    part("engine.scan")  # brings OpenCV
    import cv2

    paper = np.full((200, 260), 245, np.uint8)
    cv2.line(paper, (20, 30), (240, 120), 20, 3, cv2.LINE_AA)
    cv2.line(paper, (30, 120), (230, 20), 20, 3, cv2.LINE_AA)
    cv2.line(paper, (30, 160), (230, 165), 20, 3, cv2.LINE_AA)
    cv2.imwrite(str(tmp_path / "page.png"), paper)
    return tmp_path / "page.png"


@pytest.fixture
def traced(bpy, scan):
    bpy.ops.involute.trace(filepath=str(scan), router="geometric")
    return bpy.context.active_object


def path(*places):
    return [{"name": "", "loc": place, "time": 0.0} for place in places]


def front(part):
    return part("operators.grease_pencil.core.pixel_map").front_view((260, 200))


def test_other_settings_act_in_place(bpy, part, traced, scan):
    data, before = traced.data, drawing_of(part, traced)
    (key,) = part("operators.grease_pencil.state").keys_at(data, 1)
    assert bpy.ops.involute.trace_again(curve="bezier", smoothing=0.9) == {"FINISHED"}
    after = drawing_of(part, traced)
    assert after.settings == replace(before.settings, curve="bezier", smoothing=0.9)
    assert all(stroke.handles is not None for stroke in after.strokes)
    assert len(strokes_in(part, traced, front(part))) == len(after.strokes)
    assert str(key) not in data["involute"]["traces"]
    assert len([obj for obj in bpy.data.objects if obj.type == "GREASEPENCIL"]) == 1
    assert bpy.ops.involute.take_settings() == {"FINISHED"}
    assert bpy.context.scene.involute.curve == "bezier"
    assert bpy.ops.involute.trace_again(min_length=3.0) == {"FINISHED"}  # from the file
    scan.unlink()
    with pytest.raises(RuntimeError, match="put it back"):
        bpy.ops.involute.trace_again(min_length=2.0)


@pytest.mark.parametrize("settings", [{"smoothing": 0.9}, {"min_length": 2.0}])
def test_what_the_artist_did_stays(bpy, part, traced, settings):
    """Decisions, cuts, moved strokes, deleted strokes, and strokes drawn by hand."""
    (crossing,) = drawing_of(part, traced).junctions
    bpy.ops.involute.separate(junction=0)
    bpy.ops.involute.cut(path=path((100, 150), (100, 175)))
    gp, cel = part("operators.grease_pencil.cels"), cel_of(traced)
    curves = gp.read(cel)
    places = front(part).to_pixels(curves.point("position"))
    middle = [places[a:b].mean(0) for a, b in zip(curves.offsets, curves.offsets[1:], strict=False)]
    right = int(np.argmin([np.hypot(*(m - (165, 163))) for m in middle]))
    left = int(np.argmin([np.hypot(*(m - (65, 161))) for m in middle]))
    first, last = curves.offsets[right : right + 2]
    move(cel, slice(first, last), (0.0, 0.0, -0.2))  # 20 px down
    moved = gp.read(cel).point("position")[first:last]
    cel.remove_strokes(indices=[left])
    cel.add_strokes([2])
    hand = gp.read(cel)
    strokes = len(hand)

    assert bpy.ops.involute.trace_again(**settings) == {"FINISHED"}
    after = drawing_of(part, traced)
    (junction,) = after.junctions
    assert junction.locked
    assert junction.pairs == ()
    assert np.hypot(*(np.array(junction.position) - crossing.position)) < 3
    assert len(after.strokes) == 6  # of which one was deleted
    curves = gp.read(cel_of(traced))
    assert len(curves) == strokes
    keys, halves = curves.mark(".involute_trace"), curves.mark(".involute_half")
    assert (keys == 0).sum() == 1
    firsts = [int(s.branches[0]) + 1 for s in after.strokes]
    assert set(halves[keys != 0].tolist()) <= set(firsts)
    found = curves.point("position")
    assert any(
        np.allclose(found[a:b], moved)
        for a, b in zip(curves.offsets, curves.offsets[1:], strict=False)
    )
    # It is still known: joined again with what is beside it.
    assert bpy.ops.involute.reroute(junction=0, alternative=0) == {"FINISHED"}
    assert len(gp.read(cel_of(traced))) == strokes - 2


def test_locked_layers_and_unknown_pictures_are_said(bpy, part, traced):
    traced.data.layers["Black"].lock = True
    with pytest.raises(RuntimeError, match="locked"):
        bpy.ops.involute.trace_again(smoothing=0.1)
    entry = next(iter(traced.data["involute"]["traces"].values()))
    for name in ("path", "page", "image"):  # as in files of before
        del entry[name]
    with pytest.raises(RuntimeError, match="Nobody noted"):
        bpy.ops.involute.trace_again(smoothing=0.1)


# --- into what is there --------------------------------------------------------------------------


def test_into_the_active_layer_with_the_active_material(bpy, part, traced, scan):
    data = traced.data
    data.layers.new("Clean Up")
    data.layers.active = data.layers["Clean Up"]
    material = bpy.data.materials.new("Mine")
    bpy.data.materials.create_gpencil_data(material)
    data.materials.append(material)
    traced.active_material_index = len(data.materials) - 1
    for count in (1, 2):  # what is there stays
        bpy.ops.involute.trace(filepath=str(scan), target="LAYER", router="geometric")
        curves = part("operators.grease_pencil.cels").read(cel_of(traced, "Clean Up"))
        assert len(curves) == 3 * count
        assert set(curves.curve("material_index")) == {len(data.materials) - 1}
    assert len(part("operators.grease_pencil.cels").read(cel_of(traced))) == 3
    data.layers["Clean Up"].lock = True
    with pytest.raises(RuntimeError, match="locked"):
        bpy.ops.involute.trace(filepath=str(scan), target="LAYER")


def test_strokes_come_as_a_hand_draws_them(bpy, part, scan):
    bpy.ops.involute.trace(filepath=str(scan), order="HAND", router="geometric")
    obj = bpy.context.active_object
    found = strokes_in(part, obj, front(part))
    assert all(points[0, 0] < points[-1, 0] for points, _ in found)  # from left to right
    assert [points[0, 1] for points, _ in found] == sorted(points[0, 1] for points, _ in found)
    bpy.ops.involute.reroute(junction=0, alternative=1)
    assert len(strokes_in(part, obj, front(part))) == len(drawing_of(part, obj).strokes)


def test_long_strokes_come_first_one_block_after_the_other(part):
    order = part("engine.strokes.hand_order").hand_order
    drawing = grid(part, 6)
    found = order(drawing.strokes, drawing.size)
    assert sorted(number for number, _ in found) == list(range(len(drawing.strokes)))
    ends = [drawing.strokes[k].points[:: -1 if turned else 1][[0, -1]] for k, turned in found]
    assert all(a[0] < b[0] or a[1] < b[1] for a, b in ends)
    assert order((), (10, 10)) == []
