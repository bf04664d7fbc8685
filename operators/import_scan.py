"""Choose scans in the file browser, or drop them on the viewport, and trace them."""

from __future__ import annotations

import bpy
from bpy.props import CollectionProperty, StringProperty
from bpy_extras.io_utils import ImportHelper

from .sources import SUFFIXES
from .trace_settings import TraceSettings, as_values


class INVOLUTE_OT_import_scan(TraceSettings, bpy.types.Operator, ImportHelper):
    """Trace scanned drawings from files as Grease Pencil strokes"""

    bl_idname = "involute.import_scan"
    bl_label = "Trace Scanned Drawings"
    bl_options = {"REGISTER"}  # the trace that it starts is the step to undo

    filename_ext = ""
    filter_glob: StringProperty(
        default=";".join(f"*{suffix}" for suffix in SUFFIXES), options={"HIDDEN"}
    )
    directory: StringProperty(subtype="DIR_PATH", options={"SKIP_SAVE", "HIDDEN"})
    files: CollectionProperty(
        type=bpy.types.OperatorFileListElement, options={"SKIP_SAVE", "HIDDEN"}
    )

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if self.filepath or self.files:  # dropped
            return self.execute(context)
        return super().invoke(context, event)

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            result = bpy.ops.involute.trace(
                "EXEC_DEFAULT" if bpy.app.background else "INVOKE_DEFAULT",
                filepath=self.filepath,
                directory=self.directory,
                files=[{"name": file.name} for file in self.files],
                **as_values(self),
            )
        except RuntimeError as problem:  # what the trace reported
            self.report({"ERROR"}, str(problem).strip().removeprefix("Error: "))
            return {"CANCELLED"}
        return {"CANCELLED"} if result == {"CANCELLED"} else {"FINISHED"}

    def draw(self, context: bpy.types.Context) -> None:
        from .settings_layout import draw_settings

        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        draw_settings(self.layout, self)


CLASSES = (INVOLUTE_OT_import_scan,)
