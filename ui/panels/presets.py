"""Presets of the trace settings, kept like Blender's own."""

from __future__ import annotations

import bpy
from bl_operators.presets import AddPresetBase
from bl_ui.utils import PresetPanel

from ...operators.tracing.trace_settings import NAMES
from ...operators.tracing.use_preset import PRESETS, INVOLUTE_OT_use_preset


class INVOLUTE_OT_add_preset(AddPresetBase, bpy.types.Operator):
    """Add or remove a preset of the trace settings"""

    bl_idname = "involute.add_preset"
    bl_label = "Trace Preset"
    preset_menu = "INVOLUTE_PT_presets"
    preset_subdir = "involute/trace"
    preset_defines = ("settings = bpy.context.scene.involute",)
    preset_values = tuple(f"settings.{name}" for name in NAMES)


class INVOLUTE_PT_presets(PresetPanel, bpy.types.Panel):
    """The popover that lists the presets."""

    bl_label = "Trace Presets"
    preset_subdir = INVOLUTE_OT_add_preset.preset_subdir
    preset_operator = "script.execute_preset"
    preset_add_operator = INVOLUTE_OT_add_preset.bl_idname

    def draw(self, context: bpy.types.Context) -> None:
        """The shipped ones, then the user's; Blender calls a missing folder a missing path."""
        column = self.layout.column(align=True)
        for key, (name, _, _) in PRESETS.items():
            column.operator(INVOLUTE_OT_use_preset.bl_idname, text=name).preset = key
        self.layout.separator()
        bpy.utils.user_resource("SCRIPTS", path=f"presets/{self.preset_subdir}", create=True)
        super().draw(context)


def draw_preset_menu(layout: bpy.types.UILayout) -> None:
    """The button of the popover, for the header of a panel."""
    INVOLUTE_PT_presets.draw_panel_header(layout)


CLASSES = (INVOLUTE_OT_add_preset, INVOLUTE_PT_presets)
