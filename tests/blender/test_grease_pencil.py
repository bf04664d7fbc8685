"""Strokes in Grease Pencil data are the engine's strokes, in every Blender."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
import pytest

from .example_drawings import cross, many_strokes


def make(bpy, part, drawing, pixel_map=None):
    """Write a drawing into a new object at frame 1."""
    trace = part("operators.tracing.trace")
    state = part("operators.grease_pencil.state")
    obj = trace.new_object("Ink")
    bpy.context.scene.collection.objects.link(obj)
    pixel_map = pixel_map or part("operators.grease_pencil.core.pixel_map").front_view(drawing.size)
    key = state.add(obj.data, drawing, pixel_map, "test")
    part("operators.grease_pencil.writing").write(obj.data, 1, drawing, pixel_map, key)
    return obj, pixel_map


def curves_of(part, obj, layer="Black", frame=1):
    layers = part("operators.grease_pencil.cels")
    return layers.read(obj.data.layers[layer].get_frame_at(frame).drawing)


def with_handles(stroke):
    """The same anchors as a Bezier stroke."""
    handles = np.stack([stroke.points - 5, stroke.points + 4], axis=1)
    return replace(stroke, handles=handles.astype(np.float32))


@pytest.mark.parametrize("curve", ["polyline", "bezier"])
def test_strokes_arrive_whole(bpy, part, curve):
    drawing = cross(part)
    if curve == "bezier":
        drawing = replace(drawing, strokes=tuple(map(with_handles, drawing.strokes)))
    obj, pixel_map = make(bpy, part, drawing)
    curves = curves_of(part, obj)
    assert len(curves) == len(drawing.strokes)
    points = np.concatenate([s.points for s in drawing.strokes])
    widths = np.concatenate([s.widths for s in drawing.strokes])
    np.testing.assert_allclose(pixel_map.to_pixels(curves.point("position")), points, atol=1e-3)
    np.testing.assert_allclose(curves.point("radius"), widths / 2 * pixel_map.unit, rtol=1e-5)
    np.testing.assert_allclose(
        curves.point("opacity"), np.concatenate([s.opacity for s in drawing.strokes])
    )
    assert curves.curve("cyclic").tolist() == [s.closed for s in drawing.strokes]
    if curve == "bezier":
        handles = np.concatenate([s.handles for s in drawing.strokes])
        left = pixel_map.to_pixels(curves.point("handle_left"))
        np.testing.assert_allclose(left, handles[:, 0], atol=1e-3)
        assert set(curves.curve("curve_type")) == {2}


def test_drawing_lies_in_the_front_view_two_metres_tall(bpy, part):
    pixel_map = part("operators.grease_pencil.core.pixel_map").front_view((400, 300))
    corners = pixel_map.to_object(np.array([[0, 0], [400, 300]]))
    np.testing.assert_allclose(corners[:, 2], [1, -1])
    np.testing.assert_allclose(corners[:, 0], [-4 / 3, 4 / 3], rtol=1e-6)
    np.testing.assert_allclose(corners[:, 1], 0)


def test_inks_become_layers_and_materials(bpy, part):
    drawing = cross(part)
    red = replace(drawing.strokes[0], color=(200, 30, 40))
    obj, _ = make(bpy, part, replace(drawing, strokes=(red, *drawing.strokes[1:])))
    assert {layer.name for layer in obj.data.layers} == {"Black", "Red"}
    assert len(curves_of(part, obj, "Red")) == 1
    slot = int(curves_of(part, obj, "Red").curve("material_index")[0])
    color = obj.data.materials[slot].grease_pencil.color
    assert color[0] > 0.5 > color[1]  # linear


def test_solid_blacks_lie_below_without_their_holes(bpy, part):
    square = np.array([[0, 0], [100, 0], [100, 100], [0, 100]], np.float32)
    drawing = replace(cross(part), fills=((square, square[::-1] * 0.5 + 25),))
    obj, pixel_map = make(bpy, part, drawing)
    assert [layer.name for layer in obj.data.layers] == ["Solids", "Black"]
    curves = curves_of(part, obj, "Solids")
    x, y = pixel_map.to_pixels(curves.point("position")).T
    area = abs(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2
    assert area == pytest.approx(100 * 100 - 50 * 50, rel=1e-4)
    material = obj.data.materials[int(curves.curve("material_index")[0])]
    if bpy.app.version >= (5, 1, 0):
        assert curves.curve("fill_id")[0] > 0
        assert curves.curve("hide_stroke")[0]
    else:
        assert material.grease_pencil.show_fill
        assert not material.grease_pencil.show_stroke


def test_replace_keeps_order_and_other_attributes(bpy, part):
    gp = part("operators.grease_pencil.cels")
    curves = part("operators.grease_pencil.core.stroke_arrays")
    obj, _ = make(bpy, part, cross(part))
    drawing = obj.data.layers["Black"].get_frame_at(1).drawing
    attribute = drawing.attributes.new("mine", "FLOAT", "CURVE")
    attribute.data.foreach_set("value", np.array([1, 2, 3], np.float32))
    before = gp.read(drawing)
    single = curves.Curves(
        np.array([0, 2], np.int32),
        {"position": curves.Column("FLOAT_VECTOR", np.ones((2, 3), np.float32))},
        {"mine": curves.Column("FLOAT", np.full((1, 1), 9, np.float32))},
    )
    gp.replace(drawing, [1], single, [1])
    after = gp.read(drawing)
    assert after.curve("mine").tolist() == [1, 9, 3]
    assert after.sizes.tolist() == [before.sizes[0], 2, before.sizes[2]]
    np.testing.assert_array_equal(
        after.point("position")[-before.sizes[2] :], before.point("position")[-before.sizes[2] :]
    )


def test_tracing_again_keeps_strokes_drawn_by_hand(bpy, part):
    gp = part("operators.grease_pencil.cels")
    curves = part("operators.grease_pencil.core.stroke_arrays")
    drawing = cross(part)
    obj, pixel_map = make(bpy, part, drawing)
    cel = obj.data.layers["Black"].get_frame_at(1).drawing
    cel.add_strokes([5])
    part("operators.grease_pencil.writing").write(obj.data, 1, drawing, pixel_map, 77)
    assert gp.read(cel).curve(curves.TRACE).tolist() == [0, 77, 77, 77]


def test_ten_thousand_strokes_take_a_fifth_of_a_second(bpy, part):
    drawing = many_strokes(part, 10_000, 50)
    pixel_map = part("operators.grease_pencil.core.pixel_map").front_view(drawing.size)
    obj = part("operators.tracing.trace").new_object("Many")
    start = time.process_time()
    part("operators.grease_pencil.writing").write(obj.data, 1, drawing, pixel_map, 1)
    print(f"10,000 strokes of 50 points: {time.process_time() - start:.3f} s of CPU")
    assert len(curves_of(part, obj)) == 10_000


@pytest.mark.parametrize(
    ("color", "name"),
    [
        ((10, 10, 12), "Black"),
        ((130, 128, 125), "Gray"),
        ((200, 30, 40), "Red"),
        ((60, 90, 200), "Blue"),
        ((110, 160, 230), "Blue"),
        ((40, 140, 60), "Green"),
        ((90, 50, 20), "Brown"),
    ],
)
def test_ink_names(part, color, name):
    assert part("engine.ink.ink_names").ink_name(color) == name
