"""Join two half-branches of a junction, whatever they were joined to before, or two loose ends."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
from bpy.props import IntProperty

from ..language import message
from ..view.view_state import shown_in
from .junction_operator import JunctionOperator

if TYPE_CHECKING:
    from ...engine import Drawing


class INVOLUTE_OT_join(JunctionOperator, bpy.types.Operator):
    """Let one of these lines continue in the other; what they continued in before ends here"""

    bl_idname = "involute.join"
    bl_label = "Join Lines"

    first: IntProperty(name="First", description="Number of a half-branch", min=0)
    second: IntProperty(name="Second", description="Number of the other half-branch", min=0)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Join the two; whatever else is joined at the junction stays."""
        drawing = shown_in(context).trace.drawing
        two = {self.first, self.second}
        places = (*drawing.junctions, *drawing.corners)
        junction = next((j for j in places if two <= set(j.half_branches)), None)
        if len(two) == 2 and junction is None and _are_loose(drawing, two):
            return self.change(context, lambda d: d.join(self.first, self.second))
        if junction is None or len(two) != 2:
            said = message("Only two lines that meet at one junction, or two ends, can be joined.")
            self.report({"ERROR"}, said)
            return {"CANCELLED"}
        pairs = [pair for pair in junction.pairs if two.isdisjoint(pair)]
        pairs.append((min(two), max(two)))
        return self.change(context, lambda d: d.reroute(junction.index, pairs))


def _are_loose(drawing: Drawing, halves: set[int]) -> bool:
    """Do the lines begin at ends that hang on nothing?"""
    vertex = drawing.graph.half_vertex
    inside = all(half < len(vertex) for half in halves)
    return inside and all(drawing.graph.degrees[vertex[half]] == 1 for half in halves)


CLASSES = (INVOLUTE_OT_join,)
