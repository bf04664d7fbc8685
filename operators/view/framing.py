"""Look straight at a drawing."""

from __future__ import annotations

import bpy


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


def look_straight_at(context: bpy.types.Context, objects: list[bpy.types.Object]) -> None:
    """Turn the view to face the drawings and fill it with them; a camera's view stays."""
    view = largest_view(context)
    if view is None or looks_through_camera(context):
        return
    area, region, _ = view
    before = [obj for obj in context.selected_objects if obj not in objects]
    for obj in before:
        obj.select_set(False)
    for obj in objects:
        obj.select_set(True)
    with context.temp_override(window=context.window, area=area, region=region):
        bpy.ops.view3d.view_axis(type="FRONT", align_active=True)
        view[2].view_perspective = "ORTHO"
        bpy.ops.view3d.view_selected()
    for obj in objects:
        obj.select_set(False)
