"""Pictures from disk as arrays: whole or not at all, upright, in their own bit depth.

OpenCV decodes (Blender ships no other reader with 16 bits and CMYK). What it leaves to us: pages of
a TIFF by number, unusual TIFFs, Targa, the picture in a PSD, BMP with alpha, turning PNG, JPEG and
WebP by their EXIF tag, sizes that lie, and paths in any script.
"""

from __future__ import annotations

import io
import stat
import struct
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import BinaryIO

import cv2
import numpy as np

from ..errors import InvoluteError
from ..formats.picture_kinds import Kind, kind_of, read_kinds
from ..values import Array
from . import by_libraries, movie, plain_tiff, psd, tga, tiff_directories
from .largest import MAX_SIDE, TooLargeError
from .tiff_directories import DamagedTiffError

_ORIENTATION = 0x0112  # EXIF tag
_HEAD = 64  # bytes that show what a file is
# Pixels that one byte can stand for at most: the longest string of a GIF, 4096 in 9 bits; 64 in two
# bits of a JPEG, and four times as many in runs of empty blocks. Of a PNG, unpacked bytes: 258 in
# two bits.
_PER_BYTE = {"GIF": 4096, "JPEG": 1024, "PNG": 1032}
_REFUSED = 2**30  # px; OpenCV makes no room for more, and says so
_PNG_CHANNELS = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}  # by color type
_FRAME_HEADERS = frozenset({*range(0xC0, 0xD0)} - {0xC4, 0xC8, 0xCC})  # of a JPEG


def read_image(path: str | PathLike[str], page: int = 0) -> Array:
    """Decode one page of an image file.

    Returns:
        (H, W), (H, W, 3) RGB or (H, W, 4) RGBA, in the file's own type.

    Raises:
        InvoluteError: missing, damaged, too large, or not an image.
    """
    try:
        path = Path(path)
    except TypeError:
        raise InvoluteError("Give the path of an image, or an array of its pixels.") from None
    if movie.is_movie(path):
        return cv2.cvtColor(movie.read_image(path, page), cv2.COLOR_BGR2RGB)
    with _opened(path) as file:
        data = np.frombuffer(file.read(), np.uint8)
    kind = kind_of(data[:_HEAD].tobytes(), path)
    if kind and not kind.is_read:
        raise InvoluteError(f"{path.name} is {kind.name}, which is not read; {kind.remedy}.")
    try:
        with _quiet():
            picture = _decode(data, page, kind)
    except DamagedTiffError:
        picture = None
    except InvoluteError as error:  # of a reader, which knows no name
        raise InvoluteError(f"{path.name}: {error}") from None
    except (cv2.error, MemoryError, TooLargeError) as error:
        if isinstance(error, MemoryError | TooLargeError) or "MAX_IMAGE" in str(error):
            raise _too_large(path) from None
        picture = None
    if picture is None:
        raise InvoluteError(_why_not(path, kind))
    if max(picture.shape[:2]) > MAX_SIDE:
        raise _too_large(path)
    return picture


def page_count(path: str | PathLike[str]) -> int:
    """The number of pages of a TIFF or PDF, or of images in a movie, else 1; reads only headers.

    Raises:
        InvoluteError: there is no such file, or it can't be read.
    """
    if movie.is_movie(path):
        return movie.image_count(path)
    with _opened(Path(path)) as file:
        kind = kind_of(file.read(_HEAD), Path(path))
        file.seek(0)
        if kind and kind.name == "PDF" and kind.is_read:
            try:
                return max(1, by_libraries.pdf_pages(file.read()))
            except InvoluteError:  # whoever reads it is told
                return 1
        return max(1, len(tiff_directories.pages(file)))


@contextmanager
def _opened(path: Path) -> Iterator[BinaryIO]:
    """A file to read; what is no file is not waited for.

    Raises:
        InvoluteError: it can't be read.
    """
    try:
        if not stat.S_ISREG(path.stat().st_mode):
            what = "a folder" if path.is_dir() else "no file"
            raise InvoluteError(f"{path} is {what}; give an image file (or - for a pipe).")
        with open(path, "rb") as file:
            yield file
    except FileNotFoundError:
        raise InvoluteError(f"There is no file {path}; check the path.") from None
    except OSError as error:
        raise InvoluteError(f"Can't read {path}: {error.strerror or error}.") from None
    except ValueError:
        raise InvoluteError(f"{str(path)!r} can't be the name of a file.") from None


def _too_large(path: Path) -> InvoluteError:
    return InvoluteError(
        f"{path.name} is too large to be read; scale it down to at most 20,000 px a side."
    )


def _why_not(path: Path, kind: Kind | None) -> str:
    if kind is None:
        return f"{path.name} is not a picture of a kind that is read; give {read_kinds()}."
    return f"{path.name} is damaged; give a whole {kind.name} file."


def _decode(data: Array, page: int, kind: Kind | None) -> Array | None:
    """One page as RGB; None when it is damaged, or there is no such page.

    Raises:
        DamagedTiffError, cv2.error, MemoryError: as they say.
    """
    name = kind.name if kind else ""
    if name == "TIFF":
        return _tiff_page(data, page)
    if name == "PDF":
        return by_libraries.pdf(data.tobytes(), page)
    if page != 0:
        return None
    own = _OWN.get(name)
    picture = own(data.tobytes()) if own else None
    if picture is not None or name in ("TGA", "PSD", *by_libraries.READERS):
        return picture
    if name in _PER_BYTE and _claimed(data, name) > _PER_BYTE[name] * len(data):
        return None  # before room is made for pixels that can't be there
    picture, kinds, metadata = cv2.imdecodeWithMetadata(data, cv2.IMREAD_UNCHANGED)
    if picture is None:
        return None
    exif = [m for what, m in zip(kinds, metadata, strict=True) if what == cv2.IMAGE_METADATA_EXIF]
    picture = _upright(picture, _orientation(exif[0].tobytes())) if exif else picture
    return _as_rgb(picture)


def _tiff_page(data: Array, page: int) -> Array | None:
    raw = data.tobytes()
    numbers = tiff_directories.pages(io.BytesIO(raw))
    if not 0 <= page < len(numbers):
        return None
    directory = numbers[page]
    layout = plain_tiff.layout(raw, directory)
    if layout and layout.needs_us:
        picture = plain_tiff.read(raw, layout)
        if picture is not None:
            tags = list(tiff_directories.directories(io.BytesIO(raw)))[directory]
            return _upright(_usual(picture), tags.get(_ORIENTATION, (1,))[0])
    ok, pictures = cv2.imdecodemulti(data, cv2.IMREAD_UNCHANGED, range=(directory, directory + 1))
    return _as_rgb(pictures[0]) if ok and pictures else None


def _usual(picture: Array) -> Array:
    """Samples and channels as every other reader gives them."""
    kind, size = picture.dtype.kind, picture.dtype.itemsize
    if kind in "ui" and size > 2:
        picture = (picture >> (8 * size - 16)).astype("u2" if kind == "u" else "i2")
    elif picture.dtype == np.float16:
        picture = picture.astype(np.float32)
    if picture.ndim == 3 and picture.shape[2] == 2:
        picture = np.dstack([picture[..., :1].repeat(3, 2), picture[..., 1]])
    return picture[..., :4] if picture.ndim == 3 else picture


def _as_rgb(picture: Array) -> Array:
    if picture.ndim == 3 and picture.shape[2] == 3:
        return cv2.cvtColor(picture, cv2.COLOR_BGR2RGB, dst=picture)
    if picture.ndim == 3 and picture.shape[2] == 4:
        return cv2.cvtColor(picture, cv2.COLOR_BGRA2RGBA, dst=picture)
    return picture


def _claimed(data: Array, name: str) -> int:
    """Pixels that a GIF or JPEG says it has, or unpacked bytes of a PNG; 0 when it does not say."""
    if name == "PNG":
        if len(data) < 26 or data[12:16].tobytes() != b"IHDR":
            return 0
        width, height, bits, colors = struct.unpack(">IIBB", data[16:26].tobytes())
        chunk = _longest_chunk(data)  # OpenCV makes room for that, too
        if width * height > _REFUSED:
            return chunk
        return max(chunk, height * (width * bits * _PNG_CHANNELS.get(colors, 1) // 8 + 1))
    if name == "GIF":
        width, height = struct.unpack("<HH", data[6:10].tobytes().ljust(4, b"\0"))
        return width * height
    at = 2
    while at + 9 <= len(data) and data[at] == 0xFF:
        if int(data[at + 1]) in _FRAME_HEADERS:
            height, width = struct.unpack(">HH", data[at + 5 : at + 9].tobytes())
            return width * height
        at += 2 + int.from_bytes(data[at + 2 : at + 4].tobytes(), "big")
    return 0


def _longest_chunk(data: Array) -> int:
    """Bytes that the longest of a PNG's chunks says it has, as far as they follow each other."""
    at, longest = 8, 0
    while at + 8 <= len(data):
        size = int.from_bytes(data[at : at + 4].tobytes(), "big")
        longest = max(longest, size)
        at += 12 + size
    return longest


def _bmp_with_alpha(data: bytes) -> Array | None:
    """A BMP of 32 bits whose alpha means something, RGBA; None for those that OpenCV reads."""
    if len(data) < 70:
        return None
    start, header, width, height, _, bits, packing = struct.unpack("<10xIIiiHHI", data[:34])
    masks = struct.unpack("<4I", data[54:70]) if header >= 56 else (0, 0, 0, 0)
    usual = (0x00FF0000, 0x0000FF00, 0x000000FF, 0xFF000000)
    if bits != 32 or packing not in (0, 3) or (packing == 3 and masks != usual):
        return None
    rows, size = abs(height), abs(height) * width * 4
    if width <= 0 or not rows or len(data) - start < size:
        return None
    picture = np.frombuffer(data, np.uint8, size, start).reshape(rows, width, 4)
    if not picture[..., 3].any() or (picture[..., 3] == 255).all():
        return None
    return np.ascontiguousarray((picture[::-1] if height > 0 else picture)[..., [2, 1, 0, 3]])


_OWN: dict[str, Callable[[bytes], Array | None]] = {
    "TGA": tga.read,
    "PSD": psd.read,
    "BMP": _bmp_with_alpha,
    **by_libraries.READERS,
}


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
    file = io.BytesIO(exif.removeprefix(b"Exif\0\0"))
    try:
        first = next(tiff_directories.directories(file), {})
    except DamagedTiffError:
        return 1
    return first.get(_ORIENTATION, (1,))[0]


__all__ = ["page_count", "read_image"]
