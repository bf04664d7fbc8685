"""Drag a box over the scan: the part inside is traced to see what the settings do."""

from __future__ import annotations

import bpy
import numpy as np

from ...engine import InvoluteError
from ..junctions.path_gesture import draw_box
from ..language import label, message, reported
from ..view.on_screen import places_on_page, viewport_under
from ..view.view_state import places_of, redraw, view_of
from . import part as parts
from .part import Page

_SIDE = 320  # px of the page around a click; traced in about a second
_CLICK = 6.0  # px of the screen; what is shorter is no box


class INVOLUTE_OT_choose_part(bpy.types.Operator):
    """Drag a box over the scan to see what the settings do there; each change shows at once"""

    bl_idname = "involute.choose_part"
    bl_label = "Try on a Part"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Is there a picture to see?"""
        try:
            parts.page_of(context)
        except InvoluteError as problem:
            cls.poll_message_set(message(problem))
            return False
        return True

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Wait for the box."""
        self._page = parts.page_of(context)
        self._viewport: tuple[bpy.types.Area, bpy.types.Region] | None = None
        context.window.cursor_modal_set("CROSSHAIR")
        said = label("Drag a box over the scan, or click it; Esc leaves")
        context.workspace.status_text_set(f"Involute: {said}")
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Draw the box while the button is down; the view can be moved before."""
        if event.type in {"ESC", "RIGHTMOUSE"}:
            self.cancel(context)
            return {"CANCELLED"}
        mouse = event.mouse_x, event.mouse_y
        if self._viewport is None:
            return self._begin(context, mouse) if _pressed(event) else {"PASS_THROUGH"}
        _, region = self._viewport
        place = mouse[0] - region.x, mouse[1] - region.y
        if event.type in {"MOUSEMOVE", "INBETWEEN_MOUSEMOVE"}:
            draw_box(context, place)
        elif event.type == "LEFTMOUSE" and event.value == "RELEASE":
            draw_box(context, place)
            return self._chosen(context)
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Take back what was shown while it waited."""
        view_of(context).trail.clear()
        context.window.cursor_modal_restore()
        context.workspace.status_text_set(None)
        redraw(context)

    def _begin(self, context: bpy.types.Context, mouse: tuple[float, float]) -> set[str]:
        found = viewport_under(context, mouse)
        if found is None:  # a button of the sidebar, another editor
            return {"PASS_THROUGH"}
        self._viewport = found
        _, region = found
        trail = view_of(context).trail
        trail.clear()
        trail.add().loc = mouse[0] - region.x, mouse[1] - region.y
        return {"RUNNING_MODAL"}

    def _chosen(self, context: bpy.types.Context) -> set[str]:
        """Trace what lies inside."""
        corners = places_of(view_of(context).trail)
        self.cancel(context)
        area, region = self._viewport
        if self._page.object is None:
            return {"CANCELLED"}
        try:
            with context.temp_override(area=area, region=region):
                box = box_of(context, self._page, corners)
                bpy.ops.involute.try_part("INVOKE_DEFAULT", box=box)
        except (InvoluteError, RuntimeError) as problem:
            told = isinstance(problem, RuntimeError)
            self.report({"ERROR"}, reported(problem) if told else message(problem))
            return {"CANCELLED"}
        return {"FINISHED"}


def box_of(context: bpy.types.Context, page: Page, corners: np.ndarray) -> parts.Box:
    """The part of a page that a box encloses, (N, 2) px of the region; around a click a square.

    Raises:
        InvoluteError: it lies beside the page.
    """
    places = places_on_page(context, page, corners)
    if np.ptp(corners, axis=0).max() <= _CLICK * context.preferences.system.ui_scale:
        places = places.mean(0) + np.array([(-0.5, -0.5), (0.5, 0.5)]) * _SIDE
    return parts.box_around(places, page)


def _pressed(event: bpy.types.Event) -> bool:
    return event.type == "LEFTMOUSE" and event.value == "PRESS"


CLASSES = (INVOLUTE_OT_choose_part,)
