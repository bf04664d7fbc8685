"""How readily strokes end at corners, changed on a finished drawing."""

from __future__ import annotations

import bpy
from bpy.props import FloatProperty

from ...engine import InvoluteError
from ...engine.settings import ABOUT
from ..language import label, message
from ..view.view_state import shown_in
from .junction_operator import JunctionOperator, change_shown

_ABOUT = ABOUT["corners"]


class INVOLUTE_OT_pen_lifts(JunctionOperator, bpy.types.Operator):
    """Decide all corners that you have not decided yourself anew"""

    bl_idname = "involute.pen_lifts"
    bl_label = "Set Pen Lifts"

    bias: FloatProperty(
        name=_ABOUT.label,
        description=_ABOUT.tip,
        default=0.0,
        min=_ABOUT.low,
        max=_ABOUT.high,
        subtype="FACTOR",
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Decide the corners, and say how many strokes there are now."""
        if not shown_in(context).has_corners:
            said = message("Nobody looked for corners; trace again with Pen Lifts above -1.")
            self.report({"ERROR"}, said)
            return {"CANCELLED"}
        result = self.change(context, lambda drawing: drawing.with_corners(self.bias))
        if result == {"FINISHED"}:
            strokes = len(shown_in(context).trace.drawing.strokes)
            self.report({"INFO"}, message("{count} strokes", count=strokes))
        return result


def _get(obj: bpy.types.Object) -> float:
    try:
        shown = shown_in(bpy.context, obj)
    except InvoluteError:
        return -1.0
    return -1.0 if shown is None else shown.trace.drawing.settings.corners


def _set(obj: bpy.types.Object, bias: float) -> None:
    """The slider was moved: strokes end and go on at once."""
    context = bpy.context
    try:
        shown = shown_in(context, obj)
        if shown is not None and shown.has_corners:
            change_shown(context, shown, lambda d: d.with_corners(round(bias, 4)))
    except InvoluteError as problem:
        _say(context, message(problem))


def _say(context: bpy.types.Context, sentence: str) -> None:
    """A property can't report: what is wrong pops up instead."""
    if bpy.app.background:
        print(sentence)
        return

    def draw(menu: bpy.types.Menu, _: bpy.types.Context) -> None:
        menu.layout.label(text=sentence, translate=False)

    context.window_manager.popup_menu(draw, title=label(_ABOUT.label), icon="ERROR")


def register() -> None:
    """Give objects the slider."""
    bpy.types.Object.involute_pen_lifts = FloatProperty(
        name=_ABOUT.label,
        description=_ABOUT.tip,
        min=_ABOUT.low,
        max=_ABOUT.high,
        subtype="FACTOR",
        precision=2,
        get=_get,
        set=_set,
        options={"SKIP_SAVE"},
    )


def unregister() -> None:
    """Take it away again."""
    del bpy.types.Object.involute_pen_lifts


CLASSES = (INVOLUTE_OT_pen_lifts,)
