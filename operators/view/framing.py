"""Look straight at a drawing."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np
from mathutils import Matrix, Quaternion, Vector

from .card_layout import Card
from .on_screen import free_part_of

if TYPE_CHECKING:
    from ..grease_pencil.core.pixel_map import PixelMap

Array = np.ndarray

_FILLED = 0.9  # of what is free of the viewport; the rest is margin


def largest_view(
    context: bpy.types.Context,
) -> tuple[bpy.types.Area, bpy.types.Region, bpy.types.RegionView3D] | None:
    """The largest 3D viewport of the window; None without one."""
    screen = context.window.screen if context.window else context.screen
    areas = [area for area in screen.areas if area.type == "VIEW_3D"] if screen else []
    if not areas:
        return None
    area = max(areas, key=lambda area: area.width * area.height)
    region = next(region for region in area.regions if region.type == "WINDOW")
    return area, region, area.spaces.active.region_3d


def looks_through_camera(context: bpy.types.Context) -> bool:
    """Does the artist see the scene as its camera does, as in 2D animation?"""
    view = largest_view(context)
    return (
        context.scene.camera is not None
        and view is not None
        and view[2].view_perspective == "CAMERA"
    )


def look_straight_at(
    context: bpy.types.Context, obj: bpy.types.Object, pixel_map: PixelMap, size: tuple[int, int]
) -> None:
    """Turn the view to face a drawing and fill what is free of it; a camera's view stays.

    Args:
        pixel_map: where the pixels of its page lie in the object.
        size: (width, height) of the page.
    """
    view = largest_view(context)
    if view is None or looks_through_camera(context):
        return
    area, region, region_3d = view
    turn = facing(obj.matrix_world, pixel_map)
    region_3d.view_perspective, region_3d.view_rotation = "ORTHO", turn
    region_3d.update()
    with context.temp_override(window=context.window, area=area, region=region):
        free = free_part_of(context)
    matrix = np.array(obj.matrix_world)
    corners = np.array([(0, 0), (size[0], 0), size, (0, size[1])], float)
    places = pixel_map.to_object(corners) @ matrix[:3, :3].T + matrix[:3, 3]
    axes = np.array(turn.to_matrix())  # columns: right, up and toward the eye
    seen = 0.5 * region.width * region_3d.window_matrix[0][0]  # px per metre
    middle, scale = fitted(places @ axes, free, (region.width, region.height))
    region_3d.view_distance *= seen / scale
    region_3d.view_location = Vector((axes @ middle).tolist())


def facing(matrix: Matrix, pixel_map: PixelMap) -> Quaternion:
    """The rotation of a view to which a page is upright, its left side at the left.

    Args:
        matrix: of the object that the page lies on, upright in it or flat as on an image Empty.
    """
    turn = np.array(matrix.to_3x3())
    right, up = turn @ pixel_map.right, turn @ -pixel_map.down
    eye = np.cross(right, up)
    axes = np.column_stack([right, np.cross(eye, right), eye])
    return Matrix((axes / np.linalg.norm(axes, axis=0)).tolist()).to_quaternion()


def fitted(places: Array, free: Card, size: tuple[float, float]) -> tuple[Array, float]:
    """What an orthographic view looks at, and how large, to show places in a part of its region.

    Args:
        places: (N, 3) along the view's own axes: right, up, toward the eye.
        free: the part of the region that nothing covers.
        size: of the region, px.

    Returns:
        (3,) what lies in the middle of the region, along the same axes; px per unit.
    """
    low, high = places.min(0), places.max(0)
    across, up, _ = np.maximum(high - low, 1e-9)
    scale = _FILLED * min(free.width / across, free.height / up)
    off = np.array([free.x + free.width / 2, free.y + free.height / 2]) - np.array(size) / 2
    middle = (low + high) / 2
    middle[:2] -= off / scale
    return middle, float(scale)
