"""Point at a junction and choose among its alternatives, each previewed before it is applied."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, IntProperty

from ..language import label
from ..view.card_layout import card_at
from ..view.on_screen import cards_of, junction_under
from ..view.view_state import Shown, make_current, redraw, shown_in, view_of
from .junction_operator import JunctionOperator

_STEPS = {
    "WHEELUPMOUSE": -1,
    "WHEELDOWNMOUSE": 1,
    "LEFT_ARROW": -1,
    "RIGHT_ARROW": 1,
    "UP_ARROW": -1,
    "DOWN_ARROW": 1,
}
_DIGITS = ("ONE", "TWO", "THREE", "FOUR", "FIVE", "SIX", "SEVEN", "EIGHT", "NINE")


class INVOLUTE_OT_choose(JunctionOperator, bpy.types.Operator):
    """Show the alternatives of a junction as cards: point to preview, click to apply"""

    bl_idname = "involute.choose"
    bl_label = "Choose Routing"

    pick: BoolProperty(
        name="Pick",
        description="Take the junction under the mouse instead of the current one",
        default=False,
        options={"SKIP_SAVE", "HIDDEN"},
    )
    junction: IntProperty(
        name="Junction", description="Number of the junction; -1 is the current one", default=-1
    )
    alternative: IntProperty(
        name="Alternative", description="Which alternative, the most probable is 0", min=0
    )

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Show the cards; with `pick` of the junction under the mouse."""
        if context.region_data is None:
            return {"CANCELLED"}
        if self.pick:
            found = junction_under(context, (event.mouse_region_x, event.mouse_region_y))
            if found is None:
                return {"PASS_THROUGH"}
            make_current(context, *found)
        shown = shown_in(context)
        if shown is None or shown.junction is None:
            return {"CANCELLED"}
        shown.view.choosing = True
        context.workspace.status_text_set(
            label(
                "Point at a card to preview, click or Enter to apply, wheel or arrows for the "
                "next, L locks, Esc leaves"
            )
        )
        context.window_manager.modal_handler_add(self)
        redraw(context)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Point, step, apply or leave."""
        shown = shown_in(context)
        if shown is None or shown.junction is None or not shown.view.choosing:
            return self._leave(context, {"CANCELLED"})
        ways = len(shown.junction.alternatives)
        mouse = event.mouse_region_x, event.mouse_region_y
        if event.type == "MOUSEMOVE":
            self._point(context, shown, mouse)
        elif event.value != "PRESS":
            return {"PASS_THROUGH"}
        elif event.type in _STEPS:
            shown.view.preview = step(shown.view.preview, _STEPS[event.type], ways)
            redraw(context)
        elif event.type in _DIGITS[:ways]:
            return self._apply(context, shown, _DIGITS.index(event.type))
        elif event.type in {"RET", "NUMPAD_ENTER"} and shown.view.preview >= 0:
            return self._apply(context, shown, shown.view.preview)
        elif event.type == "LEFTMOUSE":
            card = card_at(cards_of(context, shown), *mouse)
            if card >= 0:
                return self._apply(context, shown, card)
            found = junction_under(context, mouse)
            if found is None:
                return self._leave(context, {"CANCELLED"})
            make_current(context, *found)
        elif event.type == "L":
            index = shown.junction.index
            locked = shown.junction.locked
            result = self.change(context, lambda d: d.unlock(index) if locked else d.lock(index))
            return self._leave(context, result)
        elif event.type in {"ESC", "RIGHTMOUSE"}:
            return self._leave(context, {"CANCELLED"})
        else:
            return {"PASS_THROUGH"}
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Adjust Last Operation: another alternative for the same junction."""
        return self.apply_alternative(context, self.junction, self.alternative)

    def _point(self, context: bpy.types.Context, shown: Shown, mouse: tuple[float, float]) -> None:
        """The card under the mouse is previewed; off the cards, what the wheel chose stays."""
        card = card_at(cards_of(context, shown), *mouse)
        was_on_card = getattr(self, "_on_card", False)
        self._on_card = card >= 0
        if card >= 0 or was_on_card:
            shown.view.preview = card
            redraw(context)

    def _apply(self, context: bpy.types.Context, shown: Shown, alternative: int) -> set[str]:
        self.junction, self.alternative = shown.junction.index, alternative
        return self._leave(context, self.execute(context))

    def _leave(self, context: bpy.types.Context, result: set[str]) -> set[str]:
        view = view_of(context)
        view.choosing, view.preview = False, -1
        context.workspace.status_text_set(None)
        redraw(context)
        return result


def step(preview: int, by: int, count: int) -> int:
    """The next alternative to preview; the first step shows the best or the last one."""
    if preview < 0:
        return 0 if by > 0 else count - 1
    return (preview + by) % count


CLASSES = (INVOLUTE_OT_choose,)
