"""Where a user looks for it: File > Import, Add > Grease Pencil, image Empties, drag and drop."""

from __future__ import annotations

import bpy

from ...operators.sequences.playing import plays_frames
from ...operators.sequences.trace_frames import (
    INVOLUTE_OT_import_sequence,
    INVOLUTE_OT_trace_sequence,
)
from ...operators.tracing.file_choice import TRACED
from ...operators.tracing.import_scan import INVOLUTE_OT_import_scan
from ...operators.tracing.paste import INVOLUTE_OT_paste
from ...operators.tracing.sources import is_image_empty
from ...operators.tracing.trace import INVOLUTE_OT_trace


class INVOLUTE_FH_scan(bpy.types.FileHandler):
    """Pictures, and SVGs of other programs, dropped on a 3D viewport can be traced."""

    bl_idname = "INVOLUTE_FH_scan"
    bl_label = "Trace as Grease Pencil"
    bl_import_operator = INVOLUTE_OT_import_scan.bl_idname
    bl_file_extensions = ";".join(TRACED)

    @classmethod
    def poll_drop(cls, context: bpy.types.Context) -> bool:
        """Only 3D viewports take pictures."""
        return context.area is not None and context.area.type == "VIEW_3D"


def _in_file_import(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    self.layout.operator(
        INVOLUTE_OT_import_scan.bl_idname, text="Scanned Drawing as Grease Pencil (Involute)"
    )
    self.layout.operator(
        INVOLUTE_OT_import_sequence.bl_idname,
        text="Drawing Sequence as Grease Pencil (Involute)",
    )


def _in_add(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    self.layout.operator(
        INVOLUTE_OT_import_scan.bl_idname, text="Scanned Drawing...", icon="OUTLINER_OB_IMAGE"
    )
    self.layout.operator(
        INVOLUTE_OT_import_sequence.bl_idname, text="Drawing Sequence...", icon="RENDER_ANIMATION"
    )
    self.layout.operator(
        INVOLUTE_OT_paste.bl_idname, text="Drawing from Clipboard", icon="PASTEDOWN"
    )


def _for_image_empty(self: bpy.types.Menu, context: bpy.types.Context) -> None:
    if plays_frames(context.active_object):
        self.layout.separator()
        self.layout.operator(
            INVOLUTE_OT_trace_sequence.bl_idname,
            text="Trace as Keyframes (Involute)",
            icon="GREASEPENCIL",
        )
    elif is_image_empty(context.active_object):
        self.layout.separator()
        self.layout.operator(
            INVOLUTE_OT_trace.bl_idname, text="Trace as Strokes (Involute)", icon="GREASEPENCIL"
        )


_MENUS = (
    ("TOPBAR_MT_file_import", _in_file_import),
    ("VIEW3D_MT_grease_pencil_add", _in_add),
    ("VIEW3D_MT_object_context_menu", _for_image_empty),
    ("VIEW3D_MT_object_convert", _for_image_empty),
)


def register() -> None:
    """Add our entries to the menus of Blender."""
    bpy.utils.register_class(INVOLUTE_FH_scan)
    for name, draw in _MENUS:
        getattr(bpy.types, name).append(draw)


def unregister() -> None:
    """Take them away again."""
    for name, draw in _MENUS:
        getattr(bpy.types, name).remove(draw)
    bpy.utils.unregister_class(INVOLUTE_FH_scan)
