"""The settings of a trace in three groups that an artist understands."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import bpy

GROUPS = (
    ("What the Drawing Is", ("polarity", "pen_width", "inks", "ignore_inks", "solids", "marks")),
    ("How Clean", ("min_length", "smoothing", "provider", "router", "device")),
    ("How Many Points", ("curve", "tolerance")),
)


def draw_settings(layout: bpy.types.UILayout, source: object) -> None:
    """Draw the properties of a `TraceSettings`."""
    for title, names in GROUPS:
        header, body = layout.panel(f"involute_{names[0]}", default_closed=False)
        header.label(text=title)
        if body is not None:
            column = body.column()
            for name in names:
                column.prop(source, name)
