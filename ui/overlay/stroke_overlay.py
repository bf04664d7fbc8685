"""Draws `stroke_lines` over the viewport; made anew only when strokes or colours change."""

from __future__ import annotations

from hashlib import blake2b
from typing import TYPE_CHECKING

import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader

from ...operators.grease_pencil import cels
from ..panels.preferences import preferences_of
from .drawn_batches import kept
from .stroke_lines import color_numbers, stroke_lines

if TYPE_CHECKING:
    import bpy

    from ...operators.grease_pencil.core.map_fit import Shapes
    from ...operators.view.view_state import Shown

_END_SIZE = 2.0  # line widths


def draw_strokes(context: bpy.types.Context, shown: Shown) -> None:
    """Each stroke in its colour, a dot at each end."""
    palette = palette_of(context)
    shapes, content = content_of(shown.object.data, shown.frame)
    key = ("strokes", shown.trace.stamp, shown.trace.key, palette, content)
    lines, dots = kept(key, lambda: _batches(shown, shapes, palette))
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set("NONE")
    draw_lines(context, lines, dots)
    gpu.state.blend_set("NONE")


def draw_lines(
    context: bpy.types.Context, lines: gpu.types.GPUBatch, ends: gpu.types.GPUBatch | None
) -> None:
    """Batches of lines and points with colours, as wide as the user wants strokes."""
    width = preferences_of(context).stroke_width * context.preferences.system.ui_scale
    shader = gpu.shader.from_builtin("POLYLINE_FLAT_COLOR")
    shader.bind()
    shader.uniform_float("viewportSize", (context.region.width, context.region.height))
    shader.uniform_float("lineWidth", width)
    lines.draw(shader)
    if ends is not None:
        gpu.state.point_size_set(_END_SIZE * width)
        ends.draw(gpu.shader.from_builtin("POINT_FLAT_COLOR"))


def palette_of(context: bpy.types.Context) -> tuple[tuple[float, ...], ...]:
    """The colours of strokes, as a key of what is kept."""
    colors = preferences_of(context).stroke_palette
    return tuple(tuple(round(v, 4) for v in color) for color in colors)


def _batches(
    shown: Shown, shapes: list[Shapes], palette: tuple[tuple[float, ...], ...]
) -> tuple[gpu.types.GPUBatch, gpu.types.GPUBatch | None]:
    numbers = color_numbers(shown.trace.drawing, len(palette))
    made = stroke_lines(shapes, shown.trace.key, numbers, palette)
    lines = batch_for_shader(
        gpu.shader.from_builtin("POLYLINE_FLAT_COLOR"),
        "LINES",
        {"pos": made.points, "color": made.colors},
        indices=made.edges,
    )
    if not len(made.ends):
        return lines, None
    shader = gpu.shader.from_builtin("POINT_FLAT_COLOR")
    content = {"pos": made.ends, "color": made.end_colors}
    return lines, batch_for_shader(shader, "POINTS", content)


def content_of(data: bpy.types.ID, frame: int) -> tuple[list[Shapes], bytes]:
    """All that is drawn at a frame, and a hash of it."""
    shapes = [cels.read_shapes(cel) for _, cel in cels.cels_at(data, frame)]
    content = blake2b(digest_size=16)
    for one in shapes:
        for values in (one.offsets, one.points, one.keys, one.halves, one.cyclic, one.handles):
            if values is not None:
                content.update(np.ascontiguousarray(values).tobytes())
    return shapes, content.digest()
