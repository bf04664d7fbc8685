"""A setting of the sidebar was changed: what is traced follows by itself, if that is wanted.

A part that settings are tried on always does, and while it is shown nothing else.
"""

from __future__ import annotations

from collections.abc import Callable

import bpy

from .. import job as jobs
from . import part

_PAUSE = 0.4  # seconds without another change, until the page is traced again
_PAUSE_PART = 0.1  # the same for a part: while a slider is moved, too


def changed(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Called by Blender for every setting that is changed."""
    manager = context.window_manager
    if not isinstance(settings.id_data, bpy.types.Scene) or manager is None or bpy.app.background:
        return
    if part.current() is not None:
        _later(_part_again, _PAUSE_PART)
    elif manager.involute_view.live:
        _later(_again, _PAUSE)


def _later(what: Callable[[], float | None], pause: float) -> None:
    """Do it after a pause in which it is not asked for again."""
    if bpy.app.timers.is_registered(what):
        bpy.app.timers.unregister(what)
    bpy.app.timers.register(what, first_interval=pause)


def _again() -> float | None:
    """Begin, once what runs has stopped."""
    if jobs.current is not None:
        jobs.current.cancel()
        return _PAUSE
    _run(bpy.ops.involute.trace_again, only_changed=True)
    return None


def _part_again() -> float | None:
    """Begin, once a trace of a whole page is over; one of a part gives way."""
    if jobs.current is not None and not jobs.current.gives_way:
        return _PAUSE
    _run(bpy.ops.involute.try_part)
    return None


def _run(operator: Callable, **options: object) -> None:
    """Run an operator in a window; timers have none of their own."""
    windows = bpy.context.window_manager.windows
    if len(windows):
        with bpy.context.temp_override(window=windows[0]):
            if operator.poll():
                operator("INVOKE_DEFAULT", True, **options)


def unregister() -> None:
    """Wait for nothing any more."""
    for what in (_again, _part_again):
        if bpy.app.timers.is_registered(what):
            bpy.app.timers.unregister(what)
