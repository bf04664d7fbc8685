"""Trace pictures into Grease Pencil: with a progress bar in a window, at once in the background."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import bpy
from bpy.props import EnumProperty, StringProperty

from ...engine import InvoluteError
from ..grease_pencil import cels, state, writing
from ..grease_pencil.core.pixel_map import PixelMap, front_view, on_empty
from ..language import message
from . import sources
from .background import JobOperator
from .file_choice import ChosenFiles
from .placing import PlacingSettings, place_drawing
from .settings_layout import draw_placing, draw_settings
from .sources import Source
from .trace_job import TracedSource, TraceJob
from .trace_settings import TraceSettings, engine_settings

if TYPE_CHECKING:
    from ...engine import Drawing


class INVOLUTE_OT_trace(
    JobOperator, ChosenFiles, PlacingSettings, TraceSettings, bpy.types.Operator
):
    """Turn a scanned drawing into Grease Pencil strokes that run straight through junctions"""

    bl_idname = "involute.trace"
    bl_label = "Trace Drawing"

    filepath: StringProperty(
        name="File",
        description="Picture to trace; empty for the image given below or the active image Empty",
        subtype="FILE_PATH",
        options={"SKIP_SAVE"},
    )
    image: StringProperty(
        name="Image",
        description="Name of the image data-block to trace",
        options={"SKIP_SAVE"},
    )
    target: EnumProperty(
        name="Target",
        description="Where the strokes go",
        items=[
            ("NEW", "New Object", "A Grease Pencil object per drawing"),
            ("ACTIVE", "Active Object", "A keyframe of the active Grease Pencil object"),
        ],
        default="NEW",
        options={"SKIP_SAVE"},
    )

    def begin(self, context: bpy.types.Context) -> TraceJob:
        """Read the sources and settings."""
        return TraceJob(self._sources(context), engine_settings(self))

    def finish(self, context: bpy.types.Context, job: TraceJob) -> set[str]:
        """Write what was traced; say what came of it."""
        if job.cancelled:
            self.report({"INFO"}, message("Tracing was cancelled."))
            return {"CANCELLED"}
        done = [result for result in job.results if result.drawing is not None]
        failed = [result for result in job.results if result.drawing is None]
        try:
            if done:
                self._write(context, done)
        except InvoluteError as problem:
            self.report({"ERROR"}, message(problem))
            return {"CANCELLED"}
        if not done:
            problem = failed[0].problem if failed else job.problem
            self.report({"ERROR"}, message(problem or "There is nothing to trace."))
            return {"CANCELLED"}
        for result in failed:
            self.report({"WARNING"}, f"{result.source.name}: {message(result.problem)}")
        self._report_counts([result.drawing for result in done])
        return {"FINISHED"}

    def draw(self, context: bpy.types.Context) -> None:
        """The settings in Adjust Last Operation."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        draw_placing(self.layout, self)
        draw_settings(self.layout, self)

    def _sources(self, context: bpy.types.Context) -> list[Source]:
        """What to trace; Blender is read here, in its own thread."""
        if self.files and self.directory:
            paths = [str(Path(self.directory, name)) for name in self.names]
        else:
            paths = [self.filepath] if self.filepath else []
        if paths:
            paths = [bpy.path.abspath(path) for path in paths]
            return sources.from_files(paths)
        if self.image:
            image = bpy.data.images.get(self.image)
            if image is None:
                raise InvoluteError(
                    message("There is no image {name!r} in this file.", name=self.image)
                )
            return [sources.from_image(image)]
        empty = context.active_object
        if not is_image_empty(empty):
            raise InvoluteError("Choose a picture file, or select an Empty that shows an image.")
        return [sources.from_image(empty.data, empty)]

    def _report_counts(self, drawings: Sequence[Drawing]) -> None:
        strokes = sum(len(drawing.strokes) for drawing in drawings)
        if strokes == 0 and not any(drawing.fills for drawing in drawings):
            self.report({"WARNING"}, message("There are no lines in the picture."))
            return
        junctions = sum(len(drawing.junctions) for drawing in drawings)
        doubtful = sum(len(drawing.doubtful) for drawing in drawings)
        seconds = sum(sum(drawing.seconds.values()) for drawing in drawings)
        self.report(
            {"INFO"},
            message(
                "{strokes} strokes, {junctions} junctions ({doubtful} doubtful), {seconds:.1f} s",
                strokes=strokes,
                junctions=junctions,
                doubtful=doubtful,
                seconds=seconds,
            ),
        )

    def _write(self, context: bpy.types.Context, done: Sequence[TracedSource]) -> None:
        frame = context.scene.frame_current
        if self.target == "ACTIVE":
            obj = context.active_object
            if not cels.is_grease_pencil(obj) or not obj.data.is_editable:
                raise InvoluteError("Make a Grease Pencil object of this file the active one.")
            for result in done:
                put(obj, result, frame, front_view(result.drawing.size))
            return
        if context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        places = [
            place_drawing(context, result.drawing.size, self.place, self.pixels_per_metre)
            for result in done
        ]
        objects: list[bpy.types.Object] = []
        for result, (pixel_map, matrix) in zip(done, places, strict=True):
            objects.append(new_object(result.source.name))
            objects[-1].matrix_world = matrix
            context.collection.objects.link(objects[-1])
            put(objects[-1], result, frame, pixel_map)
        for other in context.selected_objects:
            other.select_set(False)
        for obj in objects:
            obj.select_set(True)
        context.view_layer.objects.active = objects[0]


def is_image_empty(obj: bpy.types.Object | None) -> bool:
    """Is it an Empty that shows an image?"""
    return (
        obj is not None
        and obj.type == "EMPTY"
        and obj.empty_display_type == "IMAGE"
        and isinstance(obj.data, bpy.types.Image)
    )


def new_object(name: str) -> bpy.types.Object:
    """A Grease Pencil object without layers, not yet in any collection."""
    return bpy.data.objects.new(name, cels.collection().new(name))


def put(obj: bpy.types.Object, result: TracedSource, frame: int, pixel_map: PixelMap) -> None:
    """Write a traced drawing into an object, strokes and routing state.

    An image Empty that shows the picture takes precedence over `pixel_map`.
    """
    source, drawing = result.source, result.drawing
    empty = bpy.data.objects.get(source.empty) if source.empty else None
    if empty is not None:
        pixel_map = on_empty(empty, drawing.size)
        obj.matrix_world = empty.matrix_world.copy()
    key = state.add(obj.data, drawing, pixel_map, source.name)
    writing.write(obj.data, frame, drawing, pixel_map, key)


CLASSES = (INVOLUTE_OT_trace,)
