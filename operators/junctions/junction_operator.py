"""What all operators on junctions share: when they can run, and how they change a drawing."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import bpy
from bpy.props import IntProperty

from ...engine import InvoluteError
from ..grease_pencil.routing_change import change_routing
from ..language import message
from ..view.view_state import Shown, redraw, select, shown_in

if TYPE_CHECKING:
    from ...engine import Drawing


def junction_property() -> object:
    """Which junction an operator is for: the same for buttons, keys and scripts."""
    return IntProperty(
        name="Junction", description="Number of the junction; -1 is the current one", default=-1
    )


def alternative_property() -> object:
    """Which of the ways through it."""
    return IntProperty(
        name="Alternative", description="Which alternative, the most probable is 0", min=0
    )


def change_shown(
    context: bpy.types.Context, shown: Shown, how: Callable[[Drawing], Drawing]
) -> None:
    """Change a drawing, its strokes and its state; who looks at it goes on looking at it.

    Raises:
        InvoluteError: the change can't be made; nothing was changed.
    """
    from ...engine.decisions import number_in

    view, before = shown.view, shown.trace
    trace = change_routing(shown.object.data, shown.frame, before.key, how)
    if view.key == before.key:
        view.key = trace.key
        if view.junction >= 0:
            view.junction = number_in(trace.drawing, before.drawing, view.junction)
    shown.view.preview = -1
    redraw(context)


class JunctionOperator:
    """Mixin for operators on the traced drawing of the active object."""

    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Is there a traced drawing to work on? Else say why not."""
        try:
            found = shown_in(context) is not None
        except InvoluteError as problem:
            cls.poll_message_set(message(problem))
            return False
        if not found:
            cls.poll_message_set(message("Select a drawing that Involute has traced"))
        return found

    def change(self, context: bpy.types.Context, how: Callable[[Drawing], Drawing]) -> set[str]:
        """Change the drawing, its strokes and its state; report what goes wrong."""
        try:
            change_shown(context, shown_in(context), how)
        except InvoluteError as problem:
            self.report({"ERROR"}, message(problem))
            return {"CANCELLED"}
        return {"FINISHED"}

    def apply_alternative(
        self, context: bpy.types.Context, junction: int, alternative: int
    ) -> set[str]:
        """Reroute a junction (-1 is the current one) and make it the current one."""
        shown = shown_in(context)
        index = shown.view.junction if junction < 0 else junction
        if not 0 <= index < len(shown.table):
            self.report({"ERROR"}, message("Choose a junction first."))
            return {"CANCELLED"}
        ways = shown.trace.drawing.asked(index).alternatives
        if alternative >= len(ways):
            said = message("This junction has {count} alternatives.", count=len(ways))
            self.report({"ERROR"}, said)
            return {"CANCELLED"}
        select(shown, index)
        pairs = ways[alternative].pairs
        return self.change(context, lambda drawing: drawing.reroute(index, pairs))
