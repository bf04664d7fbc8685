"""Cut strokes anywhere, with a swipe across them."""

from __future__ import annotations

import bpy
import numpy as np

from ...engine import InvoluteError
from ..grease_pencil import cels
from ..grease_pencil.core.crossed import Crossing, crossed, cut_all
from ..language import message
from ..view.on_screen import halves_under, junction_of, places_on_page
from ..view.view_state import Shown, make_current, places_of, shown_in, traced_in
from .junction_operator import JunctionOperator
from .path_gesture import PathGesture, as_items, path_property

_CLICK = 4.0  # px of the screen; what is shorter is no swipe


class INVOLUTE_OT_cut(JunctionOperator, bpy.types.Operator):
    """Cut the strokes that a path crosses there; the cuts are decisions of yours and stay"""

    bl_idname = "involute.cut"
    bl_label = "Cut Strokes"

    path: path_property("Where the cut runs, in pixels of the scan")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Cut whatever the path crosses."""
        shown = shown_in(context)
        places = crossings_of(shown, places_of(self.path))
        if not places:
            self.report({"INFO"}, message("The swipe crosses no stroke."))
            return {"CANCELLED"}
        return self.change(context, lambda drawing: cut_all(drawing, places))


class INVOLUTE_OT_swipe_cut(PathGesture, bpy.types.Operator):
    """Swipe across strokes to cut them there; a click on a line ends it at its junction"""

    bl_idname = "involute.swipe_cut"
    bl_label = "Swipe to Cut"

    def drawn(self, context: bpy.types.Context, places: np.ndarray) -> set[str]:
        """Cut what the swipe crosses; of several drawings, the first that it does."""
        if np.ptp(places, axis=0).max() <= _CLICK * context.preferences.system.ui_scale:
            return self._separate(context, tuple(places[0]))
        for shown in traced_in(context):
            path = places_on_page(context, shown, places)
            try:
                found = crossings_of(shown, path)
            except InvoluteError:
                continue
            if found:
                make_current(context, shown, -1)
                return self.do(bpy.ops.involute.cut, path=as_items(path))
        self.report({"INFO"}, message("The swipe crosses no stroke."))
        return {"CANCELLED"}

    def _separate(self, context: bpy.types.Context, mouse: tuple[float, float]) -> set[str]:
        found = halves_under(context, mouse)
        if found is None:
            return {"CANCELLED"}
        shown, near = found
        half = min(near, key=near.get)
        make_current(context, shown, junction_of(shown, half))
        return self.do(bpy.ops.involute.separate, half=half)


def crossings_of(shown: Shown, path: np.ndarray) -> list[Crossing]:
    """The strokes of a drawing that a path (N, 2), px of the page, crosses."""
    there = [
        cels.read(cel)
        for layer, cel in cels.cels_at(shown.object.data, shown.frame)
        if not layer.hide
    ]
    return crossed(shown.trace.drawing, there, shown.trace.key, shown.pixel_map, path)


CLASSES = (INVOLUTE_OT_cut, INVOLUTE_OT_swipe_cut)
