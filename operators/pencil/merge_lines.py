"""Make one line of selected strokes."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ..grease_pencil import cels
from ..grease_pencil.core.crossed import line_on_page
from ..grease_pencil.core.pixel_map import PixelMap
from ..grease_pencil.core.selection import as_selected, selected
from ..grease_pencil.core.stroke_arrays import HALF, POLY, TRACE, Curves, column
from ..grease_pencil.writing import BELOW, PENCIL_LAYER
from ..junctions.junction_operator import JunctionOperator
from ..language import message
from ..view.view_state import redraw, shown_in


@dataclass(frozen=True, eq=False)
class Picked:
    """Selected strokes of one layer."""

    layer: bpy.types.bpy_struct
    cel: object
    curves: Curves
    numbers: np.ndarray


def picked_strokes(data: bpy.types.ID, frame: int) -> list[Picked]:
    """What is selected on the layers that can be seen and changed, but for areas."""
    found = []
    for layer, cel in cels.cels_at(data, frame):
        areas = layer.name in BELOW and layer.name != PENCIL_LAYER
        if areas or layer.hide or cels.is_locked(layer):
            continue
        curves = cels.read(cel)
        found.append(Picked(layer, cel, curves, selected(curves)))
    return found


class INVOLUTE_OT_merge_lines(JunctionOperator, bpy.types.Operator):
    """Make one line of the selected strokes, in the middle of them; pencil strokes stay"""

    bl_idname = "involute.merge_lines"
    bl_label = "Merge to One Line"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Lay one line through the selected strokes, in the place of those that are no pencil."""
        from ...engine.rough.merging import one_line

        shown = shown_in(context)
        data, pixel_map = shown.object.data, shown.pixel_map
        found = picked_strokes(data, shown.frame)
        strokes = [stroke for one in found for stroke in _on_page(one, pixel_map)]
        into = _target(data, found)
        if len(strokes) < 2 or into is None:
            self.report({"ERROR"}, message("Select two or more strokes that are one line."))
            return {"CANCELLED"}
        points, widths, closed = one_line(strokes)
        line = _curves(points, widths, closed, pixel_map, _material(found, into))
        for one in found:
            gone = [] if one.layer.name == PENCIL_LAYER else one.numbers.tolist()
            mine = one is into
            if gone or mine:
                slots = [gone[0] if gone else len(one.curves)] if mine else []
                added = as_selected(line, one.curves) if mine else _nothing()
                cels.replace(one.cel, gone, added, slots)
        redraw(context)
        return {"FINISHED"}


def _on_page(one: Picked, pixel_map: PixelMap) -> list[tuple[np.ndarray, np.ndarray]]:
    """Points and widths of the selected strokes of a layer, px."""
    strokes = []
    for number in one.numbers.tolist():
        points = line_on_page(one.curves, number, pixel_map, 1.0)[0]
        part = slice(*one.curves.offsets[number : number + 2])
        width = 2 * float(np.median(one.curves.point("radius", 0.01)[part])) / pixel_map.unit
        if len(points) > 1:
            strokes.append((points, np.full(len(points), width)))
    return strokes


def _target(data: bpy.types.ID, found: list[Picked]) -> Picked | None:
    """The layer that gets the line: where most lines are selected, or else the active one."""
    active = data.layers.active
    lines = [one for one in found if one.layer.name not in BELOW]
    worth = [(len(one.numbers), one.layer == active, len(one.curves)) for one in lines]
    return lines[worth.index(max(worth))] if lines else None


def _material(found: list[Picked], into: Picked) -> int:
    numbers = into.numbers if len(into.numbers) else np.arange(len(into.curves))
    slots = into.curves.curve("material_index")[numbers]
    return int(slots[0]) if len(slots) else 0


def _curves(
    points: np.ndarray, widths: np.ndarray, closed: bool, pixel_map: PixelMap, material: int
) -> Curves:
    """One stroke by hand: a new trace leaves it as it is."""
    places = points[:-1] if closed else points
    radius = 0.5 * pixel_map.unit * widths[: len(places)]
    return Curves(
        np.array([0, len(places)], np.int32),
        {
            "position": column("FLOAT_VECTOR", pixel_map.to_object(places)),
            "radius": column("FLOAT", radius),
            "opacity": column("FLOAT", np.ones(len(places))),
        },
        {
            "cyclic": column("BOOLEAN", [closed]),
            "material_index": column("INT", [material]),
            "curve_type": column("INT8", [POLY]),
            TRACE: column("INT", [0]),
            HALF: column("INT", [0]),
        },
    )


def _nothing() -> Curves:
    return Curves(np.zeros(1, np.int32))


CLASSES = (INVOLUTE_OT_merge_lines,)
