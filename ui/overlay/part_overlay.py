"""Draws the part of a page that settings are tried on, over its scan."""

from __future__ import annotations

from typing import TYPE_CHECKING

import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader
from mathutils.geometry import tessellate_polygon

from ...operators.tracing.part import Part, current
from .drawn_batches import kept
from .part_shapes import cut_off, part_shapes
from .stroke_overlay import draw_lines, palette_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    import bpy

    from ...engine.drawing import Fill
    from ...operators.tracing.part import Box

Array = np.ndarray
Rgba = tuple[float, float, float, float]

_PAPER = (1.0, 1.0, 1.0, 0.55)  # over the scan, which shows through: what was missed is seen
_SOLID = (0.25, 0.25, 0.25, 0.9)
_BORDER = (0.1, 0.1, 0.1, 0.9)
_INK = 0.45  # opacity of the ink around a stroke's middle


def draw_part(context: bpy.types.Context) -> None:
    """POST_VIEW: the part in the plane of its page."""
    part = current()
    if part is None:
        return
    palette = palette_of(context)
    gpu.state.blend_set("ALPHA")
    gpu.state.depth_test_set("NONE")
    with gpu.matrix.push_pop():
        gpu.matrix.multiply_matrix(part.page.object.matrix_world)
        areas, lines, dots = kept(("part", part, palette), lambda: _batches(part, palette))
        areas.draw(gpu.shader.from_builtin("FLAT_COLOR"))
        draw_lines(context, lines, dots)
    gpu.state.blend_set("NONE")


def _batches(
    part: Part, palette: tuple[tuple[float, ...], ...]
) -> tuple[gpu.types.GPUBatch, gpu.types.GPUBatch, gpu.types.GPUBatch | None]:
    """Areas, lines and the ends of strokes, in the space of the object."""
    left, top, right, bottom = part.box
    frame = np.array([(left, top), (right, top), (right, bottom), (left, bottom)], float)
    areas = [(frame[[0, 1, 2, 0, 2, 3]], _PAPER)]
    lines = [(frame[[0, 1, 1, 2, 2, 3, 3, 0]], _BORDER)]
    dots: list[tuple[Array, Array | Rgba]] = []
    if part.drawing is not None:
        corner, box = part.around[:2], part.box
        areas += [(_triangles(fill, corner, box), _SOLID) for fill in part.drawing.fills]
        made = part_shapes(part.drawing, corner, box, palette)
        areas.append((made.wide[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 2), _rgba(made.colors, 6, _INK)))
        lines.append((made.middle.reshape(-1, 2), _rgba(made.colors, 2, 1.0)))
        if len(made.ends):
            dots.append((made.ends, _rgba(made.end_colors, 1, 1.0)))
    line_batch = _batch("POLYLINE_FLAT_COLOR", "LINES", lines, part)
    dot_batch = _batch("POINT_FLAT_COLOR", "POINTS", dots, part) if dots else None
    return _batch("FLAT_COLOR", "TRIS", areas, part), line_batch, dot_batch


def _batch(
    shader: str, kind: str, shapes: Sequence[tuple[Array, Array | Rgba]], part: Part
) -> gpu.types.GPUBatch:
    """One batch of places (N, 2) px of the page, each with its colour or all with one."""
    places = np.concatenate([places for places, _ in shapes])
    colors = [np.broadcast_to(np.asarray(c, np.float32), (len(p), 4)) for p, c in shapes]
    content = {"pos": part.page.pixel_map.to_object(places), "color": np.concatenate(colors)}
    return batch_for_shader(gpu.shader.from_builtin(shader), kind, content)


def _rgba(colors: Array, times: int, opacity: float) -> Array:
    """(N, 3) -> (N * times, 4)."""
    return np.repeat(np.pad(colors, ((0, 0), (0, 1)), constant_values=opacity), times, axis=0)


def _triangles(fill: Fill, corner: tuple[int, int], box: Box) -> Array:
    """(3 T, 2) the solid area inside of the part, px of the page."""
    rings = [ring for ring in (cut_off(ring + corner, box) for ring in fill) if len(ring) > 2]
    if not rings:
        return np.zeros((0, 2))
    found = tessellate_polygon([[(x, y, 0.0) for x, y in ring.tolist()] for ring in rings])
    return np.concatenate(rings)[np.array(found, int).reshape(-1)]
