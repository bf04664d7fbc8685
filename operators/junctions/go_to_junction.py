"""Make a junction the current one and move the view there."""

from __future__ import annotations

import bpy
import numpy as np
from bpy.props import BoolProperty, EnumProperty, IntProperty
from mathutils import Vector

from ..language import message
from ..view.view_state import Shown, redraw, select, shown_in
from .junction_operator import JunctionOperator

_CLOSE_UP = 60.0  # pen widths that the view shows across, at most


class INVOLUTE_OT_go_to_junction(JunctionOperator, bpy.types.Operator):
    """Look at this junction"""

    bl_idname = "involute.go_to_junction"
    bl_label = "Go to Junction"
    bl_options = {"INTERNAL"}  # looking is nothing to undo

    junction: IntProperty(name="Junction", description="Number of the junction", min=0)
    move_view: BoolProperty(
        name="Move View", description="Bring the junction to the middle of the view", default=True
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Select the junction and look at it."""
        shown = shown_in(context)
        places = shown.table.positions
        if self.junction >= len(places) or not np.isfinite(places[self.junction]).all():
            return {"CANCELLED"}
        select(shown, self.junction)
        if self.move_view:
            look_at(context, shown, self.junction)
        redraw(context)
        return {"FINISHED"}


class INVOLUTE_OT_step_junction(JunctionOperator, bpy.types.Operator):
    """Go to the next or previous junction of the list"""

    bl_idname = "involute.step_junction"
    bl_label = "Next or Previous Junction"
    bl_options = {"INTERNAL"}

    direction: EnumProperty(
        name="Direction",
        description="Which way along the list",
        items=[
            ("NEXT", "Next", "The next junction of the list"),
            ("PREVIOUS", "Previous", "The junction before in the list"),
        ],
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Select the next one of the list and look at it."""
        shown = shown_in(context)
        listed = shown.listed
        if len(listed) == 0:
            self.report({"INFO"}, message("No junction passes the filters."))
            return {"CANCELLED"}
        current = shown.junction.index if shown.junction else -1
        here = np.flatnonzero(listed == current)
        if len(here):
            place = int(here[0]) + (1 if self.direction == "NEXT" else -1)
        else:  # the current one has just been decided: go on with what is left
            place = 0 if self.direction == "NEXT" else -1
        chosen = int(listed[place % len(listed)])
        select(shown, chosen)
        look_at(context, shown, chosen)
        redraw(context)
        return {"FINISHED"}


def look_at(context: bpy.types.Context, shown: Shown, junction: int) -> None:
    """Move the 3D viewport of the context, or the largest one, to a junction."""
    region_3d = _region_3d(context)
    if region_3d is None or region_3d.view_perspective == "CAMERA":
        return
    region_3d.view_location = Vector(shown.world_positions[junction].tolist())
    drawing = shown.trace.drawing
    widths = drawing.graph.widths
    pen = float(np.median(widths)) if widths is not None and len(widths) else 3.0
    scale = max(shown.object.matrix_world.to_scale())
    across = _CLOSE_UP * pen * shown.pixel_map.unit * scale
    region_3d.view_distance = min(region_3d.view_distance, across)


def _region_3d(context: bpy.types.Context) -> bpy.types.RegionView3D | None:
    if context.region_data is not None:
        return context.region_data
    screen = context.screen or (context.window.screen if context.window else None)
    areas = [area for area in screen.areas if area.type == "VIEW_3D"] if screen else []
    if not areas:
        return None
    return max(areas, key=lambda area: area.width * area.height).spaces.active.region_3d


CLASSES = (INVOLUTE_OT_go_to_junction, INVOLUTE_OT_step_junction)
