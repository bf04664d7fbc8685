"""PLI: a vector level of OpenToonz and Tahoma2D, strokes as center lines with thickness.

A level holds the drawings of a sequence by their numbers, and a palette with a style per ink. The
layout was learnt from OpenToonz 1.7's own reader (`pli_io`, `tiio_pli`); nothing is copied. A file
is a head, then tags: a byte with the kind and how long its length is, the length, the content. All
is little-endian; whole numbers of a tag have as many bytes as the last SET_DATA tag says, their
highest bit is the sign. Tags refer to others by their place in the file.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from ..drawing import Drawing
from ..strokes.small_parts import layers_of
from ..values import Array, Stroke
from .areas import SOLIDS
from .flatten import outline, widths_along
from .whole_file import write_bytes

# Kinds of tags.
_END, _WIDE, _UNUSED, _GROUP, _IMAGE, _COLOR, _STYLE = 0, 3, 11, 14, 16, 17, 20
_CHAIN, _IMAGE_BEGIN, _LOOP, _PRECISION = 10, 22, 23, 25
_PALETTE, _SOLID, _OF_STROKE = 5, 1, 3  # kinds of groups, of styles, and of what they are for
_BYTE, _INT, _STRING = 1, 2, 6  # kinds of values in a style
_SOLID_STYLE = 3  # OpenToonz's number for a plain color

_VERSION = (71, 0)  # what OpenToonz 1.2 to 1.7 write, and every Tahoma2D reads
_INCH = 53.33333  # units of a level, on which its grid and camera rest
_PRECISE = 128 * 128  # steps of a unit, OpenToonz's own
_MOST_FRAME = 65_535
_PER_CURVE = 8  # quadratic pieces for a Bezier segment; half a pixel in the sharpest of them
_CORNER = float(np.cos(np.radians(40.0)))  # a turn of more than this is a corner, and stays one
_INFLECTED = 1e-3  # of the chord: tangents that meet closer than this to its ends are of no use


def write(drawing: Drawing, path: Path) -> None:
    """Write a drawing as a level of one drawing, number 1."""
    write_sequence(path.stem, [(1, drawing)], path)


def write_sequence(name: str, frames: Iterable[tuple[int, Drawing]], path: Path) -> None:
    """Write the drawings of a sequence as a level; each has the number of its frame."""
    images: list[tuple[int, list[tuple[int, Stroke]], Drawing]] = []
    styles: dict[str, tuple[int, int, int]] = {}
    shift = 0
    for frame, drawing in frames:
        if not images:
            shift = max(0, 1 - frame)  # drawings of a level count from 1
        strokes = []
        for ink in layers_of(drawing):
            style = _style(styles, ink.name, ink.color)
            strokes += [(style, drawing.strokes[number]) for number in ink.numbers]
        if drawing.fills:
            style = _style(styles, SOLIDS, (0, 0, 0))
            strokes += [(style, _border(ring)) for fill in drawing.fills for ring in fill]
        images.append((min(frame + shift, _MOST_FRAME), strokes, drawing))
    file = _File(len(images))
    file.palette(styles)
    for frame, strokes, drawing in images:
        file.image(frame, strokes, drawing)
    write_bytes(file.finished(), path)


def _style(styles: dict[str, tuple[int, int, int]], name: str, color: tuple[int, int, int]) -> int:
    """The number of an ink's style, from 1; an ink keeps its style through a sequence."""
    for number, known in enumerate(styles.values()):
        if known == color:
            return number + 1
    while name in styles:
        name += "'"
    styles[name] = color
    return len(styles)


def _border(ring: Array) -> Stroke:
    """The border of a solid area as a thin closed stroke."""
    count = len(ring)
    return Stroke(
        points=ring,
        widths=np.ones(count, np.float32),
        opacity=np.ones(count, np.float32),
        closed=True,
        color=(0, 0, 0),
        branches=np.zeros(1, np.int32),
    )


class _File:
    """The bytes of a level as they grow; each tag gives its place."""

    def __init__(self, images: int) -> None:
        creator = b"Involute"
        self._data = bytearray(b"PLIM" + bytes(_VERSION))
        self._data += struct.pack("<H", len(creator)) + creator
        self._length_at = len(self._data)
        # Sign and hundredths of the usual tolerance of gaps when areas are filled, 1.15.
        self._data += struct.pack("<IH3B", 0, images, 2, 1, 15)

    def finished(self) -> bytes:
        """The whole file."""
        self._tag(_UNUSED, b"END")  # read by nobody: shows that the file was not cut short
        self._data.append(_END)
        struct.pack_into("<I", self._data, self._length_at, len(self._data))
        return bytes(self._data)

    def palette(self, styles: dict[str, tuple[int, int, int]]) -> None:
        """The styles, on one page."""
        places = [self._tag(_STYLE, struct.pack("<HH", 0, 0) + _text("Inks"))]
        for number, (name, color) in enumerate(styles.items()):
            channels = b"".join(bytes((_BYTE, value)) for value in (*color, 255))
            kind = struct.pack("<BHH", _INT, _SOLID_STYLE, 0)  # whole part and fraction
            head = struct.pack("<HH", number + 1, 0)
            places.append(self._tag(_STYLE, head + _text(name) + kind + channels))
        self._data.append(_WIDE)
        self._tag(_GROUP, struct.pack(f"<B{len(places)}I", _PALETTE, *places))

    def image(self, frame: int, strokes: Sequence[tuple[int, Stroke]], drawing: Drawing) -> None:
        """A drawing: its strokes, each style said before the first stroke that has it."""
        number = struct.pack("<HB", frame, 0)
        self._tag(_IMAGE_BEGIN, number)
        self._data.append(_WIDE)  # readers count on such a tag in this place
        places = [self._tag(_PRECISION, struct.pack("<I", _PRECISE))]
        unit = drawing.mm_per_px / 25.4 * _INCH
        middle = np.array(drawing.size) / 2
        current = 0
        for style, stroke in strokes:
            if style != current:
                color = struct.pack("<BBI", _SOLID, _OF_STROKE, style)
                places.append(self._tag(_COLOR, color))
                current = style
            chain = _chain(stroke, middle, unit)
            places.append(self._tag(_LOOP if stroke.closed else _CHAIN, chain))
        self._tag(_IMAGE, number + struct.pack(f"<{len(places)}I", *places))

    def _tag(self, kind: int, content: bytes) -> int:
        place, size = len(self._data), len(content)
        wide, pattern = (1, "<BB") if size < 256 else (2, "<BH") if size < 65_535 else (3, "<BI")
        self._data += struct.pack(pattern, kind | wide << 6, size) + content
        return place


def _text(text: str) -> bytes:
    data = text.encode("utf-8")
    return struct.pack("<BH", _STRING, len(data)) + data


def _chain(stroke: Stroke, middle: Array, unit: float) -> bytes:
    """A stroke as a chain of quadratic curves: point, then control point and point by turns."""
    points, controls = _quadratics(stroke)
    line = np.empty((2 * len(points) - 1, 2))
    line[::2], line[1::2] = points, controls
    widths = _widths(stroke, len(points))
    thick = np.empty(len(line))
    thick[::2] = widths / 2
    thick[1::2] = (thick[:-2:2] + thick[2::2]) / 2
    # Half the width is a level's thickness; y runs up from the middle of the page.
    steps = np.round((line - middle) * (unit, -unit) * _PRECISE).astype(np.int64)
    most = min(int(np.ceil(thick.max() * unit)), 255)
    shares = np.clip(np.round(thick * unit * 255 / most), 0, 255).astype(np.uint8)
    steps[1:] = np.diff(steps, axis=0)
    signed = np.abs(steps) | np.where(steps < 0, 1 << 31, 0)
    rows = np.zeros(len(line), [("x", "<u4"), ("y", "<u4"), ("thick", "u1")])
    rows["x"], rows["y"], rows["thick"] = signed[:, 0], signed[:, 1], shares
    return bytes((most,)) + rows.tobytes()


def _widths(stroke: Stroke, count: int) -> Array:
    """Full widths at the points of the chain, px."""
    widths = widths_along(stroke).astype(np.float64)
    return np.interp(np.linspace(0, len(widths) - 1, count), np.arange(len(widths)), widths)


def _quadratics(stroke: Stroke) -> tuple[Array, Array]:
    """Points (N, 2) of a smooth chain through the stroke, and the control points between them.

    A control point lies where the tangents of its two points meet; where they don't, as around an
    inflection or beside a corner, in the middle: the piece is straight.
    """
    line = outline(stroke).astype(np.float64)
    if len(line) < 2 or (stroke.closed and len(line) < 3):
        line = np.concatenate([line, line[-1:]])
    length = np.maximum(np.hypot(*np.diff(line, axis=0).T), 1e-9)
    way = np.diff(line, axis=0) / length[:, None]
    before, after = np.vstack([way[:1], way]), np.vstack([way, way[-1:]])
    if stroke.closed:
        before[0], after[-1] = way[-1], way[0]
    # The nearer neighbour says more about the direction at a point.
    near = 1 / np.concatenate([length[:1], length])
    far = 1 / np.concatenate([length, length[-1:]])
    tangent = before * near[:, None] + after * far[:, None]
    tangent /= np.maximum(np.hypot(*tangent.T), 1e-9)[:, None]
    corner = ((before * after).sum(1) < _CORNER)[:, None]
    kept = slice(None, None, 1 if stroke.handles is None else 16 // _PER_CURVE)
    leaving = np.where(corner, after, tangent)[kept][:-1]
    coming = np.where(corner, before, tangent)[kept][1:]
    line = line[kept]
    step = np.diff(line, axis=0)
    length = np.hypot(*step.T)
    across = leaving[:, 0] * coming[:, 1] - leaving[:, 1] * coming[:, 0]
    safe = np.where(np.abs(across) < 1e-6, np.inf, across)
    a = (step[:, 0] * coming[:, 1] - step[:, 1] * coming[:, 0]) / safe
    b = (leaving[:, 0] * step[:, 1] - leaving[:, 1] * step[:, 0]) / safe
    meets = (np.minimum(a, b) > _INFLECTED * length) & (np.maximum(a, b) < length)
    middle = (line[:-1] + line[1:]) / 2
    return line, np.where(meets[:, None], line[:-1] + a[:, None] * leaving, middle)
