"""What both ways to trace share: a job in the background while a window is there, else at once."""

from __future__ import annotations

import sys

import bpy

from ...engine import InvoluteError
from .. import job as jobs
from ..language import label, message
from ..view.view_state import redraw_sidebars
from .trace_settings import take_from_sidebar

_TICK = 0.1  # seconds between two looks at the job
_QUIETLY = {"-q", "--quiet"}  # Blender's own options, and ours behind its "--"
_LAST_STEP = 5.0  # seconds that a trace is given to stop, where it looks up about every second
# While one of these waits for the mouse, objects and undo steps must not come in between.
_AT_WORK = ("TRANSFORM_OT", "GREASE_PENCIL_OT", "SCULPT_OT", "PAINT_OT", "MESH_OT", "CURVE_OT")


_waiting: dict[jobs.Job, tuple[bpy.types.Timer, bool]] = {}
"""The timers of the operators that wait, and whether they show progress. Of several, all but one
have given way and will see it."""


def _stop_waiting(job: jobs.Job) -> None:
    """Take back what Blender would go on doing and showing."""
    if job not in _waiting:
        return
    timer, shows_progress = _waiting.pop(job)
    manager = bpy.context.window_manager
    manager.event_timer_remove(timer)
    if shows_progress:
        manager.progress_end()
        for workspace in bpy.data.workspaces:
            workspace.status_text_set(None)


def stage_of(job: jobs.Job) -> str:
    """Where a job is, in words."""
    return label(job.stage, **job.counts)


class JobOperator:
    """Mixin for operators that run a job; they add `begin`, `finish` and, if they like, `take`."""

    bl_options = {"REGISTER", "UNDO"}
    escape_cancels = True

    def begin(self, context: bpy.types.Context) -> jobs.Job:
        """Read all that Blender knows; what then runs needs nothing of it."""
        raise NotImplementedError

    _repeats = False

    def is_repeat(self) -> bool:
        """Does a script or Adjust Last Operation run it, so that the view is not to move?"""
        return self._repeats

    def take(self, context: bpy.types.Context, job: jobs.Job) -> None:
        """Use what has come so far."""

    def finish(self, context: bpy.types.Context, job: jobs.Job) -> set[str]:
        """The job is over."""
        raise NotImplementedError

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Start the job and wait for it without holding Blender up."""
        take_from_sidebar(self, context)
        if bpy.app.background:
            return self.execute(context)
        if jobs.current is not None and not jobs.current.gives_way:
            self.report({"ERROR"}, message("Another trace is running; wait for it or cancel it."))
            return {"CANCELLED"}
        self._job = self._begun(context)
        if self._job is None:
            return {"CANCELLED"}
        jobs.abandon()
        jobs.current = self._job
        self._job.start()
        self._shown, self._repeats = "", False
        manager = context.window_manager
        timer = manager.event_timer_add(_TICK, window=context.window)
        _waiting[self._job] = timer, self.escape_cancels
        if self.escape_cancels:
            manager.progress_begin(0, 100)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Look in on the job at every tick; let all other events pass.

        What has come is written only while the artist is not in the middle of something.
        """
        job = self._job
        if jobs.current is not job:  # abandoned: see `job.abandon`
            self._stop(context)
            return {"CANCELLED"}
        if self.escape_cancels and event.type == "ESC" and event.value == "PRESS" and job.running:
            job.cancel()
            return {"RUNNING_MODAL"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        alive = job.running  # before results are taken: what comes later is taken next time
        self._show_progress(context, job)
        if is_at_work(context):
            return {"PASS_THROUGH"}
        self.take(context, job)
        if alive:
            return {"PASS_THROUGH"}
        self._stop(context)
        return self.finish(context, job)

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender itself ends the operator, for example when a file is opened."""
        self._job.cancel()
        self._stop(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Run the job at once, as scripts and the background want it."""
        self._repeats = True
        job = self._begun(context)
        if job is None:
            return {"CANCELLED"}
        _run_aloud(job)
        self.take(context, job)
        return self.finish(context, job)

    def _begun(self, context: bpy.types.Context) -> jobs.Job | None:
        try:
            return self.begin(context)
        except InvoluteError as problem:
            self.report({"ERROR"}, message(problem))
            return None

    def _show_progress(self, context: bpy.types.Context, job: jobs.Job) -> None:
        """In the sidebar; on the cursor and in the status bar, too, while the artist waits."""
        percent = round(100 * job.fraction)
        said = label("{stage}, {percent} % (Esc cancels)", stage=stage_of(job), percent=percent)
        if said == self._shown:
            return
        self._shown = said
        if self.escape_cancels:
            context.window_manager.progress_update(percent)
            context.workspace.status_text_set(f"Involute: {said}")
        redraw_sidebars(context)

    def _stop(self, context: bpy.types.Context) -> None:
        _stop_waiting(self._job)
        if jobs.current is self._job:
            jobs.current = None
        redraw_sidebars(context)


def _run_aloud(job: jobs.Job) -> None:
    """Run it; `blender -b` says what became of each picture, unless it was told to be quiet."""
    if not bpy.app.background or _QUIETLY & set(sys.argv):
        job.run()
        return
    from ...command.progress_display import ProgressDisplay

    with ProgressDisplay(job.pictures, tells=True) as display:
        job.heard = display.done
        job.run()


def is_at_work(context: bpy.types.Context) -> bool:
    """Is the artist moving, drawing or sculpting something at this very moment?"""
    windows = context.window_manager.windows
    return any(
        operator and operator.bl_idname.startswith(_AT_WORK)  # None: one whose class has gone
        for window in windows
        for operator in getattr(window, "modal_operators", ())
    )


class INVOLUTE_OT_cancel(bpy.types.Operator):
    """Stop the trace that is running; nothing in the scene changes"""

    bl_idname = "involute.cancel"
    bl_label = "Cancel"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Is there a job to cancel?"""
        return jobs.current is not None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Ask the job to stop."""
        jobs.current.cancel()
        return {"FINISHED"}


def _abandon(*_: object) -> None:
    jobs.abandon()


def register() -> None:
    """Opening a file ends what was traced for the one before."""
    bpy.app.handlers.load_pre.append(bpy.app.handlers.persistent(_abandon))


def unregister() -> None:
    """End what is running: nobody will be there to take it, and its files may be replaced."""
    jobs.abandon(_LAST_STEP)
    for job in list(_waiting):
        _stop_waiting(job)
    bpy.app.handlers.load_pre.remove(_abandon)


CLASSES = (INVOLUTE_OT_cancel,)
