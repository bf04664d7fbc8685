"""The pie menu: what is wanted most while going from junction to junction."""

from __future__ import annotations

import bpy

from ...operators.junctions.ask_again import INVOLUTE_OT_ask_again
from ...operators.junctions.choose import INVOLUTE_OT_choose
from ...operators.junctions.go_to_junction import INVOLUTE_OT_step_junction
from ...operators.junctions.lock import INVOLUTE_OT_lock
from ...operators.junctions.review import INVOLUTE_OT_review
from ...operators.junctions.separate import INVOLUTE_OT_separate


class INVOLUTE_MT_pie(bpy.types.Menu):
    """Previous, next, choose, lock, separate, ask again, review."""

    bl_idname = "INVOLUTE_MT_pie"
    bl_label = "Junctions"

    def draw(self, context: bpy.types.Context) -> None:
        """The seven slices."""
        pie = self.layout.menu_pie()
        step = INVOLUTE_OT_step_junction.bl_idname
        pie.operator(step, text="Previous", icon="TRIA_LEFT").direction = "PREVIOUS"
        pie.operator(step, text="Next", icon="TRIA_RIGHT").direction = "NEXT"
        pie.operator(INVOLUTE_OT_choose.bl_idname, text="Choose Routing", icon="MOD_LINEART")
        pie.operator(INVOLUTE_OT_lock.bl_idname, text="Lock or Unlock", icon="LOCKED")
        pie.operator(INVOLUTE_OT_separate.bl_idname, text="Separate All Lines", icon="UNLINKED")
        pie.operator(INVOLUTE_OT_ask_again.bl_idname, icon="FILE_REFRESH")
        pie.operator(INVOLUTE_OT_review.bl_idname, icon="PLAY")


CLASSES = (INVOLUTE_MT_pie,)
