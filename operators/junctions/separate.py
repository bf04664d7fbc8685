"""End lines at a junction by hand."""

from __future__ import annotations

import bpy
from bpy.props import IntProperty

from ..language import message
from ..view.view_state import select, shown_in
from .junction_operator import JunctionOperator, junction_property


class INVOLUTE_OT_separate(JunctionOperator, bpy.types.Operator):
    """End a line at its junction, or all lines of the current junction"""

    bl_idname = "involute.separate"
    bl_label = "Separate Lines"

    half: IntProperty(
        name="Line", description="Number of the half-branch; -1 separates all", default=-1
    )
    junction: junction_property()

    def execute(self, context: bpy.types.Context) -> set[str]:
        """End one line, or all of the junction; the other pairs stay."""
        shown = shown_in(context)
        junctions = shown.trace.drawing.junctions
        if self.half >= 0:
            junction = next((j for j in junctions if self.half in j.half_branches), None)
        elif 0 <= self.junction < len(junctions):
            junction = junctions[self.junction]
        else:
            junction = shown.junction
        if junction is None:
            self.report({"ERROR"}, message("Choose a junction first."))
            return {"CANCELLED"}
        pairs = [p for p in junction.pairs if self.half >= 0 and self.half not in p]
        select(shown, junction.index)
        return self.change(context, lambda d: d.reroute(junction.index, pairs))


CLASSES = (INVOLUTE_OT_separate,)
