"""Put the pencil strokes of a line in its place."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..grease_pencil import cels
from ..grease_pencil.core.selection import as_selected
from ..grease_pencil.core.stroke_arrays import (
    HALF,
    TRACE,
    Curves,
    column,
    concatenate,
    stroke_curves,
)
from ..grease_pencil.writing import PENCIL_LAYER
from ..junctions.junction_operator import JunctionOperator
from ..language import message
from ..view.view_state import Shown, redraw, shown_in
from .merge_lines import Picked, picked_strokes

if TYPE_CHECKING:
    from ...engine import Drawing


class INVOLUTE_OT_split_line(JunctionOperator, bpy.types.Operator):
    """Put the pencil strokes that say a line in its place, for all selected lines"""

    bl_idname = "involute.split_line"
    bl_label = "Split into Pencil Strokes"

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Draw the pencil strokes of the selected lines instead of them."""
        shown = shown_in(context)
        count = sum(
            _split(one, shown)
            for one in picked_strokes(shown.object.data, shown.frame)
            if one.layer.name != PENCIL_LAYER
        )
        if not count:
            self.report({"ERROR"}, message("Select lines that were made of pencil strokes."))
            return {"CANCELLED"}
        redraw(context)
        return {"FINISHED"}


def _split(one: Picked, shown: Shown) -> int:
    """How many lines of a layer were split."""
    drawing = shown.trace.drawing
    if drawing.pencil is None:
        return 0
    traced = one.curves.mark(TRACE) == shown.trace.key
    halves = np.where(traced, one.curves.mark(HALF), 0)
    gone, added, slots = [], [], []
    for number in one.numbers[halves[one.numbers] > 0].tolist():
        strokes = [drawing.pencil.strokes[k] for k in _pencil_of(drawing, int(halves[number]) - 1)]
        if strokes:
            material = int(one.curves.curve("material_index")[number])
            gone.append(number)
            added.append(_by_hand(stroke_curves(strokes, shown.pixel_map, 0, material)))
            slots += [number] * len(strokes)
    if gone:
        cels.replace(one.cel, gone, as_selected(concatenate(added), one.curves), slots)
    return len(gone)


def _pencil_of(drawing: Drawing, half: int) -> tuple[int, ...]:
    """The pencil strokes of the stroke with a half-branch; none where there is no such stroke."""
    for number, stroke in enumerate(drawing.strokes):
        if half >> 1 in (stroke.branches >> 1).tolist():
            return drawing.pencil_of(number)
    return ()


def _by_hand(curves: Curves) -> Curves:
    """Strokes that a new trace leaves as they are."""
    curves.curves[HALF] = column("INT", np.zeros(len(curves)))
    return curves


CLASSES = (INVOLUTE_OT_split_line,)
