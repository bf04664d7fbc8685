"""Apply an alternative to a junction."""

from __future__ import annotations

import bpy

from .junction_operator import JunctionOperator, alternative_property, junction_property


class INVOLUTE_OT_reroute(JunctionOperator, bpy.types.Operator):
    """Let the lines continue through the junction in this way; only they change"""

    bl_idname = "involute.reroute"
    bl_label = "Reroute Junction"

    junction: junction_property()
    alternative: alternative_property()

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Apply the alternative; only strokes through the junction change."""
        return self.apply_alternative(context, self.junction, self.alternative)


CLASSES = (INVOLUTE_OT_reroute,)
