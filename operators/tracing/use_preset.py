"""Settings for a kind of drawing at one click; the user's own presets are files of Blender's."""

from __future__ import annotations

from typing import Any

import bpy
from bpy.props import EnumProperty

from ...engine.settings import DEFAULTS
from .trace_settings import NAMES, scene_settings

# What differs from the defaults, which suit a scanned ink drawing.
PRESETS: dict[str, tuple[str, str, dict[str, Any]]] = {
    "INK": ("Ink", "Pen drawings on paper; the defaults", {}),
    "PENCIL": (
        "Pencil",
        "Soft lines of changing darkness, crumbs left out; no solid blacks",
        {"solids": False, "smoothing": 0.4, "min_length": 2.0},
    ),
    "BRUSH": (
        "Brush and Marker",
        "Broad, swelling lines in few points, thick places not taken for solids",
        {"solids": False, "smoothing": 0.5, "tolerance": 1.0},
    ),
    "BLUEPRINT": (
        "Blueprint",
        "Light lines on dark paper, all in one ink, corners kept sharp",
        {"polarity": "light", "inks": False, "solids": False, "smoothing": 0.1},
    ),
    "ANIMATION": (
        "Binarised Animation Lines",
        "Hard black and colored lines without grey, closed regions filled",
        {"solids": False, "marks": False, "regions": True, "smoothing": 0.4},
    ),
    "COMIC": (
        "Comic Page",
        "Ink with solid blacks, all in one ink, specks of the print left out",
        {"inks": False, "min_length": 2.0},
    ),
}


class INVOLUTE_OT_use_preset(bpy.types.Operator):
    """Set all trace settings to what suits a kind of drawing"""

    bl_idname = "involute.use_preset"
    bl_label = "Use Preset"
    bl_options = {"REGISTER", "UNDO"}

    preset: EnumProperty(
        name="Preset",
        description="What kind of drawing it is",
        items=[(key, name, tip) for key, (name, tip, _) in PRESETS.items()],
    )

    @classmethod
    def description(
        cls, context: bpy.types.Context, properties: bpy.types.OperatorProperties
    ) -> str:
        """The tip of the preset that the button stands for."""
        return bpy.app.translations.pgettext_tip(PRESETS[properties.preset][1])

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Change the sidebar's settings, all of them, so that nothing of before is left."""
        settings, wanted = scene_settings(context.scene), PRESETS[self.preset][2]
        for name in NAMES:
            value = wanted.get(name, DEFAULTS[name])
            setattr(settings, name, set(value) if isinstance(value, tuple) else value)
        return {"FINISHED"}


CLASSES = (INVOLUTE_OT_use_preset,)
