"""Set the sidebar's settings back to the defaults of the preferences."""

from __future__ import annotations

import bpy

from .trace_settings import as_values, scene_settings


class INVOLUTE_OT_use_defaults(bpy.types.Operator):
    """Set all trace settings back to the defaults that are in the preferences"""

    bl_idname = "involute.use_defaults"
    bl_label = "Reset to Defaults"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Copy the defaults of the preferences into the scene."""
        package = __package__.removesuffix(".operators.tracing")
        defaults = context.preferences.addons[package].preferences.defaults
        settings = scene_settings(context.scene)
        for name, value in as_values(defaults).items():
            setattr(settings, name, value)
        return {"FINISHED"}


CLASSES = (INVOLUTE_OT_use_defaults,)
