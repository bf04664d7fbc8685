"""What the user can do in Blender: one file per verb. `grease_pencil` alone touches strokes."""

from __future__ import annotations

from importlib import import_module

_VERBS = (
    "tracing",
    "trace",
    "import_scan",
    "use_defaults",
    "sequence",
    "reroute",
    "join",
    "separate",
    "lock",
    "accept",
    "ask_again",
    "go_to_junction",
    "preview",
    "choose",
    "drag_join",
)


def _classes() -> list[type]:
    from .trace_settings import INVOLUTE_PG_trace_settings
    from .view_state import INVOLUTE_PG_view

    verbs = [import_module(f".{name}", __package__) for name in _VERBS]
    operators = [cls for verb in verbs for cls in verb.CLASSES]
    return [INVOLUTE_PG_trace_settings, INVOLUTE_PG_view, *operators]


def register() -> None:
    import bpy

    from . import command, trace_settings, view_state

    for cls in _classes():
        bpy.utils.register_class(cls)
    pointer = bpy.props.PointerProperty
    bpy.types.Scene.involute = pointer(type=trace_settings.INVOLUTE_PG_trace_settings)
    bpy.types.WindowManager.involute_view = pointer(type=view_state.INVOLUTE_PG_view)
    command.register()


def unregister() -> None:
    import bpy

    from . import command

    command.unregister()
    del bpy.types.WindowManager.involute_view
    del bpy.types.Scene.involute
    for cls in reversed(_classes()):
        bpy.utils.unregister_class(cls)
