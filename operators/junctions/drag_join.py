"""Drag along a line to route it, to another one or from end to end to join them."""

from __future__ import annotations

import bpy
import numpy as np

from ..language import message
from ..view.following import followed
from ..view.on_screen import (
    end_under,
    halves_under,
    junction_of,
    line_under,
    places_on_page,
    radius_on_page,
)
from ..view.picking import nearest_pair
from ..view.view_state import make_current
from .path_gesture import PathGesture, as_items


class INVOLUTE_OT_drag_join(PathGesture, bpy.types.Operator):
    """Drag along a line to let one stroke follow it, from line to line or end to end to join"""

    bl_idname = "involute.drag_join"
    bl_label = "Drag to Join"

    def begins_at(self, context: bpy.types.Context, mouse: tuple[float, float]) -> bool:
        """Only a drag that begins at a line is ours."""
        found = halves_under(context, mouse)
        if found is None:
            self._first = {}
            return line_under(context, mouse) is not None or end_under(context, mouse) is not None
        shown, self._first = found
        make_current(context, shown, junction_of(shown, min(self._first, key=self._first.get)))
        return True

    def drawn(self, context: bpy.types.Context, places: np.ndarray) -> set[str]:
        """A path along lines routes; else its two ends say what is joined."""
        shown = line_under(context, tuple(places[0]))
        if shown is not None:
            make_current(context, shown, -1)
            line = places_on_page(context, shown, places)
            radius = radius_on_page(context, shown, places)
            if len(followed(shown.trace.drawing.graph, line, radius)) >= 2:
                path = as_items(line)
                return self.do(bpy.ops.involute.route_along, path=path, radius=radius)
        ends = [end_under(context, tuple(place)) for place in (places[0], places[-1])]
        if all(ends) and ends[0][1] != ends[1][1] and ends[0][0].object == ends[1][0].object:
            make_current(context, ends[0][0], -1)
            pair = ends[0][1], ends[1][1]
            return self.do(bpy.ops.involute.join, first=pair[0], second=pair[1])
        return self._join_near(context, tuple(places[-1]))

    def _join_near(self, context: bpy.types.Context, mouse: tuple[float, float]) -> set[str]:
        found = halves_under(context, mouse)
        vertex = found[0].trace.drawing.graph.half_vertex if found else None
        pair = nearest_pair(self._first, found[1], vertex) if found else None
        if pair is None:
            said = message(
                "Drag along a line, from one line to another that meets it at a junction, or from "
                "one end to another."
            )
            self.report({"INFO"}, said)
            return {"CANCELLED"}
        make_current(context, found[0], junction_of(found[0], pair[0]))
        return self.do(bpy.ops.involute.join, first=pair[0], second=pair[1])


CLASSES = (INVOLUTE_OT_drag_join,)
