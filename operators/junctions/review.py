"""Go through doubtful junctions and bundles, the most costly first: a key decides and goes on."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..language import label, message
from ..view.alike import decided_alike
from ..view.on_screen import junction_under
from ..view.view_state import Shown, make_current, redraw, select, shown_in, view_of
from .card_choice import CardChoice
from .go_to_junction import look_at

if TYPE_CHECKING:
    from ...engine import Drawing

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
        self._skipped: set[int] = set()  # those of them that stay open
        self._settled = 0  # doubts that went when others were decided
        shown = shown_in(context)
        self._numbered_in = shown.trace.drawing  # what these numbers are of
        if len(open_doubts(shown, ())) == 0:
            self.report({"INFO"}, message("No junction is doubtful any more."))
            return {"CANCELLED"}
        self._show(context, shown, int(open_doubts(shown, ())[0]))
        return self.begin(context, self._status(shown))

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """As ever; undo may have brought back lines of before an answer."""
        shown = shown_in(context)
        if shown is not None and shown.view.choosing and shown.view.key != shown.trace.key:
            self._follow(shown)
            left = open_doubts(shown, self._skipped)
            if len(left):
                self._show(context, shown, int(left[0]))
        return super().modal(context, event)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Scripts decide by `involute.reroute`; there is nothing to show them."""
        self.report({"ERROR"}, message("A review needs a 3D viewport."))
        return {"CANCELLED"}

    def decide(self, context: bpy.types.Context, shown: Shown, alternative: int) -> set[str]:
        """Apply, and go on with the next."""
        index = shown.junction.index
        pairs = shown.junction.alternatives[alternative].pairs
        return self._decided(context, shown, lambda drawing: drawing.reroute(index, pairs))

    def accept(self, context: bpy.types.Context, shown: Shown) -> set[str]:
        """The routing in force is right: lock it, and go on."""
        return self.lock(context, shown)

    def lock(self, context: bpy.types.Context, shown: Shown) -> set[str]:
        """Lock the junction as it is, and go on."""
        index = shown.junction.index
        return self._decided(context, shown, lambda drawing: drawing.lock(index))

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
        """Backspace goes back to the junction before, Space and N skip one, S decides all that are
        like it as well."""
        index = shown.junction.index
        if key in {"SPACE", "N"}:
            self._skipped.add(index)
            return self._go_on(context, index)
        if key == "S":
            pairs = shown.junction.pairs
            if shown.view.preview >= 0:
                pairs = shown.junction.alternatives[shown.view.preview].pairs
            return self._decided(context, shown, lambda d: decided_alike(d, index, pairs))
        if key != "BACK_SPACE":
            return {"PASS_THROUGH"}
        if self._passed:
            before = self._passed.pop()
            self._skipped.discard(before)
            if before < 0:  # an answer made other lines, and it is gone
                return {"RUNNING_MODAL"}
            if shown.table.locked[before]:
                drawing = shown.trace.drawing
                self._change(context, lambda drawing: drawing.unlock(before))
                (before,) = _numbers_now([before], drawing, shown_in(context).trace.drawing)
            if before >= 0:
                self._show(context, shown_in(context), before)
        return {"RUNNING_MODAL"}

    def _decided(
        self, context: bpy.types.Context, shown: Shown, how: Callable[[Drawing], Drawing]
    ) -> set[str]:
        """Decide, ask again what lies around it, count what that settled, and go on."""
        index, before = shown.junction.index, shown.trace.drawing
        open_before = open_doubts(shown, (index,)).tolist()
        if self._change(context, how):
            now = shown_in(context)
            there = _numbers_now(open_before, before, now.trace.drawing)
            left = open_doubts(now, ()).tolist()
            self._settled += sum(number not in left for number in there)
            (index,) = _numbers_now([index], before, now.trace.drawing)
        else:  # it can't be decided now
            self._skipped.add(index)
        return self._go_on(context, index)

    def _change(self, context: bpy.types.Context, how: Callable[[Drawing], Drawing]) -> bool:
        """One step to undo: a decision, and what it teaches about the junctions around it."""

        def asked(drawing: Drawing) -> Drawing:
            return how(drawing).ask_around(drawing)

        if self.change(context, asked) != {"FINISHED"}:
            return False
        self._follow(shown_in(context))
        bpy.ops.ed.undo_push(message="Review Junctions")
        return True

    def _follow(self, shown: Shown) -> None:
        """An answer about a bundle, or a step of undo, made other lines: what numbers they have."""
        before, self._numbered_in = self._numbered_in, shown.trace.drawing
        self._passed = _numbers_now(self._passed, before, self._numbered_in)
        self._skipped = set(_numbers_now(self._skipped, before, self._numbered_in))

    def _go_on(self, context: bpy.types.Context, passed: int) -> set[str]:
        self._passed.append(passed)
        shown = shown_in(context)
        left = open_doubts(shown, self._skipped)
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
        left = open_doubts(shown, self._skipped)
        done = [one for one in self._passed if one not in left]  # the others were undone
        long = _LONG * max(shown.trace.drawing.size)
        number = len(done) + 1
        return label(
            "{number} of {all}, {long} long strokes left, {settled} settled by your decisions: "
            "digit or click decides, Enter accepts, S decides all that are alike, Space skips, "
            "Backspace goes back, Esc leaves",
            number=number,
            all=max(number, len(done) + len(left)),
            long=int((shown.table.cost[left] > long).sum()),
            settled=self._settled,
        )


def _numbers_now(numbers: Iterable[int], before: Drawing, now: Drawing) -> list[int]:
    """The numbers that places have after a change; -1 = an answer made other lines there."""
    from ...engine.decisions import number_in

    return [number if number < 0 else number_in(now, before, number) for number in numbers]


def open_doubts(shown: Shown, passed: object) -> np.ndarray:
    """The doubtful junctions that are neither locked nor passed, the most costly first."""
    listed = shown.table.listed("COST", doubtful=True, unlocked=True)
    return listed[np.isin(listed, list(passed), invert=True)]


CLASSES = (INVOLUTE_OT_review,)
