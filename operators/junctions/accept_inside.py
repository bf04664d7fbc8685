"""Lock all junctions that a lasso or a box encloses."""

from __future__ import annotations

import bpy
import numpy as np
from bpy.props import BoolProperty

from ..language import message
from ..view.on_screen import places_on_page
from ..view.picking import inside
from ..view.view_state import make_current, places_of, shown_in, traced_in, view_of
from .junction_operator import JunctionOperator
from .path_gesture import PathGesture, as_items, draw_box, path_property


class INVOLUTE_OT_accept_inside(JunctionOperator, bpy.types.Operator):
    """Lock every junction inside an outline as it is"""

    bl_idname = "involute.accept_inside"
    bl_label = "Accept Inside"

    path: path_property("The outline, in pixels of the scan")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Lock them, and say how many there were."""
        table = shown_in(context).table
        there = inside(table.positions, places_of(self.path)) & ~table.locked
        chosen = np.flatnonzero(there).tolist()
        if not chosen:
            self.report({"INFO"}, message("No open junction lies inside."))
            return {"CANCELLED"}
        result = self.change(context, lambda drawing: drawing.lock_all(chosen))
        if result == {"FINISHED"}:
            self.report({"INFO"}, message("{count} junctions accepted", count=len(chosen)))
        return result


class INVOLUTE_OT_lasso_accept(PathGesture, bpy.types.Operator):
    """Draw around junctions to accept them as they are"""

    bl_idname = "involute.lasso_accept"
    bl_label = "Lasso to Accept"

    box: BoolProperty(
        name="Box", description="Draw a box instead", default=False, options={"SKIP_SAVE"}
    )

    def drawn(self, context: bpy.types.Context, places: np.ndarray) -> set[str]:
        """Accept what is inside; of several drawings, the first that has something there."""
        for shown in traced_in(context):
            outline = places_on_page(context, shown, places)
            if (inside(shown.table.positions, outline) & ~shown.table.locked).any():
                make_current(context, shown, shown.view.junction)
                path = as_items(outline)
                return self.do(bpy.ops.involute.accept_inside, path=path)
        self.report({"INFO"}, message("No open junction lies inside."))
        return {"CANCELLED"}

    def _add(self, context: bpy.types.Context, place: tuple[float, float]) -> None:
        if self.box and len(view_of(context).trail):
            draw_box(context, place)
        else:
            super()._add(context, place)


CLASSES = (INVOLUTE_OT_accept_inside, INVOLUTE_OT_lasso_accept)
