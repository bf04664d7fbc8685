"""Before a file is saved, data-blocks adopt the junctions of strokes that came from others.

Before another one is opened, what was remembered of this one is forgotten.
"""

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


@bpy.app.handlers.persistent
def _forget(*_: object) -> None:
    state.forget_seen()


def register() -> None:
    """Adopt before every save."""
    bpy.app.handlers.save_pre.append(_adopt)
    bpy.app.handlers.load_pre.append(_forget)


def unregister() -> None:
    """No longer adopt."""
    bpy.app.handlers.save_pre.remove(_adopt)
    bpy.app.handlers.load_pre.remove(_forget)
