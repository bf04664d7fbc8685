"""Apply an alternative to a junction."""

from __future__ import annotations

import bpy
from bpy.props import IntProperty

from .junction_operator import JunctionOperator


class INVOLUTE_OT_reroute(JunctionOperator, bpy.types.Operator):
    """Let the lines continue through the junction in this way; only they change"""

    bl_idname = "involute.reroute"
    bl_label = "Reroute Junction"

    junction: IntProperty(
        name="Junction", description="Number of the junction; -1 is the current one", default=-1
    )
    alternative: IntProperty(
        name="Alternative", description="Which alternative, the most probable is 0", min=0
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Apply the alternative; only strokes through the junction change."""
        return self.apply_alternative(context, self.junction, self.alternative)


CLASSES = (INVOLUTE_OT_reroute,)
