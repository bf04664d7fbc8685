"""Pictures from disk as arrays: whole or not at all, upright, in their own bit depth.

OpenCV decodes (Blender ships no other reader with 16 bits and CMYK). What it leaves to us: pages of
a TIFF by number, turning PNG, JPEG and WebP by their EXIF tag, and paths in any script.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import BinaryIO

import cv2
import numpy as np

from ..errors import InvoluteError
from ..values import Array
from . import movie

_TIFF = {b"II*\0": "<", b"MM\0*": ">", b"II+\0": "<", b"MM\0+": ">"}
_MOST_PAGES = 10_000  # a directory chain longer than this runs in circles
_ORIENTATION, _SUBFILE = 0x0112, 0x00FE  # TIFF and EXIF tags


def read_image(path: str | PathLike[str], page: int = 0) -> Array:
    """Decode one page of an image file.

    Returns:
        (H, W), (H, W, 3) RGB or (H, W, 4) RGBA, in the file's own type.

    Raises:
        InvoluteError: missing, damaged, too large, or not an image.
    """
    path = Path(path)
    if movie.is_movie(path):
        return cv2.cvtColor(movie.read_image(path, page), cv2.COLOR_BGR2RGB)
    try:
        data = np.fromfile(path, np.uint8)
    except FileNotFoundError:
        raise InvoluteError(f"There is no file {path}; check the path.") from None
    except OSError as error:
        raise InvoluteError(f"Can't read {path}: {error.strerror or error}.") from None
    try:
        with _quiet():
            picture = _decode(data, page)
    except (cv2.error, MemoryError) as error:
        if isinstance(error, cv2.error) and "MAX_IMAGE" not in str(error):
            picture = None
        else:
            raise InvoluteError(
                f"{path.name} is too large to be read; scale it down to at most 20,000 px a side."
            ) from None
    if picture is None:
        raise InvoluteError(
            f"{path.name} is damaged or not a picture; give a whole PNG, JPEG, TIFF, WebP or BMP."
        )
    if picture.ndim == 3 and picture.shape[2] == 3:
        cv2.cvtColor(picture, cv2.COLOR_BGR2RGB, dst=picture)
    elif picture.ndim == 3 and picture.shape[2] == 4:
        cv2.cvtColor(picture, cv2.COLOR_BGRA2RGBA, dst=picture)
    return picture


def page_count(path: str | PathLike[str]) -> int:
    """The number of pages of a TIFF, or of images in a movie, else 1; reads only headers.

    Raises:
        InvoluteError: there is no such file, or it can't be read.
    """
    if movie.is_movie(path):
        return movie.image_count(path)
    try:
        with open(path, "rb") as file:
            return max(1, len(_tiff_pages(file)))
    except FileNotFoundError:
        raise InvoluteError(f"There is no file {path}; check the path.") from None
    except OSError as error:
        raise InvoluteError(f"Can't read {path}: {error.strerror or error}.") from None


def _decode(data: Array, page: int) -> Array | None:
    if data[:4].tobytes() in _TIFF:
        directories = _tiff_pages(_Bytes(data))
        if not 0 <= page < len(directories):
            return None
        first = directories[page]
        ok, pages = cv2.imdecodemulti(data, cv2.IMREAD_UNCHANGED, range=(first, first + 1))
        return pages[0] if ok and pages else None
    if page != 0:
        return None
    picture, kinds, metadata = cv2.imdecodeWithMetadata(data, cv2.IMREAD_UNCHANGED)
    if picture is None:
        return None
    exif = [m for kind, m in zip(kinds, metadata, strict=True) if kind == cv2.IMAGE_METADATA_EXIF]
    return _upright(picture, _orientation(exif[0].tobytes())) if exif else picture


@contextmanager
def _quiet() -> Iterator[None]:
    """OpenCV reports damaged files on stderr; we say it in a sentence of our own."""
    before = cv2.utils.logging.getLogLevel()
    cv2.utils.logging.setLogLevel(cv2.utils.logging.LOG_LEVEL_SILENT)
    try:
        yield
    finally:
        cv2.utils.logging.setLogLevel(before)


def _upright(picture: Array, orientation: int) -> Array:
    """Turn a picture as its EXIF orientation (1 to 8) asks."""
    if orientation in (5, 6, 7, 8):
        picture = cv2.transpose(picture)
    flip = {2: 1, 3: -1, 4: 0, 6: 1, 7: -1, 8: 0}.get(orientation)
    return picture if flip is None else cv2.flip(picture, flip)


def _orientation(exif: bytes) -> int:
    file = _Bytes(np.frombuffer(exif.removeprefix(b"Exif\0\0"), np.uint8))
    try:
        return next((tags.get(_ORIENTATION, 1) for tags in _tiff_directories(file)), 1)
    except (struct.error, OSError):
        return 1


def _tiff_pages(file: BinaryIO | _Bytes) -> list[int]:
    """The numbers of the directories that are pages, not thumbnails or masks of one."""
    found = []
    try:
        for number, tags in enumerate(_tiff_directories(file)):
            if not tags.get(_SUBFILE, 0) & 0b101:
                found.append(number)
    except struct.error:  # cut off: decoding will tell
        pass
    return found


def _tiff_directories(file: BinaryIO | _Bytes) -> Iterator[dict[int, int]]:
    """The short tags of every directory of a TIFF or BigTIFF: tag -> first value."""
    magic = file.read(4)
    order = _TIFF.get(magic)
    if order is None:
        return
    big = b"+" in magic
    if big:
        file.read(4)
    pointer, count, entry = ("Q", "Q", "HHQ8s") if big else ("I", "H", "HHI4s")

    def unpack(layout: str) -> tuple:
        layout = order + layout
        return struct.unpack(layout, file.read(struct.calcsize(layout)))

    (offset,) = unpack(pointer)
    seen: set[int] = set()
    while offset and offset not in seen and len(seen) < _MOST_PAGES:
        seen.add(offset)
        file.seek(offset)
        (entries,) = unpack(count)
        tags = {}
        for _ in range(entries):
            tag, kind, _, value = unpack(entry)
            if kind in (3, 4):
                tags[tag] = struct.unpack_from(order + ("H" if kind == 3 else "I"), value)[0]
        yield tags
        (offset,) = unpack(pointer)


class _Bytes:
    """The little of a file that the TIFF reader needs, over bytes in memory."""

    def __init__(self, data: Array) -> None:
        self._data, self._at = data, 0

    def seek(self, offset: int) -> None:
        self._at = offset

    def read(self, size: int) -> bytes:
        part = self._data[self._at : self._at + size].tobytes()
        self._at += size
        return part


__all__ = ["page_count", "read_image"]
