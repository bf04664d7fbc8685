"""Targa pictures, as RETAS and OpenToonz write them: with or without runs, 8 to 32 bits."""

from __future__ import annotations

import struct

import numpy as np

from ..values import Array

_HEAD = 18
_INDEXED, _TRUE, _GRAY, _RUNS = 1, 2, 3, 8  # kinds of pictures; + _RUNS = in runs


def read(data: bytes) -> Array | None:
    """A Targa picture, (H, W) or (H, W, 3 or 4) uint8, RGB; None when it is not a whole one."""
    if len(data) < _HEAD:
        return None
    name, has_map, kind, first, count, map_bits, _, _, width, height, bits, how = struct.unpack(
        "<BBBHHBHHHHBB", data[:_HEAD]
    )
    packed, plain = kind & _RUNS, kind & ~_RUNS
    sizes = {_INDEXED: (8,), _TRUE: (15, 16, 24, 32), _GRAY: (8,)}.get(plain, ())
    if bits not in sizes or not width * height or has_map > 1:
        return None
    map_size = (map_bits + 7) // 8
    start = _HEAD + name + (count * map_size if has_map else 0)
    size = (bits + 7) // 8
    raw = data[start:]
    pixels = _runs(raw, size, width * height) if packed else raw[: width * height * size]
    if pixels is None or len(pixels) < width * height * size:
        return None
    values = np.frombuffer(pixels, np.uint8).reshape(height * width, size)
    if plain == _INDEXED:
        if not has_map or map_bits not in (15, 16, 24, 32):
            return None
        colors = np.frombuffer(data, np.uint8, count * map_size, _HEAD + name)
        at = values[:, 0].astype(int) - first
        if not count or at.min() < 0 or at.max() >= count:
            return None
        values = colors.reshape(count, map_size)[at]
    picture = _colors(values, how & 15).reshape(height, width, -1)
    if not how & 32:  # rows run upward
        picture = picture[::-1]
    if how & 16:
        picture = picture[:, ::-1]
    return np.ascontiguousarray(picture[..., 0] if picture.shape[2] == 1 else picture)


def _runs(data: bytes, size: int, count: int) -> bytes | None:
    """Pixels out of runs and literal stretches."""
    if count > 128 * len(data):
        return None
    out, at, total = bytearray(), 0, count * size
    while len(out) < total:
        if at >= len(data):
            return None
        many = (data[at] & 127) + 1
        if data[at] & 128:
            out += data[at + 1 : at + 1 + size] * many
            at += 1 + size
        else:
            out += data[at + 1 : at + 1 + size * many]
            at += 1 + size * many
    return bytes(out[:total])


def _colors(values: Array, alpha_bits: int) -> Array:
    """(N, bytes) as they lie in the file -> (N, 1, 3 or 4) grey, RGB or RGBA."""
    if values.shape[1] == 2:
        both = values[:, 0].astype(np.uint16) | values[:, 1].astype(np.uint16) << 8
        channels = [both >> shift & 31 for shift in (10, 5, 0)]
        return np.stack([(c * 255 + 15) // 31 for c in channels], 1).astype(np.uint8)
    if values.shape[1] == 1:
        return values
    rgb = values[:, 2::-1]
    # Many programs leave the fourth byte zero and mean nothing by it.
    if values.shape[1] == 4 and alpha_bits and values[:, 3].any():
        return np.concatenate([rgb, values[:, 3:]], 1)
    return rgb
