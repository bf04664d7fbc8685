"""Try the settings on a part of a page, before the whole of it is traced."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import bpy
import numpy as np
from bpy.props import IntVectorProperty

from ...engine import InvoluteError, Settings
from .. import job as jobs
from ..view.view_state import redraw
from . import part as parts
from .background import JobOperator
from .part import Part
from .recent import PARTS
from .trace import make_active, new_object, put
from .trace_job import TracedSource, TraceJob
from .trace_settings import engine_settings, scene_settings

if TYPE_CHECKING:
    from .sources import Source


class PartJob(TraceJob):
    """Traces a part; every other trace may take its place."""

    gives_way = True
    recent = PARTS

    def __init__(self, part: Part, source: Source, settings: Settings) -> None:
        super().__init__([source], settings)
        self.part = part

    def work(self) -> None:
        """Read its pixels, if that was not done before, and trace them."""
        crop = self.part.crop or self.part.read(self.sources[0])
        self.part, self.sources = replace(self.part, crop=crop), [crop]
        super().work()


class INVOLUTE_OT_try_part(JobOperator, bpy.types.Operator):
    """Trace a part of the picture with the settings of the sidebar, to see what they do"""

    bl_idname = "involute.try_part"
    bl_label = "Trace a Part"
    bl_options = {"INTERNAL"}  # nothing changes in the file
    escape_cancels = False

    box: IntVectorProperty(
        name="Box",
        description="Left, top, right and bottom of the part, in pixels of the scan; "
        "the part that is shown already, if it isn't given",
        size=4,
        options={"SKIP_SAVE"},
    )

    def begin(self, context: bpy.types.Context) -> PartJob:
        """The part of the picture that is looked at; or once more the one that is shown."""
        if self.properties.is_property_set("box"):
            page = parts.page_of(context)
            corners = [self.box[:2], self.box[2:]]
            part = Part(page, parts.box_around(np.array(corners, float), page))
        elif (part := parts.current()) is None:
            raise InvoluteError(parts.BESIDE)
        # A sheet is found on a whole page; straightened, the part would lie elsewhere.
        settings = replace(engine_settings(scene_settings(context.scene)), straighten=False)
        source = part.crop or part.page.source()
        parts.show(part)
        redraw(context)
        return PartJob(part, source, settings)

    def finish(self, context: bpy.types.Context, job: PartJob) -> set[str]:
        """Show what came out."""
        if job.cancelled:
            return {"CANCELLED"}
        result = job.results[0] if job.results else TracedSource(job.sources[0], None, job.problem)
        parts.show(replace(job.part, drawing=result.drawing, problem=result.problem))
        redraw(context)
        return {"FINISHED"}


class _OnPart:
    """What can be done with the part that is shown."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Is there one?"""
        return parts.current() is not None


class INVOLUTE_OT_drop_part(_OnPart, bpy.types.Operator):
    """Take the traced part away; nothing of it stays"""

    bl_idname = "involute.drop_part"
    bl_label = "Remove"
    bl_options = {"INTERNAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """End what is still at work on it, too."""
        if jobs.current is not None and jobs.current.gives_way:
            jobs.abandon()
        parts.show(None)
        redraw(context)
        return {"FINISHED"}


class INVOLUTE_OT_keep_part(_OnPart, bpy.types.Operator):
    """Make a Grease Pencil object of the traced part"""

    bl_idname = "involute.keep_part"
    bl_label = "Keep as Object"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Is there one, and were there lines?"""
        part = parts.current()
        return context.mode == "OBJECT" and part is not None and part.drawing is not None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Put it where it was shown."""
        part = parts.current()
        page, drawing = part.page.object, part.drawing
        obj = new_object(part.crop.name)
        obj.matrix_world = page.matrix_world
        (context.collection or context.scene.collection).objects.link(obj)
        result = TracedSource(part.crop, drawing)
        pixel_map = part.page.pixel_map.moved(*part.around[:2])
        put(obj, result, context.scene.frame_current, pixel_map)
        make_active(context, obj, outlined=False)
        parts.show(None)
        redraw(context)
        return {"FINISHED"}


CLASSES = (INVOLUTE_OT_try_part, INVOLUTE_OT_drop_part, INVOLUTE_OT_keep_part)
