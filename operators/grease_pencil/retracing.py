"""A traced keyframe made anew from another trace of its picture; the artist's work stays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ...engine import InvoluteError
from ..language import message
from . import cels, state, writing
from .core.hand_edits import Kept, hand_edits
from .core.stroke_arrays import ALONG, HALF, ROUTING, TRACE, column

if TYPE_CHECKING:
    import bpy

    from ...engine import Drawing


@dataclass(frozen=True)
class Retraced:
    """key: of the new trace. decisions: how many found no place any more. kept: strokes that the
    artist had changed and that stayed."""

    key: int
    decisions: int
    kept: int


def retrace(data: bpy.types.ID, frame: int, key: int, drawing: Drawing) -> Retraced:
    """Put another drawing of the same page in the place of a traced one.

    Decisions are made again on it; strokes that the artist has changed stay as they are, deleted
    ones stay deleted, strokes drawn by hand and other traces are not touched.

    Raises:
        InvoluteError: a layer is locked, or the data are linked; nothing was changed.
    """
    from ...engine.decisions import carried

    if not data.is_editable:
        raise InvoluteError("This drawing is linked from another file; make it local to change it.")
    trace = state.load(data, key, frame)
    pixel_map = state.pixel_map_at(data, frame, trace)
    layers, shown = zip(*cels.cels_at(data, frame), strict=True)
    for layer, cel in zip(layers, shown, strict=True):
        if cels.is_locked(layer) and _of(cel, key).any():
            said = "The layer {name!r} is locked; unlock it to trace again."
            raise InvoluteError(message(said, name=layer.name))
    new, lost = carried(trace.drawing, drawing)
    edits = hand_edits(trace.drawing, new, [cels.read(cel) for cel in shown], key, pixel_map)
    there = _frame_of(layers, frame, key)
    picture = state.picture_of(data, key)
    own = state.add(data, new, pixel_map, trace.source, picture)
    for cel, kept in zip(shown, edits.kept, strict=True):
        _leave(cel, key, kept, own)
    drawn = [s for k, s in enumerate(new.strokes) if k not in edits.left_out]
    thinned = replace(new, strokes=tuple(drawn), edits=None)
    writing.write(data, there, thinned, pixel_map, own, clear=False)
    state.forget(data, key)
    return Retraced(own, lost, sum(map(len, edits.kept)))


def _of(cel: object, key: int) -> np.ndarray:
    """(n,) bool: the strokes of a trace."""
    column = cels.read_column(cel, TRACE)
    return np.zeros(0, bool) if column is None else column == key


def _frame_of(layers: tuple[bpy.types.bpy_struct, ...], frame: int, key: int) -> int:
    """The frame at which the keyframe stands that has most strokes of a trace."""
    keys = [layer.get_frame_at(frame) for layer in layers]
    counts = [int(_of(one.drawing, key).sum()) for one in keys]
    return keys[int(np.argmax(counts))].frame_number


def _leave(cel: object, key: int, kept: Sequence[Kept], own: int) -> None:
    """Take away all strokes of a trace but some, which stand for strokes of the new one from now
    on."""
    mine = _of(cel, key)
    if kept:
        curves = cels.read(cel)
        marks = {name: curves.mark(name).astype(np.int32) for name in (TRACE, HALF, ROUTING)}
        along = curves.point(ALONG).astype(np.float32)
        for one in kept:
            marks[TRACE][one.index] = own if one.half else 0
            marks[HALF][one.index], marks[ROUTING][one.index] = one.half, 0
            along[curves.offsets[one.index] : curves.offsets[one.index + 1]] = one.along
        for name, values in marks.items():
            cels.set_column(cel, name, values)
        cels.set_points(cel, ALONG, column("FLOAT", along))
    gone = np.setdiff1d(np.flatnonzero(mine), [one.index for one in kept])
    if len(gone):
        cel.remove_strokes(indices=gone.tolist())
