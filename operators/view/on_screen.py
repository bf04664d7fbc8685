"""Where drawings, junctions, lines and cards lie in a region; what the mouse points at."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

from .card_layout import Card, free_part, layout
from .picking import distance_to_line, lines_at, near_part, nearest, project, unproject
from .view_state import Shown, traced_in

if TYPE_CHECKING:
    import bpy

    from ..grease_pencil.core.pixel_map import PixelMap

Mouse = tuple[float, float]


class Lies(Protocol):
    """A page in the scene: on which object, and where its pixels lie there."""

    @property
    def object(self) -> bpy.types.Object:
        """The object."""
        ...

    @property
    def pixel_map(self) -> PixelMap:
        """Where its pixels lie."""
        ...


_JUNCTION_RADIUS, _LINE_RADIUS = 22.0, 16.0  # px of the screen, times the interface's scale
_NEIGHBORS = 6  # junctions whose lines are looked at


def places_on_screen(context: bpy.types.Context, shown: Lies, points: np.ndarray) -> np.ndarray:
    """Pixels of a drawing -> pixels of the region; NaN behind the eye."""
    region = context.region
    matrix = np.array(context.region_data.perspective_matrix) @ np.array(shown.object.matrix_world)
    places = shown.pixel_map.to_object(points)
    return project(places, matrix, region.width, region.height)


def places_on_page(context: bpy.types.Context, shown: Lies, places: np.ndarray) -> np.ndarray:
    """The way back: pixels of the region -> (N, 2) pixels of the drawing, on its plane."""
    region = context.region
    matrix = np.array(context.region_data.perspective_matrix) @ np.array(shown.object.matrix_world)
    lies = shown.pixel_map
    plane = np.stack([lies.right, lies.down, lies.origin])
    return unproject(places, matrix, plane, region.width, region.height)


def radius_on_page(context: bpy.types.Context, shown: Shown, places: np.ndarray) -> float:
    """How many pixels of the drawing a line may be away from a gesture.

    Args:
        places: (N, 2) of the gesture, px of the region.
    """
    middle = np.asarray(places, float).mean(0)
    around = middle + np.array([(-0.5, 0), (0.5, 0), (0, -0.5), (0, 0.5)])
    found = places_on_page(context, shown, around)
    size = 0.5 * (np.linalg.norm(found[1] - found[0]) + np.linalg.norm(found[3] - found[2]))
    return float(_LINE_RADIUS * context.preferences.system.ui_scale * size)


def end_under(context: bpy.types.Context, mouse: Mouse) -> tuple[Shown, int] | None:
    """The half-branch at the nearest end of a stroke."""
    radius = _JUNCTION_RADIUS * context.preferences.system.ui_scale
    for shown in traced_in(context):
        drawing = shown.trace.drawing
        partner = drawing.routing.partner
        ends = np.flatnonzero(partner == np.arange(len(partner)))
        places = drawing.graph.vertices[drawing.graph.half_vertex[ends]]
        found = nearest(places_on_screen(context, shown, places), mouse, radius)
        if found >= 0:
            return shown, int(ends[found])
    return None


def junction_under(context: bpy.types.Context, mouse: Mouse) -> tuple[Shown, int] | None:
    """The nearest junction or bundle; the active object's count first."""
    radius = _JUNCTION_RADIUS * context.preferences.system.ui_scale
    for shown in traced_in(context):
        found = nearest(places_on_screen(context, shown, shown.table.positions), mouse, radius)
        if found >= 0:
            return shown, found
    return None


def halves_under(context: bpy.types.Context, mouse: Mouse) -> tuple[Shown, dict[int, float]] | None:
    """The half-branches near the mouse with their distances, of the junctions around it."""
    radius = _LINE_RADIUS * context.preferences.system.ui_scale
    for shown in traced_in(context):
        places = places_on_screen(context, shown, shown.table.positions)
        distance = np.nan_to_num(np.linalg.norm(places - mouse, axis=1), nan=np.inf)
        every = shown.trace.drawing.junctions
        around = np.argsort(distance[: len(every)])[:_NEIGHBORS]
        junctions = [every[k] for k in around]
        near = {}
        for half in (half for junction in junctions for half in junction.half_branches):
            line = places_on_screen(context, shown, near_part(shown.trace.drawing, half))
            if (away := distance_to_line(line, mouse)) <= radius:
                near[half] = away
        if near:
            return shown, near
    return None


def line_under(context: bpy.types.Context, mouse: Mouse) -> Shown | None:
    """The drawing that has any line near the mouse."""
    radius = _LINE_RADIUS * context.preferences.system.ui_scale
    for shown in traced_in(context):
        places = places_on_screen(context, shown, shown.trace.drawing.graph.points)
        if nearest(places, mouse, radius) >= 0:
            return shown
    return None


def junction_of(shown: Shown, half: int) -> int:
    """The number of the junction at which a half-branch starts."""
    graph = shown.trace.drawing.graph
    return int(np.searchsorted(graph.junctions, graph.half_vertex[half]))


def cards_of(context: bpy.types.Context, shown: Shown) -> tuple[list[Card], float]:
    """The cards of the current junction's alternatives in the region, and their scale."""
    junction = shown.junction
    (anchor,) = places_on_screen(context, shown, np.array([junction.position]))
    region = context.region
    if not np.isfinite(anchor).all():
        anchor = (region.width / 2, region.height / 2)
    scale = context.preferences.system.ui_scale
    parts = lines_at(shown.trace.drawing, junction)
    lines = places_on_screen(context, shown, np.concatenate(parts))
    free = free_part_of(context)
    return layout(len(junction.alternatives), tuple(anchor), free, scale, lines)


def viewport_under(
    context: bpy.types.Context, mouse: Mouse
) -> tuple[bpy.types.Area, bpy.types.Region] | None:
    """The 3D viewport at a place of the window, px; None on its sidebar, toolbar and headers."""
    for area in context.window.screen.areas:
        if area.type != "VIEW_3D":
            continue
        there = {
            region.type: region
            for region in area.regions
            if Card(region.x, region.y, region.width, region.height).holds(*mouse)
            and min(region.width, region.height) > 1
        }
        window = there.pop("WINDOW", None)
        if window is not None and not there.keys() - {"HUD"}:
            return area, window
    return None


def free_part_of(context: bpy.types.Context) -> Card:
    """What sidebar, toolbar and headers leave of the region of the context."""
    region = context.region
    covers = [
        Card(other.x - region.x, other.y - region.y, other.width, other.height)
        for other in (context.area.regions if context.area else ())
        if other.type not in {"WINDOW", "HUD"} and min(other.width, other.height) > 1
    ]
    inside = [c for c in covers if _overlaps(c, region.width, region.height)]
    return free_part((region.width, region.height), inside)


def _overlaps(card: Card, width: float, height: float) -> bool:
    return (
        card.x < width and card.y < height and card.x + card.width > 0 and card.y + card.height > 0
    )
