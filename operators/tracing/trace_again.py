"""Trace the picture of the active drawing again, in its place; what the artist did stays."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import bpy
from bpy.props import BoolProperty

from ...engine import InvoluteError
from ..grease_pencil import state
from ..grease_pencil.retracing import retrace
from ..junctions.junction_operator import JunctionOperator
from ..language import message
from ..view.view_state import redraw, shown_in
from . import part, sources
from .background import JobOperator
from .settings_layout import draw_settings
from .trace_job import TraceJob
from .trace_settings import (
    NAMES,
    TraceOptions,
    engine_settings,
    scene_settings,
    take_from_engine,
    take_from_sidebar,
)

if TYPE_CHECKING:
    from ...engine import Settings


class INVOLUTE_OT_trace_again(JobOperator, JunctionOperator, TraceOptions, bpy.types.Operator):
    """Trace the picture of this drawing again with other settings; decisions and changes stay"""

    bl_idname = "involute.trace_again"
    bl_label = "Trace Again"

    only_changed: BoolProperty(
        name="Only What Changed",
        description="Do nothing if the drawing has these settings already",
        default=False,
        options={"SKIP_SAVE", "HIDDEN"},
    )

    def begin(self, context: bpy.types.Context) -> TraceJob:
        """Find the picture; settings that nobody gave are those of the drawing."""
        shown = shown_in(context)
        drawing = shown.trace.drawing
        own = [name for name in NAMES if not self.properties.is_property_set(name)]
        take_from_engine(self, drawing.settings, own)
        self._object, self._key, self._frame = shown.object.name, shown.trace.key, shown.frame
        picture = state.picture_of(shown.object.data, shown.trace.key)
        source = sources.noted(picture, shown.trace.source)
        return TraceJob([source], self._wanted(drawing.settings))

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Start with the sidebar's settings."""
        take_from_sidebar(self, context)
        settings = shown_in(context).trace.drawing.settings
        if self.only_changed and self._wanted(settings) == settings:
            return {"CANCELLED"}
        return super().invoke(context, event)

    def _wanted(self, settings: Settings) -> Settings:
        """Those of the drawing, but for what is set here."""
        chosen = engine_settings(self)
        return replace(settings, **{name: getattr(chosen, name) for name in NAMES})

    def finish(self, context: bpy.types.Context, job: TraceJob) -> set[str]:
        """Put the new strokes in the place of the old ones."""
        if job.cancelled:
            self.report({"INFO"}, message("Tracing was cancelled."))
            return {"CANCELLED"}
        result = job.results[0] if job.results else None
        if result is None or result.drawing is None:
            problem = result.problem if result else job.problem
            self.report({"ERROR"}, message(problem or "There is nothing to trace."))
            return {"CANCELLED"}
        obj = bpy.data.objects.get(self._object)
        try:
            if obj is None:
                raise InvoluteError("The drawing was deleted meanwhile.")
            done = retrace(obj.data, self._frame, self._key, result.drawing)
        except InvoluteError as problem:
            self.report({"ERROR"}, message(problem))
            return {"CANCELLED"}
        part.show(None)  # all of it is there now
        view = context.window_manager.involute_view
        view.key, view.junction, view.preview = done.key, -1, -1
        redraw(context)
        said = [message("{count} strokes", count=len(result.drawing.strokes))]
        if done.kept:
            said.append(message("{count} that you changed stay", count=done.kept))
        if done.decisions:
            said.append(message("{count} decisions have no place any more", count=done.decisions))
        self.report({"WARNING" if done.decisions else "INFO"}, ", ".join(said))
        return {"FINISHED"}

    def draw(self, context: bpy.types.Context) -> None:
        """The settings in Adjust Last Operation."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        draw_settings(self.layout, self)


class INVOLUTE_OT_take_settings(JunctionOperator, bpy.types.Operator):
    """Show the settings in the sidebar that this drawing was traced with"""

    bl_idname = "involute.take_settings"
    bl_label = "Use Its Settings"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Copy them into the scene."""
        wanted = shown_in(context).trace.drawing.settings
        take_from_engine(scene_settings(context.scene), wanted)
        return {"FINISHED"}


CLASSES = (INVOLUTE_OT_trace_again, INVOLUTE_OT_take_settings)
