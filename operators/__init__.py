"""What the user can do in Blender: one file per verb. `grease_pencil` alone touches strokes."""

from __future__ import annotations

from importlib import import_module

_VERBS = (
    "tracing.background",
    "tracing.trace",
    "tracing.import_scan",
    "tracing.use_defaults",
    "sequences.trace_frames",
    "junctions.reroute",
    "junctions.join",
    "junctions.separate",
    "junctions.lock",
    "junctions.accept",
    "junctions.ask_again",
    "junctions.go_to_junction",
    "junctions.preview",
    "junctions.choose",
    "junctions.drag_join",
)


def _classes() -> list[type]:
    from .junctions.view_state import INVOLUTE_PG_view
    from .tracing.trace_settings import INVOLUTE_PG_trace_settings

    verbs = [import_module(f".{name}", __package__) for name in _VERBS]
    operators = [cls for verb in verbs for cls in verb.CLASSES]
    return [INVOLUTE_PG_trace_settings, INVOLUTE_PG_view, *operators]


def register() -> None:
    import bpy

    from . import blender_command
    from .junctions import view_state
    from .tracing import trace_settings

    for cls in _classes():
        bpy.utils.register_class(cls)
    pointer = bpy.props.PointerProperty
    bpy.types.Scene.involute = pointer(type=trace_settings.INVOLUTE_PG_trace_settings)
    bpy.types.WindowManager.involute_view = pointer(type=view_state.INVOLUTE_PG_view)
    blender_command.register()


def unregister() -> None:
    import bpy

    from . import blender_command

    blender_command.unregister()
    del bpy.types.WindowManager.involute_view
    del bpy.types.Scene.involute
    for cls in reversed(_classes()):
        bpy.utils.unregister_class(cls)
