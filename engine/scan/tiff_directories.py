"""The directories of a TIFF or BigTIFF: which are pages, and what is in them; bounded in any file.

A directory may point anywhere, also into another one: a small file could hold millions of entries.
All directories together may not be longer than the file, which is so in every honest one.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Mapping
from typing import BinaryIO

import numpy as np

ORDERS = {b"II*\0": "<", b"MM\0*": ">", b"II+\0": "<", b"MM\0+": ">"}
_MOST_PAGES = 10_000  # a chain longer than this runs in circles
_MOST_VALUES = 2_000_000  # strips or tiles of a picture of 20,000 px a side in tiles of 16 px
_SUBFILE = 0x00FE
_SIZES = {1: "B", 3: "H", 4: "I", 16: "Q"}  # kinds of whole numbers


class DamagedTiffError(ValueError):
    """What is written in the file can't be."""


Tags = Mapping[int, tuple[int, ...]]


def pages(file: BinaryIO) -> list[int]:
    """The numbers of the directories that are pages, not thumbnails or masks of one.

    A chain that breaks off ends there: decoding will tell.
    """
    found = []
    try:
        for number, tags in enumerate(directories(file)):
            if not tags.get(_SUBFILE, (0,))[0] & 0b101:
                found.append(number)
    except DamagedTiffError:
        pass
    return found


def directories(file: BinaryIO, values: bool = False) -> Iterator[Tags]:
    """The tags of every directory, in order: tag -> whole numbers.

    Args:
        file: open for reading bytes, at its beginning.
        values: read all numbers of a tag; else only those that are in the directory itself.

    Raises:
        DamagedTiffError: a directory lies outside the file or in another one.
    """
    magic = file.read(4)
    order = ORDERS.get(magic)
    if order is None:
        return
    size = file.seek(0, 2)
    file.seek(4)
    big = b"+" in magic
    pointer, count, entry = ("Q", "Q", "HHQ8s") if big else ("I", "H", "HHI4s")
    if big:
        _read(file, 4)
    entry_size = struct.calcsize(order + entry)
    (offset,) = _unpack(file, order + pointer)
    left, seen = size, set[int]()
    while offset and offset not in seen and len(seen) < _MOST_PAGES:
        seen.add(offset)
        if offset >= size:
            raise DamagedTiffError("a directory lies beyond the file")
        file.seek(offset)
        (entries,) = _unpack(file, order + count)
        left -= entries * entry_size
        if left < 0:
            raise DamagedTiffError("its directories overlap")
        raw = _read(file, entries * entry_size)
        (following,) = _unpack(file, order + pointer)
        yield {
            tag: numbers
            for tag, kind, many, value in struct.iter_unpack(order + entry, raw)
            if (numbers := _numbers(file if values else None, order, kind, many, value, big))
        }
        offset = following


def _numbers(
    file: BinaryIO | None, order: str, kind: int, many: int, value: bytes, big: bool
) -> tuple[int, ...]:
    letter = _SIZES.get(kind)
    if letter is None or not many:
        return ()
    length = struct.calcsize(letter)
    if many * length <= len(value):
        return struct.unpack_from(f"{order}{many}{letter}", value)
    if file is None or many > _MOST_VALUES:
        return ()
    (offset,) = struct.unpack(order + ("Q" if big else "I"), value)
    try:
        file.seek(offset)
    except (OSError, ValueError, OverflowError):
        raise DamagedTiffError("a value lies beyond the file") from None
    return tuple(np.frombuffer(_read(file, many * length), f"{order}u{length}").tolist())


def _unpack(file: BinaryIO, layout: str) -> tuple[int, ...]:
    return struct.unpack(layout, _read(file, struct.calcsize(layout)))


def _read(file: BinaryIO, size: int) -> bytes:
    data = file.read(size)
    if len(data) < size:
        raise DamagedTiffError("it ends too early")
    return data
