"""The junctions in the viewport: rings coloured by doubt, the current routing, the preview.

Rings are one batch per drawing, in the drawing's own space: they follow the object's transform for
nothing and are made anew only when the routing or the colours change.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader

from ...operators.view.on_screen import places_on_screen
from ...operators.view.view_state import Shown, places_of, traced_in, view_of
from ..panels.preferences import preferences_of
from . import cards
from .colors import Color
from .drawn_batches import forget, kept
from .overlay_geometry import rings, routes
from .part_overlay import draw_part
from .stroke_overlay import draw_strokes

if TYPE_CHECKING:
    from ...engine import Drawing

_RING_WIDTH, _RING_RADIUS = 2.2, 8.0  # px of the screen; smaller rings have thinner lines

_handles: list[object] = []
_seen: dict[int, Shown] = {}
"""By region: what one handler looked up for the other, within one redraw."""


def draw_rings_and_routes() -> None:
    """POST_VIEW: everything that lies in the drawing's plane."""
    context = bpy.context
    _seen.clear()
    if not _in_viewport(context):
        return
    draw_part(context)
    if not view_of(context).show_overlay:
        return
    for shown in traced_in(context):
        with gpu.matrix.push_pop():
            gpu.matrix.multiply_matrix(shown.object.matrix_world)
            if shown.view.stroke_colors:
                draw_strokes(context, shown)
            _draw_rings(context, shown)
            if shown.object == context.active_object and shown.junction is not None:
                _draw_routes(context, shown)
                _seen[context.region.as_pointer()] = shown


def draw_labels() -> None:
    """POST_PIXEL: letters, cards and the path of a drag."""
    context = bpy.context
    if not _in_viewport(context) or context.region_data is None:
        return
    trail = places_of(view_of(context).trail)
    if len(trail) > 1:
        cards.draw_trail(trail)
    if not view_of(context).show_overlay:
        return
    shown = _seen.pop(context.region.as_pointer(), None)
    if shown is not None:
        cards.draw(context, shown)


def register() -> None:
    """Start drawing over 3D viewports."""
    space = bpy.types.SpaceView3D
    _handles.append(space.draw_handler_add(draw_rings_and_routes, (), "WINDOW", "POST_VIEW"))
    _handles.append(space.draw_handler_add(draw_labels, (), "WINDOW", "POST_PIXEL"))


def unregister() -> None:
    """Stop drawing, and free what was made for it."""
    for handle in _handles:
        bpy.types.SpaceView3D.draw_handler_remove(handle, "WINDOW")
    _handles.clear()
    _seen.clear()
    forget()


def pen_width(drawing: Drawing) -> float:
    """The usual width of a line, px of the drawing."""
    widths = drawing.graph.widths
    return float(np.median(widths)) if widths is not None and len(widths) else 3.0


def _in_viewport(context: bpy.types.Context) -> bool:
    """Is this a 3D viewport that shows overlays?"""
    space = context.space_data
    return space is not None and space.type == "VIEW_3D" and space.overlay.show_overlays


def _draw_rings(context: bpy.types.Context, shown: Shown) -> None:
    preferences = preferences_of(context)
    scale = tuple(
        tuple(round(v, 4) for v in getattr(preferences, name))
        for name in ("color_sure", "color_doubtful", "color_locked")
    )
    key = ("rings", *_state(shown), scale, preferences.ring_size)
    shader = gpu.shader.from_builtin("POLYLINE_FLAT_COLOR")
    batch = kept(key, lambda: _ring_batch(shader, shown, scale, preferences.ring_size))
    width = _ring_width(context, shown, preferences.ring_size)
    dark = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    _set_up(context, dark, 1.8 * width)  # an edge, so that rings show on paper and on ink alike
    dark.uniform_float("color", (0.0, 0.0, 0.0, 0.35))
    batch.draw(dark)
    _set_up(context, shader, width)
    batch.draw(shader)
    _tidy_up()


def _ring_width(context: bpy.types.Context, shown: Shown, size: float) -> float:
    """Px of the screen: thin while the whole page is seen, so that rings don't hide its strokes."""
    middle = np.array(shown.trace.drawing.size) / 2
    radius = size * pen_width(shown.trace.drawing)
    places = places_on_screen(context, shown, np.array([middle, middle + np.array([radius, 0.0])]))
    seen = float(np.linalg.norm(places[1] - places[0]))
    return float(np.clip(_RING_WIDTH * seen / _RING_RADIUS, 1.0, _RING_WIDTH))


def _ring_batch(
    shader: gpu.types.GPUShader, shown: Shown, scale: tuple[Color, Color, Color], size: float
) -> gpu.types.GPUBatch:
    shape = rings(shown.table, size * pen_width(shown.trace.drawing), scale)
    places = shown.pixel_map.to_object(shape.points)
    return batch_for_shader(
        shader, "LINES", {"pos": places, "color": shape.colors}, indices=shape.edges
    )


def _draw_routes(context: bpy.types.Context, shown: Shown) -> None:
    """The current junction's lines in the colours of their strokes; a preview is drawn wider."""
    junction, preview = shown.junction, shown.view.preview
    previewing = 0 <= preview < len(junction.alternatives)
    pairs = junction.alternatives[preview].pairs if previewing else junction.pairs
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    _set_up(context, shader, 7.0 if previewing else 4.5)
    key = ("routes", *_state(shown), junction.index, pairs)
    for color, batch in kept(key, lambda: _route_batches(shader, shown, pairs)):
        shader.uniform_float("color", color)
        batch.draw(shader)
    _tidy_up()


def _route_batches(
    shader: gpu.types.GPUShader, shown: Shown, pairs: tuple[tuple[int, int], ...]
) -> list[tuple[tuple[float, ...], gpu.types.GPUBatch]]:
    return [
        (
            (*route.color, 0.95 if route.joined else 0.6),
            batch_for_shader(
                shader, "LINE_STRIP", {"pos": shown.pixel_map.to_object(route.points)}
            ),
        )
        for route in routes(shown.trace.drawing, shown.junction, pairs)
    ]


def _state(shown: Shown) -> tuple:
    """What the batches of a drawing depend on: its content and where it lies in its object."""
    return shown.trace.stamp, hash(shown.halves.tobytes()), *shown.pixel_map.as_list()


def _set_up(context: bpy.types.Context, shader: gpu.types.GPUShader, width: float) -> None:
    region = context.region
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set("NONE")
    shader.bind()
    shader.uniform_float("viewportSize", (region.width, region.height))
    shader.uniform_float("lineWidth", width * context.preferences.system.ui_scale)


def _tidy_up() -> None:
    gpu.state.blend_set("NONE")
