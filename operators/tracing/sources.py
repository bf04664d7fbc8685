"""What there is to trace: files, pages, images, image Empties; read before any thread starts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...engine import InvoluteError
from ...engine.formats.picture_kinds import SUFFIXES
from ..grease_pencil.stored_trace import Picture
from ..language import message

if TYPE_CHECKING:
    import bpy


@dataclass(frozen=True, eq=False)
class Source:
    """One picture to trace.

    picture: a path, or an (H, W, 4) float32 array in sRGB, 0..1.
    empty: name of the image Empty that shows it, or None.
    image: name of the image data-block that holds it, or None.
    """

    name: str
    picture: str | np.ndarray
    page: int = 0
    empty: str | None = None
    image: str | None = None

    @property
    def noted(self) -> Picture:
        """What is kept of it, to find it again."""
        path = self.picture if isinstance(self.picture, str) else ""
        return Picture(path, self.page, self.image or "")


def from_files(paths: Sequence[str]) -> list[Source]:
    """Each page of each file."""
    from ...engine.scan import page_count

    sources = []
    for path in paths:
        count, stem = page_count(path) if _has_pages(path) else 1, Path(path).stem
        names = [stem] if count == 1 else [f"{stem} {page + 1}" for page in range(count)]
        sources += [Source(name, path, page) for page, name in enumerate(names)]
    return sources


def from_image(image: bpy.types.Image, empty: bpy.types.Object | None = None) -> Source:
    """An image data-block: its file when it is saved as it is, else the pixels in memory.

    Raises:
        InvoluteError: the image has no pixels.
    """
    import bpy

    stem = Path(image.name).stem if Path(image.name).suffix.lower() in SUFFIXES else image.name
    name = stem or "Drawing"
    shown_by = empty.name if empty else None
    if image.source in {"FILE", "SEQUENCE"} and not image.packed_file and not image.is_dirty:
        path = image.filepath
        if empty and image.source == "SEQUENCE":  # what the Empty shows at this moment
            path = image.filepath_from_user(image_user=empty.image_user)
        path = bpy.path.abspath(path, library=image.library)
        if Path(path).is_file() and Path(path).suffix.lower() in SUFFIXES:
            return Source(name, path, empty=shown_by, image=image.name)
    width, height = image.size
    if not (width and height and len(image.pixels)):
        raise InvoluteError(
            message(
                "The image {name!r} has no pixels; reload it or choose another.", name=image.name
            )
        )
    return Source(name, _pixels(image), empty=shown_by, image=image.name)


def is_image_empty(obj: bpy.types.Object | None) -> bool:
    """Is it an Empty that shows an image?"""
    import bpy

    return (
        obj is not None
        and obj.type == "EMPTY"
        and obj.empty_display_type == "IMAGE"
        and isinstance(obj.data, bpy.types.Image)
    )


def noted(picture: Picture, name: str) -> Source:
    """A picture that was noted when it was traced.

    Raises:
        InvoluteError: it is not there any more.
    """
    import bpy

    if picture.path and Path(bpy.path.abspath(picture.path)).is_file():
        return Source(name, bpy.path.abspath(picture.path), picture.page)
    if picture.image and picture.image in bpy.data.images:
        return from_image(bpy.data.images[picture.image])
    if picture.path:
        said = "There is no file {path}; put it back, or trace the picture as a new object."
        raise InvoluteError(message(said, path=picture.path))
    raise InvoluteError("Nobody noted which picture this was; trace it as a new object.")


def _pixels(image: bpy.types.Image) -> np.ndarray:
    """(H, W, 4) float32 sRGB, first row on top."""
    width, height = image.size
    channels = image.channels
    flat = np.empty(width * height * channels, np.float32)
    image.pixels.foreach_get(flat)
    pixels = flat.reshape(height, width, channels)[::-1]
    if channels != 4:
        color = pixels[..., :3] if channels == 3 else np.repeat(pixels[..., :1], 3, axis=2)
        pixels = np.concatenate([color, np.ones((height, width, 1), np.float32)], axis=2)
    if image.is_float:  # these are linear
        pixels = pixels.copy()
        color = np.clip(pixels[..., :3], 0.0, 1.0)
        pixels[..., :3] = np.where(
            color <= 0.0031308, color * 12.92, 1.055 * color ** (1 / 2.4) - 0.055
        )
    return np.ascontiguousarray(np.clip(pixels, 0.0, 1.0))


def _has_pages(path: str) -> bool:
    return Path(path).suffix.lower() in (".tif", ".tiff") and Path(path).is_file()
