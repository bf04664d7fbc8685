"""A whole drawing -> layers, keyframes and materials of a Grease Pencil data-block."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import bpy
import numpy as np

from ...engine.ink.ink_names import ink_name
from ...engine.strokes.small_parts import layers_of
from . import cels
from .core.pixel_map import PixelMap
from .core.stroke_arrays import HALF, LINE, TRACE, Curves, bridge_holes, column, stroke_curves

if TYPE_CHECKING:
    from ...engine import Drawing

Array = np.ndarray

FILL_LAYER = "Solids"
REGION_LAYER = "Regions"
PENCIL_LAYER = "Pencil"
BELOW = (PENCIL_LAYER, FILL_LAYER, REGION_LAYER)  # the last lies lowest
_DIMMED = 0.3  # opacity of the layer of pencil strokes
_NOT_RENDERED = "(not rendered)"  # a view layer that nobody has
_FILLS_BY_STROKE = (5, 1, 0)  # since then strokes say whether they are filled, not materials


class Into(NamedTuple):
    """A layer by its name, and the number of a material slot; None = a material per ink."""

    layer: str
    material: int | None


def write(
    data: bpy.types.ID,
    frame: int,
    drawing: Drawing,
    pixel_map: PixelMap,
    key: int,
    *,
    alone: bool = False,
    clear: bool = True,
    into: Into | None = None,
) -> None:
    """Write a drawing as the keyframe `frame`: a layer per ink, solid blacks on a layer below,
    the pencil strokes of a rough drawing on another one.

    What was traced onto these layers at that very frame is replaced; other layers stay.

    Args:
        alone: for a sequence: end what other layers still show of traces at earlier frames.
        clear: else all that is there stays.
        into: one layer for the strokes of all inks, with one material.
    """
    written: set[str] = set()
    if drawing.fills:
        written.add(FILL_LAYER)
        fills = _keyframe(data, FILL_LAYER, frame, clear), data, drawing.fills
        _write_fills(*fills, FILL_LAYER, (0, 0, 0), pixel_map, key)
    if drawing.settings.regions and drawing.regions:
        written.add(REGION_LAYER)
        fills = _keyframe(data, REGION_LAYER, frame, clear), data, drawing.regions
        white = (255, 255, 255)
        _write_fills(*fills, REGION_LAYER, white, pixel_map, key, drawing.region_colors)
    if drawing.pencil and drawing.pencil.strokes:
        written.add(PENCIL_LAYER)
        _write_pencil(data, frame, drawing, pixel_map, key, clear)
    inks = layers_of(drawing)
    for ink in inks:
        layer = into.layer if into else ink.name
        written.add(layer)
        material = into.material if into else None
        if material is None:
            material = _material_slot(data, ink.name, ink.color, fill=False)
        strokes = [drawing.strokes[number] for number in ink.numbers]
        columns = stroke_curves(strokes, pixel_map, key, material)
        cels.append(_keyframe(data, layer, frame, clear and not into), columns)
    if not inks and not drawing.fills:
        blank = into.layer if into else ink_name((0, 0, 0))
        _keyframe(data, blank, frame, clear and not into)  # a blank page is a blank keyframe
    if alone:
        for layer in [layer for layer, cel in cels.cels_at(data, frame) if _has_traces(cel)]:
            if layer.name not in written:
                _keyframe(data, layer.name, frame)


def _keyframe(data: bpy.types.ID, name: str, frame: int, clear: bool = True) -> object:
    """The cel of a layer's keyframe, if asked without traced strokes; made when it is missing."""
    layer = data.layers.get(name)
    if layer is None:
        layer = data.layers.new(name, set_active=name not in BELOW)
        layer.use_lights = False
        if name in BELOW:
            for below in BELOW:
                if below in data.layers:
                    data.layers.move_bottom(data.layers[below])
    key = next((k for k in layer.frames if k.frame_number == frame), None)
    cel = (key or layer.frames.new(frame)).drawing
    if clear and _has_traces(cel):
        traced = cels.read_column(cel, TRACE)
        cel.remove_strokes(indices=np.flatnonzero(traced).tolist())
    return cel


def _write_pencil(
    data: bpy.types.ID, frame: int, drawing: Drawing, pixel_map: PixelMap, key: int, clear: bool
) -> None:
    """Write the pencil strokes of a rough drawing, dimmed, on a layer that is not rendered.

    Each says in an attribute which line it is a part of, by a half-branch of it.
    """
    assert drawing.pencil is not None
    is_new = PENCIL_LAYER not in data.layers
    cel = _keyframe(data, PENCIL_LAYER, frame, clear)
    if is_new:
        layer = data.layers[PENCIL_LAYER]
        layer.opacity, layer.viewlayer_render = _DIMMED, _NOT_RENDERED
    material = _material_slot(data, PENCIL_LAYER, (0, 0, 0), fill=False)
    curves = stroke_curves(drawing.pencil.strokes, pixel_map, key, material)
    curves.curves[LINE] = column("INT", drawing.line_of_pencil)
    cels.append(cel, curves)


def _has_traces(cel: object) -> bool:
    traced = cels.read_column(cel, TRACE)
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
    cel: object,
    data: bpy.types.ID,
    fills: Sequence[Sequence[Array]],
    name: str,
    color: tuple[int, int, int],
    pixel_map: PixelMap,
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
        "position": column("FLOAT_VECTOR", pixel_map.to_object(points)),
        "radius": column("FLOAT", np.full(total, 0.5 * pixel_map.unit)),
        "opacity": column("FLOAT", np.ones(total)),
    }
    cels.append(cel, Curves(offsets, columns, curves))


def _linear(color: Sequence[int]) -> tuple[float, ...]:
    """sRGB 0..255 -> linear, as Blender's materials want it."""
    srgb = np.asarray(color, float) / 255
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    return tuple(float(v) for v in linear)
