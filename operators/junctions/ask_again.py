"""Decide the junctions that are not locked anew, given those that are."""

from __future__ import annotations

import bpy

from ..language import message
from ..view.view_state import shown_in
from .junction_operator import JunctionOperator


class INVOLUTE_OT_ask_again(JunctionOperator, bpy.types.Operator):
    """Route all junctions that are not locked again, given what you have fixed"""

    bl_idname = "involute.ask_again"
    bl_label = "Ask Again"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Route anew, and say how many junctions changed."""
        before = shown_in(context).trace.drawing
        result = self.change(context, lambda drawing: drawing.ask_again())
        if result == {"FINISHED"}:
            after = shown_in(context).trace.drawing
            pairs = zip(before.junctions, after.junctions, strict=True)
            changed = sum(one.pairs != other.pairs for one, other in pairs)
            self.report({"INFO"}, message("{count} junctions changed", count=changed))
        return result


CLASSES = (INVOLUTE_OT_ask_again,)
