"""What the user sees in Blender: panels, overlay, menus, tool; no logic of its own."""

from __future__ import annotations


def register() -> None:
    from . import menus

    menus.register()


def unregister() -> None:
    from . import menus

    menus.unregister()
