"""Trace pictures into Grease Pencil: with a progress bar in a window, at once in the background."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import bpy
from bpy.props import EnumProperty, StringProperty

from ...engine import InvoluteError
from ..grease_pencil import cels, state, writing
from ..grease_pencil.core.pixel_map import PixelMap, front_view, on_empty
from ..grease_pencil.writing import Into
from ..language import message
from ..view.framing import look_straight_at
from ..view.view_state import view_of
from . import part, sources
from .background import JobOperator
from .file_choice import ChosenFiles
from .placing import fits_camera, place_drawing
from .scan_behind import put_behind
from .settings_layout import draw_placing, draw_settings
from .sources import Source
from .trace_job import TracedSource, TraceJob
from .trace_settings import PlacingOptions, TraceOptions, engine_settings

if TYPE_CHECKING:
    from ...engine import Drawing


def target_property() -> object:
    """Where the strokes go: the same choice in the file browser and for scripts."""
    return EnumProperty(
        name="Target",
        description="Where the strokes go",
        items=[
            ("NEW", "New Object", "A Grease Pencil object per drawing"),
            ("ACTIVE", "Active Object", "A keyframe of the active Grease Pencil object"),
            (
                "LAYER",
                "Active Layer",
                "The active layer of the active Grease Pencil object, with its active material; "
                "what is there stays",
            ),
        ],
        default="NEW",
        options={"SKIP_SAVE"},
    )


class INVOLUTE_OT_trace(JobOperator, ChosenFiles, PlacingOptions, TraceOptions, bpy.types.Operator):
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
    target: target_property()

    def begin(self, context: bpy.types.Context) -> TraceJob:
        """Read the sources and settings; what can't be met later is said now."""
        self._target, self._into = "", None
        if self.target != "NEW":
            obj = context.active_object
            if not cels.is_grease_pencil(obj) or not obj.data.is_editable:
                raise InvoluteError("Make a Grease Pencil object of this file the active one.")
            state.check_writable(obj.data)
            self._target = obj.name
            self._into = into_active_layer(obj) if self.target == "LAYER" else None
        else:
            place_drawing(context, (1, 1), self.place, self.pixels_per_metre)
        return TraceJob(self._sources(context), engine_settings(self))

    def finish(self, context: bpy.types.Context, job: TraceJob) -> set[str]:
        """Write what was traced; say what came of it."""
        if job.cancelled:
            self.report({"INFO"}, message("Tracing was cancelled."))
            return {"CANCELLED"}
        done = [result for result in job.results if result.drawing is not None]
        failed = [result for result in job.results if result.drawing is None]
        if done:
            part.show(None)  # all of it is there now
            self._write(context, done)
        else:
            problem = failed[0].problem if failed else job.problem
            self.report({"ERROR"}, message(problem or "There is nothing to trace."))
            return {"CANCELLED"}
        for result in failed:
            self.report({"WARNING"}, f"{result.source.name}: {message(result.problem)}")
        for result in done:
            for sentence in result.drawing.warnings:
                self.report({"WARNING"}, f"{result.source.name}: {message(sentence)}")
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
        if not sources.is_image_empty(empty):
            raise InvoluteError("Choose a picture file, or select an Empty that shows an image.")
        return [sources.from_image(empty.data, empty)]

    def _report_counts(self, drawings: Sequence[Drawing]) -> None:
        strokes = sum(len(drawing.strokes) for drawing in drawings)
        if strokes == 0 and not any(drawing.fills for drawing in drawings):
            self.report({"WARNING"}, message("There are no lines in the picture."))
            return
        junctions = sum(len(drawing.junctions) for drawing in drawings)
        bundles = sum(len(drawing.bundles) for drawing in drawings)
        doubtful = sum(len(drawing.doubtful) for drawing in drawings)
        seconds = sum(sum(drawing.seconds.values()) for drawing in drawings)
        counts = {"strokes": strokes, "junctions": junctions, "doubtful": doubtful}
        said = message(
            "{strokes} strokes, {junctions} junctions ({doubtful} doubtful), {seconds:.1f} s",
            **counts,
            seconds=seconds,
        )
        if bundles:
            said = message(
                "{strokes} strokes, {junctions} junctions and {bundles} bundles "
                "({doubtful} doubtful), {seconds:.1f} s",
                **counts,
                bundles=bundles,
                seconds=seconds,
            )
        self.report({"INFO"}, said)

    def _write(self, context: bpy.types.Context, done: Sequence[TracedSource]) -> None:
        """Whatever the artist did meanwhile, what was traced gets a place."""
        frame, view = context.scene.frame_current, view_of(context)
        target = bpy.data.objects.get(self._target) if self._target else None
        if cels.is_grease_pencil(target) and target.data.is_editable:
            for result in done:
                pixel_map = front_view(result.drawing.size)
                view.key = put(target, result, frame, pixel_map, order=self.order, into=self._into)
            return
        objects = [self._new(context, result, frame) for result in done]
        if context.mode == "OBJECT":
            make_active(context, objects[0], outlined=bpy.app.background or self.is_repeat())
            if not (bpy.app.background or self.is_repeat()):
                pixel_map = state.pixel_map_in(objects[0].data)
                look_straight_at(context, objects[0], pixel_map, done[0].drawing.size)

    def _new(
        self, context: bpy.types.Context, result: TracedSource, frame: int
    ) -> bpy.types.Object:
        """An object of its own for a traced source, with the scan behind it."""
        size = result.drawing.size
        try:
            pixel_map, matrix = place_drawing(context, size, self.place, self.pixels_per_metre)
        except InvoluteError as problem:  # the camera is gone by now
            self.report({"WARNING"}, message(problem))
            pixel_map, matrix = place_drawing(context, size, "FRONT", self.pixels_per_metre)
        obj = new_object(result.source.name)
        obj.matrix_world = matrix
        (context.collection or context.scene.collection).objects.link(obj)
        view_of(context).key = put(obj, result, frame, pixel_map, order=self.order)
        if self.show_scan:
            lies = state.pixel_map_in(obj.data)
            paper = not fits_camera(context, self.place)
            put_behind(obj, result.source, size, lies, paper=paper)
        return obj


def make_active(context: bpy.types.Context, obj: bpy.types.Object, *, outlined: bool) -> None:
    """Make a new drawing the active object; not selected, no outline hides its strokes."""
    for other in context.selected_objects:
        other.select_set(False)
    obj.select_set(outlined)
    context.view_layer.objects.active = obj


def new_object(name: str) -> bpy.types.Object:
    """A Grease Pencil object without layers, not yet in any collection."""
    return bpy.data.objects.new(name, cels.collection().new(name))


def into_active_layer(obj: bpy.types.Object) -> Into:
    """The layer that an artist would draw on, and the material that she would draw with.

    Raises:
        InvoluteError: there is no layer, or it is locked.
    """
    layer = obj.data.layers.active
    if layer is None:
        raise InvoluteError("The Grease Pencil object has no layer; add one to trace into.")
    if cels.is_locked(layer):
        said = message("The layer {name!r} is locked; unlock it to trace into it.", name=layer.name)
        raise InvoluteError(said)
    material = None if obj.active_material is None else obj.active_material_index
    return Into(layer.name, material)


def put(
    obj: bpy.types.Object,
    result: TracedSource,
    frame: int,
    pixel_map: PixelMap,
    *,
    order: str = "PAGE",
    into: Into | None = None,
) -> int:
    """Write a traced drawing into an object, strokes and routing state; return its key.

    An image Empty that shows the picture takes precedence over `pixel_map`.

    Args:
        order: "HAND" = strokes as a hand would draw them.
        into: one layer for all strokes.
    """
    source, drawing = result.source, result.drawing
    empty = bpy.data.objects.get(source.empty) if source.empty else None
    if empty is not None:
        pixel_map = on_empty(empty, drawing.size)
        obj.matrix_world = empty.matrix_world.copy()
    if order == "HAND":
        drawing = by_hand(drawing)
    key = state.add(obj.data, drawing, pixel_map, source.name, source.noted)
    writing.write(obj.data, frame, drawing, pixel_map, key, clear=into is None, into=into)
    return key


def by_hand(drawing: Drawing) -> Drawing:
    """The same drawing with its strokes in the order and direction in which a hand draws."""
    from ...engine.sequence.follow import reverse
    from ...engine.strokes.hand_order import hand_order

    strokes = [
        reverse(drawing.strokes[number]) if turned else drawing.strokes[number]
        for number, turned in hand_order(drawing.strokes, drawing.size)
    ]
    return replace(drawing, strokes=tuple(strokes))


CLASSES = (INVOLUTE_OT_trace,)
