"""Lock all junctions that are nearly certain."""

from __future__ import annotations

import bpy

from ..language import message
from ..view.view_state import certainty_property, shown_in
from .junction_operator import JunctionOperator


class INVOLUTE_OT_accept(JunctionOperator, bpy.types.Operator):
    """Lock every junction that is at least this certain"""

    bl_idname = "involute.accept"
    bl_label = "Accept Certain Junctions"

    probability: certainty_property(least=0.0)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Lock them, and say how many there were."""
        before = int(shown_in(context).table.locked.sum())
        result = self.change(context, lambda d: d.accept_above(self.probability / 100))
        if result == {"FINISHED"}:
            locked = int(shown_in(context).table.locked.sum()) - before
            self.report({"INFO"}, message("{count} junctions accepted", count=locked))
        return result


CLASSES = (INVOLUTE_OT_accept,)
