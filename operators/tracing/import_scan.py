"""Choose scans in the file browser, or drop them on the viewport, and trace them."""

from __future__ import annotations

import bpy

from .file_choice import FileChoice
from .placing import PlacingSettings, placing_values
from .trace import INVOLUTE_OT_trace
from .trace_settings import TraceSettings, as_values


class INVOLUTE_OT_import_scan(FileChoice, PlacingSettings, TraceSettings, bpy.types.Operator):
    """Trace scanned drawings from files as Grease Pencil strokes"""

    bl_idname = "involute.import_scan"
    bl_label = "Trace Scanned Drawings"

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for files, unless they were dropped."""
        if self.filepath or self.files:  # dropped
            return self.execute(context)
        return super().invoke(context, event)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Hand the chosen files to the trace."""
        return self.hand_to(
            bpy.ops.involute.trace,
            filepath=self.filepath,
            directory=self.directory,
            files=[{"name": name} for name in self.names],
            **placing_values(self),
            **as_values(self),
        )

    def draw(self, context: bpy.types.Context) -> None:
        """The settings in the file browser."""
        INVOLUTE_OT_trace.draw(self, context)


CLASSES = (INVOLUTE_OT_import_scan,)
