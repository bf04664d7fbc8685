"""Before a file is saved, data-blocks adopt the junctions of strokes that came from others."""

from __future__ import annotations

import bpy

from ...engine import InvoluteError
from . import cels, state


@bpy.app.handlers.persistent
def _adopt(*_: object) -> None:
    for data in cels.collection():
        if data.is_editable:
            try:
                state.adopt(data)
            except InvoluteError:  # damaged, or of a newer version: it stays as it is
                continue


def register() -> None:
    """Adopt before every save."""
    bpy.app.handlers.save_pre.append(_adopt)


def unregister() -> None:
    """No longer adopt."""
    bpy.app.handlers.save_pre.remove(_adopt)
