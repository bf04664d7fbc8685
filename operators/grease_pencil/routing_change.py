"""One way in for everything that changes the routing of a drawing: state and strokes together."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ...engine import InvoluteError
from ..language import message
from . import cels, state
from .core.regraphed import regraphed
from .core.splice import Edit, plan
from .core.stroke_arrays import TRACE, column, concatenate
from .retracing import reclean
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
    trace = state.load(data, key, frame)
    trace = replace(trace, pixel_map=state.pixel_map_at(data, frame, trace))
    new = how(trace.drawing)
    if new.pencil is not trace.drawing.pencil:  # an answer about bundles made other lines
        return state.load(data, reclean(data, frame, key, new), frame)
    new = state.settled(data, key, new)
    layers, shown = zip(*cels.cels_at(data, frame), strict=True)
    edits = []
    old = regraphed(trace.drawing, new)
    if (new.routing.partner != old.routing.partner).any():
        there = with_weights(data, frame, [cels.read(cel) for cel in shown])
        edits = plan(old, new, there, key, trace.pixel_map)
        _need_open(layers, edits)
    own = state.own_key(data, frame, trace)
    for cel, edit in zip(shown, edits, strict=False):
        if edit.removed or edit.added:
            added = concatenate(edit.added)
            added.curves[TRACE] = column("INT", np.full(len(added), own.key))
            cels.replace(cel, edit.removed, added, edit.slots)
    return state.store(data, frame, trace, replace(own, drawing=new))


def _need_open(layers: Sequence[bpy.types.bpy_struct], edits: Sequence[Edit]) -> None:
    """What is locked is not to be changed.

    Raises:
        InvoluteError: strokes of a locked layer would have to be.
    """
    for layer, edit in zip(layers, edits, strict=True):
        if edit.removed and cels.is_locked(layer):
            raise InvoluteError(
                message("The layer {name!r} is locked; unlock it to reroute.", name=layer.name)
            )
