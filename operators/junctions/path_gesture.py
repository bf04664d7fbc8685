"""Drawing a path with the mouse: what dragging to join and cutting with a swipe share."""

from __future__ import annotations

from collections.abc import Callable

import bpy
import numpy as np
from bpy.props import CollectionProperty

from ..language import reported
from ..view.view_state import places_of, redraw, traced_in, view_of
from .junction_operator import JunctionOperator

Array = np.ndarray


class PathGesture(JunctionOperator):
    """Mixin: the mouse draws a path while its button is down; subclasses say what that does."""

    bl_options = {"INTERNAL"}  # what it does is the step to undo

    def begins_at(self, context: bpy.types.Context, mouse: tuple[float, float]) -> bool:
        """Is a drag from there ours?"""
        return next(traced_in(context), None) is not None

    def drawn(self, context: bpy.types.Context, places: Array) -> set[str]:
        """The path is there, (N, 2) px of the region."""
        raise NotImplementedError

    def do(self, operator: Callable[..., set[str]], **options: object) -> set[str]:
        """Run the operator that the path means; what it reports is told, not raised."""
        try:
            return operator("EXEC_DEFAULT", True, **options)
        except RuntimeError as problem:
            self.report({"ERROR"}, reported(problem))
            return {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Begin where the button went down; elsewhere the drag belongs to others."""
        if context.region_data is None:
            return {"CANCELLED"}
        region = context.region
        start = event.mouse_region_x, event.mouse_region_y
        if event.value != "PRESS":  # the drag is known by now, the button went down before
            start = event.mouse_prev_press_x - region.x, event.mouse_prev_press_y - region.y
        if not self.begins_at(context, start):
            return {"PASS_THROUGH"}
        view_of(context).trail.clear()
        self._add(context, start)
        self._add(context, (event.mouse_region_x, event.mouse_region_y))
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Draw on; where the button goes up, do it."""
        mouse = event.mouse_region_x, event.mouse_region_y
        if event.type in {"MOUSEMOVE", "INBETWEEN_MOUSEMOVE"}:
            self._add(context, mouse)
            return {"RUNNING_MODAL"}
        if event.type in {"ESC", "RIGHTMOUSE"}:
            self._leave(context)
            return {"CANCELLED"}
        if event.type != "LEFTMOUSE" or event.value != "RELEASE":
            return {"RUNNING_MODAL"}
        self._add(context, mouse)
        places = places_of(view_of(context).trail)
        self._leave(context)
        return self.drawn(context, places)

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender itself ends the operator."""
        self._leave(context)

    def _add(self, context: bpy.types.Context, place: tuple[float, float]) -> None:
        view_of(context).trail.add().loc = place
        redraw(context)

    def _leave(self, context: bpy.types.Context) -> None:
        view_of(context).trail.clear()
        redraw(context)


def draw_box(context: bpy.types.Context, corner: tuple[float, float]) -> None:
    """Let the path be a box from where it began to a corner, px of the region."""
    trail = view_of(context).trail
    (x, y), (right, top) = trail[0].loc, corner
    trail.clear()
    for place in ((x, y), (right, y), (right, top), (x, top), (x, y)):
        trail.add().loc = place
    redraw(context)


def path_property(description: str) -> object:
    """The property `path` of an operator that acts along one, px of the drawing."""
    return CollectionProperty(
        type=bpy.types.OperatorMousePath,
        name="Path",
        description=description,
        options={"SKIP_SAVE"},
    )


def as_items(path: Array) -> list[dict[str, object]]:
    """A path (N, 2) as operators take it; `places_of` gives it back."""
    return [{"name": "", "loc": (float(x), float(y)), "time": 0.0} for x, y in path]
