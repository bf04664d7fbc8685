"""Sidebar, junctions: the list, the current junction in words, its alternatives, what to do."""

from __future__ import annotations

import bpy
import numpy as np

from ...operators.grease_pencil import state
from ...operators.junctions.accept import INVOLUTE_OT_accept
from ...operators.junctions.ask_again import INVOLUTE_OT_ask_again
from ...operators.junctions.choose import INVOLUTE_OT_choose
from ...operators.junctions.doubtful_frame import (
    INVOLUTE_OT_doubtful_frame,
    INVOLUTE_OT_go_to_frame,
)
from ...operators.junctions.go_to_junction import (
    INVOLUTE_OT_go_to_junction,
    INVOLUTE_OT_step_junction,
)
from ...operators.junctions.join import INVOLUTE_OT_join
from ...operators.junctions.lock import INVOLUTE_OT_lock
from ...operators.junctions.preview import INVOLUTE_OT_preview
from ...operators.junctions.reroute import INVOLUTE_OT_reroute
from ...operators.junctions.review import INVOLUTE_OT_review
from ...operators.junctions.separate import INVOLUTE_OT_separate
from ...operators.language import label
from ...operators.view.junction_words import angle, arrow, in_words, letters, percent
from ...operators.view.picking import is_bundle
from ...operators.view.view_state import Shown, shown_in
from .sidebar import OfDrawing

_ROWS = 6


class INVOLUTE_PT_junctions(OfDrawing, bpy.types.Panel):
    """All junctions: filters, list, steps, and what is done to all of them."""

    bl_label = "Junctions"

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        """The switch of the overlay."""
        view = context.window_manager.involute_view
        row = self.layout.row(align=True)
        row.prop(view, "stroke_colors", text="", icon="COLOR", emboss=False)
        row.prop(view, "show_overlay", text="", icon="OVERLAY", emboss=False)

    def draw(self, context: bpy.types.Context) -> None:
        """Filters, list and buttons."""
        shown = shown_in(context)
        _filters(self.layout, shown)
        listed = shown.listed
        _list(self.layout, shown, listed)
        row = self.layout.row(align=True)
        step = INVOLUTE_OT_step_junction.bl_idname
        row.operator(step, text="Previous", icon="TRIA_LEFT").direction = "PREVIOUS"
        row.operator(step, text="Next", icon="TRIA_RIGHT").direction = "NEXT"
        self.layout.operator(INVOLUTE_OT_review.bl_idname, icon="PLAY")
        column = self.layout.column(align=True)
        certainty = shown.view.certainty
        row = column.row(align=True)
        row.prop(shown.view, "certainty", text="Above", slider=True)
        sure = shown.table.at_least(certainty / 100)
        said = label("Accept {count}", count=int(sure.sum()))
        field = row.row(align=True)
        field.enabled = bool(sure.any())
        button = field.operator(INVOLUTE_OT_accept.bl_idname, text=said, translate=False)
        button.probability = certainty
        column.operator(INVOLUTE_OT_ask_again.bl_idname, icon="FILE_REFRESH")
        _frames(self.layout, shown)
        if shown.has_corners:
            self.layout.prop(shown.object, "involute_pen_lifts", slider=True)


class INVOLUTE_PT_junction(OfDrawing, bpy.types.Panel):
    """The current junction or bundle: in words, its alternatives, by hand."""

    bl_label = "Current Junction"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Is there a current junction?"""
        return super().poll(context) and shown_in(context).junction is not None

    def draw(self, context: bpy.types.Context) -> None:
        """The junction in words, its lock, its alternatives."""
        shown = shown_in(context)
        layout, junction = self.layout, shown.junction
        drawing = shown.trace.drawing
        row = layout.row()
        bundle = is_bundle(drawing, junction)
        kind = label("Bundle") if bundle else label("{count} lines", count=junction.degree)
        said = in_words(drawing, junction, junction.pairs)
        row.label(text=f"{kind}: {said}", translate=False)
        lock = "LOCKED" if junction.locked else "UNLOCKED"
        row.operator(INVOLUTE_OT_lock.bl_idname, text="", icon=lock).junction = junction.index
        _alternatives(layout, shown)
        if not bundle:
            _by_hand(layout, shown, letters(drawing, junction))


def _filters(layout: bpy.types.UILayout, shown: Shown) -> None:
    view = shown.view
    row = layout.row(align=True)
    row.prop(view, "order", expand=True)
    row = layout.row(align=True)
    row.prop(view, "doubtful_only", toggle=True)
    row.prop(view, "unlocked_only", toggle=True)
    row.prop(view, "degree", text="")


def _frames(layout: bpy.types.UILayout, shown: Shown) -> None:
    """For sequences: which keyframes are doubtful."""
    frames = state.doubtful_frames(shown.object.data)
    if len(frames) < 2:
        return
    doubtful = {frame: count for frame, count in frames.items() if count}
    row = layout.row(align=True)
    step = INVOLUTE_OT_doubtful_frame.bl_idname
    row.operator(step, text="", icon="PREV_KEYFRAME").direction = "PREVIOUS"
    said = label(
        "{doubts} doubts on {some} of {all} keyframes",
        doubts=sum(doubtful.values()),
        some=len(doubtful),
        all=len(frames),
    )
    row.label(text=said, translate=False)
    row.operator(step, text="", icon="NEXT_KEYFRAME").direction = "NEXT"
    header, body = layout.panel("involute_frames", default_closed=True)
    header.label(text="Most to Review")
    if body is None:
        return
    column = body.column(align=True)
    for frame in sorted(doubtful, key=lambda frame: -doubtful[frame])[:_ROWS]:
        said = label("Frame {frame}:  {count} doubts", frame=frame, count=doubtful[frame])
        button = column.operator(
            INVOLUTE_OT_go_to_frame.bl_idname,
            text=said,
            depress=frame == shown.frame,
            translate=False,
        )
        button.frame = frame


def _list(layout: bpy.types.UILayout, shown: Shown, listed: np.ndarray) -> None:
    """A page of the list; the table is too large and too short-lived for a UIList's collection."""
    pages = max(1, -(-len(listed) // _ROWS))
    page = min(shown.view.list_page, pages) - 1
    box = layout.box().column(align=True)
    if len(listed) == 0:
        box.label(text="No junction passes the filters")
    for index in listed[page * _ROWS : (page + 1) * _ROWS].tolist():
        row = box.row(align=True)
        is_locked = bool(shown.table.locked[index])
        degree = shown.table.degree[index]
        lines = label("Bundle") if degree == 2 else label("{count} lines", count=degree)
        certain = percent(1.0 - float(shown.table.doubt[index]))
        button = row.operator(
            INVOLUTE_OT_go_to_junction.bl_idname,
            text=f"{index}:  {lines},  {certain}",
            icon="LOCKED" if is_locked else "NONE",
            depress=index == shown.view.junction,
            translate=False,
        )
        button.junction = index
    row = layout.row(align=True)
    count = label("{some} of {all}", some=len(listed), all=shown.table.count)
    row.label(text=count, translate=False)
    row.prop(shown.view, "list_page", text=label("Page of {count}", count=pages), translate=False)


def _alternatives(layout: bpy.types.UILayout, shown: Shown) -> None:
    drawing, junction = shown.trace.drawing, shown.junction
    column = layout.column(align=True)
    for number, way in enumerate(junction.alternatives):
        row = column.row(align=True)
        eye = row.operator(
            INVOLUTE_OT_preview.bl_idname,
            text="",
            icon="HIDE_OFF" if shown.view.preview == number else "HIDE_ON",
            depress=shown.view.preview == number,
        )
        eye.alternative = number
        button = row.operator(
            INVOLUTE_OT_reroute.bl_idname,
            text=f"{percent(way.probability)}   {in_words(drawing, junction, way.pairs)}",
            depress=way.pairs == junction.pairs,
            translate=False,
        )
        button.junction, button.alternative = junction.index, number
    layout.operator(INVOLUTE_OT_choose.bl_idname, text="Choose in Viewport", icon="MOD_LINEART")


def _by_hand(layout: bpy.types.UILayout, shown: Shown, names: dict[int, str]) -> None:
    """Every line with its direction; buttons join it to any other or end it here."""
    header, body = layout.panel("involute_by_hand", default_closed=True)
    header.label(text="By Hand")
    if body is None:
        return
    drawing, junction = shown.trace.drawing, shown.junction
    partner = {a: b for pair in junction.pairs for a, b in (pair, pair[::-1])}
    for half, letter in sorted(names.items(), key=lambda item: item[1]):
        row = body.row(align=True)
        row.label(text=f"{letter} {arrow(angle(drawing, half))}", translate=False)
        for other, name in sorted(names.items(), key=lambda item: item[1]):
            cell = row.row(align=True)
            cell.enabled = other != half
            if other == half:
                cell.label(text="")
                continue
            button = cell.operator(
                INVOLUTE_OT_join.bl_idname,
                text=name,
                depress=partner.get(half) == other,
                translate=False,
            )
            button.first, button.second = half, other
        end = row.operator(INVOLUTE_OT_separate.bl_idname, text="Ends", depress=half not in partner)
        end.half = half


CLASSES = (INVOLUTE_PT_junctions, INVOLUTE_PT_junction)
