"""The scan behind its strokes: an image Empty that belongs to the drawing's object."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np
from mathutils import Matrix

from ..grease_pencil.core.pixel_map import PixelMap
from .sources import Source

if TYPE_CHECKING:
    from collections.abc import Sequence

_MARK = "involute_scan"
_OPACITY = 0.35  # strokes stand out, and what was missed can still be seen
_BEHIND = 1e-3  # of its size; near enough to lie under its strokes from the side, too


def put_behind(
    obj: bpy.types.Object, source: Source, size: tuple[int, int], pixel_map: PixelMap
) -> bpy.types.Object | None:
    """Show a source behind the drawing that was traced from it; None where Blender can't.

    Args:
        size: (width, height) of the drawing in pixels; a picture of another size lies otherwise.
    """
    image = _image_of(source)
    if image is None:
        return None
    if tuple(image.size) != tuple(size):
        if not image.users:  # it was loaded for this
            bpy.data.images.remove(image)
        return None
    empty = bpy.data.objects.new(f"{obj.name} Scan", None)
    empty[_MARK] = True
    empty.empty_display_type = "IMAGE"
    empty.data = image
    empty.empty_image_side = "FRONT"
    empty.empty_image_offset = (-0.5, -0.5)
    empty.use_empty_image_alpha = True
    empty.color[3] = _OPACITY
    empty.hide_select = True  # a click means the strokes
    empty.parent = obj
    for collection in obj.users_collection:
        collection.objects.link(empty)
    right, down = pixel_map.right, pixel_map.down
    empty.empty_display_size = float(max(np.linalg.norm(right) * size[0], _height(down, size)))
    middle = pixel_map.origin + 0.5 * size[0] * right + 0.5 * size[1] * down
    across, up = _unit(right), _unit(-down)
    toward_the_eye = np.cross(across, up)
    middle -= _BEHIND * empty.empty_display_size * toward_the_eye
    axes = np.column_stack([across, up, toward_the_eye])
    empty.matrix_basis = Matrix.Translation(middle.tolist()) @ Matrix(axes.tolist()).to_4x4()
    return empty


def scan_of(obj: bpy.types.Object) -> bpy.types.Object | None:
    """The Empty that shows the scan behind an object, or None."""
    return next((child for child in obj.children if child.get(_MARK)), None)


def _image_of(source: Source) -> bpy.types.Image | None:
    from ...engine.vector_page import is_vector  # brings in OpenCV

    if source.empty or source.page:
        return None  # it is shown already; Blender knows only the first page of a file
    if source.image:
        return bpy.data.images.get(source.image)
    if not isinstance(source.picture, str) or is_vector(source.picture):
        return None
    try:
        return bpy.data.images.load(source.picture, check_existing=True)
    except RuntimeError:  # a kind of file that Blender can't read
        return None


def _unit(vector: Sequence[float]) -> np.ndarray:
    return np.asarray(vector) / np.linalg.norm(vector)


def _height(down: np.ndarray, size: tuple[int, int]) -> float:
    return float(np.linalg.norm(down) * size[1])
