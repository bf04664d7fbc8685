"""Pages of a TIFF that OpenCV does not read: grey with alpha, 16-bit floats, 32-bit numbers, small
tiles; without compression, or with Deflate, LZW or PackBits.
"""

from __future__ import annotations

import io
import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..values import Array
from .tiff_directories import ORDERS, DamagedTiffError, Tags, directories

_KINDS = {1: "u", 2: "i", 3: "f"}  # sample formats
_WHITE_IS_ZERO, _RGB = 0, 2  # photometric interpretations; 1 = black is zero
_LARGEST = 20_000 * 20_000  # px


@dataclass(frozen=True)
class Layout:
    """How the samples of a page lie in the file.

    piece: (height, width) of a strip or tile; separate: each channel has pieces of its own.
    """

    height: int
    width: int
    samples: int
    dtype: np.dtype[Any]
    piece: tuple[int, int]
    separate: bool
    compression: int
    predictor: int
    photometric: int
    offsets: tuple[int, ...]
    counts: tuple[int, ...]

    @staticmethod
    def of(tags: Tags, order: str) -> Layout:
        """Read it from a directory.

        Raises:
            DamagedTiffError: the directory says nothing that can be.
            NotImplementedError: it is of a kind that is not read here.
        """

        def one(tag: int, default: int) -> int:
            return tags.get(tag, (default,))[0]

        width, height, samples = one(256, 0), one(257, 0), one(277, 1)
        bits, kinds = set(tags.get(258, (1,))), set(tags.get(339, (1,)))
        if not 0 < width * height <= _LARGEST or not 1 <= samples <= 8:
            raise DamagedTiffError("its size can't be")
        kind = _KINDS.get(next(iter(kinds)))
        size = next(iter(bits))
        known = {"u": (8, 16, 32, 64), "i": (8, 16, 32, 64), "f": (16, 32, 64)}.get(kind or "", ())
        if len(bits) > 1 or len(kinds) > 1 or size not in known or one(262, 1) > _RGB:
            raise NotImplementedError
        tiled = 324 in tags
        piece = (one(323, 0), one(322, 0)) if tiled else (min(one(278, height), height), width)
        if not 0 < piece[0] * piece[1] <= _LARGEST:
            raise DamagedTiffError("its tiles have no size")
        return Layout(
            height=height,
            width=width,
            samples=samples,
            dtype=np.dtype(f"{order}{kind}{size // 8}"),
            piece=piece,
            separate=one(284, 1) == 2,
            compression=one(259, 1),
            predictor=one(317, 1),
            photometric=one(262, 1),
            offsets=tags.get(324 if tiled else 273, ()),
            counts=tags.get(325 if tiled else 279, ()),
        )

    @property
    def needs_us(self) -> bool:
        """Whether OpenCV reads such a page wrongly or not at all."""
        wide = self.dtype.kind != "f" and self.dtype.itemsize > 2
        half = self.dtype == np.dtype(f"{self.dtype.byteorder}f2")
        return self.samples == 2 or wide or half or self.piece[1] <= 16

    def places(self) -> Iterator[tuple[int, int, int]]:
        """(first channel, top, left) of each piece, in order."""
        for channel in range(self.samples if self.separate else 1):
            for top in range(0, self.height, self.piece[0]):
                for left in range(0, self.width, self.piece[1]):
                    yield channel, top, left


def layout(data: bytes, directory: int) -> Layout | None:
    """How a page lies in a TIFF; None when it is of a kind that is not read here.

    Raises:
        DamagedTiffError: it has no such directory, or that makes no sense.
    """
    for number, tags in enumerate(directories(io.BytesIO(data), values=True)):
        if number == directory:
            try:
                return Layout.of(tags, ORDERS[data[:4]])
            except NotImplementedError:
                return None
    raise DamagedTiffError("it has no such page")


def read(data: bytes, page: Layout) -> Array | None:
    """The page, (H, W) or (H, W, C) in RGB order; None when its compression is not read here.

    Raises:
        DamagedTiffError: pieces are missing.
    """
    unpack = _UNPACK.get(page.compression)
    if unpack is None or page.predictor > 2:
        return None
    channels = 1 if page.separate else page.samples
    shape = (*page.piece, channels)
    size = int(np.prod(shape)) * page.dtype.itemsize
    places = list(page.places())
    if len(places) > min(len(page.offsets), len(page.counts)):
        raise DamagedTiffError("pieces are missing")
    out = np.zeros((page.height, page.width, page.samples), page.dtype.newbyteorder("="))
    for (channel, top, left), offset, count in zip(places, page.offsets, page.counts, strict=False):
        rows = min(page.piece[0], page.height - top)
        raw = unpack(data[offset : offset + count], size)
        needed = rows * page.piece[1] * channels * page.dtype.itemsize
        if len(raw) < needed:
            raise DamagedTiffError("a piece is cut short")
        piece = np.frombuffer(raw[:needed], page.dtype).reshape(rows, *shape[1:])
        if page.predictor == 2:
            piece = np.cumsum(piece, axis=1, dtype=out.dtype)
        width = min(page.piece[1], page.width - left)
        out[top : top + rows, left : left + width, channel : channel + channels] = piece[:, :width]
    if page.photometric == _WHITE_IS_ZERO and out.dtype.kind == "u":
        out[..., 0] = np.iinfo(out.dtype).max - out[..., 0]
    return out[..., 0] if page.samples == 1 else out


def _plain(data: bytes, size: int) -> bytes:
    return data


def _deflate(data: bytes, size: int) -> bytes:
    try:
        return zlib.decompressobj().decompress(data, size)
    except zlib.error:
        raise DamagedTiffError("a piece is damaged") from None


def packbits(data: bytes, size: int) -> bytes:
    """Undo PackBits, up to so many bytes."""
    out, at = bytearray(), 0
    while at < len(data) and len(out) < size:
        head = data[at]
        if head < 128:
            out += data[at + 1 : at + 2 + head]
            at += 2 + head
        else:
            if head > 128:
                out += data[at + 1 : at + 2] * (257 - head)
            at += 2 if head > 128 else 1
    return bytes(out[:size])


def _lzw(data: bytes, size: int) -> bytes:
    """Undo LZW as TIFF has it: codes of 9 to 12 bits, the first bit highest."""
    out, table = bytearray(), []
    bits = held = 0
    width, before = 9, b""
    for byte in data:
        held, bits = (held << 8 | byte) & 0xFFFFFF, bits + 8
        if bits < width:
            continue
        bits -= width
        code = held >> bits & ((1 << width) - 1)
        if code == 257 or len(out) >= size:
            break
        if code == 256:
            table = [bytes([value]) for value in range(256)] + [b"", b""]
            width, before = 9, b""
            continue
        if not table or code > len(table) or (code == len(table) and not before):
            raise DamagedTiffError("a piece is damaged")
        entry = table[code] if code < len(table) else before + before[:1]
        out += entry
        if before and len(table) < 4096:
            table.append(before + entry[:1])
        before = entry
        width = min(12, max(9, (len(table) + 1).bit_length()))
    return bytes(out[:size])


_UNPACK: dict[int, Callable[[bytes, int], bytes]] = {
    1: _plain,
    5: _lzw,
    8: _deflate,
    32946: _deflate,
    32773: packbits,
}
