"""What the panels of our tab in the sidebar share."""

from __future__ import annotations

import bpy

from ...engine import InvoluteError
from ...operators.view.view_state import shown_in


class Sidebar:
    """Mixin: a panel of the tab."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Involute"


class OfDrawing(Sidebar):
    """Mixin: a panel for the drawing that is worked on."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Is there a traced drawing whose junctions can be shown?"""
        try:
            return shown_in(context) is not None
        except InvoluteError:
            return False
