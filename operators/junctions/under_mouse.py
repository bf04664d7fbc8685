"""Which junction or line of which traced drawing lies under the mouse."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from .picking import distance_to_line, nearest, project
from .view_state import Shown, shown_in

if TYPE_CHECKING:
    import bpy

    from ...engine import Drawing

Mouse = tuple[float, float]

REACH = 60.0  # px of the drawing; how far a half-branch counts as belonging to its junction
_JUNCTION_RADIUS, _LINE_RADIUS = 22.0, 16.0  # px of the screen, times the interface's scale
_NEIGHBORS = 6  # junctions whose lines are looked at


def places_on_screen(context: bpy.types.Context, shown: Shown, points: np.ndarray) -> np.ndarray:
    """Pixels of a drawing -> pixels of the region; NaN behind the eye."""
    region = context.region
    matrix = np.array(context.region_data.perspective_matrix) @ np.array(shown.object.matrix_world)
    places = shown.trace.placement.to_object(points)
    return project(places, matrix, region.width, region.height)


def junction_under(context: bpy.types.Context, mouse: Mouse) -> tuple[Shown, int] | None:
    """The nearest junction; the active object's count first."""
    radius = _JUNCTION_RADIUS * context.preferences.system.ui_scale
    for shown in _drawings(context):
        found = nearest(places_on_screen(context, shown, shown.table.positions), mouse, radius)
        if found >= 0:
            return shown, found
    return None


def halves_under(context: bpy.types.Context, mouse: Mouse) -> tuple[Shown, dict[int, float]] | None:
    """The half-branches near the mouse with their distances, of the junctions around it."""
    radius = _LINE_RADIUS * context.preferences.system.ui_scale
    for shown in _drawings(context):
        places = places_on_screen(context, shown, shown.table.positions)
        distance = np.nan_to_num(np.linalg.norm(places - mouse, axis=1), nan=np.inf)
        around = np.argsort(distance)[:_NEIGHBORS]
        junctions = [shown.trace.drawing.junctions[k] for k in around]
        near = {}
        for half in (half for junction in junctions for half in junction.half_branches):
            line = places_on_screen(context, shown, near_part(shown.trace.drawing, half))
            if (away := distance_to_line(line, mouse)) <= radius:
                near[half] = away
        if near:
            return shown, near
    return None


def near_part(drawing: Drawing, half: int, reach: float = REACH, share: float = 0.5) -> np.ndarray:
    """(N, 2) px: a half-branch from its junction outward, no farther than a share of the branch."""
    points = drawing.graph.half_branch(half).astype(np.float64)
    lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    end = min(reach, share * lengths[-1])
    inside = lengths < end
    last = [np.interp(end, lengths, points[:, k]) for k in (0, 1)]
    return np.concatenate([points[inside], [last]])


def _drawings(context: bpy.types.Context) -> Iterator[Shown]:
    """The traced drawings that can be seen, the active one first."""
    active = context.active_object
    others = (obj for obj in context.visible_objects if obj != active)
    for obj in (active, *others):
        shown = shown_in(context, obj) if obj is not None else None
        if shown is not None and len(shown.table):
            yield shown
