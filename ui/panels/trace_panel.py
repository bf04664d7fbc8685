"""Sidebar, first panel: settings, the Trace button, progress, and what came out."""

from __future__ import annotations

from textwrap import wrap

import bpy

from ...engine import InvoluteError
from ...operators import job as jobs
from ...operators.language import label, message
from ...operators.pencil.merge_lines import INVOLUTE_OT_merge_lines
from ...operators.pencil.split_line import INVOLUTE_OT_split_line
from ...operators.sequences.playing import plays_frames
from ...operators.sequences.trace_frames import (
    INVOLUTE_OT_import_sequence,
    INVOLUTE_OT_trace_sequence,
)
from ...operators.tracing import part as parts
from ...operators.tracing.background import INVOLUTE_OT_cancel, stage_of
from ...operators.tracing.choose_part import INVOLUTE_OT_choose_part
from ...operators.tracing.import_scan import INVOLUTE_OT_import_scan
from ...operators.tracing.paste import INVOLUTE_OT_paste
from ...operators.tracing.scan_behind import paper_of, scan_of
from ...operators.tracing.settings_layout import draw_placing, draw_settings
from ...operators.tracing.sources import is_image_empty
from ...operators.tracing.trace import INVOLUTE_OT_trace
from ...operators.tracing.trace_again import (
    INVOLUTE_OT_take_settings,
    INVOLUTE_OT_trace_again,
)
from ...operators.tracing.trace_settings import as_values, scene_settings
from ...operators.tracing.try_part import INVOLUTE_OT_drop_part, INVOLUTE_OT_keep_part
from ...operators.tracing.use_defaults import INVOLUTE_OT_use_defaults
from ...operators.view.view_state import Shown, shown_in
from .presets import draw_preset_menu
from .sidebar import Sidebar

_LINE = 34  # letters in a line of the sidebar


class INVOLUTE_PT_trace(Sidebar, bpy.types.Panel):
    """What to trace and how; progress while a trace runs."""

    bl_label = "Trace Drawing"

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        """Reset and presets."""
        self.layout.operator(
            INVOLUTE_OT_use_defaults.bl_idname, text="", icon="LOOP_BACK", emboss=False
        )
        draw_preset_menu(self.layout)

    def draw(self, context: bpy.types.Context) -> None:
        """Buttons, or the progress; and the settings, which *Live* goes on asking for meanwhile."""
        layout, settings = self.layout, scene_settings(context.scene)
        if jobs.current is None or jobs.current.gives_way:
            _what_to_trace(layout.column(), context, settings)
            _part(layout.column(align=True), context)
        else:
            job = jobs.current
            layout.progress(factor=job.fraction, text=stage_of(job), translate=False)
            layout.operator(INVOLUTE_OT_cancel.bl_idname, icon="CANCEL")
        layout.use_property_split = True
        layout.use_property_decorate = False
        draw_settings(layout, settings)
        header, body = layout.panel("involute_placing", default_closed=True)
        header.label(text="Where It Goes")
        if body is not None:
            draw_placing(body, settings)


def _what_to_trace(
    column: bpy.types.UILayout, context: bpy.types.Context, settings: object
) -> None:
    """A button for what is selected, and those that ask for files."""
    column.scale_y = 1.3
    active = context.active_object
    if plays_frames(active):
        said = label("Trace What {name} Plays", name=active.name)
        _button(column, INVOLUTE_OT_trace_sequence, settings, said, "RENDER_ANIMATION")
    elif is_image_empty(active):
        said = label("Trace {name}", name=active.name)
        _button(column, INVOLUTE_OT_trace, settings, said, "GREASEPENCIL")
    row = column.row(align=True)
    _button(row, INVOLUTE_OT_import_scan, settings, "Trace Files...", "FILE_FOLDER")
    row.operator(INVOLUTE_OT_paste.bl_idname, text="", icon="PASTEDOWN")
    said = "Trace Sequence..."
    _button(column, INVOLUTE_OT_import_sequence, settings, said, "RENDER_ANIMATION")


def _part(column: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Trying the settings on a part; always as high, so that nothing moves while it is traced."""
    part = parts.current()
    column.operator(INVOLUTE_OT_choose_part.bl_idname, icon="SELECT_SET", depress=part is not None)
    if part is None:
        return
    row = column.row(align=True)
    if jobs.current is not None:
        row.progress(factor=jobs.current.fraction, text=stage_of(jobs.current), translate=False)
    else:
        row.label(text=_said_of(part), icon="ERROR" if part.problem else "NONE", translate=False)
    row.operator(INVOLUTE_OT_keep_part.bl_idname, text="", icon="GREASEPENCIL")
    row.operator(INVOLUTE_OT_drop_part.bl_idname, text="", icon="X")


def _said_of(part: parts.Part) -> str:
    """What came out, in one line."""
    if part.drawing is None:
        return message(part.problem)
    return label("Part: {count} strokes", count=len(part.drawing.strokes))


class INVOLUTE_PT_summary(Sidebar, bpy.types.Panel):
    """What came out of the trace."""

    bl_label = "Result"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Is there a traced drawing, or one that was?"""
        try:
            return shown_in(context) is not None
        except InvoluteError:
            return True

    def draw(self, context: bpy.types.Context) -> None:
        """Counts in two lines; or why there are no junctions."""
        try:
            shown: Shown = shown_in(context)
        except InvoluteError as problem:
            draw_sentence(self.layout, message(problem), "ERROR")
            return
        if shown.object != context.active_object:
            self.layout.label(text=shown.object.name, icon="GREASEPENCIL", translate=False)
        drawing = shown.trace.drawing
        seconds = sum(drawing.seconds.values())
        column = self.layout.column(align=True)
        drawn = label(
            "{strokes:,} strokes, {solids:,} solids, {seconds:.1f} s",
            strokes=len(drawing.strokes),
            solids=len(drawing.fills),
            seconds=seconds,
        )
        found = label(
            "{junctions:,} junctions, {doubtful:,} doubtful",
            junctions=shown.table.count,
            doubtful=len(drawing.doubtful),
        )
        if drawing.bundles:
            found = label(
                "{junctions:,} junctions, {bundles:,} bundles, {doubtful:,} doubtful",
                junctions=len(drawing.junctions),
                bundles=len(drawing.bundles),
                doubtful=len(drawing.doubtful),
            )
        for text in (drawn, found):
            column.label(text=text, translate=False)
        for icon, sentences in (("ERROR", drawing.warnings), ("INFO", drawing.notes)):
            for sentence in sentences:
                draw_sentence(self.layout, message(sentence), icon)
        column = self.layout.column(align=True)
        row = column.row(align=True)
        row.operator(INVOLUTE_OT_trace_again.bl_idname, icon="FILE_REFRESH")
        row.operator(INVOLUTE_OT_take_settings.bl_idname, text="", icon="EYEDROPPER")
        column.prop(shown.view, "live", toggle=True, icon="PLAY")
        if drawing.pencil is not None:
            column = self.layout.column(align=True)
            column.operator(INVOLUTE_OT_merge_lines.bl_idname, icon="AUTOMERGE_ON")
            column.operator(INVOLUTE_OT_split_line.bl_idname, icon="MOD_EDGESPLIT")
        _behind(self.layout.row(align=True), shown.object)


def _behind(row: bpy.types.UILayout, obj: bpy.types.Object) -> None:
    """How strongly the scan shows; and whether the paper under it does."""
    scan, paper = scan_of(obj), paper_of(obj)
    if scan is not None:
        row.prop(scan, "color", index=3, text="Scan", slider=True)
        row.prop(scan, "hide_viewport", text="")
    if paper is not None:
        row.prop(paper, "hide_viewport", text="" if scan else "Paper", icon="FILE_BLANK")


def draw_sentence(layout: bpy.types.UILayout, sentence: str, icon: str) -> None:
    """A sentence in lines that fit into the sidebar as Blender opens it."""
    column = layout.column(align=True)
    for number, line in enumerate(wrap(sentence, _LINE)):
        column.label(text=line, icon="BLANK1" if number else icon, translate=False)


def _button(
    layout: bpy.types.UILayout, operator: type, settings: object, text: str, icon: str
) -> None:
    """A button that traces with the settings of the sidebar."""
    button = layout.operator(operator.bl_idname, text=text, icon=icon)
    for name, value in as_values(settings).items():
        setattr(button, name, value)


CLASSES = (INVOLUTE_PT_trace, INVOLUTE_PT_summary)
