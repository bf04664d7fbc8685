"""Drag from one line to another to join them; Ctrl-click a line to end it at its junction."""

from __future__ import annotations

import bpy
import numpy as np

from ..language import message
from ..view.on_screen import halves_under
from ..view.picking import nearest_pair
from ..view.view_state import Shown, make_current, redraw, view_of
from .junction_operator import JunctionOperator


class INVOLUTE_OT_drag_join(JunctionOperator, bpy.types.Operator):
    """Drag from one line to another that meets it at a junction to join them"""

    bl_idname = "involute.drag_join"
    bl_label = "Drag to Join"
    bl_options = {"INTERNAL"}  # the joining itself is the step to undo

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Begin at the line under the mouse; elsewhere the drag belongs to others."""
        if context.region_data is None:
            return {"CANCELLED"}
        region = context.region
        start = event.mouse_prev_press_x - region.x, event.mouse_prev_press_y - region.y
        found = halves_under(context, start)
        if found is None:
            return {"PASS_THROUGH"}
        shown, self._first = found
        make_current(context, shown, _junction_of(shown, min(self._first, key=self._first.get)))
        shown.view.drag = (*start, event.mouse_region_x, event.mouse_region_y)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Draw the line of the drag; where it ends, join."""
        view = view_of(context)
        mouse = event.mouse_region_x, event.mouse_region_y
        if event.type == "MOUSEMOVE":
            view.drag = (*view.drag[:2], *mouse)
            redraw(context)
            return {"RUNNING_MODAL"}
        if event.type in {"ESC", "RIGHTMOUSE"}:
            return self._leave(context, {"CANCELLED"})
        if event.type != "LEFTMOUSE" or event.value != "RELEASE":
            return {"RUNNING_MODAL"}
        found = halves_under(context, mouse)
        self._leave(context, {"FINISHED"})
        vertex = found[0].trace.drawing.graph.half_vertex if found else None
        pair = nearest_pair(self._first, found[1], vertex) if found else None
        if pair is None:
            said = message("Drag from one line to another that meets it at a junction.")
            self.report({"INFO"}, said)
            return {"CANCELLED"}
        make_current(context, found[0], _junction_of(found[0], pair[0]))
        return bpy.ops.involute.join("EXEC_DEFAULT", True, first=pair[0], second=pair[1])

    def _leave(self, context: bpy.types.Context, result: set[str]) -> set[str]:
        view_of(context).drag = (0, 0, 0, 0)
        redraw(context)
        return result


class INVOLUTE_OT_separate_under_mouse(JunctionOperator, bpy.types.Operator):
    """End the line under the mouse at its junction"""

    bl_idname = "involute.separate_under_mouse"
    bl_label = "Separate Line"
    bl_options = {"INTERNAL"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Separate the line under the mouse."""
        if context.region_data is None:
            return {"CANCELLED"}
        found = halves_under(context, (event.mouse_region_x, event.mouse_region_y))
        if found is None:
            return {"PASS_THROUGH"}
        shown, near = found
        half = min(near, key=near.get)
        make_current(context, shown, _junction_of(shown, half))
        return bpy.ops.involute.separate("EXEC_DEFAULT", True, half=half)


def _junction_of(shown: Shown, half: int) -> int:
    graph = shown.trace.drawing.graph
    return int(np.searchsorted(graph.junctions, graph.half_vertex[half]))


CLASSES = (INVOLUTE_OT_drag_join, INVOLUTE_OT_separate_under_mouse)
