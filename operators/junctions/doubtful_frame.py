"""Go to a keyframe of a sequence that has doubtful junctions: the next one, or a certain one."""

from __future__ import annotations

import bpy
from bpy.props import EnumProperty, IntProperty

from ..grease_pencil import state
from ..language import message
from ..view.view_state import shown_in
from .junction_operator import JunctionOperator


class INVOLUTE_OT_doubtful_frame(JunctionOperator, bpy.types.Operator):
    """Go to the next or previous keyframe that has doubtful junctions"""

    bl_idname = "involute.doubtful_frame"
    bl_label = "Next or Previous Doubtful Keyframe"
    bl_options = {"INTERNAL"}  # looking is nothing to undo

    direction: EnumProperty(
        name="Direction",
        description="Which way along the timeline",
        items=[
            ("NEXT", "Next", "The next doubtful keyframe"),
            ("PREVIOUS", "Previous", "The doubtful keyframe before"),
        ],
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Set the current frame; after the last one comes the first."""
        scene = context.scene
        frames = state.doubtful_frames(shown_in(context).object.data)
        others = [f for f, count in frames.items() if count and f != scene.frame_current]
        if not others:
            self.report({"INFO"}, message("No other keyframe has doubtful junctions."))
            return {"CANCELLED"}
        here = scene.frame_current
        later, earlier = [f for f in others if f > here], [f for f in others if f < here]
        if self.direction == "NEXT":
            chosen = min(later) if later else min(others)
        else:
            chosen = max(earlier) if earlier else max(others)
        scene.frame_set(chosen)
        return {"FINISHED"}


class INVOLUTE_OT_go_to_frame(JunctionOperator, bpy.types.Operator):
    """Go to this keyframe"""

    bl_idname = "involute.go_to_frame"
    bl_label = "Go to Keyframe"
    bl_options = {"INTERNAL"}

    frame: IntProperty(name="Frame", description="Number of the frame")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Set the current frame."""
        context.scene.frame_set(self.frame)
        return {"FINISHED"}


CLASSES = (INVOLUTE_OT_doubtful_frame, INVOLUTE_OT_go_to_frame)
