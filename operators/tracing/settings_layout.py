"""The settings of a trace in three groups that an artist understands."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...engine.settings import ABOUT
from ...engine.settings import GROUPS as TITLES
from ..language import label

if TYPE_CHECKING:
    import bpy

GROUPS = tuple(
    (title, tuple(name for name, about in ABOUT.items() if about.group == title))
    for title in TITLES
)


def draw_settings(layout: bpy.types.UILayout, source: object) -> None:
    """Draw the properties of a `TraceSettings`."""
    for number, (title, names) in enumerate(GROUPS):
        header, body = layout.panel(f"involute_settings_{number}", default_closed=True)
        header.label(text=title)
        if body is not None:
            column = body.column()
            for name in names:
                if ABOUT[name].kind is tuple:
                    _flags(column, source, name)
                else:
                    column.prop(source, name)


def draw_sequence(layout: bpy.types.UILayout, source: object) -> None:
    """Draw the properties of a `SequenceSettings`."""
    column = layout.column()
    row = column.row(heading="Start At")
    row.prop(source, "own_start", text="")
    field = row.row()
    field.active = source.own_start
    field.prop(source, "start", text="")
    for name in ("step", "align", "follow", "jobs"):
        column.prop(source, name)


def draw_placing(layout: bpy.types.UILayout, source: object) -> None:
    """Draw the properties of a `PlacingSettings`."""
    column = layout.column()
    column.prop(source, "place")
    field = column.row()
    field.active = source.place != "CAMERA"
    field.prop(source, "pixels_per_metre")
    column.prop(source, "order")
    column.prop(source, "show_scan")


def _flags(layout: bpy.types.UILayout, source: object, name: str) -> None:
    """A choice of several, folded into a menu that says what is chosen."""
    split = layout.split(factor=0.4)
    split.alignment = "RIGHT"
    split.label(text=source.bl_rna.properties[name].name)
    chosen = ", ".join(sorted(label(value.title()) for value in getattr(source, name)))
    split.prop_menu_enum(source, name, text=chosen or "None")
