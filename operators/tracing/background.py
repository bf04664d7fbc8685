"""What both ways to trace share: a job in the background while a window is there, else at once."""

from __future__ import annotations

import bpy

from ...engine import InvoluteError
from .. import job as jobs
from ..language import label, message
from ..view.view_state import redraw


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

    def take(self, context: bpy.types.Context, job: jobs.Job) -> None:
        """Use what has come so far."""

    def finish(self, context: bpy.types.Context, job: jobs.Job) -> set[str]:
        """The job is over."""
        raise NotImplementedError

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Start the job and wait for it without holding Blender up."""
        if bpy.app.background:
            return self.execute(context)
        if jobs.current is not None:
            self.report({"ERROR"}, message("Another trace is running; wait for it or cancel it."))
            return {"CANCELLED"}
        jobs.current = self._begun(context)
        if jobs.current is None:
            return {"CANCELLED"}
        jobs.current.start()
        manager = context.window_manager
        self._timer = manager.event_timer_add(0.1, window=context.window)
        if self.escape_cancels:
            manager.progress_begin(0, 100)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Look in on the job at every tick; let all other events pass."""
        job = jobs.current
        if self.escape_cancels and event.type == "ESC" and event.value == "PRESS":
            job.cancel()
            return {"RUNNING_MODAL"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        alive = job.running  # before results are taken: what comes later is taken next time
        self.take(context, job)
        self._show_progress(context, job)
        if alive:
            return {"PASS_THROUGH"}
        self._stop(context)
        return self.finish(context, job)

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender itself ends the operator, for example when a file is opened."""
        jobs.current.cancel()
        self._stop(context)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Run the job at once, as scripts and the background want it."""
        job = self._begun(context)
        if job is None:
            return {"CANCELLED"}
        job.run()
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
        if self.escape_cancels:
            percent = round(100 * job.fraction)
            context.window_manager.progress_update(percent)
            said = label("{stage}, {percent} % (Esc cancels)", stage=stage_of(job), percent=percent)
            context.workspace.status_text_set(f"Involute: {said}")
        redraw(context)

    def _stop(self, context: bpy.types.Context) -> None:
        context.window_manager.event_timer_remove(self._timer)
        if self.escape_cancels:
            context.window_manager.progress_end()
            context.workspace.status_text_set(None)
        jobs.current = None
        redraw(context)


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


CLASSES = (INVOLUTE_OT_cancel,)
