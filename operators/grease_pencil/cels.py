"""Cels: the strokes that one layer shows at one keyframe, read and changed as arrays.

Blender calls them drawings; here a drawing is what the engine makes of a whole page. What marks a
stroke as traced is explained in `core.stroke_arrays`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import bpy
import numpy as np

from .core.map_fit import Places, Shapes
from .core.stroke_arrays import BEZIER, FORMATS, HALF, POLY, TRACE, WEIGHT, Column, Curves, column
from .vertex_weights import set_weights

Array = np.ndarray

_SIDES = ("left", "right")
_TYPE_NAMES = {0: "CATMULL_ROM", 1: "POLY", 2: "BEZIER", 3: "NURBS"}

# --- data-blocks ---------------------------------------------------------------------------------


def collection() -> bpy.types.bpy_prop_collection:
    """All Grease Pencil data-blocks; Blender 4.5 keeps them apart from the annotations."""
    if hasattr(bpy.data, "grease_pencils_v3"):
        return bpy.data.grease_pencils_v3
    return bpy.data.grease_pencils


def is_grease_pencil(obj: bpy.types.Object | None) -> bool:
    """Is there an object, and is it a Grease Pencil object?"""
    return obj is not None and obj.type == "GREASEPENCIL"


def is_locked(layer: bpy.types.bpy_struct) -> bool:
    """Did the artist lock the layer, or a group that it is in?"""
    group = layer.parent_group
    while group is not None and not group.lock:
        group = group.parent_group
    return layer.lock or group is not None


def cels_at(data: bpy.types.ID, frame: int) -> Iterator[tuple[bpy.types.bpy_struct, object]]:
    """Each layer with the cel that it shows at a frame, bottom layer first."""
    for layer in data.layers:
        key = layer.get_frame_at(frame)
        if key is not None and key.drawing is not None:
            yield layer, key.drawing


def all_cels(data: bpy.types.ID) -> Iterator[object]:
    """The cels of all keyframes of all layers."""
    for layer in data.layers:
        for key in layer.frames:
            if key.drawing is not None:
                yield key.drawing


# --- reading and changing ------------------------------------------------------------------------


def read(cel: object) -> Curves:
    """All strokes of a Grease Pencil drawing, with every attribute that has numbers."""
    count = _strokes_and_points(cel)[0]
    offsets = np.zeros(count + 1, np.int32)
    if count:
        cel.curve_offsets.foreach_get("value", offsets)
    columns: dict[str, dict[str, Column]] = {"POINT": {}, "CURVE": {}}
    for attribute in cel.attributes:
        if attribute.data_type in FORMATS and attribute.domain in columns:
            size = int(offsets[-1]) if attribute.domain == "POINT" else count
            columns[attribute.domain][attribute.name] = _get(attribute, size)
    return Curves(offsets, columns["POINT"], columns["CURVE"])


def read_column(cel: object, name: str) -> Array | None:
    """One INT attribute of the strokes, (n,), or None where there is none of that type."""
    attribute = cel.attributes.get(name)
    if attribute is None or (attribute.data_type, attribute.domain) != ("INT", "CURVE"):
        return None
    return _get(attribute, _strokes_and_points(cel)[0]).values[:, 0]


def read_places(cel: object) -> Places:
    """Where the strokes of a cel lie and what they were traced from."""
    count, total = _strokes_and_points(cel)
    offsets = np.zeros(count + 1, np.int32)
    if count:
        cel.curve_offsets.foreach_get("value", offsets)
    none = np.zeros(count, np.int32)
    keys, halves = (read_column(cel, name) for name in (TRACE, HALF))
    return Places(
        offsets,
        _get(cel.attributes["position"], total).values if total else np.zeros((0, 3)),
        none if keys is None else keys,
        none if halves is None else halves,
    )


def read_shapes(cel: object) -> Shapes:
    """The same with their shapes, for drawing them."""
    places = read_places(cel)
    count, total = len(places.keys), len(places.points)
    cyclic, kinds = (
        _typed(cel, name, kind, "CURVE", count)
        for name, kind in (("cyclic", "BOOLEAN"), ("curve_type", "INT8"))
    )
    curved = kinds.reshape(-1) == BEZIER
    handles = None
    if curved.any():
        both = [_typed(cel, f"handle_{side}", "FLOAT_VECTOR", "POINT", total) for side in _SIDES]
        handles = np.stack(both, axis=1)
    cyclic = cyclic.reshape(-1).astype(bool)
    return Shapes(
        places.offsets, places.points, places.keys, places.halves, cyclic, curved, handles
    )


def set_column(cel: object, name: str, values: Array) -> None:
    """Overwrite one INT attribute of the strokes."""
    _set_tail(cel, {name: column("INT", values)}, 0, "CURVE")


def set_points(cel: object, name: str, values: Column) -> None:
    """Overwrite one attribute of all points."""
    _set_tail(cel, {name: values}, 0, "POINT")


def append(cel: object, curves: Curves) -> None:
    """Add strokes to a Grease Pencil drawing, after those that are there."""
    if len(curves) == 0:
        return
    sizes = _strokes_and_points(cel)
    cel.add_strokes(curves.sizes.tolist())
    _set_tail(cel, curves.points, sizes[1], "POINT")
    _set_tail(cel, curves.curves, sizes[0], "CURVE")
    types = curves.curve("curve_type", POLY).astype(int)
    for kind in np.unique(types[types != POLY]):
        indices = (np.flatnonzero(types == kind) + sizes[0]).tolist()
        cel.set_types(type=_TYPE_NAMES[int(kind)], indices=indices)
    cel.tag_positions_changed()


def replace(cel: object, removed: Sequence[int], added: Curves, slots: Sequence[int]) -> None:
    """Remove some strokes and put others in their places in the drawing order.

    Args:
        removed: indices of strokes to take away.
        added: the new strokes.
        slots: for each new stroke the index (before removal) of the stroke whose place it takes.
    """
    before = _strokes_and_points(cel)[0]
    append(cel, added)
    keep = np.setdiff1d(np.arange(before), np.asarray(removed, int))
    if len(removed):
        cel.remove_strokes(indices=[int(i) for i in sorted(removed)])
    order = np.argsort(np.concatenate([keep, np.asarray(slots, float)]), kind="stable")
    if len(order) and (order != np.arange(len(order))).any():
        cel.reorder_strokes(new_indices=order.tolist())
    cel.tag_positions_changed()


# --- details -------------------------------------------------------------------------------------


def _typed(cel: object, name: str, kind: str, domain: str, size: int) -> Array:
    """(size, k) values of an attribute; zeros where there is none of that type."""
    attribute = cel.attributes.get(name)
    if attribute is None or (attribute.data_type, attribute.domain) != (kind, domain):
        return column(kind, np.zeros(size * FORMATS[kind][2])).values
    return _get(attribute, size).values


def _get(attribute: bpy.types.Attribute, size: int) -> Column:
    key, dtype, width = FORMATS[attribute.data_type]
    values = np.zeros(size * width, dtype)
    if size:
        attribute.data.foreach_get(key, values)
    return Column(attribute.data_type, values.reshape(-1, width))


def _set_tail(cel: object, columns: dict[str, Column], start: int, domain: str) -> None:
    """Write attributes for the elements from `start` on."""
    for name, made in columns.items():
        if name == "curve_type":  # Blender counts the types: only set_types may change them
            continue
        if made.type == WEIGHT:
            set_weights(cel, name, start, made)
            continue
        key = FORMATS[made.type][0]
        attribute = cel.attributes.get(name)
        if attribute is None:
            attribute = cel.attributes.new(name, made.type, domain)
        elif (attribute.data_type, attribute.domain) != (made.type, domain):
            continue  # the artist's own attribute of that name
        values = made.values
        if start:
            values = np.concatenate([_get(attribute, start + len(values)).values[:start], values])
        attribute.data.foreach_set(key, np.ascontiguousarray(values).reshape(-1))


def _strokes_and_points(cel: object) -> tuple[int, int]:
    size = cel.attributes.domain_size
    return size("CURVE"), size("POINT")
