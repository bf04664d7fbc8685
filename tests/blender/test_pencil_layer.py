"""The pencil strokes of a rough drawing lie on a layer of their own behind its lines."""

from __future__ import annotations

import numpy as np


def test_pencil_strokes_lie_behind_their_lines(bpy, part, tmp_path):
    part("engine.scan")  # brings OpenCV
    import cv2

    page = np.full((240, 360), 255, np.uint8)
    for left, right, y, tilt in ((30, 330, 80, 4), (60, 320, 84, -3), (30, 200, 87, 0)):
        cv2.line(page, (left, y), (right, y + tilt), 0, 2, cv2.LINE_AA)
    cv2.line(page, (80, 150), (80, 220), 0, 2, cv2.LINE_AA)
    cv2.imwrite(str(tmp_path / "page.png"), page)
    quick = {"provider": "classical", "solids": False}
    bpy.ops.involute.trace(filepath=str(tmp_path / "page.png"), drawing="rough", **quick)
    data = bpy.context.active_object.data
    assert [layer.name for layer in data.layers] == ["Pencil", "Black"]
    assert data.layers.active.name == "Black"
    pencil, lines = data.layers
    assert pencil.opacity < 0.5
    assert pencil.viewlayer_render not in ("", *(v.name for v in bpy.context.scene.view_layers))
    cels = part("operators.grease_pencil.cels")
    drawn, clean = (cels.read(layer.frames[0].drawing) for layer in (pencil, lines))
    assert len(drawn) > len(clean) == 2
    known = drawn.mark("involute_line")
    assert set(known[known > 0]) <= set(clean.mark(".involute_half"))
    assert (known > 0).sum() >= 3
    # Traced again as clean, nothing is left behind of them but an empty layer.
    state = part("operators.grease_pencil.state")
    trace = state.load(data, state.keys_at(data, 1)[0])
    assert len(trace.drawing.pencil.strokes) == len(drawn)


def test_pencil_strokes_of_another_trace_stay(bpy, part, tmp_path):
    part("engine.scan")  # brings OpenCV
    import cv2

    quick = {"provider": "classical", "solids": False, "drawing": "rough"}
    for name, x in (("a", 60), ("b", 160)):
        page = np.full((240, 360), 255, np.uint8)
        for shift in (0, 4):
            cv2.line(page, (x, 30 + shift), (x + 140, 34 + shift), 0, 2, cv2.LINE_AA)
        cv2.imwrite(str(tmp_path / f"{name}.png"), page)
    bpy.ops.involute.trace(filepath=str(tmp_path / "a.png"), **quick)
    data = bpy.context.active_object.data
    cels = part("operators.grease_pencil.cels")

    def marks():
        cel = data.layers["Pencil"].frames[0].drawing
        return cels.read(cel).mark(".involute_trace").tolist()

    first = marks()
    assert first
    data.layers.active = data.layers["Black"]
    bpy.ops.involute.trace(filepath=str(tmp_path / "b.png"), target="LAYER", **quick)
    assert marks()[: len(first)] == first
    assert len(marks()) > len(first)
    view = bpy.context.window_manager.involute_view
    view.key = (set(marks()) - set(first)).pop()
    assert bpy.ops.involute.trace_again(smoothing=0.9) == {"FINISHED"}
    assert marks()[: len(first)] == first
    assert len(marks()) > len(first)
