"""Keep a junction as it is, or let it be decided anew."""

from __future__ import annotations

import bpy

from ..language import message
from ..view.view_state import shown_in
from .junction_operator import JunctionOperator, junction_property


class INVOLUTE_OT_lock(JunctionOperator, bpy.types.Operator):
    """Lock the junction: it counts as certain, and Ask Again learns from it; or unlock it"""

    bl_idname = "involute.lock"
    bl_label = "Lock Junction"

    junction: junction_property()

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Lock the junction, or unlock it when it is locked."""
        shown = shown_in(context)
        index = shown.view.junction if self.junction < 0 else self.junction
        if not 0 <= index < len(shown.table):
            self.report({"ERROR"}, message("Choose a junction first."))
            return {"CANCELLED"}
        if shown.table.locked[index]:
            return self.change(context, lambda drawing: drawing.unlock(index))
        return self.change(context, lambda drawing: drawing.lock(index))


CLASSES = (INVOLUTE_OT_lock,)
