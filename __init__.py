"""Involute: scanned line drawings become Grease Pencil strokes that run through their junctions.

Outside Blender this package is a plain Python library (`involute.engine`) and a command line.
"""

from __future__ import annotations


def register() -> None:
    """Called by Blender when the extension is enabled; loads neither OpenCV nor a network."""
    from . import operators, ui

    operators.register()
    ui.register()


def unregister() -> None:
    """Called by Blender when the extension is disabled."""
    from . import operators, ui

    ui.unregister()
    operators.unregister()
