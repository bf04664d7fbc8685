"""What the user can do in Blender: one file per verb.

tracing         pictures become Grease Pencil objects
sequences       numbered drawings become keyframes
junctions       what is done to the junctions of a traced drawing
pencil          lines and the pencil strokes that they were made of
view            what is looked at and where it lies on the screen; `ui` draws it
grease_pencil   the data layer: it alone touches strokes
blend_file, blender_command   .blend files for the command line, which Blender runs as well
job                             threads that Blender does not wait for
language, engine_sentences      words in the user's language; those of the engine
"""

from __future__ import annotations

from importlib import import_module

_VERBS = (
    "tracing.background",
    "tracing.trace",
    "tracing.trace_again",
    "tracing.import_scan",
    "tracing.paste",
    "tracing.try_part",
    "tracing.choose_part",
    "tracing.use_defaults",
    "tracing.use_preset",
    "sequences.trace_frames",
    "junctions.reroute",
    "junctions.join",
    "junctions.separate",
    "junctions.cut",
    "junctions.route_along",
    "junctions.lift_bias",
    "junctions.lock",
    "junctions.accept",
    "junctions.accept_inside",
    "junctions.ask_again",
    "junctions.go_to_junction",
    "junctions.doubtful_frame",
    "junctions.preview",
    "junctions.choose",
    "junctions.review",
    "junctions.drag_join",
    "pencil.merge_lines",
    "pencil.split_line",
)


def _classes() -> list[type]:
    from .tracing.trace_settings import INVOLUTE_PG_trace_settings
    from .view.view_state import INVOLUTE_PG_view

    verbs = [import_module(f".{name}", __package__) for name in _VERBS]
    operators = [cls for verb in verbs for cls in verb.CLASSES]
    return [INVOLUTE_PG_trace_settings, INVOLUTE_PG_view, *operators]


def register() -> None:
    """Register the operators, the settings in scenes, the view state and the command."""
    import bpy

    from . import blender_command
    from .grease_pencil import saving
    from .junctions import lift_bias
    from .tracing import background, part, trace_settings, use_defaults
    from .view import view_state

    for cls in _classes():
        bpy.utils.register_class(cls)
    pointer = bpy.props.PointerProperty
    bpy.types.Scene.involute = pointer(type=trace_settings.INVOLUTE_PG_trace_settings)
    bpy.types.WindowManager.involute_view = pointer(type=view_state.INVOLUTE_PG_view)
    lift_bias.register()
    saving.register()
    background.register()
    part.register()
    use_defaults.register()
    blender_command.register()


def unregister() -> None:
    """Take all of it back, in the opposite order."""
    import bpy

    from . import blender_command
    from .grease_pencil import saving
    from .junctions import lift_bias
    from .tracing import background, live, part, use_defaults

    live.unregister()
    blender_command.unregister()
    use_defaults.unregister()
    part.unregister()
    background.unregister()
    saving.unregister()
    lift_bias.unregister()
    del bpy.types.WindowManager.involute_view
    del bpy.types.Scene.involute
    for cls in reversed(_classes()):
        bpy.utils.unregister_class(cls)
