"""Set the sidebar's settings back to the defaults of the preferences."""

from __future__ import annotations

import bpy

from .trace_settings import NAMES, scene_settings, set_defaults


class INVOLUTE_OT_use_defaults(bpy.types.Operator):
    """Set all trace settings back to the defaults that are in the preferences"""

    bl_idname = "involute.use_defaults"
    bl_label = "Reset to Defaults"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Copy the defaults of the preferences into the scene."""
        set_defaults(scene_settings(context.scene), context)
        return {"FINISHED"}


@bpy.app.handlers.persistent
def _fill(scene: bpy.types.Scene | None, *_: object) -> None:
    """New scenes begin with the defaults of the preferences."""
    if isinstance(scene, bpy.types.Scene) and not scene.involute.filled:
        scene.involute.filled = True
        if not any(scene.involute.is_property_set(name) for name in NAMES):
            set_defaults(scene.involute, bpy.context)


@bpy.app.handlers.persistent
def _fill_all(*_: object) -> None:
    for scene in bpy.data.scenes:
        _fill(scene)


def register() -> None:
    """Fill new scenes as they come."""
    bpy.app.handlers.load_post.append(_fill_all)
    bpy.app.handlers.depsgraph_update_post.append(_fill)


def unregister() -> None:
    """No longer fill them."""
    bpy.app.handlers.load_post.remove(_fill_all)
    bpy.app.handlers.depsgraph_update_post.remove(_fill)


CLASSES = (INVOLUTE_OT_use_defaults,)
