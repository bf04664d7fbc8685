"""Choosing among the cards of a junction: what `choose` and `review` share."""

from __future__ import annotations

import bpy

from ..view.card_layout import card_at
from ..view.on_screen import cards_of
from ..view.view_state import Shown, redraw, shown_in, view_of
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
_PADS = tuple(f"NUMPAD_{number}" for number in range(1, 10))


class CardChoice(JunctionOperator):
    """Mixin: the cards of the current junction are open; subclasses say what a choice does."""

    def decide(self, context: bpy.types.Context, shown: Shown, alternative: int) -> set[str]:
        """The artist chose a card, by click, digit or Enter."""
        raise NotImplementedError

    def accept(self, context: bpy.types.Context, shown: Shown) -> set[str]:
        """Enter where no card is pointed at."""
        return {"RUNNING_MODAL"}

    def lock(self, context: bpy.types.Context, shown: Shown) -> set[str]:
        """The artist pressed L."""
        raise NotImplementedError

    def click_elsewhere(
        self, context: bpy.types.Context, shown: Shown, mouse: tuple[float, float]
    ) -> set[str]:
        """A click beside the cards."""
        raise NotImplementedError

    def other_key(self, context: bpy.types.Context, shown: Shown, key: str) -> set[str]:
        """Any other key that is pressed."""
        return {"PASS_THROUGH"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Point, step, decide or leave."""
        shown = shown_in(context)
        if shown is None or shown.junction is None or not shown.view.choosing:
            return self.leave(context, {"CANCELLED"})
        mouse = event.mouse_region_x, event.mouse_region_y
        if event.type == "MOUSEMOVE":
            self._point(context, shown, mouse)
            return {"RUNNING_MODAL"}
        if event.value != "PRESS" or event.ctrl or event.oskey or event.shift:
            return {"PASS_THROUGH"}
        if event.type == "LEFTMOUSE":
            card = card_at(cards_of(context, shown)[0], *mouse)
            if card >= 0:
                return self.decide(context, shown, card)
            return self.click_elsewhere(context, shown, mouse)
        return self._key(context, shown, event.type)

    def _key(self, context: bpy.types.Context, shown: Shown, key: str) -> set[str]:
        ways, preview = len(shown.junction.alternatives), shown.view.preview
        if key in _STEPS:
            shown.view.preview = step(preview, _STEPS[key], ways)
            redraw(context)
            return {"RUNNING_MODAL"}
        for keys in (_DIGITS, _PADS):
            if key in keys[:ways]:
                return self.decide(context, shown, keys.index(key))
        if key in {"RET", "NUMPAD_ENTER"}:
            if preview < 0:
                return self.accept(context, shown)
            return self.decide(context, shown, preview)
        if key == "L":
            return self.lock(context, shown)
        if key in {"ESC", "RIGHTMOUSE"}:
            return self.leave(context, {"CANCELLED"})
        return self.other_key(context, shown, key)

    def begin(self, context: bpy.types.Context, status: str) -> set[str]:
        """Open the cards and wait."""
        view_of(context).choosing = True
        context.workspace.status_text_set(status)
        context.window_manager.modal_handler_add(self)
        redraw(context)
        return {"RUNNING_MODAL"}

    def leave(self, context: bpy.types.Context, result: set[str]) -> set[str]:
        """Close the cards."""
        view = view_of(context)
        view.choosing, view.preview = False, -1
        context.workspace.status_text_set(None)
        redraw(context)
        return result

    def _point(self, context: bpy.types.Context, shown: Shown, mouse: tuple[float, float]) -> None:
        """The card under the mouse is previewed; off the cards, what the wheel chose stays."""
        card = card_at(cards_of(context, shown)[0], *mouse)
        was_on_card = getattr(self, "_on_card", False)
        self._on_card = card >= 0
        if card >= 0 or was_on_card:
            shown.view.preview = card
            redraw(context)


def step(preview: int, by: int, count: int) -> int:
    """The next alternative to preview; the first step shows the best or the last one."""
    if preview < 0:
        return 0 if by > 0 else count - 1
    return (preview + by) % count
