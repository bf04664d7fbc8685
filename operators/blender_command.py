"""`blender -b --command involute ...`: the same command line, run by an installed Blender."""

from __future__ import annotations

import bpy

_handle: object = None


def run(argv: list[str]) -> int:
    """Run the command line with these arguments and return its exit code."""
    from ..command.cli import main
    from .blend_file import BLEND

    return main(argv, formats=[BLEND])


def register() -> None:
    """Make `blender --command involute` known."""
    global _handle
    _handle = bpy.utils.register_cli_command("involute", run)


def unregister() -> None:
    """Forget it again."""
    bpy.utils.unregister_cli_command(_handle)
