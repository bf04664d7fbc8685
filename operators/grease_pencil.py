"""The only place that reads or writes Grease Pencil data: Drawing <-> layers, frames, strokes.

Every stroke that comes from a trace carries three attributes, so that it can be told after the
artist has worked on it (named with a dot: hidden from the lists in the interface):

    .involute_trace   per stroke   key of the drawing in the data-block (see `state`); 0 = by hand
    .involute_half    per stroke   first half-branch of the stroke in that drawing, counted from 1;
                                   negative for what has no branches (solid blacks)
    .involute_along   per point    length along the stroke as it was traced, in pixels

Blender interpolates the last one when points are added and keeps it when they move, so it still
says which part of the traced line a point belongs to.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import bpy
import numpy as np

from .inks import ink_name
from .placement import Placement

if TYPE_CHECKING:
    from ..engine import Drawing, Stroke

Array = np.ndarray

TRACE, HALF, ALONG = ".involute_trace", ".involute_half", ".involute_along"
FILL_LAYER = "Solids"
POLY, BEZIER = 1, 2
_TYPE_NAMES = {0: "CATMULL_ROM", 1: "POLY", 2: "BEZIER", 3: "NURBS"}

# What foreach_set calls the value, its NumPy type and its length, for each type of attribute.
_FORMATS: dict[str, tuple[str, type, int]] = {
    "FLOAT": ("value", np.float32, 1),
    "INT": ("value", np.int32, 1),
    "INT8": ("value", np.int8, 1),
    "BOOLEAN": ("value", np.bool_, 1),
    "FLOAT_VECTOR": ("vector", np.float32, 3),
    "FLOAT2": ("vector", np.float32, 2),
    "FLOAT_COLOR": ("color", np.float32, 4),
    "BYTE_COLOR": ("color", np.float32, 4),
    "INT32_2D": ("value", np.int32, 2),
    "QUATERNION": ("value", np.float32, 4),
}


@dataclass(frozen=True, eq=False)
class Column:
    """One attribute: Blender's type, and an (N, k) array."""

    type: str
    values: Array


@dataclass(frozen=True, eq=False)
class Curves:
    """Strokes of one Grease Pencil drawing as arrays.

    offsets: (n + 1,) int32; stroke i has the points offsets[i]:offsets[i + 1].
    points, curves: attributes per point and per stroke, by name.
    """

    offsets: Array
    points: dict[str, Column] = field(default_factory=dict)
    curves: dict[str, Column] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.offsets) - 1

    @property
    def sizes(self) -> Array:
        return np.diff(self.offsets)

    def point(self, name: str, default: float = 0.0) -> Array:
        """An attribute of the points, (N,) or (N, k); full of `default` where there is none."""
        return self._get(self.points, name, int(self.offsets[-1]), default)

    def curve(self, name: str, default: float = 0.0) -> Array:
        """The same for the strokes."""
        return self._get(self.curves, name, len(self), default)

    @staticmethod
    def _get(columns: dict[str, Column], name: str, count: int, default: float) -> Array:
        if name not in columns:
            return np.full(count, default)
        values = columns[name].values
        return values[:, 0] if values.shape[1] == 1 else values


# --- data-blocks ---------------------------------------------------------------------------------


def collection() -> bpy.types.bpy_prop_collection:
    """All Grease Pencil data-blocks; Blender 4.5 keeps them apart from the annotations."""
    if hasattr(bpy.data, "grease_pencils_v3"):
        return bpy.data.grease_pencils_v3
    return bpy.data.grease_pencils


def is_grease_pencil(obj: bpy.types.Object | None) -> bool:
    return obj is not None and obj.type == "GREASEPENCIL"


def drawings_at(data: bpy.types.ID, frame: int) -> Iterator[tuple[bpy.types.bpy_struct, object]]:
    """Each layer with the drawing that it shows at a frame, bottom layer first."""
    for layer in data.layers:
        key = layer.get_frame_at(frame)
        if key is not None and key.drawing is not None:
            yield layer, key.drawing


def all_drawings(data: bpy.types.ID) -> Iterator[object]:
    """The drawings of all keyframes of all layers."""
    for layer in data.layers:
        for key in layer.frames:
            if key.drawing is not None:
                yield key.drawing


# --- writing a whole drawing ---------------------------------------------------------------------


def write(data: bpy.types.ID, frame: int, drawing: Drawing, placement: Placement, key: int) -> None:
    """Write a drawing as the keyframe `frame`: a layer per ink, solid blacks on a layer below.

    What these layers showed at that very frame is replaced; other layers stay.
    """
    if drawing.fills:
        _write_fills(_keyframe(data, FILL_LAYER, frame), data, drawing, placement, key)
    inks: dict[tuple[int, int, int], list[Stroke]] = {}
    for stroke in drawing.strokes:
        inks.setdefault(tuple(stroke.color), []).append(stroke)
    names: dict[str, int] = {}
    for color, strokes in sorted(inks.items(), key=lambda item: -len(item[1])):
        name = ink_name(color)
        names[name] = names.get(name, 0) + 1
        layer = name if names[name] == 1 else f"{name} {names[name]}"
        material = _material_slot(data, layer, color, fill=False)
        columns = stroke_curves(strokes, placement, key, material)
        append(_keyframe(data, layer, frame), columns)
    if not inks and not drawing.fills:
        _keyframe(data, ink_name((0, 0, 0)), frame)  # a blank page is a blank keyframe


def stroke_curves(
    strokes: Sequence[Stroke], placement: Placement, key: int, material: int
) -> Curves:
    """The engine's strokes as Grease Pencil attributes."""
    sizes = np.fromiter((len(s.points) for s in strokes), np.int32, len(strokes))
    offsets = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32)
    points = np.concatenate([s.points for s in strokes])
    radius = np.concatenate([s.widths for s in strokes]) * (0.5 * placement.unit)
    halves = np.fromiter(
        (int(s.branches[0]) + 1 if len(s.branches) else -1 for s in strokes), np.int32, len(sizes)
    )
    curved = np.fromiter((s.handles is not None for s in strokes), bool, len(sizes))
    point_columns = {
        "position": _column("FLOAT_VECTOR", placement.to_object(points)),
        "radius": _column("FLOAT", radius),
        "opacity": _column("FLOAT", np.concatenate([s.opacity for s in strokes])),
        ALONG: _column("FLOAT", lengths_along(points, offsets)),
    }
    if curved.any():
        handles = placement.to_object(np.concatenate([_handles(s) for s in strokes]))
        point_columns |= {
            "handle_left": _column("FLOAT_VECTOR", handles[:, 0]),
            "handle_right": _column("FLOAT_VECTOR", handles[:, 1]),
            "handle_type_left": _column("INT8", np.zeros(len(points))),  # free
            "handle_type_right": _column("INT8", np.zeros(len(points))),
        }
    closed = np.fromiter((s.closed for s in strokes), bool, len(sizes))
    curve_columns = {
        "cyclic": _column("BOOLEAN", closed),
        "material_index": _column("INT", np.full(len(sizes), material)),
        "curve_type": _column("INT8", np.where(curved, BEZIER, POLY)),
        TRACE: _column("INT", np.full(len(sizes), key)),
        HALF: _column("INT", halves),
    }
    return Curves(offsets, point_columns, curve_columns)


def lengths_along(points: Array, offsets: Array) -> Array:
    """(N,) float64: length from the start of each polyline to each of its points."""
    if len(points) == 0:
        return np.zeros(0)
    steps = np.zeros(len(points))
    steps[1:] = np.linalg.norm(np.diff(points.astype(np.float64), axis=0), axis=1)
    steps[offsets[:-1]] = 0.0
    total = np.cumsum(steps)
    return total - np.repeat(total[offsets[:-1]], np.diff(offsets))


def append(drawing: object, curves: Curves) -> None:
    """Add strokes to a Grease Pencil drawing, after those that are there."""
    if len(curves) == 0:
        return
    sizes = _strokes_and_points(drawing)
    drawing.add_strokes(curves.sizes.tolist())
    _set_tail(drawing, curves.points, sizes[1], "POINT")
    _set_tail(drawing, curves.curves, sizes[0], "CURVE")
    types = curves.curve("curve_type", POLY).astype(int)
    for kind in np.unique(types[types != POLY]):
        indices = (np.flatnonzero(types == kind) + sizes[0]).tolist()
        drawing.set_types(type=_TYPE_NAMES[int(kind)], indices=indices)
    drawing.tag_positions_changed()


# --- reading and changing ------------------------------------------------------------------------


def read(drawing: object) -> Curves:
    """All strokes of a Grease Pencil drawing, with every attribute that has numbers."""
    count = _strokes_and_points(drawing)[0]
    offsets = np.zeros(count + 1, np.int32)
    if count:
        drawing.curve_offsets.foreach_get("value", offsets)
    columns: dict[str, dict[str, Column]] = {"POINT": {}, "CURVE": {}}
    for attribute in drawing.attributes:
        if attribute.data_type in _FORMATS and attribute.domain in columns:
            size = int(offsets[-1]) if attribute.domain == "POINT" else count
            columns[attribute.domain][attribute.name] = _get(attribute, size)
    return Curves(offsets, columns["POINT"], columns["CURVE"])


def read_column(drawing: object, name: str) -> Array | None:
    """One attribute of the strokes, (n,), or None where there is none."""
    attribute = drawing.attributes.get(name)
    if attribute is None:
        return None
    return _get(attribute, _strokes_and_points(drawing)[0]).values[:, 0]


def set_column(drawing: object, name: str, values: Array) -> None:
    """Overwrite one INT attribute of the strokes."""
    _set_tail(drawing, {name: _column("INT", values)}, 0, "CURVE")


def replace(drawing: object, removed: Sequence[int], added: Curves, slots: Sequence[int]) -> None:
    """Remove some strokes and put others in their places in the drawing order.

    Args:
        removed: indices of strokes to take away.
        added: the new strokes.
        slots: for each new stroke the index (before removal) of the stroke whose place it takes.
    """
    before = _strokes_and_points(drawing)[0]
    append(drawing, added)
    keep = np.setdiff1d(np.arange(before), np.asarray(removed, int))
    if len(removed):
        drawing.remove_strokes(indices=[int(i) for i in sorted(removed)])
    order = np.argsort(np.concatenate([keep, np.asarray(slots, float)]), kind="stable")
    if len(order) and (order != np.arange(len(order))).any():
        drawing.reorder_strokes(new_indices=order.tolist())
    drawing.tag_positions_changed()


# --- details -------------------------------------------------------------------------------------


def _column(kind: str, values: Array) -> Column:
    _, dtype, width = _FORMATS[kind]
    return Column(kind, np.ascontiguousarray(values, dtype).reshape(-1, width))


def _get(attribute: bpy.types.Attribute, size: int) -> Column:
    key, dtype, width = _FORMATS[attribute.data_type]
    values = np.zeros(size * width, dtype)
    if size:
        attribute.data.foreach_get(key, values)
    return Column(attribute.data_type, values.reshape(-1, width))


def _set_tail(drawing: object, columns: dict[str, Column], start: int, domain: str) -> None:
    """Write attributes for the elements from `start` on."""
    for name, column in columns.items():
        if name == "curve_type":  # Blender counts the types: only set_types may change them
            continue
        key = _FORMATS[column.type][0]
        attribute = drawing.attributes.get(name)
        if attribute is None:
            attribute = drawing.attributes.new(name, column.type, domain)
        elif (attribute.data_type, attribute.domain) != (column.type, domain):
            continue  # the artist's own attribute of that name
        values = column.values
        if start:
            values = np.concatenate([_get(attribute, start + len(values)).values[:start], values])
        attribute.data.foreach_set(key, np.ascontiguousarray(values).reshape(-1))


def _strokes_and_points(drawing: object) -> tuple[int, int]:
    count = len(drawing.strokes)
    return count, len(drawing.attributes["position"].data) if count else 0


def _keyframe(data: bpy.types.ID, name: str, frame: int) -> object:
    """The drawing of a layer's keyframe without traced strokes; made when it is missing."""
    layer = data.layers.get(name)
    if layer is None:
        layer = data.layers.new(name, set_active=name != FILL_LAYER)
        layer.use_lights = False
        if name == FILL_LAYER:
            data.layers.move_bottom(layer)
    key = next((k for k in layer.frames if k.frame_number == frame), None)
    drawing = (key or layer.frames.new(frame)).drawing
    traced = read_column(drawing, TRACE)
    if traced is not None and traced.any():
        drawing.remove_strokes(indices=np.flatnonzero(traced).tolist())
    return drawing


def _material_slot(data: bpy.types.ID, name: str, color: Sequence[int], fill: bool) -> int:
    """The slot of the object's material of that name, made when it is missing."""
    for index, material in enumerate(data.materials):
        if material is not None and material.get("involute_ink") == name:
            return index
    material = bpy.data.materials.new(name)
    bpy.data.materials.create_gpencil_data(material)
    material["involute_ink"] = name  # the artist may rename the material
    style = material.grease_pencil
    rgba = (*_linear(color), 1.0)
    style.color, style.fill_color = rgba, rgba
    style.show_stroke, style.show_fill = not fill, fill
    data.materials.append(material)
    return len(data.materials) - 1


def _write_fills(
    drawing: object, data: bpy.types.ID, source: Drawing, placement: Placement, key: int
) -> None:
    outlines = [bridge_holes(rings) for rings in source.fills]
    outlines = [ring for ring in outlines if len(ring) >= 3]
    sizes = np.array([len(ring) for ring in outlines], np.int32)
    offsets = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32)
    material = _material_slot(data, FILL_LAYER, (0, 0, 0), fill=True)
    count, total = len(outlines), int(offsets[-1])
    points = np.concatenate(outlines)
    curves = {
        "cyclic": _column("BOOLEAN", np.ones(count)),
        "material_index": _column("INT", np.full(count, material)),
        TRACE: _column("INT", np.full(count, key)),
        HALF: _column("INT", np.full(count, -1)),
    }
    if bpy.app.version >= (5, 1, 0):  # there the stroke says whether it is filled, not the material
        curves["fill_id"] = _column("INT", np.arange(1, count + 1))
        curves["hide_stroke"] = _column("BOOLEAN", np.ones(count))
    columns = {
        "position": _column("FLOAT_VECTOR", placement.to_object(points)),
        "radius": _column("FLOAT", np.full(total, 0.5 * placement.unit)),
        "opacity": _column("FLOAT", np.ones(total)),
    }
    append(drawing, Curves(offsets, columns, curves))


def bridge_holes(rings: Sequence[Array]) -> Array:
    """One outline that leaves the holes out: each is reached by a bridge walked there and back.

    Args:
        rings: (N, 2) outlines, the outer one first.
    """
    outline = np.asarray(rings[0], np.float32)
    holes = [np.asarray(hole, np.float32) for hole in rings[1:] if len(hole) >= 3]
    while holes:
        bridges = [_shortest_bridge(outline, hole) for hole in holes]
        nearest = int(np.argmin([bridge[0] for bridge in bridges]))
        _, at, start = bridges[nearest]
        hole = np.roll(holes.pop(nearest), -start, axis=0)
        if _area(hole) * _area(outline) > 0:
            hole = np.roll(hole[::-1], 1, axis=0)
        outline = np.concatenate([outline[: at + 1], hole, hole[:1], outline[at:]])
    return outline


def _shortest_bridge(outline: Array, hole: Array) -> tuple[float, int, int]:
    """Distance and the two point numbers; a few dozen points of the hole are enough to try."""
    tried = np.arange(0, len(hole), max(1, len(hole) // 48))
    squares = ((outline[:, None] - hole[None, tried]) ** 2).sum(-1)
    at, column = np.unravel_index(np.argmin(squares), squares.shape)
    return float(squares[at, column]), int(at), int(tried[column])


def _area(ring: Array) -> float:
    x, y = ring.astype(np.float64).T
    return float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2


def _handles(stroke: Stroke) -> Array:
    """(N, 2, 2) handles; a polyline's lie on its points."""
    if stroke.handles is not None:
        return stroke.handles
    return np.repeat(stroke.points[:, None], 2, axis=1)


def _linear(color: Sequence[int]) -> tuple[float, ...]:
    """sRGB 0..255 -> linear, as Blender's materials want it."""
    srgb = np.asarray(color, float) / 255
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    return tuple(float(v) for v in linear)
