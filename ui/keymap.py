"""Keys in the 3D viewport; they can be changed in the preferences."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from ..operators.junctions.go_to_junction import INVOLUTE_OT_step_junction
from ..operators.junctions.review import INVOLUTE_OT_review
from .panels.pie import INVOLUTE_MT_pie

_MENU = "wm.call_menu_pie"
_added: list[tuple[bpy.types.KeyMap, bpy.types.KeyMapItem]] = []


def register() -> None:
    """Add our keys to the 3D viewport."""
    configuration = bpy.context.window_manager.keyconfigs.addon
    if configuration is None:
        return
    keymap = configuration.keymaps.new(name="3D View", space_type="VIEW_3D")
    item = keymap.keymap_items.new(_MENU, "J", "PRESS", ctrl=True, alt=True)
    item.properties.name = INVOLUTE_MT_pie.bl_idname
    _added.append((keymap, item))
    for key, direction in (("PAGE_DOWN", "NEXT"), ("PAGE_UP", "PREVIOUS")):
        item = keymap.keymap_items.new(
            INVOLUTE_OT_step_junction.bl_idname, key, "PRESS", ctrl=True, alt=True
        )
        item.properties.direction = direction
        _added.append((keymap, item))
    item = keymap.keymap_items.new(INVOLUTE_OT_review.bl_idname, "R", "PRESS", ctrl=True, alt=True)
    _added.append((keymap, item))


def unregister() -> None:
    """Take them away again."""
    for keymap, item in _added:
        keymap.keymap_items.remove(item)
    _added.clear()


def items(
    configuration: bpy.types.KeyConfig,
) -> Iterator[tuple[bpy.types.KeyMap, bpy.types.KeyMapItem, str]]:
    """Our items as the user has them, and what each does: two run the same operator."""
    keymap = configuration.keymaps.get("3D View")
    for item in keymap.keymap_items if keymap else ():
        if item.idname == INVOLUTE_OT_step_junction.bl_idname:
            is_next = item.properties.direction == "NEXT"
            yield keymap, item, "Next Junction" if is_next else "Previous Junction"
        elif item.idname == INVOLUTE_OT_review.bl_idname:
            yield keymap, item, "Review Junctions"
        elif item.idname == _MENU and item.properties.name == INVOLUTE_MT_pie.bl_idname:
            yield keymap, item, "Junctions"
