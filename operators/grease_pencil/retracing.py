"""A traced keyframe made anew from another trace of its picture; the artist's work stays."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ...engine import InvoluteError
from ..language import message
from . import cels, state, writing
from .core.hand_edits import Kept, hand_edits, same_strokes
from .core.stroke_arrays import ALONG, HALF, LINE, ROUTING, TRACE, column

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

    trace = state.load(data, key, frame)
    _need_open(data, frame, key, "The layer {name!r} is locked; unlock it to trace again.")
    new, lost = carried(trace.drawing, drawing)
    own, kept = _put(data, frame, trace, new, {}, new)
    return Retraced(own, lost, kept)


def reclean(data: bpy.types.ID, frame: int, key: int, new: Drawing) -> int:
    """Put a drawing in the place of the one that it was cleaned from again; returns its key.

    Lines that are as they were are not touched, nor are the pencil strokes.

    Raises:
        InvoluteError: a layer is locked; nothing was changed.
    """
    trace = state.load(data, key, frame)
    said = "The layer {name!r} is locked; unlock it to reroute."
    _need_open(data, frame, key, said, but=writing.PENCIL_LAYER)
    same = same_strokes(trace.drawing, new)
    return _put(data, frame, trace, new, same, replace(new, pencil=None))[0]


def _need_open(data: bpy.types.ID, frame: int, key: int, said: str, but: str = "") -> None:
    """What is linked or locked is not to be changed, `but` for a layer.

    Raises:
        InvoluteError: strokes of the trace are.
    """
    if not data.is_editable:
        raise InvoluteError("This drawing is linked from another file; make it local to change it.")
    for layer, cel in cels.cels_at(data, frame):
        if layer.name != but and cels.is_locked(layer) and _of(cel, key).any():
            raise InvoluteError(message(said, name=layer.name))


def _put(
    data: bpy.types.ID,
    frame: int,
    trace: state.Trace,
    new: Drawing,
    same: Mapping[int, int],
    written: Drawing,
) -> tuple[int, int]:
    """The key of the new drawing, and how many strokes of the old one stayed.

    Args:
        same: see `hand_edits`. written: what of the new one is written.
    """
    key, old = trace.key, trace.drawing
    pixel_map = state.pixel_map_at(data, frame, trace)
    layers, shown = zip(*cels.cels_at(data, frame), strict=True)
    edits = hand_edits(old, new, [cels.read(cel) for cel in shown], key, pixel_map, same)
    there = _frame_of(layers, frame, key)
    picture = state.picture_of(data, key)
    own = state.add(data, new, pixel_map, trace.source, picture)
    for cel, kept in zip(shown, edits.kept, strict=True):
        if written.pencil is None and new.pencil is not None:
            _keep_pencil(cel, key, own, old, new)
        _leave(cel, key, kept, own)
    drawn = [s for k, s in enumerate(new.strokes) if k not in edits.left_out]
    thinned = replace(written, strokes=tuple(drawn), edits=None)
    writing.write(data, there, thinned, pixel_map, own, clear=False)
    state.forget(data, key)
    return own, sum(map(len, edits.kept))


def _keep_pencil(cel: object, key: int, own: int, old: Drawing, new: Drawing) -> None:
    """Leave the pencil strokes of a trace to another one, and tell them their lines."""
    halves, traces, said = (cels.read_column(cel, name) for name in (HALF, TRACE, LINE))
    if said is None or halves is None or traces is None:  # only pencil strokes have lines
        return
    mine = np.flatnonzero((traces == key) & (halves < 0))
    traces[mine] = own
    cels.set_column(cel, TRACE, traces)
    lines = new.line_of_pencil
    if len(mine) == len(lines):
        said[mine] = lines
    else:  # the artist took some away
        known = dict(zip(old.line_of_pencil.tolist(), lines.tolist(), strict=True))
        said[mine] = [known.get(line, 0) for line in said[mine].tolist()]
    cels.set_column(cel, LINE, said)


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
