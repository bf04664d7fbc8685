"""Show an alternative in the viewport without applying it."""

from __future__ import annotations

import bpy
from bpy.props import IntProperty

from ..view.view_state import redraw, view_of
from .junction_operator import JunctionOperator


class INVOLUTE_OT_preview(JunctionOperator, bpy.types.Operator):
    """Show this alternative in the viewport without applying it; again to stop"""

    bl_idname = "involute.preview"
    bl_label = "Preview Alternative"
    bl_options = {"INTERNAL"}

    alternative: IntProperty(name="Alternative", description="Which alternative", min=0)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Show the alternative, or stop showing it."""
        view = view_of(context)
        view.preview = -1 if view.preview == self.alternative else self.alternative
        redraw(context)
        return {"FINISHED"}


CLASSES = (INVOLUTE_OT_preview,)
