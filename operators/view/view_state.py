"""What the user looks at: the current junction, the preview, the filters. Not saved, not undone."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import bpy
import numpy as np
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatProperty,
    IntProperty,
)

from ...engine import InvoluteError
from ..grease_pencil import cels, state
from ..grease_pencil.core.pixel_map import PixelMap
from .junction_table import JunctionTable, table_of

if TYPE_CHECKING:
    from ...engine import Bundle, Junction


CERTAIN = 80.0  # percent; of scans a sixth of the junctions, and nine in ten of them are right


def certainty_property(least: float) -> object:
    """From which certainty on junctions are accepted, percent; no less than `least`."""
    return FloatProperty(
        name="Certainty",
        description="Least probability of the routing in force",
        default=CERTAIN,
        min=least,
        max=100.0,
        precision=0,
        subtype="PERCENTAGE",
    )


class INVOLUTE_PG_view(bpy.types.PropertyGroup):
    """Kept in the window manager."""

    key: IntProperty(name="Drawing", description="The traced drawing that is looked at")
    junction: IntProperty(name="Junction", description="The current junction", default=-1, min=-1)
    preview: IntProperty(
        name="Preview", description="The alternative that is shown but not applied", default=-1
    )
    choosing: BoolProperty(name="Choosing", description="The cards of the alternatives are shown")
    trail: CollectionProperty(  # where the mouse has drawn so far, px of the region
        type=bpy.types.OperatorMousePath, options={"HIDDEN"}
    )
    show_overlay: BoolProperty(
        name="Junction Overlay",
        description="Show junctions in the viewport, colored by doubt",
        default=True,
    )
    stroke_colors: BoolProperty(
        name="Stroke Colors",
        description="Show every stroke in a color of its own, with its ends marked",
        default=False,
    )
    live: BoolProperty(
        name="Live",
        description="Trace again by itself when a setting changes",
        default=False,
    )
    certainty: certainty_property(least=50.0)
    order: EnumProperty(
        name="Sort",
        description="Order of the list",
        items=[
            ("COST", "Cost", "Doubt times the length of stroke that another answer changes"),
            ("DOUBT", "Doubt", "The most doubtful first"),
            ("PLACE", "Place", "From the top of the page to the bottom"),
        ],
    )
    doubtful_only: BoolProperty(
        name="Doubtful", description="List doubtful junctions only", default=True
    )
    unlocked_only: BoolProperty(
        name="Unlocked", description="Leave out junctions that you have fixed", default=False
    )
    degree: EnumProperty(
        name="Lines",
        description="How many lines meet",
        items=[
            ("0", "Any", "Any number of lines"),
            ("2", "1–2", "Pencil strokes beside each other: one line or two"),
            ("3", "3", "Three lines meet"),
            ("4", "4", "Four lines meet"),
            ("5", "5+", "Five or more lines meet"),
        ],
    )
    list_page: IntProperty(name="Page", description="Page of the list", default=1, min=1)


@dataclass(frozen=True, eq=False)
class Shown:
    """The traced drawing that the user works on."""

    object: bpy.types.Object
    frame: int
    trace: state.Trace
    view: INVOLUTE_PG_view

    @cached_property
    def table(self) -> JunctionTable:
        """All its junctions as arrays."""
        return table_of(self.trace, self.halves)

    @cached_property
    def halves(self) -> np.ndarray:
        """The first half-branches of its strokes that are there."""
        return state.halves_at(self.object.data, self.frame, self.trace.key)

    @cached_property
    def pixel_map(self) -> PixelMap:
        """Where its pixels lie in the object, as its strokes say now."""
        return state.pixel_map_at(self.object.data, self.frame, self.trace)

    @property
    def junction(self) -> Junction | Bundle | None:
        """The current junction, or bundle of pencil strokes."""
        index = self.view.junction
        if self.view.key != self.trace.key or not 0 <= index < len(self.table):
            return None
        return self.trace.drawing.asked(index)

    @property
    def has_corners(self) -> bool:
        """Was the picture asked where the pen may have been lifted?"""
        clues = self.trace.drawing.graph.clues
        return clues is not None and len(clues) > 0

    @property
    def listed(self) -> np.ndarray:
        """The numbers of the junctions that pass the filters, in the list's order."""
        return self.table.listed(
            self.view.order,
            self.view.doubtful_only,
            int(self.view.degree),
            self.view.unlocked_only,
        )

    @property
    def world_positions(self) -> np.ndarray:
        """(J, 3) where the rows of the table are in the scene; NaN where that has no place."""
        places = self.pixel_map.to_object(self.table.positions)
        matrix = np.array(self.object.matrix_world)
        return places @ matrix[:3, :3].T + matrix[:3, 3]


def traced_in(context: bpy.types.Context) -> Iterator[Shown]:
    """What can be seen of traced drawings, the active object's first; what is damaged has none."""
    visible = sorted(context.visible_objects, key=lambda obj: obj != context.active_object)
    for obj in visible:
        try:
            shown = shown_in(context, obj)
        except InvoluteError:
            continue
        if shown is not None and shown.table.count:
            yield shown


def places_of(path: bpy.types.bpy_prop_collection) -> np.ndarray:
    """(N, 2) float64: the places of a path, whether drawn so far or given to an operator."""
    places = np.zeros(2 * len(path), np.float32)
    path.foreach_get("loc", places)
    return places.reshape(-1, 2).astype(np.float64)


def view_of(context: bpy.types.Context) -> INVOLUTE_PG_view:
    """What the user looks at, kept in the window manager."""
    return context.window_manager.involute_view


def shown_in(context: bpy.types.Context, obj: bpy.types.Object | None = None) -> Shown | None:
    """What an object shows at the current frame, or the one that is worked on; None = no trace."""
    obj = obj or looked_at(context)
    if not cels.is_grease_pencil(obj):
        return None
    frame = context.scene.frame_current
    keys = state.keys_at(obj.data, frame)
    if not keys:
        return None
    view = view_of(context)
    key = view.key if view.key in keys else keys[0]
    return Shown(obj, frame, state.load(obj.data, key, frame), view)


def looked_at(context: bpy.types.Context) -> bpy.types.Object | None:
    """The object that is worked on: the active one, or the drawing that was looked at last.

    A click beside the lines makes whatever lies behind them the active object, and in Draw Mode
    the one that is drawn on stays it; neither must take the drawing out of the artist's hands.
    """
    active, key = context.active_object, view_of(context).key
    frame = context.scene.frame_current
    if not key or (cels.is_grease_pencil(active) and state.keys_at(active.data, frame)):
        return active
    for obj in context.visible_objects:
        if cels.is_grease_pencil(obj) and key in state.keys_at(obj.data, frame):
            return obj
    return active


def select(shown: Shown, junction: int) -> None:
    """Make a junction the current one."""
    shown.view.key, shown.view.junction, shown.view.preview = shown.trace.key, junction, -1


def make_current(context: bpy.types.Context, shown: Shown, junction: int) -> None:
    """The same for any drawing that can be seen: its object becomes the active one."""
    if context.active_object != shown.object and context.mode == "OBJECT":
        context.view_layer.objects.active = shown.object
    select(shown, junction)
    redraw(context)


def redraw_sidebars(context: bpy.types.Context) -> None:
    """Let the sidebars of all 3D viewports draw anew, and nothing else."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                for region in area.regions:
                    if region.type == "UI":
                        region.tag_redraw()


def redraw(context: bpy.types.Context) -> None:
    """Let all 3D viewports draw anew."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()
