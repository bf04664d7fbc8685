"""The routing state of traced drawings, kept in the Grease Pencil data-block itself.

So it is saved, appended, duplicated and undone together with the strokes. Layers and keyframes
can't hold such data, and artists rename and move them: instead every traced stroke carries the key
of its drawing, and the data-block holds an ID property

    data["involute"] = {"version": 1, "traces": {key: entry}}          see `stored_trace`

The strokes are the truth. Undo in Edit Mode takes strokes back, but no ID properties: therefore
strokes are marked with the routing that they are in, and the entry remembers earlier ones. Objects
are joined and separated, and only strokes move: the entry of a key is found in whatever data-block
has it, and where the pixels lie is looked up from the strokes (`core.map_fit`).

A step of undo back into Edit Mode brings strokes together with older ID properties than they had:
ones that don't know their routing yet. So the last entry of each key is remembered as long as the
file is open (`_seen`), and strokes find theirs there by their mark; saving writes it down.

Rerouting stores little and is quick, since the drawing stays as it was traced. Decoded drawings are
remembered, too, looked up by the hash of their content.
"""

from __future__ import annotations

import contextlib
import zlib
from collections import Counter, OrderedDict
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ...engine import InvoluteError
from . import cels, change, stored_trace
from .core.map_fit import fitted
from .core.pixel_map import PixelMap
from .core.stroke_arrays import HALF, ROUTING, TRACE
from .stored_trace import Picture, UnsoundTraceError, reading

if TYPE_CHECKING:
    import bpy

    from ...engine import Drawing

PROPERTY = "involute"
VERSION = 1
_MAX_SEEN = 64  # entries; each is as large as a drawing in the file, a few hundred KB
_seen: OrderedDict[int, dict[str, Any]] = OrderedDict()


@dataclass(frozen=True, eq=False)
class Trace:
    """A traced drawing inside a Grease Pencil data-block."""

    key: int
    drawing: Drawing
    pixel_map: PixelMap
    source: str
    stamp: str


def keys_at(data: bpy.types.ID, frame: int) -> list[int]:
    """The traces whose strokes are shown at a frame, those with most strokes first."""
    counts: Counter[int] = Counter()
    for _, cel in cels.cels_at(data, frame):
        counts.update(_strokes_by_key(cel))
    return [key for key, _ in counts.most_common() if key > 0 and _entry(data, key) is not None]


def keys_at_exactly(data: bpy.types.ID, frame: int) -> list[int]:
    """The same, but only when a keyframe stands at that very frame."""
    there = any(key.frame_number == frame for layer in data.layers for key in layer.frames)
    return keys_at(data, frame) if there else []


def pixel_map_in(data: bpy.types.ID) -> PixelMap | None:
    """Where the pixels of a traced drawing in this data-block lie; None when there is none."""
    with reading():
        for entry in _traces(data).values():
            return stored_trace.pixel_map_of(entry)
    return None


def load(data: bpy.types.ID, key: int, frame: int | None = None) -> Trace:
    """The trace of that key.

    Args:
        frame: look in which routing the strokes of that frame are; None = the latest.

    Raises:
        UnsoundTraceError: what is stored of it is damaged.
        InvoluteError: there is none, or a newer Involute wrote it.
    """
    entry = _entry(data, key)
    if entry is None:
        raise InvoluteError("This drawing was not traced by Involute.")
    with reading():
        stamp = stored_trace.stamp_of(entry)
        if frame is not None:
            marks = _marks([cel for _, cel in cels.cels_at(data, frame)], key)
            entry = _knowing(entry, key, marks[0])
            stamp = stored_trace.stamp_among(entry, marks)
        drawing = stored_trace.drawing_of(entry, stamp)
        pixel_map = stored_trace.pixel_map_of(entry)
        return Trace(key, drawing, pixel_map, stored_trace.source_of(entry), stamp)


def pixel_map_at(data: bpy.types.ID, frame: int, trace: Trace) -> PixelMap:
    """Where the pixels of a trace lie now: a transform that was applied moves strokes only."""
    shown = [cels.read_places(cel) for _, cel in cels.cels_at(data, frame)]
    return fitted(trace.drawing, shown, trace.key, trace.pixel_map)


def halves_at(data: bpy.types.ID, frame: int, key: int) -> np.ndarray:
    """The first half-branches of the strokes of a trace that are there, ascending."""
    found = [np.zeros(0, np.int32)]
    for _, cel in cels.cels_at(data, frame):
        keys, halves = (cels.read_column(cel, name) for name in (TRACE, HALF))
        if keys is not None and halves is not None:
            found.append(halves[(keys == key) & (halves > 0)] - 1)
    return np.unique(np.concatenate(found))


def settled(data: bpy.types.ID, key: int, drawing: Drawing) -> Drawing:
    """A changed drawing of that trace with the strokes that it will have when it is read again.

    In a sequence strokes start and run as on the frame before; one that was rerouted and is back as
    it was traced gets that start and direction back, too.
    """
    with reading():
        base = stored_trace.base_of(_entry(data, key))
    return change.again(base, drawing) if change.can_be_told(base, drawing) else drawing


def check_writable(data: bpy.types.ID) -> None:
    """Can a trace be stored here?

    Raises:
        InvoluteError: a newer Involute has stored its own.
    """
    with contextlib.suppress(UnsoundTraceError):  # that is made anew
        _traces(data)


def add(
    data: bpy.types.ID,
    drawing: Drawing,
    pixel_map: PixelMap,
    source: str,
    picture: Picture | None = None,
) -> int:
    """Store a new trace and return its key."""
    traces = _writable(data)
    key = _free_key(data, drawing, source)
    entry, _ = stored_trace.made(drawing, pixel_map, source, picture)
    traces[str(key)] = entry
    _see(key, entry)
    return key


def picture_of(data: bpy.types.ID, key: int) -> Picture:
    """The picture that a trace was made from; without a path and an image where nobody knows."""
    entry = _entry(data, key)
    with reading():
        return Picture() if entry is None else stored_trace.picture_of(entry)


def doubtful_frames(data: bpy.types.ID) -> dict[int, int]:
    """The keyframes with traced strokes, ascending, and how many of their junctions are doubtful.

    Quick: no drawing is decoded. What is damaged counts as certain.
    """
    keys: dict[int, set[int]] = {}
    for layer in data.layers:
        for frame in layer.frames:
            there = {} if frame.drawing is None else _strokes_by_key(frame.drawing)
            if any(there):
                keys.setdefault(frame.frame_number, set()).update(k for k in there if k > 0)
    found = {}
    for frame, some in sorted(keys.items()):
        found[frame] = 0
        for key in some:
            with contextlib.suppress(InvoluteError), reading():
                entry = _entry(data, key)
                found[frame] += 0 if entry is None else stored_trace.doubtful_of(entry)
    return found


def forget(data: bpy.types.ID, key: int) -> None:
    """Drop what is stored of a trace, if no stroke carries its key any more."""
    if not _users(list(cels.all_cels(data)), key) and str(key) in _traces(data):
        del _traces(data)[str(key)]


def store(data: bpy.types.ID, frame: int, before: Trace, after: Trace) -> Trace:
    """Store another routing of a trace, mark its strokes with it, and return it with its stamp.

    Args:
        before: the trace as it was loaded.
        after: the same with another drawing, and the key that it is to have.
    """
    entry = _knowing(_entry(data, before.key), before.key, stored_trace.mark_of(before.stamp))
    base = stored_trace.base_of(entry)
    if change.can_be_told(base, after.drawing):
        entry, stamp = stored_trace.rerouted(
            entry, before.drawing, after.drawing, after.pixel_map, before.stamp
        )
    else:
        picture = stored_trace.picture_of(entry)
        entry, stamp = stored_trace.made(after.drawing, after.pixel_map, after.source, picture)
    _writable(data)[str(after.key)] = entry
    _see(after.key, entry)
    for _, cel in cels.cels_at(data, frame):
        mine = cels.read_column(cel, TRACE)
        if mine is not None and (mine == after.key).any():
            marks = cels.read_column(cel, ROUTING)
            marks = np.zeros(len(mine), np.int32) if marks is None else marks
            marks[mine == after.key] = stored_trace.mark_of(stamp)
            cels.set_column(cel, ROUTING, marks)
    return replace(after, stamp=stamp)


def own_key(data: bpy.types.ID, frame: int, trace: Trace) -> Trace:
    """Give the trace of one keyframe a key of its own when copies of the keyframe share it.

    A copied keyframe carries the same keys; a change to one must not change the other.
    """
    here = [cel for _, cel in cels.cels_at(data, frame)]
    if _users(list(cels.all_cels(data)), trace.key) <= _users(here, trace.key):
        return trace
    key = _free_key(data, trace.drawing, f"{trace.source}@{frame}")
    for cel in here:
        column = cels.read_column(cel, TRACE)
        if column is not None and (column == trace.key).any():
            cels.set_column(cel, TRACE, np.where(column == trace.key, key, column))
    return replace(trace, key=key)


def adopt(data: bpy.types.ID) -> None:
    """Copy what the data-block's strokes need from where it is: other data-blocks, or `_seen`.

    Joining and separating objects moves strokes, not ID properties; a file that is saved with one
    of the objects alone must hold the junctions of its strokes.
    """
    wanted: dict[int, int] = {}
    for cel in cels.all_cels(data):
        for key in _strokes_by_key(cel):
            wanted.setdefault(key, _marks([cel], key)[0])
    for key, mark in sorted(wanted.items()):
        entry = _entry(data, key) if key > 0 else None
        if entry is None:
            continue
        known = _knowing(entry, key, mark)
        if known is not entry or str(key) not in _traces(data):
            _writable(data)[str(key)] = known if isinstance(known, dict) else known.to_dict()


def forget_seen() -> None:
    """Another file is opened: its keys may be the same, and there is nothing to undo."""
    _seen.clear()


def _see(key: int, entry: dict[str, Any]) -> None:
    _seen[key] = entry
    _seen.move_to_end(key)
    while len(_seen) > _MAX_SEEN:
        _seen.popitem(last=False)


def _knowing(entry: Any, key: int, mark: int) -> Any:
    """The entry, or the one that was seen last where only that knows the routing of strokes."""
    seen = _seen.get(key)
    if seen is None or stored_trace.holds(entry, mark):
        return entry
    return seen if stored_trace.holds(seen, mark) else entry


def _strokes_by_key(cel: object) -> dict[int, int]:
    """How many strokes of a cel there are of each trace, and of none: 0."""
    column = cels.read_column(cel, TRACE)
    if column is None or not len(column):
        return {}
    if (column == column[0]).all():  # as nearly always; this runs at every redraw
        return {int(column[0]): len(column)}
    return _counted(column)


def _counted(column: np.ndarray) -> dict[int, int]:
    keys, counts = np.unique(column, return_counts=True)
    return dict(zip(keys.tolist(), counts.tolist(), strict=True))


def _marks(some: list[object], key: int) -> list[int]:
    """The routings that the strokes in cels are marked with, the most usual first; 0 = no mark."""
    counts: Counter[int] = Counter()
    for cel in some:
        keys, marks = (cels.read_column(cel, name) for name in (TRACE, ROUTING))
        if keys is not None and marks is not None:
            counts.update(_counted(marks[keys == key]))
    return [mark for mark, _ in counts.most_common()] or [0]


def _users(some: list[object], key: int) -> int:
    """How many of the cels have strokes of that trace."""
    columns = (cels.read_column(cel, TRACE) for cel in some)
    return sum(1 for c in columns if c is not None and (c == key).any())


def _traces(data: bpy.types.ID) -> Any:
    """The entries of a data-block by their keys; an empty mapping where there are none.

    Raises:
        UnsoundTraceError: it is not what Involute writes.
        InvoluteError: a newer Involute wrote it.
    """
    root = data.get(PROPERTY)
    if root is None:
        return {}
    with reading():
        version, traces = root["version"], root["traces"]
        if not isinstance(version, int) or not hasattr(traces, "to_dict"):
            raise TypeError
    if version > VERSION:
        raise InvoluteError("A newer Involute traced this drawing; update the extension.")
    return traces


def _entry(data: bpy.types.ID, key: int) -> Any:
    """What is stored for a key, here or in the data-block that the strokes came from."""
    name = str(key)
    own = _traces(data)
    if name in own:
        return own[name]
    for other in cels.collection():
        if other != data and other.get(PROPERTY) is not None:
            try:
                found = _traces(other)
            except InvoluteError:  # damaged, or of a newer version: nothing for us
                continue
            if name in found:
                return found[name]
    return _seen.get(key)  # undo brought its strokes back


def _writable(data: bpy.types.ID) -> Any:
    """The entries, made anew where there are none or nothing that can be read."""
    try:
        if data.get(PROPERTY) is not None:
            return _traces(data)
    except UnsoundTraceError:
        pass
    data[PROPERTY] = {"version": VERSION, "traces": {}}
    return data[PROPERTY]["traces"]


def _free_key(data: bpy.types.ID, drawing: Drawing, source: str) -> int:
    """A positive key that says as little as possible about time and chance: same input, same key.

    Keys must also differ between data-blocks, since their objects may be joined.
    """
    seed = f"{data.name}|{source}|{len(drawing.strokes)}|{drawing.size}"
    key = zlib.crc32(seed.encode()) & 0x7FFFFFFF or 1
    while _entry(data, key) is not None:
        key = key % 0x7FFFFFFF + 1
    return key
