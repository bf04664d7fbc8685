"""The Junction tool in the toolbar of the 3D viewport, in every mode where it makes sense."""

from __future__ import annotations

import bpy

from ..operators.junctions.accept_inside import INVOLUTE_OT_lasso_accept
from ..operators.junctions.choose import INVOLUTE_OT_choose
from ..operators.junctions.cut import INVOLUTE_OT_swipe_cut
from ..operators.junctions.drag_join import INVOLUTE_OT_drag_join


class _Junctions:
    bl_space_type = "VIEW_3D"
    bl_label = "Junctions"
    bl_description = (
        "Click a junction to choose among its alternatives\n"
        "Drag along a line to let one stroke follow it; from line to line or end to end to join\n"
        "Ctrl-drag or Alt-drag across strokes to cut them\n"
        "Ctrl-click or Alt-click a line to end it at its junction\n"
        "Shift-drag around junctions to accept them; with Ctrl, too, a box"
    )
    bl_icon = "ops.node.add_reroute"
    bl_keymap = (
        (
            INVOLUTE_OT_choose.bl_idname,
            {"type": "LEFTMOUSE", "value": "CLICK"},
            {"properties": [("pick", True)]},
        ),
        (INVOLUTE_OT_drag_join.bl_idname, {"type": "LEFTMOUSE", "value": "CLICK_DRAG"}, None),
        # Some window managers take Alt-click for themselves.
        *(
            (
                INVOLUTE_OT_swipe_cut.bl_idname,
                {"type": "LEFTMOUSE", "value": "PRESS", key: True},
                None,
            )
            for key in ("ctrl", "alt")
        ),
        (
            INVOLUTE_OT_lasso_accept.bl_idname,
            {"type": "LEFTMOUSE", "value": "PRESS", "shift": True},
            None,
        ),
        (
            INVOLUTE_OT_lasso_accept.bl_idname,
            {"type": "LEFTMOUSE", "value": "PRESS", "shift": True, "ctrl": True},
            {"properties": [("box", True)]},
        ),
    )

    @staticmethod
    def draw_settings(context: bpy.types.Context, layout: bpy.types.UILayout, tool: object) -> None:
        """The switch of the overlay in the header."""
        view = context.window_manager.involute_view
        layout.prop(view, "stroke_colors", text="Strokes", icon="COLOR", toggle=True)
        layout.prop(view, "show_overlay", text="Junctions", icon="OVERLAY", toggle=True)


def _tool(mode: str, name: str) -> type:
    attributes = {"bl_context_mode": mode, "bl_idname": f"involute.junctions_{name}"}
    return type(f"INVOLUTE_WT_{name}", (_Junctions, bpy.types.WorkSpaceTool), attributes)


_TOOLS = (
    _tool("OBJECT", "object"),
    _tool("EDIT_GREASE_PENCIL", "edit"),
    _tool("PAINT_GREASE_PENCIL", "draw"),
)


def register() -> None:
    """Add the tool to each mode."""
    for tool in _TOOLS:
        bpy.utils.register_tool(tool, separator=True)


def unregister() -> None:
    """Take it away again."""
    for tool in reversed(_TOOLS):
        bpy.utils.unregister_tool(tool)
