"""Scribble to route: one stroke follows the line that was drawn along."""

from __future__ import annotations

import bpy
from bpy.props import FloatProperty

from ..language import message
from ..view.following import followed
from ..view.view_state import places_of, shown_in
from .junction_operator import JunctionOperator
from .path_gesture import path_property


class INVOLUTE_OT_route_along(JunctionOperator, bpy.types.Operator):
    """Let one stroke follow a path; what else meets on its way is decided anew around it"""

    bl_idname = "involute.route_along"
    bl_label = "Route Along Path"

    path: path_property("Where the stroke is to run, in pixels of the scan")
    radius: FloatProperty(
        name="Radius",
        description="How far lines may lie from the path, in pixels of the scan",
        default=12.0,
        min=0.5,
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Find the lines that the path follows, and join them to one stroke."""
        drawing = shown_in(context).trace.drawing
        halves = followed(drawing.graph, places_of(self.path), self.radius)
        if len(halves) < 2:
            said = message("Draw along a line, over at least one junction.")
            self.report({"INFO"}, said)
            return {"CANCELLED"}
        return self.change(context, lambda d: d.reroute_along(halves))


CLASSES = (INVOLUTE_OT_route_along,)
