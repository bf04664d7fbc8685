"""The flattened picture inside a PSD or PSB."""

from __future__ import annotations

import struct
import zlib

import numpy as np

from ..errors import InvoluteError
from ..values import Array
from .plain_tiff import packbits

_GRAY, _INDEXED, _RGB, _CMYK, _DUOTONE = 1, 2, 3, 4, 8
_NEEDED = {_GRAY: 1, _INDEXED: 1, _RGB: 3, _CMYK: 4, _DUOTONE: 1}  # channels of the color modes
_LARGEST = 20_000 * 20_000  # px
_VERSION_INFO = 1057  # resource that says whether there is a flattened picture at all


def read(data: bytes) -> Array | None:
    """The flattened picture, (H, W), (H, W, 3) or (H, W, 4), RGB; None when it is not whole.

    Raises:
        InvoluteError: it was saved without one; the name of the file is to be put before it.
    """
    try:
        return _read(memoryview(data))
    except (struct.error, zlib.error, ValueError):
        return None


def _read(data: memoryview) -> Array | None:
    version, channels, height, width, depth, mode = struct.unpack(">4xH6xHIIHH", data[:26])
    needed = _NEEDED.get(mode, 0)
    if version not in (1, 2) or depth not in (8, 16, 32) or not 0 < needed <= channels <= 56:
        return None
    if not 0 < width * height <= _LARGEST:
        return None
    colors, at = _block(data, 26)
    resources, at = _block(data, at)
    layers, at = _block(data, at, ">Q" if version == 2 else ">I")
    if not _has_picture(resources):
        raise InvoluteError(
            "the PSD holds no flattened picture; save it with 'Maximize Compatibility', or as PNG."
        )
    kept = needed + (channels > needed and _is_transparent(layers, version))
    (packing,) = struct.unpack(">H", data[at : at + 2])
    row = width * (depth // 8)
    raw = _unpacked(data[at + 2 :], packing, height, channels, row, version)
    if raw is None or len(raw) < kept * height * row:
        return None
    dtype = {8: ">u1", 16: ">u2", 32: ">f4"}[depth]
    planes = np.frombuffer(raw, dtype, kept * height * width).reshape(kept, height, width)
    return _as_rgb(planes.astype(planes.dtype.newbyteorder("=")), mode, needed, bytes(colors))


def _block(data: memoryview, at: int, layout: str = ">I") -> tuple[memoryview, int]:
    """A block with its length before it, and where the next begins."""
    size = struct.calcsize(layout)
    (length,) = struct.unpack(layout, data[at : at + size])
    if at + size + length > len(data):
        raise ValueError("a block reaches beyond the file")
    return data[at + size : at + size + length], at + size + length


def _has_picture(resources: memoryview) -> bool:
    at = 0
    while at + 12 <= len(resources):
        kind, name = struct.unpack(">4xHB", resources[at : at + 7])
        at += 6 + (name + 2) // 2 * 2
        content, at = _block(resources, at)
        at += len(content) % 2
        if kind == _VERSION_INFO and len(content) > 4:
            return bool(content[4])
    return True


def _is_transparent(layers: memoryview, version: int) -> bool:
    """Whether the first further channel is what shines through, not a selection that was kept."""
    head = 8 if version == 2 else 4
    return len(layers) >= head + 2 and struct.unpack(">h", layers[head : head + 2])[0] < 0


def _unpacked(
    data: memoryview, packing: int, height: int, channels: int, row: int, version: int
) -> bytes | None:
    """All planes of samples, one after the other."""
    total = channels * height * row
    if packing == 0:
        return bytes(data[:total])
    if packing == 1:
        counts = np.frombuffer(data, ">u4" if version == 2 else ">u2", channels * height)
        at, rows = counts.nbytes, []
        for count in counts.tolist():
            line = packbits(bytes(data[at : at + count]), row)
            rows.append(line.ljust(row, b"\0"))
            at += count
        return b"".join(rows) if at <= len(data) else None
    if packing == 2:
        return zlib.decompressobj().decompress(data, total)
    return None


def _as_rgb(planes: Array, mode: int, needed: int, colors: bytes) -> Array | None:
    color, alpha = planes[:needed], planes[needed:]
    if mode == _INDEXED:
        table = np.frombuffer(colors, np.uint8)
        if len(table) < 768 or planes.dtype != np.uint8:
            return None
        color = table[:768].reshape(3, 256)[:, color[0]]
    elif mode == _CMYK:  # stored as what is left of the paper's white
        most = 1.0 if planes.dtype.kind == "f" else np.iinfo(planes.dtype).max
        ink = color.astype(np.float32) / most
        color = (ink[:3] * ink[3] * most).astype(planes.dtype)
    if len(alpha):
        color = np.repeat(color, 3, 0) if len(color) == 1 else color
        return np.ascontiguousarray(np.concatenate([color, alpha]).transpose(1, 2, 0))
    return np.ascontiguousarray(color[0] if len(color) == 1 else color.transpose(1, 2, 0))
