"""The scan behind its strokes as on a light table: paled, on paper that hides what lies behind.

Scan and paper are image Empties that belong to the drawing's object; neither is rendered.
"""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Matrix

from ..grease_pencil.core.pixel_map import PixelMap
from .sources import Source, is_image_empty

_SCAN, _PAPER = "involute_scan", "involute_paper"
_OPACITY = 0.35  # strokes stand out, and what was missed can still be seen
_BEHIND = 1e-3  # of its size; near enough to lie under its strokes from the side, too
_PAPER_IMAGE = "Involute Paper"  # white: strokes of light lines are dark as well


def put_behind(
    obj: bpy.types.Object,
    source: Source,
    size: tuple[int, int],
    pixel_map: PixelMap,
    *,
    paper: bool,
) -> bpy.types.Object | None:
    """Show a source behind the drawing that was traced from it; None where Blender can't.

    Args:
        size: (width, height) of the drawing in pixels; a picture of another size lies otherwise.
        paper: with paper behind it; for a camera's view, what the artist has there is the paper.
    """
    if source.empty:
        scan = pale(bpy.data.objects.get(source.empty))
    else:
        scan = _new_scan(obj, source, size, pixel_map)
    if paper:
        put_paper(obj, size, pixel_map)
    return scan


def pale(scan: bpy.types.Object | None) -> bpy.types.Object | None:
    """Let strokes stand out on the Empty that they were traced from; the same Empty.

    What the artist has made paler herself stays so.
    """
    if scan is not None and not scan.use_empty_image_alpha and scan.library is None:
        scan.use_empty_image_alpha, scan.color[3] = True, _OPACITY
    return scan


def put_paper(obj: bpy.types.Object, size: tuple[int, int], pixel_map: PixelMap) -> None:
    """Put paper behind a drawing and its scan.

    Args:
        size: (width, height) of the drawing in pixels.
    """
    image = bpy.data.images.get(_PAPER_IMAGE)
    if image is None:
        image = bpy.data.images.new(_PAPER_IMAGE, 1, 1)
        image.generated_color = (1.0, 1.0, 1.0, 1.0)
    _lay(obj, "Paper", image, pixel_map, size, 2 * _BEHIND)[_PAPER] = True


def scan_of(obj: bpy.types.Object) -> bpy.types.Object | None:
    """The Empty that shows the scan behind an object: its own, or the one that it was traced from
    and lies on; None where there is none."""
    own = _child(obj, _SCAN)
    if own is not None:
        return own
    lies = np.array(obj.matrix_world)
    there = [one for one in bpy.context.scene.objects if is_image_empty(one) and one.parent != obj]
    return next((one for one in there if np.allclose(one.matrix_world, lies, atol=1e-5)), None)


def paper_of(obj: bpy.types.Object) -> bpy.types.Object | None:
    """The paper behind an object, or None."""
    return _child(obj, _PAPER)


def _child(obj: bpy.types.Object, mark: str) -> bpy.types.Object | None:
    return next((child for child in obj.children if child.get(mark)), None)


def _new_scan(
    obj: bpy.types.Object, source: Source, size: tuple[int, int], pixel_map: PixelMap
) -> bpy.types.Object | None:
    """An Empty of its own; None for a picture of another size than the drawing."""
    image = _image_of(source)
    if image is None:
        return None
    if tuple(image.size) != tuple(size):
        if not image.users:  # it was loaded for this
            bpy.data.images.remove(image)
        return None
    scan = _lay(obj, "Scan", image, pixel_map, size, _BEHIND)
    scan[_SCAN] = True
    return pale(scan)


def _lay(
    obj: bpy.types.Object,
    name: str,
    image: bpy.types.Image,
    pixel_map: PixelMap,
    size: tuple[int, int],
    behind: float,
) -> bpy.types.Object:
    """An Empty with an image, as large as the page, behind the drawing.

    Args:
        behind: how far, of its size.
    """
    empty = bpy.data.objects.new(f"{obj.name} {name}", None)
    empty.empty_display_type = "IMAGE"
    empty.data = image
    empty.empty_image_side = "FRONT"
    empty.empty_image_offset = (-0.5, -0.5)
    empty.hide_select = True  # a click means the strokes
    empty.parent = obj
    for collection in obj.users_collection:
        collection.objects.link(empty)
    across, down = size[0] * pixel_map.right, size[1] * pixel_map.down
    width, height = float(np.linalg.norm(across)), float(np.linalg.norm(down))
    empty.empty_display_size = max(width, height)
    middle = pixel_map.origin + 0.5 * across + 0.5 * down
    right, up = across / width, -down / height
    toward_the_eye = np.cross(right, up)
    middle -= behind * empty.empty_display_size * toward_the_eye
    seen = np.array(image.size) / max(image.size) * empty.empty_display_size
    axes = np.column_stack([right * width / seen[0], up * height / seen[1], toward_the_eye])
    empty.matrix_basis = Matrix.Translation(middle.tolist()) @ Matrix(axes.tolist()).to_4x4()
    return empty


def _image_of(source: Source) -> bpy.types.Image | None:
    from ...engine.vector_page import is_vector  # brings in OpenCV

    if source.page:
        return None  # Blender knows only the first page of a file
    if source.image:
        return bpy.data.images.get(source.image)
    if not isinstance(source.picture, str) or is_vector(source.picture):
        return None
    try:
        return bpy.data.images.load(source.picture, check_existing=True)
    except RuntimeError:  # a kind of file that Blender can't read
        return None
