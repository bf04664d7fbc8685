"""Go through the doubtful junctions, the most costly first: a key decides and goes on."""

from __future__ import annotations

import bpy
import numpy as np

from ..language import label, message
from ..view.on_screen import junction_under
from ..view.view_state import Shown, make_current, redraw, select, shown_in, view_of
from .card_choice import CardChoice
from .go_to_junction import look_at

_LONG = 0.05  # of the drawing's longer side; a stroke part that costs more is a long one


class INVOLUTE_OT_review(CardChoice, bpy.types.Operator):
    """Decide the doubtful junctions one after the other, those first where most depends on it"""

    bl_idname = "involute.review"
    bl_label = "Review Junctions"
    bl_options = {"REGISTER"}  # every decision is a step to undo of its own

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Fly to the most costly doubt and open its cards."""
        if context.region_data is None:
            return {"CANCELLED"}
        self._passed: list[int] = []  # junctions that were decided or skipped, in order
        shown = shown_in(context)
        self._total = len(open_doubts(shown, ()))
        if self._total == 0:
            self.report({"INFO"}, message("No junction is doubtful any more."))
            return {"CANCELLED"}
        self._show(context, shown, int(open_doubts(shown, ())[0]))
        return self.begin(context, self._status(shown))

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Scripts decide by `involute.reroute`; there is nothing to show them."""
        self.report({"ERROR"}, message("A review needs a 3D viewport."))
        return {"CANCELLED"}

    def decide(self, context: bpy.types.Context, shown: Shown, alternative: int) -> set[str]:
        """Apply, and go on with the next."""
        index = shown.junction.index
        if self.apply_alternative(context, index, alternative) == {"FINISHED"}:
            bpy.ops.ed.undo_push(message="Review Junctions")
        return self._go_on(context, index)

    def accept(self, context: bpy.types.Context, shown: Shown) -> set[str]:
        """The routing in force is right: lock it, and go on."""
        return self.lock(context, shown)

    def lock(self, context: bpy.types.Context, shown: Shown) -> set[str]:
        """Lock the junction as it is, and go on."""
        index = shown.junction.index
        if self.change(context, lambda drawing: drawing.lock(index)) == {"FINISHED"}:
            bpy.ops.ed.undo_push(message="Review Junctions")
        return self._go_on(context, index)

    def click_elsewhere(
        self, context: bpy.types.Context, shown: Shown, mouse: tuple[float, float]
    ) -> set[str]:
        """The junction there comes first; other clicks are not ours."""
        found = junction_under(context, mouse)
        if found is None:
            return {"PASS_THROUGH"}
        make_current(context, *found)
        return {"RUNNING_MODAL"}

    def other_key(self, context: bpy.types.Context, shown: Shown, key: str) -> set[str]:
        """Backspace goes back to the junction before, Space and N skip one."""
        if key in {"SPACE", "N"}:
            return self._go_on(context, shown.junction.index)
        if key != "BACK_SPACE":
            return {"PASS_THROUGH"}
        if self._passed:
            before = self._passed.pop()
            if shown.table.locked[before]:
                self.change(context, lambda drawing: drawing.unlock(before))
                bpy.ops.ed.undo_push(message="Review Junctions")
            self._show(context, shown_in(context), before)
        return {"RUNNING_MODAL"}

    def _go_on(self, context: bpy.types.Context, passed: int) -> set[str]:
        self._passed.append(passed)
        shown = shown_in(context)
        left = open_doubts(shown, self._passed)
        if len(left) == 0:
            self.report({"INFO"}, message("No junction is doubtful any more."))
            return self.leave(context, {"FINISHED"})
        self._show(context, shown, int(left[0]))
        return {"RUNNING_MODAL"}

    def _show(self, context: bpy.types.Context, shown: Shown, junction: int) -> None:
        select(shown, junction)
        look_at(context, shown, junction)
        view_of(context).choosing = True
        context.workspace.status_text_set(self._status(shown))
        redraw(context)

    def _status(self, shown: Shown) -> str:
        left = open_doubts(shown, self._passed)
        long = _LONG * max(shown.trace.drawing.size)
        return label(
            "{number} of {all}, {long} long strokes left: digit or click decides, Enter accepts, "
            "Space skips, Backspace goes back, Esc leaves",
            number=min(len(self._passed) + 1, self._total),
            all=self._total,
            long=int((shown.table.cost[left] > long).sum()),
        )


def open_doubts(shown: Shown, passed: object) -> np.ndarray:
    """The doubtful junctions that are neither locked nor passed, the most costly first."""
    listed = shown.table.listed("COST", doubtful=True, unlocked=True)
    return listed[np.isin(listed, list(passed), invert=True)]


CLASSES = (INVOLUTE_OT_review,)
