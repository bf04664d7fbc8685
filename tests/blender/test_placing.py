"""New drawings stand where they are asked to: before the camera, in the drawing plane, to scale."""

from __future__ import annotations

import numpy as np
import pytest

from .example_drawings import cross, grid
from .test_grease_pencil import make

SIZE = (160, 120)
CORNERS = np.array([[0, 0], [160, 0], [160, 120], [0, 120]], float)


@pytest.fixture
def corners(bpy, part):
    """World places of the picture's corners: top left, top right, bottom right, bottom left."""

    def find(place, pixels_per_metre=0.0):
        bpy.context.view_layer.update()
        place_drawing = part("operators.tracing.placing").place_drawing
        pixel_map, matrix = place_drawing(bpy.context, SIZE, place, pixels_per_metre)
        local = np.c_[pixel_map.to_object(CORNERS), np.ones(4)]
        return (local @ np.array(matrix).T)[:, :3]

    return find


@pytest.fixture
def camera(bpy):
    made = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    made.location, made.rotation_euler = (3, -6, 4), (1.1, 0.1, 0.5)
    bpy.context.scene.collection.objects.link(made)
    bpy.context.scene.camera = made
    return made


@pytest.mark.parametrize("kind", ["PERSP", "ORTHO"])
@pytest.mark.parametrize("resolution", [(1920, 1080), (400, 900)])
def test_it_fills_the_cameras_view(bpy, corners, camera, kind, resolution):
    from bpy_extras.object_utils import world_to_camera_view
    from mathutils import Vector

    scene = bpy.context.scene
    camera.data.type = kind
    camera.data.shift_x = 0.1
    scene.render.resolution_x, scene.render.resolution_y = resolution
    seen = [world_to_camera_view(scene, camera, Vector(c)) for c in corners("CAMERA")]
    x, y, depth = np.array(seen).T
    full = max(np.ptp(x), np.ptp(y))
    assert abs(full - 1) < 1e-4
    assert np.allclose([x.mean(), y.mean()], 0.5, atol=1e-4)
    assert np.ptp(depth) < 1e-4
    assert x[0] < x[1]
    assert y[0] > y[3]  # neither turned over nor upside down


def test_without_a_camera_it_says_so(bpy, part, corners):
    with pytest.raises(part("engine").InvoluteError, match="no camera"):
        corners("CAMERA")


def test_pixels_per_metre(corners):
    for place in ("FRONT", "PLANE"):
        found = corners(place, 80.0)
        assert np.isclose(np.linalg.norm(found[1] - found[0]), 2.0)
        assert np.isclose(np.linalg.norm(found[3] - found[0]), 1.5)
    assert np.isclose(np.linalg.norm(np.subtract(*corners("FRONT")[[0, 3]])), 2.0)


@pytest.mark.parametrize(
    ("axis", "right", "up"),
    [
        ("AXIS_Y", (1, 0, 0), (0, 0, 1)),
        ("AXIS_X", (0, 1, 0), (0, 0, 1)),
        ("AXIS_Z", (1, 0, 0), (0, 1, 0)),
        ("CURSOR", (0, 1, 0), (-1, 0, 0)),
    ],
)
def test_it_lies_in_the_drawing_plane(bpy, corners, axis, right, up):
    scene = bpy.context.scene
    scene.tool_settings.gpencil_sculpt.lock_axis = axis
    scene.tool_settings.gpencil_stroke_placement_view3d = "CURSOR"
    scene.cursor.location, scene.cursor.rotation_euler = (1, 2, 3), (0, 0, np.pi / 2)
    found = corners("PLANE", 80.0)
    assert np.allclose(found.mean(0), (1, 2, 3), atol=1e-5)
    assert np.allclose((found[1] - found[0]) / 2.0, right, atol=1e-5)
    assert np.allclose((found[0] - found[3]) / 1.5, up, atol=1e-5)


def test_the_trace_stands_there(bpy, part, corners, camera, tmp_path):
    part("engine.scan")
    import cv2

    page = np.full((120, 160), 250, np.uint8)
    cv2.line(page, (10, 60), (150, 60), 10, 3)
    cv2.imwrite(str(tmp_path / "line.png"), page)
    expected = corners("CAMERA")
    assert bpy.ops.involute.trace(filepath=str(tmp_path / "line.png"), place="CAMERA") == {
        "FINISHED"
    }
    bpy.context.view_layer.update()
    obj = bpy.context.active_object
    points = [p.position for p in obj.data.layers["Black"].frames[0].drawing.strokes[0].points]
    ends = np.array([obj.matrix_world @ points[0], obj.matrix_world @ points[-1]])
    middle = (expected[0] + expected[3]) / 2, (expected[1] + expected[2]) / 2
    reach = np.linalg.norm(middle[1] - middle[0])
    near = min(np.abs(ends - middle).max(), np.abs(ends[::-1] - middle).max())
    assert near < 0.12 * reach


def test_the_view_shows_all_of_a_page_in_what_is_free(part):
    """A sidebar on the right: the page lies left of it, as large as fits, with a margin."""
    framing, card = part("operators.view.framing"), part("operators.view.card_layout").Card
    places = np.array([(-1.0, 2, -1), (-1, 2, 1), (3, 2, 1), (3, 2, -1)])[:, [0, 2, 1]]
    middle, scale = framing.fitted(places, card(100, 0, 400, 600), (800, 600))
    seen = (places - middle)[:, :2] * scale + (400, 300)
    assert np.allclose(seen.min(0)[0], 120)
    assert np.allclose(seen.max(0)[0], 480)
    assert np.allclose((seen.min(0) + seen.max(0))[1] / 2, 300)


def test_a_click_beside_the_lines_keeps_the_drawing_in_the_sidebar(bpy, part, tmp_path):
    """What lies behind becomes the active object; another drawing takes over, though."""
    view_state = part("operators.view.view_state")
    obj, _ = make(bpy, part, cross(part))
    other, _ = make(bpy, part, grid(part, 3))
    bpy.context.view_layer.objects.active = obj
    view_state.select(view_state.shown_in(bpy.context), 0)
    bpy.ops.mesh.primitive_cube_add()
    assert view_state.shown_in(bpy.context).object == obj
    assert bpy.ops.involute.lock(junction=0) == {"FINISHED"}
    bpy.ops.object.grease_pencil_add(type="EMPTY")  # as in Draw Mode of a 2D scene
    assert view_state.shown_in(bpy.context).object == obj
    bpy.context.view_layer.objects.active = other
    assert view_state.shown_in(bpy.context).object == other
    obj.hide_viewport = True
    bpy.context.view_layer.objects.active = bpy.data.objects["Cube"]
    bpy.context.view_layer.update()
    assert view_state.shown_in(bpy.context) is None


@pytest.mark.parametrize("flat", [False, True])
def test_the_view_faces_the_page(part, flat):
    """Also one that lies on an image Empty, flat in its object."""
    from mathutils import Matrix, Vector

    framing = part("operators.view.framing")
    maps = part("operators.grease_pencil.core.pixel_map")
    lies = maps.front_view((160, 120))
    if flat:
        right, up = np.array([0.01, 0, 0]), np.array([0, 0.01, 0])
        lies = maps.PixelMap(np.zeros(3), right, -up)
    stands = Matrix.LocRotScale((1, 2, 3), Matrix.Rotation(0.7, 3, "Z"), (2, 2, 2))
    matrix = stands @ Matrix.Rotation(np.pi / 2, 4, "X") if flat else stands
    turn = np.array(framing.facing(matrix, lies).to_matrix())
    right, up, eye = (np.array(stands.to_3x3() @ Vector(v)) / 2 for v in np.eye(3)[[0, 2, 1]])
    np.testing.assert_allclose(turn, np.column_stack([right, up, -eye]), atol=1e-6)
