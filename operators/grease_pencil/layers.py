"""The only place that reads or writes Grease Pencil data: Drawing <-> layers, frames, strokes.

What marks a stroke as traced is explained in `curves`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...engine.ink.ink_names import ink_name
from .placement import Placement
from .stroke_arrays import (
    FORMATS,
    HALF,
    POLY,
    TRACE,
    WEIGHT,
    Column,
    Curves,
    bridge_holes,
    column,
    stroke_curves,
)
from .vertex_weights import set_weights

if TYPE_CHECKING:
    from ...engine import Drawing, Stroke

Array = np.ndarray

FILL_LAYER = "Solids"
REGION_LAYER = "Regions"
_BELOW = (FILL_LAYER, REGION_LAYER)  # the last lies lowest
_FILLS_BY_STROKE = (5, 1, 0)  # since then strokes say whether they are filled, not materials
_TYPE_NAMES = {0: "CATMULL_ROM", 1: "POLY", 2: "BEZIER", 3: "NURBS"}

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


def write(
    data: bpy.types.ID,
    frame: int,
    drawing: Drawing,
    placement: Placement,
    key: int,
    *,
    alone: bool = False,
) -> None:
    """Write a drawing as the keyframe `frame`: a layer per ink, solid blacks on a layer below.

    What these layers showed at that very frame is replaced; other layers stay.

    Args:
        alone: for a sequence: end what other layers still show of traces at earlier frames.
    """
    written: set[str] = set()
    if drawing.fills:
        written.add(FILL_LAYER)
        fills = _keyframe(data, FILL_LAYER, frame), data, drawing.fills
        _write_fills(*fills, FILL_LAYER, (0, 0, 0), placement, key)
    if drawing.settings.regions and drawing.regions:
        written.add(REGION_LAYER)
        fills = _keyframe(data, REGION_LAYER, frame), data, drawing.regions
        white = (255, 255, 255)
        _write_fills(*fills, REGION_LAYER, white, placement, key, drawing.region_colors)
    inks: dict[tuple[int, int, int], list[Stroke]] = {}
    for stroke in drawing.strokes:
        inks.setdefault(tuple(stroke.color), []).append(stroke)
    names: dict[str, int] = {}
    for color, strokes in sorted(inks.items(), key=lambda item: -len(item[1])):
        name = ink_name(color)
        names[name] = names.get(name, 0) + 1
        layer = name if names[name] == 1 else f"{name} {names[name]}"
        written.add(layer)
        material = _material_slot(data, layer, color, fill=False)
        columns = stroke_curves(strokes, placement, key, material)
        append(_keyframe(data, layer, frame), columns)
    if not inks and not drawing.fills:
        _keyframe(data, ink_name((0, 0, 0)), frame)  # a blank page is a blank keyframe
    if alone:
        for layer in [layer for layer, held in drawings_at(data, frame) if _has_traces(held)]:
            if layer.name not in written:
                _keyframe(data, layer.name, frame)


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
        if attribute.data_type in FORMATS and attribute.domain in columns:
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
    _set_tail(drawing, {name: column("INT", values)}, 0, "CURVE")


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


def _get(attribute: bpy.types.Attribute, size: int) -> Column:
    key, dtype, width = FORMATS[attribute.data_type]
    values = np.zeros(size * width, dtype)
    if size:
        attribute.data.foreach_get(key, values)
    return Column(attribute.data_type, values.reshape(-1, width))


def _set_tail(drawing: object, columns: dict[str, Column], start: int, domain: str) -> None:
    """Write attributes for the elements from `start` on."""
    for name, made in columns.items():
        if name == "curve_type":  # Blender counts the types: only set_types may change them
            continue
        if made.type == WEIGHT:
            set_weights(drawing, name, start, made)
            continue
        key = FORMATS[made.type][0]
        attribute = drawing.attributes.get(name)
        if attribute is None:
            attribute = drawing.attributes.new(name, made.type, domain)
        elif (attribute.data_type, attribute.domain) != (made.type, domain):
            continue  # the artist's own attribute of that name
        values = made.values
        if start:
            values = np.concatenate([_get(attribute, start + len(values)).values[:start], values])
        attribute.data.foreach_set(key, np.ascontiguousarray(values).reshape(-1))


def _strokes_and_points(drawing: object) -> tuple[int, int]:
    size = drawing.attributes.domain_size
    return size("CURVE"), size("POINT")


def _keyframe(data: bpy.types.ID, name: str, frame: int) -> object:
    """The drawing of a layer's keyframe without traced strokes; made when it is missing."""
    layer = data.layers.get(name)
    if layer is None:
        layer = data.layers.new(name, set_active=name not in _BELOW)
        layer.use_lights = False
        if name in _BELOW:
            for below in _BELOW:
                if below in data.layers:
                    data.layers.move_bottom(data.layers[below])
    key = next((k for k in layer.frames if k.frame_number == frame), None)
    drawing = (key or layer.frames.new(frame)).drawing
    if _has_traces(drawing):
        traced = read_column(drawing, TRACE)
        drawing.remove_strokes(indices=np.flatnonzero(traced).tolist())
    return drawing


def _has_traces(drawing: object) -> bool:
    traced = read_column(drawing, TRACE)
    return traced is not None and bool(traced.any())


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
    if bpy.app.version < _FILLS_BY_STROKE:
        style.show_stroke, style.show_fill = not fill, fill
    data.materials.append(material)
    return len(data.materials) - 1


def _write_fills(
    drawing: object,
    data: bpy.types.ID,
    fills: Sequence[Sequence[Array]],
    name: str,
    color: tuple[int, int, int],
    placement: Placement,
    key: int,
    own_colors: Array | None = None,
) -> None:
    """Write areas, each the rings of its outline and holes, as filled strokes without a line.

    Args:
        own_colors: (n, 3) sRGB 0..255 of each area instead of the material's.
    """
    outlines = [bridge_holes(rings) for rings in fills]
    shown = [len(ring) >= 3 for ring in outlines]
    outlines = [ring for ring, is_area in zip(outlines, shown, strict=True) if is_area]
    sizes = np.array([len(ring) for ring in outlines], np.int32)
    offsets = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32)
    material = _material_slot(data, name, color, fill=True)
    count, total = len(outlines), int(offsets[-1])
    points = np.concatenate(outlines)
    curves = {
        "cyclic": column("BOOLEAN", np.ones(count)),
        "material_index": column("INT", np.full(count, material)),
        TRACE: column("INT", np.full(count, key)),
        HALF: column("INT", np.full(count, -1)),
    }
    if own_colors is not None:
        # Bare paper stays the material's, so that the artist can recolour it at one place.
        colors = [(*_linear(own), float(min(own) < 255)) for own in own_colors[shown]]
        curves["fill_color"] = column("FLOAT_COLOR", np.array(colors).reshape(-1, 4))
    if bpy.app.version >= _FILLS_BY_STROKE:
        curves["fill_id"] = column("INT", np.arange(1, count + 1))
        curves["hide_stroke"] = column("BOOLEAN", np.ones(count))
    columns = {
        "position": column("FLOAT_VECTOR", placement.to_object(points)),
        "radius": column("FLOAT", np.full(total, 0.5 * placement.unit)),
        "opacity": column("FLOAT", np.ones(total)),
    }
    append(drawing, Curves(offsets, columns, curves))


def _linear(color: Sequence[int]) -> tuple[float, ...]:
    """sRGB 0..255 -> linear, as Blender's materials want it."""
    srgb = np.asarray(color, float) / 255
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    return tuple(float(v) for v in linear)
