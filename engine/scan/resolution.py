"""How large the paper was: the pixels per inch that a picture's file says it was scanned with."""

from __future__ import annotations

import io
import struct
from contextlib import suppress
from os import PathLike
from pathlib import Path
from typing import BinaryIO

from .by_libraries import PDF_DPI
from .tiff_directories import ORDERS, DamagedTiffError, pages

# Scanners say 100 to 4800; 72 and 96 are what cameras and programs write that know nothing.
_BELIEVED = (100.0, 4800.0)  # dpi
_INCH = 0.0254  # m
_X_RESOLUTION, _UNIT = 282, 296  # tags of a TIFF
_MOST_CHUNKS = 200  # before the picture itself


def dots_per_inch(path: str | PathLike[str], page: int = 0) -> float | None:
    """The resolution of a PNG, JPEG, TIFF or BMP; None where the file says none to be believed."""
    found = None
    with suppress(OSError, struct.error, DamagedTiffError, IndexError), open(Path(path), "rb") as f:
        head = f.read(4)
        f.seek(0)
        if head == b"\x89PNG":
            found = _of_png(f)
        elif head[:2] == b"\xff\xd8":
            found = _of_jpeg(f)
        elif head in (b"II*\0", b"MM\0*"):
            found = _of_tiff(f, page)
        elif head == b"%PDF":
            found = PDF_DPI
        elif head[:2] == b"BM":
            f.seek(38)
            found = struct.unpack("<i", f.read(4))[0] * _INCH
    return found if found and _BELIEVED[0] <= found <= _BELIEVED[1] else None


def _of_png(file: BinaryIO) -> float | None:
    file.seek(8)
    for _ in range(_MOST_CHUNKS):
        size, kind = struct.unpack(">I4s", file.read(8))
        if kind == b"pHYs":
            across, _, unit = struct.unpack(">IIB", file.read(9))
            return round(across * _INCH, 2) if unit == 1 else None
        if kind in (b"IDAT", b"IEND"):
            return None
        file.seek(size + 4, 1)
    return None


def _of_jpeg(file: BinaryIO) -> float | None:
    file.seek(2)
    for _ in range(_MOST_CHUNKS):
        marker, size = struct.unpack(">HH", file.read(4))
        if marker == 0xFFE0:
            name, _, unit, across = struct.unpack(">5sHBH", file.read(10))
            if name == b"JFIF\0" and unit in (1, 2):
                return across * (1.0 if unit == 1 else 2.54)
            file.seek(size - 12, 1)
        elif marker == 0xFFE1 and file.read(6) == b"Exif\0\0":
            return _of_tiff(io.BytesIO(file.read(size - 8)), 0)
        elif marker >> 8 != 0xFF or marker == 0xFFDA:
            return None
        else:
            file.seek(size - (8 if marker == 0xFFE1 else 2), 1)
    return None


def _of_tiff(file: BinaryIO, page: int) -> float | None:
    number = pages(file)[page]
    file.seek(0)
    order = ORDERS[file.read(4)]
    (offset,) = struct.unpack(order + "I", file.read(4))
    for _ in range(number):
        file.seek(offset)
        (count,) = struct.unpack(order + "H", file.read(2))
        file.seek(12 * count, 1)
        (offset,) = struct.unpack(order + "I", file.read(4))
    file.seek(offset)
    (count,) = struct.unpack(order + "H", file.read(2))
    entries = struct.iter_unpack(order + "HHI4s", file.read(12 * count))
    tags = {tag: value for tag, _, _, value in entries}
    if _X_RESOLUTION not in tags:
        return None
    unit = struct.unpack(order + "H", tags[_UNIT][:2])[0] if _UNIT in tags else 2
    file.seek(struct.unpack(order + "I", tags[_X_RESOLUTION])[0])
    over, under = struct.unpack(order + "II", file.read(8))
    if not under or unit not in (2, 3):
        return None
    return float(over) / under * (1.0 if unit == 2 else 2.54)
