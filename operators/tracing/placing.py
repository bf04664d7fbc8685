"""Where a new drawing stands in the scene, when no image Empty says so."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING, Any

from bpy.props import BoolProperty, EnumProperty, FloatProperty
from mathutils import Matrix, Vector

from ...engine import InvoluteError
from ..grease_pencil.core.pixel_map import PixelMap, front_view
from ..view.framing import looks_through_camera

if TYPE_CHECKING:
    import bpy

_HEIGHT = 2.0  # metres, of a drawing whose size nobody asked for
_SOLID = {"MESH", "CURVE", "SURFACE", "META", "FONT", "VOLUME"}
_GAP = 0.1  # metres before what stands at the origin
_DISTANCE = 5.0  # metres from a camera that the 3D cursor lies behind
# A drawing lies in the XZ plane of its object; this lays it into an XY plane, seen from above.
_INTO_XY = Matrix.Rotation(-pi / 2, 4, "X")


class PlacingSettings:
    """Mixin: where new objects stand and how large they are."""

    __annotations__ = {
        "place": EnumProperty(
            name="Place",
            description="Where a new drawing stands; on an image Empty it always lies on the image",
            items=[
                (
                    "AUTO",
                    "Automatic",
                    "Fit to the camera while you look through it, else front view",
                ),
                ("FRONT", "Front View", "Upright at the world's origin, before what stands there"),
                ("CAMERA", "Fit to Camera", "Fill the view of the scene's camera, facing it"),
                ("PLANE", "Drawing Plane", "As the scene's Stroke Placement and Drawing Plane say"),
            ],
            default="AUTO",
        ),
        "pixels_per_metre": FloatProperty(
            name="Pixels per Metre",
            description="Size of a new drawing; 0 makes it 2 metres tall. Fit to Camera ignores it",
            default=0.0,
            min=0.0,
            soft_max=10000.0,
        ),
        "order": EnumProperty(
            name="Stroke Order",
            description="In which order and direction the strokes are drawn",
            items=[
                ("PAGE", "As Found", "As the lines were found on the page"),
                (
                    "HAND",
                    "As by Hand",
                    "Long outlines first, from left to right and top to bottom, one neighborhood "
                    "after the other; for the Build modifier",
                ),
            ],
            default="PAGE",
        ),
        "show_scan": BoolProperty(
            name="Scan Behind",
            description="Show the picture, paled and on paper, behind the strokes that were traced "
            "from it",
            default=True,
        ),
    }


def placing_values(source: PlacingSettings) -> dict[str, Any]:
    """The settings as operators take them."""
    return {name: getattr(source, name) for name in PlacingSettings.__annotations__}


def place_drawing(
    context: bpy.types.Context, size: tuple[int, int], place: str, pixels_per_metre: float
) -> tuple[PixelMap, Matrix]:
    """Where the pixels lie in a new object, and where the object stands.

    Raises:
        InvoluteError: there is no camera to fit to.
    """
    height = size[1] / pixels_per_metre if pixels_per_metre else _HEIGHT
    if fits_camera(context, place):
        height, matrix = _before_camera(context.scene, size)
    elif place == "PLANE":
        matrix = _drawing_plane(context)
    else:
        width = height * size[0] / size[1]
        matrix = Matrix.Translation((0.0, _before_others(context, width, height), 0.0))
    return front_view(size, height), matrix


def fits_camera(context: bpy.types.Context, place: str) -> bool:
    """Is a new drawing to fill the camera's view?"""
    return place == "CAMERA" or (place == "AUTO" and looks_through_camera(context))


def _before_others(context: bpy.types.Context, width: float, height: float) -> float:
    """How far to the front a drawing at the origin stands before what it would lie inside of."""
    front = 0.0
    for obj in context.visible_objects:
        if obj.type in _SOLID:
            corners = [obj.matrix_world @ Vector(corner) for corner in obj.bound_box]
            low, high = (Vector(map(pick, zip(*corners, strict=True))) for pick in (min, max))
            across = low.x < width / 2 and high.x > -width / 2
            if across and low.z < height / 2 and high.z > -height / 2 and low.y <= 0 <= high.y:
                front = min(front, low.y - _GAP)
    return front


def _before_camera(scene: bpy.types.Scene, size: tuple[int, int]) -> tuple[float, Matrix]:
    """The height of a drawing that just fits the camera's view, and where it stands then.

    It is as far away as the 3D cursor.
    """
    camera = scene.camera
    if camera is None:
        raise InvoluteError("There is no camera in the scene to fit to; add one, or place it else.")
    location, rotation, _ = camera.matrix_world.decompose()
    at = Matrix.LocRotScale(location, rotation, None)
    distance = -(at.inverted() @ scene.cursor.location).z
    if distance <= camera.data.clip_start:
        distance = _DISTANCE
    corners = camera.data.view_frame(scene=scene)
    grow = 1.0 if camera.data.type == "ORTHO" else distance / -corners[0].z
    right, left = (pick(c.x for c in corners) * grow for pick in (max, min))
    top, bottom = (pick(c.y for c in corners) * grow for pick in (max, min))
    height = min(top - bottom, (right - left) * size[1] / size[0])
    middle = Matrix.Translation(((left + right) / 2, (bottom + top) / 2, -distance))
    return height, at @ middle @ _INTO_XY


def _drawing_plane(context: bpy.types.Context) -> Matrix:
    """The plane in which the artist draws by hand."""
    tools, cursor = context.scene.tool_settings, context.scene.cursor
    where = cursor.location if tools.gpencil_stroke_placement_view3d == "CURSOR" else (0, 0, 0)
    axis = tools.gpencil_sculpt.lock_axis
    region = context.region_data
    if axis == "AXIS_X":
        turn = Matrix.Rotation(pi / 2, 4, "Z")
    elif axis == "AXIS_Z":
        turn = _INTO_XY
    elif axis == "CURSOR":
        turn = cursor.matrix.to_3x3().normalized().to_4x4() @ _INTO_XY
    elif axis == "VIEW" and region is not None:
        turn = region.view_rotation.to_matrix().to_4x4() @ _INTO_XY
    else:
        turn = Matrix()
    return Matrix.Translation(where) @ turn
