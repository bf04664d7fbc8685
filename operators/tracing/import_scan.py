"""Choose scans in the file browser, or drop them on the viewport, and trace them."""

from __future__ import annotations

from pathlib import Path

import bpy

from ..language import message
from .file_choice import FileChoice
from .placing import placing_values
from .trace import INVOLUTE_OT_trace, target_property
from .trace_settings import PlacingOptions, TraceOptions, as_values, take_from_sidebar


class INVOLUTE_OT_import_scan(FileChoice, PlacingOptions, TraceOptions, bpy.types.Operator):
    """Trace scanned drawings from files as Grease Pencil strokes"""

    bl_idname = "involute.import_scan"
    bl_label = "Trace Scanned Drawings"

    target: target_property()

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for files, unless they were dropped."""
        take_from_sidebar(self, context)
        if self.filepath or self.files:  # dropped
            return self.execute(context)
        return super().invoke(context, event)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Hand the chosen files to the trace."""
        if not self.names and (not self.filepath or Path(self.filepath).is_dir()):
            self.report({"ERROR"}, message("Choose one picture file or several."))
            return {"CANCELLED"}
        return self.hand_to(
            bpy.ops.involute.trace,
            filepath=self.filepath,
            directory=self.directory,
            files=[{"name": name} for name in self.names],
            target=self.target,
            **placing_values(self),
            **as_values(self),
        )

    def draw(self, context: bpy.types.Context) -> None:
        """The settings in the file browser."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        self.layout.prop(self, "target")
        INVOLUTE_OT_trace.draw(self, context)


CLASSES = (INVOLUTE_OT_import_scan,)
