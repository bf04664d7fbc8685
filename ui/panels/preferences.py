"""The extension's preferences: looks of the overlay, keys, and where the networks are."""

from __future__ import annotations

import bpy
from bpy.props import FloatProperty, FloatVectorProperty, PointerProperty

from ...operators.language import label
from ...operators.tracing.settings_layout import draw_settings
from ...operators.tracing.trace_settings import INVOLUTE_PG_trace_settings
from ..overlay import colors

_PACKAGE = __package__.removesuffix(".ui.panels")

_ONE_OF = "One of the colors that tell strokes apart"
_PALETTE = tuple(f"stroke_color_{number + 1}" for number in range(len(colors.STROKES)))


def _color(name: str, description: str, default: colors.Color) -> object:
    return FloatVectorProperty(
        name=name,
        description=description,
        subtype="COLOR_GAMMA",
        size=3,
        min=0.0,
        max=1.0,
        default=default,
    )


class INVOLUTE_AP_preferences(bpy.types.AddonPreferences):
    """Preferences > Add-ons > Involute."""

    bl_idname = _PACKAGE

    defaults: PointerProperty(
        type=INVOLUTE_PG_trace_settings,
        name="Defaults",
        description="Trace settings that Reset to Defaults brings back",
    )
    color_sure: _color("Certain", "Color of junctions that are certain", colors.SURE)
    color_doubtful: _color("Doubtful", "Color of the most doubtful junctions", colors.DOUBTFUL)
    color_locked: _color("Locked", "Color of junctions that you have fixed", colors.LOCKED)
    ring_size: FloatProperty(
        name="Ring Size",
        description="Radius of a certain junction's ring, in pen widths",
        default=1.0,
        min=0.2,
        max=20.0,
    )

    stroke_width: FloatProperty(
        name="Stroke Width",
        description="Width of a stroke that is shown in a color of its own, in pixels",
        default=2.5,
        min=0.5,
        max=20.0,
    )
    stroke_color_1: _color("Stroke Color 1", _ONE_OF, colors.STROKES[0])
    stroke_color_2: _color("Stroke Color 2", _ONE_OF, colors.STROKES[1])
    stroke_color_3: _color("Stroke Color 3", _ONE_OF, colors.STROKES[2])
    stroke_color_4: _color("Stroke Color 4", _ONE_OF, colors.STROKES[3])
    stroke_color_5: _color("Stroke Color 5", _ONE_OF, colors.STROKES[4])
    stroke_color_6: _color("Stroke Color 6", _ONE_OF, colors.STROKES[5])

    @property
    def stroke_palette(self) -> list[colors.Color]:
        """The colours of strokes, in order."""
        return [tuple(getattr(self, name)) for name in _PALETTE]

    def draw(self, context: bpy.types.Context) -> None:
        """Overlay, default settings, keys, networks."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.label(text="Junction Overlay")
        column = layout.column()
        for name in ("color_sure", "color_doubtful", "color_locked", "ring_size"):
            column.prop(self, name)
        layout.label(text="Stroke Colors")
        column = layout.column()
        for name in ("stroke_width", *_PALETTE):
            column.prop(self, name)
        header, body = layout.panel("involute_defaults", default_closed=True)
        header.label(text="Default Trace Settings")
        if body is not None:
            draw_settings(body, self.defaults)
        self._draw_keys(context)
        self._draw_networks()

    def _draw_keys(self, context: bpy.types.Context) -> None:
        from rna_keymap_ui import draw_kmi

        from ..keymap import items

        box = self.layout.box()
        box.label(text="Keys in the 3D Viewport")
        configuration = context.window_manager.keyconfigs.user
        for keymap, item, name in items(configuration):
            box.label(text=name)
            draw_kmi(["ADDON", "USER", "DEFAULT"], configuration, keymap, item, box, 0)

    def _draw_networks(self) -> None:
        from ...operators.tracing.networks import found_networks

        box = self.layout.box()
        box.label(text="Networks")
        for name, path in found_networks():
            row = box.row()
            row.label(text=name)
            missing = label("not installed: the method without learning is used")
            row.label(text=path or missing, translate=False)


def preferences_of(context: bpy.types.Context) -> INVOLUTE_AP_preferences:
    """The preferences of the user."""
    return context.preferences.addons[_PACKAGE].preferences


CLASSES = (INVOLUTE_AP_preferences,)
