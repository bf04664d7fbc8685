"""Trace numbered drawings, or what an image Empty plays, as keyframes of one object."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path

import bpy
from bpy.props import BoolProperty, IntProperty, StringProperty

from ...engine import InvoluteError
from ...engine.formats.picture_kinds import SUFFIXES
from ...engine.sequence import Frame
from ..grease_pencil import cels, state, writing
from ..grease_pencil.core.pixel_map import PixelMap, front_view, on_empty
from ..grease_pencil.stored_trace import Picture
from ..language import message
from ..tracing.background import JobOperator
from ..tracing.file_choice import ChosenFiles, FileChoice, files_shown
from ..tracing.placing import fits_camera, place_drawing, placing_values
from ..tracing.scan_behind import pale, put_paper
from ..tracing.settings_layout import draw_placing, draw_sequence, draw_settings
from ..tracing.trace import make_active, new_object
from ..tracing.trace_settings import (
    PlacingOptions,
    TraceOptions,
    as_values,
    engine_settings,
    take_from_sidebar,
)
from ..view.framing import look_straight_at
from .playing import frames_of_empty, frames_of_files, plays_frames
from .sequence_job import SequenceJob, parts_folder


def resume_property() -> object:
    """Trace a sequence again: the same choice in the file browser and for scripts."""
    return BoolProperty(
        name="Only What Changed",
        description="Fill the active object; keyframes whose drawing has not changed stay as "
        "they are, with all that was done to them",
        default=False,
        options={"SKIP_SAVE"},
    )


class SequenceSettings:
    """Mixin: what the frames are."""

    own_start: BoolProperty(
        name="Start At",
        description="Put the first drawing at a frame of your choice instead of its own number",
        default=False,
    )
    start: IntProperty(name="Start Frame", description="Frame of the first drawing", default=1)
    step: IntProperty(
        name="Step",
        description="Frames from one number to the next; 2 animates on twos",
        default=1,
        min=1,
        soft_max=8,
    )
    align: BoolProperty(
        name="Align by Peg Holes",
        description="Bring all pages to where the peg holes or registration marks of the first lie",
        default=False,
    )
    follow: BoolProperty(
        name="Steady Strokes",
        description="Give neighboring frames the same order and direction of strokes, "
        "so that Interpolate pairs them rightly",
        default=True,
    )
    jobs: IntProperty(
        name="Processes",
        description="Drawings traced at the same time; 0 uses every processor core",
        default=0,
        min=0,
        max=256,
    )


class INVOLUTE_OT_trace_sequence(
    JobOperator, ChosenFiles, SequenceSettings, PlacingOptions, TraceOptions, bpy.types.Operator
):
    """Turn numbered drawings into keyframes of one Grease Pencil object, in the background"""

    bl_idname = "involute.trace_sequence"
    bl_label = "Trace Sequence"
    escape_cancels = False  # the artist goes on working, and presses it for other reasons

    directory: StringProperty(
        name="Folder",
        description="Folder of numbered drawings; empty for what the active image Empty plays",
        subtype="DIR_PATH",
        options={"SKIP_SAVE"},
    )
    resume: resume_property()

    def draw(self, context: bpy.types.Context) -> None:
        """The settings in Adjust Last Operation."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        draw_sequence(self.layout, self)
        draw_placing(self.layout, self)
        draw_settings(self.layout, self)

    def begin(self, context: bpy.types.Context) -> SequenceJob:
        """Find the frames, and where they will stand."""
        self._name, self._empty, self._target = "", "", ""
        self._pixel_map: PixelMap | None = None
        self._written, self._kept, self._failed = 0, 0, []
        self._pictures: dict[int, Picture] = {}
        options = {"start": self.start if self.own_start else None, "step": self.step}
        empty = context.active_object
        if self.directory:
            folder = Path(bpy.path.abspath(self.directory))
            frames = frames_of_files(folder, self.names, **options)
            self._name = folder.name or "Sequence"
        elif plays_frames(empty):
            frames = frames_of_empty(empty, **options)
            self._name, self._empty = empty.name, empty.name
        else:
            raise InvoluteError(
                "Choose a folder of drawings, or select an Empty that plays images or a movie."
            )
        if self.resume:
            if not cels.is_grease_pencil(context.active_object):
                raise InvoluteError("Make the Grease Pencil object of the sequence the active one.")
            state.check_writable(context.active_object.data)
            self._target = context.active_object.name
        elif not self._empty:
            place_drawing(
                context, (1, 1), self.place, self.pixels_per_metre
            )  # says now if it can't be
        self._pictures = {f.frame: Picture(str(f.path), f.page or 0) for f in frames}
        return SequenceJob(
            frames,
            _aligned(engine_settings(self), frames) if self.align else engine_settings(self),
            jobs=self.jobs,
            parts=parts_folder(_cache(), frames),
            follow=self.follow,
        )

    def take(self, context: bpy.types.Context, job: SequenceJob) -> None:
        """Write the keyframes that have come."""
        for frame, drawing, unchanged in job.results():
            if isinstance(drawing, InvoluteError):
                self._failed.append(frame)
                self.report(
                    {"WARNING"}, message("Frame {frame}", frame=frame) + f": {message(drawing)}"
                )
                continue
            obj = self._object(context, drawing.size)
            if self.resume and unchanged and state.keys_at_exactly(obj.data, frame):
                self._kept += 1
                continue
            name = f"{self._name} {frame}"
            key = state.add(obj.data, drawing, self._pixel_map, name, self._pictures.get(frame))
            writing.write(obj.data, frame, drawing, self._pixel_map, key, alone=True)
            self._written += 1

    def _object(self, context: bpy.types.Context, size: tuple[int, int]) -> bpy.types.Object:
        """The object that takes the keyframes; looked up by name, since undo replaces objects.

        The first drawing says where all of them lie: a pixel is as large on every frame.
        """
        obj = bpy.data.objects.get(self._target) if self._target else None
        if obj is not None:
            self._pixel_map = self._pixel_map or state.pixel_map_in(obj.data) or front_view(size)
            return obj
        if empty := bpy.data.objects.get(self._empty):
            self._pixel_map, matrix = on_empty(empty, size), empty.matrix_world.copy()
        else:
            self._pixel_map, matrix = place_drawing(
                context, size, self.place, self.pixels_per_metre
            )
        obj = new_object(self._name)
        obj.matrix_world = matrix
        context.scene.collection.objects.link(obj)
        self._target = obj.name
        if self.show_scan:
            pale(empty)
            if not fits_camera(context, self.place):
                put_paper(obj, size, self._pixel_map)
        if self._in_sight(context):
            make_active(context, obj, outlined=False)
            context.view_layer.update()
            look_straight_at(context, obj, self._pixel_map, size)
        return obj

    def _in_sight(self, context: bpy.types.Context) -> bool:
        """May the view turn to what was traced? Not of an artist who is at something else."""
        return context.mode == "OBJECT" and not (bpy.app.background or self.is_repeat())

    def finish(self, context: bpy.types.Context, job: SequenceJob) -> set[str]:
        """Select the object and say what came of it."""
        if job.problem:
            self.report({"ERROR"}, message(job.problem))
        if not self._written and not self._kept:
            if not (job.problem or job.cancelled):
                self.report({"ERROR"}, message("None of the frames could be traced."))
            return {"CANCELLED"}
        obj = bpy.data.objects.get(self._target)
        if obj is not None:
            if context.mode == "OBJECT":
                make_active(context, obj, outlined=not self._in_sight(context))
            else:
                obj.select_set(True)
        if job.unaligned:
            from ...command.sequence_command import unaligned

            self.report({"WARNING"}, unaligned(job.unaligned))
        said = [message("{count} keyframes", count=self._written)]
        if self._kept:
            said.append(message("{count} kept", count=self._kept))
        if self._failed:
            said.append(message("{count} frames failed", count=len(self._failed)))
        if job.cancelled:
            said.append(message("then cancelled"))
        self.report({"INFO"}, ", ".join(said))
        return {"FINISHED"}


class INVOLUTE_OT_import_sequence(
    FileChoice, SequenceSettings, PlacingOptions, TraceOptions, bpy.types.Operator
):
    """Choose a folder of numbered drawings, or some of them, and trace them as keyframes"""

    bl_idname = "involute.import_sequence"
    bl_label = "Trace Drawing Sequence"

    filter_glob: files_shown(SUFFIXES)
    resume: resume_property()

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for the folder, with the sidebar's settings beside it."""
        take_from_sidebar(self, context)
        return super().invoke(context, event)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Hand the chosen files to the trace."""
        sequence = {name: getattr(self, name) for name in SequenceSettings.__annotations__}
        # One file alone stands for all that are numbered like it.
        names = self.names if len(self.names) > 1 else []
        return self.hand_to(
            bpy.ops.involute.trace_sequence,
            directory=self.folder,
            resume=self.resume,
            files=[{"name": name} for name in names],
            **sequence,
            **placing_values(self),
            **as_values(self),
        )

    def draw(self, context: bpy.types.Context) -> None:
        """The settings in the file browser."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        self.layout.prop(self, "resume")
        INVOLUTE_OT_trace_sequence.draw(self, context)


def _aligned(settings: object, frames: Sequence[Frame]) -> object:
    from dataclasses import replace

    from ...engine.scan.registration import first_anchors

    return replace(settings, align=first_anchors(frames[0].path, frames[0].page, settings))


def _cache() -> Path:
    """The extension's own folder in the user's; a temporary one where there is none."""
    try:
        return Path(
            bpy.utils.extension_path_user(
                __package__.removesuffix(".operators.sequences"), path="sequences", create=True
            )
        )
    except ValueError:
        return Path(tempfile.gettempdir(), "involute-sequences")


CLASSES = (INVOLUTE_OT_trace_sequence, INVOLUTE_OT_import_sequence)
