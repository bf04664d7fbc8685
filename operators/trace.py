"""Trace pictures into Grease Pencil: with a progress bar in a window, at once in the background."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import bpy
from bpy.props import CollectionProperty, EnumProperty, StringProperty

from ..engine import InvoluteError
from . import grease_pencil as gp
from . import sources, state, worker
from .placement import Placement, front_view, on_empty
from .placing import PlacingSettings, stand
from .sources import Source
from .trace_settings import TraceSettings, engine_settings


class INVOLUTE_OT_trace(PlacingSettings, TraceSettings, bpy.types.Operator):
    """Turn a scanned drawing into Grease Pencil strokes that run straight through junctions"""

    bl_idname = "involute.trace"
    bl_label = "Trace Drawing"
    bl_options = {"REGISTER", "UNDO"}

    filepath: StringProperty(
        name="File",
        description="Picture to trace; empty for the image given below or the active image Empty",
        subtype="FILE_PATH",
        options={"SKIP_SAVE"},
    )
    directory: StringProperty(subtype="DIR_PATH", options={"SKIP_SAVE", "HIDDEN"})
    files: CollectionProperty(
        type=bpy.types.OperatorFileListElement, options={"SKIP_SAVE", "HIDDEN"}
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

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if bpy.app.background:
            return self.execute(context)
        if worker.current is not None:
            self.report({"ERROR"}, "Another trace is running; wait for it or cancel it.")
            return {"CANCELLED"}
        try:
            worker.current = worker.Worker(self._sources(context), engine_settings(self))
        except InvoluteError as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        worker.current.start()
        manager = context.window_manager
        self._timer = manager.event_timer_add(0.1, window=context.window)
        manager.progress_begin(0, 100)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        job = worker.current
        if event.type == "ESC" and event.value == "PRESS":
            job.cancel()
            return {"RUNNING_MODAL"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        _show_progress(context, job)
        if job.running:
            return {"RUNNING_MODAL"}
        self._stop_showing(context)
        if job.cancelled:
            self.report({"INFO"}, "Tracing was cancelled.")
            return {"CANCELLED"}
        return self._finish(context, job.results)

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender itself ends the operator, for example when a file is opened."""
        worker.current.cancel()
        self._stop_showing(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            job = worker.Worker(self._sources(context), engine_settings(self))
        except InvoluteError as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        job.run()
        return self._finish(context, job.results)

    def draw(self, context: bpy.types.Context) -> None:
        from .settings_layout import draw_placing, draw_settings

        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        draw_placing(self.layout, self)
        draw_settings(self.layout, self)

    def _sources(self, context: bpy.types.Context) -> list[Source]:
        """What to trace; Blender is read here, in its own thread."""
        if self.files and self.directory:
            paths = [str(Path(self.directory, file.name)) for file in self.files if file.name]
        else:
            paths = [self.filepath] if self.filepath else []
        if paths:
            paths = [bpy.path.abspath(path) for path in paths]
            return sources.from_files(paths)
        if self.image:
            image = bpy.data.images.get(self.image)
            if image is None:
                raise InvoluteError(f"There is no image {self.image!r} in this file.")
            return [sources.from_image(image)]
        empty = context.active_object
        if not is_image_empty(empty):
            raise InvoluteError("Choose a picture file, or select an Empty that shows an image.")
        return [sources.from_image(empty.data, empty)]

    def _finish(self, context: bpy.types.Context, results: Sequence[worker.Result]) -> set[str]:
        done = [result for result in results if result.drawing is not None]
        failed = [result for result in results if result.drawing is None]
        try:
            if done:
                self._write(context, done)
        except InvoluteError as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        if not done:
            self.report({"ERROR"}, failed[0].problem if failed else "There is nothing to trace.")
            return {"CANCELLED"}
        for result in failed:
            self.report({"WARNING"}, f"{result.source.name}: {result.problem}")
        strokes = sum(len(result.drawing.strokes) for result in done)
        junctions = sum(len(result.drawing.junctions) for result in done)
        doubtful = sum(len(result.drawing.doubtful) for result in done)
        seconds = sum(sum(result.drawing.seconds.values()) for result in done)
        if strokes == 0 and not any(result.drawing.fills for result in done):
            self.report({"WARNING"}, "There are no lines in the picture.")
        else:
            self.report(
                {"INFO"},
                f"{strokes} strokes, {junctions} junctions ({doubtful} doubtful), {seconds:.1f} s",
            )
        return {"FINISHED"}

    def _write(self, context: bpy.types.Context, done: Sequence[worker.Result]) -> None:
        frame = context.scene.frame_current
        if self.target == "ACTIVE":
            obj = context.active_object
            if not gp.is_grease_pencil(obj) or not obj.data.is_editable:
                raise InvoluteError("Make a Grease Pencil object of this file the active one.")
            for result in done:
                put(obj, result, frame, front_view(result.drawing.size))
            return
        if context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        places = [
            stand(context, result.drawing.size, self.place, self.pixels_per_metre)
            for result in done
        ]
        objects: list[bpy.types.Object] = []
        for result, (placement, matrix) in zip(done, places, strict=True):
            objects.append(new_object(result.source.name))
            objects[-1].matrix_world = matrix
            context.collection.objects.link(objects[-1])
            put(objects[-1], result, frame, placement)
        for other in context.selected_objects:
            other.select_set(False)
        for obj in objects:
            obj.select_set(True)
        context.view_layer.objects.active = objects[0]

    def _stop_showing(self, context: bpy.types.Context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
        worker.current = None
        _redraw_sidebars(context)


class INVOLUTE_OT_cancel(bpy.types.Operator):
    """Stop the trace that is running; nothing in the scene changes"""

    bl_idname = "involute.cancel"
    bl_label = "Cancel"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return worker.current is not None

    def execute(self, context: bpy.types.Context) -> set[str]:
        worker.current.cancel()
        return {"FINISHED"}


def is_image_empty(obj: bpy.types.Object | None) -> bool:
    return (
        obj is not None
        and obj.type == "EMPTY"
        and obj.empty_display_type == "IMAGE"
        and isinstance(obj.data, bpy.types.Image)
    )


def new_object(name: str) -> bpy.types.Object:
    """A Grease Pencil object without layers, not yet in any collection."""
    return bpy.data.objects.new(name, gp.collection().new(name))


def put(obj: bpy.types.Object, result: worker.Result, frame: int, placement: Placement) -> None:
    """Write a traced drawing into an object, strokes and routing state.

    An image Empty that shows the picture takes precedence over `placement`.
    """
    source, drawing = result.source, result.drawing
    empty = bpy.data.objects.get(source.empty) if source.empty else None
    if empty is not None:
        placement = on_empty(empty, drawing.size)
        obj.matrix_world = empty.matrix_world.copy()
    key = state.add(obj.data, drawing, placement, source.name)
    gp.write(obj.data, frame, drawing, placement, key)


def _show_progress(context: bpy.types.Context, job: worker.Worker) -> None:
    percent = round(100 * job.fraction)
    context.window_manager.progress_update(percent)
    context.workspace.status_text_set(f"Involute: {job.stage}, {percent} %   (ESC cancels)")
    _redraw_sidebars(context)


def _redraw_sidebars(context: bpy.types.Context) -> None:
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


CLASSES = (INVOLUTE_OT_trace, INVOLUTE_OT_cancel)
