"""One way in for everything that changes the routing of a drawing: state and strokes together."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ...engine import InvoluteError
from . import cels, state
from .core.splice import plan
from .core.stroke_arrays import TRACE, column, concatenate
from .vertex_weights import with_weights

if TYPE_CHECKING:
    import bpy

    from ...engine import Drawing


def change_routing(
    data: bpy.types.ID, frame: int, key: int, how: Callable[[Drawing], Drawing]
) -> state.Trace:
    """Apply a change to the drawing that a keyframe shows, and to its strokes.

    Args:
        how: gives the new drawing, for example `lambda drawing: drawing.lock(3)`.

    Returns:
        The trace as it is now; its key is a new one when another keyframe shared the old.

    Raises:
        InvoluteError: the change can't be made; nothing was changed.
    """
    if not data.is_editable:
        raise InvoluteError("This drawing is linked from another file; make it local to change it.")
    trace = state.load(data, key)
    new = state.settled(data, key, how(trace.drawing))
    shown = [cel for _, cel in cels.cels_at(data, frame)]
    edits = []
    if (new.routing.partner != trace.drawing.routing.partner).any():
        there = with_weights(data, frame, [cels.read(cel) for cel in shown])
        edits = plan(trace.drawing, new, there, key, trace.pixel_map)
    trace = state.separate(data, frame, trace)
    for cel, edit in zip(shown, edits, strict=False):
        if edit.removed or edit.added:
            added = concatenate(edit.added)
            added.curves[TRACE] = column("INT", np.full(len(added), trace.key))
            cels.replace(cel, edit.removed, added, edit.slots)
    return state.store(data, replace(trace, drawing=new))
