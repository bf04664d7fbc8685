"""A setting of the sidebar was changed: the active drawing follows by itself, if that is wanted."""

from __future__ import annotations

import bpy

from .. import job as jobs

_PAUSE = 0.4  # seconds without another change, until the trace begins


def changed(settings: bpy.types.PropertyGroup, context: bpy.types.Context) -> None:
    """Called by Blender for every setting that is changed."""
    manager = context.window_manager
    of_scene = isinstance(settings.id_data, bpy.types.Scene)
    if not of_scene or manager is None or not manager.involute_view.live or bpy.app.background:
        return
    if bpy.app.timers.is_registered(_again):
        bpy.app.timers.unregister(_again)
    bpy.app.timers.register(_again, first_interval=_PAUSE)


def _again() -> float | None:
    """Begin, once what runs has stopped; timers have no window of their own."""
    if jobs.current is not None:
        jobs.current.cancel()
        return _PAUSE
    windows = bpy.context.window_manager.windows
    if not len(windows):
        return None
    with bpy.context.temp_override(window=windows[0]):
        if bpy.ops.involute.trace_again.poll():
            bpy.ops.involute.trace_again("INVOKE_DEFAULT", True, only_changed=True)
    return None


def unregister() -> None:
    """Wait for nothing any more."""
    if bpy.app.timers.is_registered(_again):
        bpy.app.timers.unregister(_again)
