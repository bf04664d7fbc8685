"""What the user can do in Blender: one file per verb. `grease_pencil` alone touches strokes."""

from __future__ import annotations


def _classes() -> list[type]:
    from . import import_scan, trace, trace_settings

    return [trace_settings.INVOLUTE_PG_trace_settings, *trace.CLASSES, *import_scan.CLASSES]


def register() -> None:
    import bpy

    from . import command
    from .trace_settings import INVOLUTE_PG_trace_settings

    for cls in _classes():
        bpy.utils.register_class(cls)
    bpy.types.Scene.involute = bpy.props.PointerProperty(type=INVOLUTE_PG_trace_settings)
    command.register()


def unregister() -> None:
    import bpy

    from . import command

    command.unregister()
    del bpy.types.Scene.involute
    for cls in reversed(_classes()):
        bpy.utils.unregister_class(cls)
