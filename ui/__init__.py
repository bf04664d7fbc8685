"""What the user sees in Blender: panels, overlay, menus, tool, keys; no logic of its own."""

from __future__ import annotations

from importlib import import_module
from types import ModuleType

_WITH_CLASSES = (
    "panels.preferences",
    "panels.presets",
    "panels.trace_panel",
    "panels.junction_panel",
    "panels.pie",
)
_WITH_REGISTER = (
    "language.translations",
    "panels.menus",
    "overlay.overlay",
    "keymap",
    "tool",
)


def _modules(names: tuple[str, ...]) -> list[ModuleType]:
    return [import_module(f".{name}", __package__) for name in names]


def register() -> None:
    """Register all that is seen."""
    import bpy

    for module in _modules(_WITH_CLASSES):
        for cls in module.CLASSES:
            bpy.utils.register_class(cls)
    for module in _modules(_WITH_REGISTER):
        module.register()


def unregister() -> None:
    """Take all of it back, in the opposite order."""
    import bpy

    for module in reversed(_modules(_WITH_REGISTER)):
        module.unregister()
    for module in reversed(_modules(_WITH_CLASSES)):
        for cls in reversed(module.CLASSES):
            bpy.utils.unregister_class(cls)
