"""The routing state of traced drawings, kept in the Grease Pencil data-block itself.

So it is saved, appended, duplicated and undone together with the strokes. Layers and keyframes
can't hold such data, and artists rename and move them: instead every traced stroke carries the key
of its drawing, and the data-block holds an ID property

    data["involute"] = {"version": 1, "traces": {key: {
        "drawing": bytes, "base": str,      the engine's own JSON, compressed, and its hash
        "routing": bytes, "stamp": str,     what was rerouted and locked since; hash of it all
        "placement": 9 floats, "source": str}}}

Rerouting stores little and is quick, since the drawing stays as it was traced. Nothing is
remembered in Python but decoded drawings, looked up by the hash of their content.
"""

from __future__ import annotations

import zlib
from collections import Counter, OrderedDict
from dataclasses import dataclass, replace
from hashlib import blake2b
from typing import TYPE_CHECKING, Any

import numpy as np

from ...engine import InvoluteError
from . import cels
from .core.pixel_map import PixelMap
from .core.stroke_arrays import TRACE

if TYPE_CHECKING:
    import bpy

    from ...engine import Drawing

PROPERTY = "involute"
VERSION = 1
_MAX_DECODED = 16
_decoded: OrderedDict[str, Drawing] = OrderedDict()


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
    if data.get(PROPERTY) is None:
        return []
    columns = [cels.read_column(drawing, TRACE) for _, drawing in cels.cels_at(data, frame)]
    counts: Counter[int] = Counter()
    for column in columns:
        if column is None or not len(column):
            continue
        if (column == column[0]).all():  # as nearly always; this runs at every redraw
            counts[int(column[0])] += len(column)
        else:
            counts.update(_counted(column))
    known = _traces(data)
    return [key for key, _ in counts.most_common() if key and str(key) in known]


def keys_at_exactly(data: bpy.types.ID, frame: int) -> list[int]:
    """The same, but only when a keyframe stands at that very frame."""
    there = any(key.frame_number == frame for layer in data.layers for key in layer.frames)
    return keys_at(data, frame) if there else []


def pixel_map_in(data: bpy.types.ID) -> PixelMap | None:
    """Where the pixels of a traced drawing in this data-block lie; None when there is none."""
    entry = next(iter(_traces(data).values()), None)
    return PixelMap.from_list(entry["placement"]) if entry else None


def load(data: bpy.types.ID, key: int) -> Trace:
    """The trace of that key.

    Raises:
        InvoluteError: there is none, or a newer Involute wrote it.
    """
    entry = _traces(data).get(str(key))
    if entry is None:
        raise InvoluteError("This drawing was not traced by Involute.")
    stamp = entry["stamp"]
    drawing = _decoded.get(stamp)
    if drawing is None:
        drawing = _with_routing(_base(entry), entry["routing"])
        _remember(stamp, drawing)
    return Trace(key, drawing, PixelMap.from_list(entry["placement"]), entry["source"], stamp)


def stamp(data: bpy.types.ID, key: int) -> str:
    """A hash of the trace's content: the same as long as nothing was changed."""
    entry = _traces(data).get(str(key))
    return entry["stamp"] if entry else ""


def settled(data: bpy.types.ID, key: int, drawing: Drawing) -> Drawing:
    """A changed drawing of that trace with the strokes that it will have when it is read again.

    In a sequence strokes start and run as on the frame before; one that was rerouted and is back as
    it was traced gets that start and direction back, too.
    """
    base = _base(_traces(data)[str(key)])
    if not _differs_in_routing_only(base, drawing):
        return drawing
    return base.with_routing(drawing.routing.partner, drawing.routing.locked)


def add(data: bpy.types.ID, drawing: Drawing, pixel_map: PixelMap, source: str) -> int:
    """Store a new trace and return its key."""
    key = _free_key(data, drawing, source)
    store(data, Trace(key, drawing, pixel_map, source, ""))
    return key


def store(data: bpy.types.ID, trace: Trace) -> Trace:
    """Store a trace under its key, in place of what was there; return it with its stamp."""
    root = data.get(PROPERTY)
    if root is None:
        data[PROPERTY] = {"version": VERSION, "traces": {}}
        root = data[PROPERTY]
    old = root["traces"].get(str(trace.key))
    if old is not None and _differs_in_routing_only(_base(old), trace.drawing):
        blob, base, routing = old["drawing"], old["base"], _routing_of(trace.drawing)
    else:
        blob, routing = _encode(trace.drawing), b""
        base = _hash(blob)
        _remember(base, trace.drawing)
    stamp = _hash(base.encode() + routing)
    root["traces"][str(trace.key)] = {
        "drawing": blob,
        "base": base,
        "routing": routing,
        "stamp": stamp,
        "placement": trace.pixel_map.as_list(),
        "source": trace.source,
    }
    _remember(stamp, trace.drawing)
    return replace(trace, stamp=stamp)


def separate(data: bpy.types.ID, frame: int, trace: Trace) -> Trace:
    """Make the trace of one keyframe its own when copies of the keyframe share it.

    A copied keyframe carries the same keys; a change to one must not change the other.
    """
    here = [drawing for _, drawing in cels.cels_at(data, frame)]
    everywhere = list(cels.all_cels(data))
    if _users(everywhere, trace.key) <= _users(here, trace.key):
        return trace
    key = _free_key(data, trace.drawing, f"{trace.source}@{frame}")
    for drawing in here:
        column = cels.read_column(drawing, TRACE)
        if column is not None and (column == trace.key).any():
            cels.set_column(drawing, TRACE, np.where(column == trace.key, key, column))
    return store(data, replace(trace, key=key))


def _counted(column: np.ndarray) -> dict[int, int]:
    keys, counts = np.unique(column, return_counts=True)
    return dict(zip(keys.tolist(), counts.tolist(), strict=True))


def _users(drawings: list[object], key: int) -> int:
    """How many of the drawings have strokes of that trace."""
    columns = (cels.read_column(drawing, TRACE) for drawing in drawings)
    return sum(1 for c in columns if c is not None and (c == key).any())


def _traces(data: bpy.types.ID) -> Any:
    root = data.get(PROPERTY)
    if root is None:
        return {}
    if root["version"] > VERSION:
        raise InvoluteError("A newer Involute traced this drawing; update the extension.")
    return root["traces"]


def _free_key(data: bpy.types.ID, drawing: Drawing, source: str) -> int:
    """A positive key that says as little as possible about time and chance: same input, same key.

    Keys must also differ between data-blocks, since their objects may be joined.
    """
    traces = _traces(data)
    seed = f"{data.name}|{source}|{len(drawing.strokes)}|{drawing.size}"
    key = zlib.crc32(seed.encode()) & 0x7FFFFFFF or 1
    while str(key) in traces:
        key = key % 0x7FFFFFFF + 1
    return key


def _base(entry: Any) -> Drawing:
    """The drawing of an entry as it was traced."""
    drawing = _decoded.get(entry["base"])
    if drawing is None:
        drawing = _decode(entry["drawing"])
        _remember(entry["base"], drawing)
    return drawing


def _differs_in_routing_only(base: Drawing, drawing: Drawing) -> bool:
    """Was the drawing made from that one by rerouting and locking? Then all else is shared."""
    return (
        base.graph is drawing.graph
        and base.routing.alternatives is drawing.routing.alternatives
        and base.fills is drawing.fills
    )


def _routing_of(drawing: Drawing) -> bytes:
    """What rerouting and locking change: partners as int32, then locks as bits, compressed."""
    routing = drawing.routing
    partner = routing.partner.astype("<i4").tobytes()
    return zlib.compress(partner + np.packbits(routing.locked).tobytes(), 3)


def _with_routing(base: Drawing, routing: bytes) -> Drawing:
    if not routing:
        return base
    raw, halves = zlib.decompress(routing), len(base.routing.partner)
    partner = np.frombuffer(raw, "<i4", halves).astype(np.int32)
    bits = np.unpackbits(np.frombuffer(raw, np.uint8, offset=4 * halves))
    return base.with_routing(partner, bits[: len(base.routing.locked)].astype(bool))


def _hash(content: bytes) -> str:
    return blake2b(content, digest_size=16).hexdigest()


def _remember(stamp: str, drawing: Drawing) -> None:
    _decoded[stamp] = drawing
    _decoded.move_to_end(stamp)
    while len(_decoded) > _MAX_DECODED:
        _decoded.popitem(last=False)


def _encode(drawing: Drawing) -> bytes:
    from ...engine.formats import drawing_json

    return zlib.compress(drawing_json.dumps(drawing).encode("utf-8"), 3)


def _decode(blob: bytes) -> Drawing:
    from ...engine.formats import drawing_json

    return drawing_json.read(zlib.decompress(blob).decode("utf-8"))
