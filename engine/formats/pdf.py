"""PDF in the size of the paper: shapes with the true widths, a layer per ink, a page per drawing.

A stroke of even width is a line with round ends, as a person would draw it in Illustrator; any
other is the filled shape that its pen leaves. Layers are PDF's optional content groups.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from pypdf import PageObject, PdfWriter
from pypdf.generic import (
    ArrayObject,
    DecodedStreamObject,
    DictionaryObject,
    FloatObject,
    IndirectObject,
    NameObject,
    TextStringObject,
)

from ..drawing import Drawing
from ..strokes.small_parts import layers_of
from ..values import Array, Stroke
from .areas import SOLIDS, area_layers
from .flatten import controls
from .pen_shape import pen_shape

_EVEN = 0.02  # share of its width by which a line may vary that is drawn as one
_POINTS_PER_MM = 72 / 25.4

Content = list[tuple[str, list[str]]]  # layers from below: name, and what is drawn


def write(drawing: Drawing, path: Path) -> None:
    """Write a drawing as a PDF of one page."""
    _write([drawing], path)


def write_sequence(name: str, frames: Iterable[tuple[int, Drawing]], path: Path) -> None:
    """Write the drawings of a sequence as the pages of one PDF; layers go through all of them."""
    _write((drawing for _, drawing in frames), path)


def _write(drawings: Iterable[Drawing], path: Path) -> None:
    document = PdfWriter()
    layers: dict[str, IndirectObject] = {}
    for drawing in drawings:
        _add_page(document, layers, drawing)
    if not document.pages:
        document.add_blank_page(1, 1)
    document.metadata = {"/Producer": "Involute"}
    groups = ArrayObject(layers.values())
    shown = DictionaryObject({NameObject("/Order"): groups, NameObject("/ON"): groups})
    document.root_object[NameObject("/OCProperties")] = DictionaryObject(
        {NameObject("/OCGs"): groups, NameObject("/D"): shown}
    )
    with open(path, "wb") as file:
        document.write(file)


def _add_page(document: PdfWriter, layers: dict[str, IndirectObject], drawing: Drawing) -> None:
    point = drawing.mm_per_px * _POINTS_PER_MM
    width, height = (side * point for side in drawing.size)
    page = document.add_blank_page(width, height)
    fades: dict[str, DictionaryObject] = {}
    names: dict[str, IndirectObject] = {}
    lines = [f"{point:.6g} 0 0 {-point:.6g} 0 {height:.6g} cm 1 J 1 j"]
    for name, drawn in _content(drawing, fades):
        if name not in layers:
            layers[name] = document._add_object(
                DictionaryObject(
                    {
                        NameObject("/Type"): NameObject("/OCG"),
                        NameObject("/Name"): TextStringObject(name),
                    }
                )
            )
        key = f"/L{len(names)}"
        names[key] = layers[name]
        lines += [f"/OC {key} BDC", *drawn, "EMC"]
    stream = DecodedStreamObject()
    stream.set_data("\n".join(lines).encode("ascii"))
    page[NameObject("/Contents")] = document._add_object(stream.flate_encode())
    _set_resources(page, {"/Properties": names, "/ExtGState": fades})


def _set_resources(page: PageObject, tables: dict[str, dict[str, Any]]) -> None:
    page[NameObject("/Resources")] = DictionaryObject(
        {
            NameObject(kind): DictionaryObject({NameObject(k): v for k, v in table.items()})
            for kind, table in tables.items()
        }
    )


def _content(drawing: Drawing, fades: dict[str, DictionaryObject]) -> Content:
    """What is on the page, layer by layer; strengths that are used go into `fades`."""
    content: Content = []
    for name, areas in area_layers(drawing).items():
        # Solid blacks are in the gray space, which converts to black ink alone.
        paints = ["0 g" if name == SOLIDS else f"{_color(color)} rg" for _, color in areas]
        shapes = zip(paints, areas, strict=True)
        content.append((name, [f"{paint} {_rings(area)} f*" for paint, (area, _) in shapes]))
    for ink in layers_of(drawing):
        drawn = [f"{_color(ink.color)} rg {_color(ink.color)} RG"]
        for number in ink.numbers:
            stroke = drawing.strokes[number]
            strength = round(float(stroke.opacity.mean()), 2)
            key = f"/G{strength * 100:.0f}"
            fades.setdefault(key, _fade(strength))
            drawn.append(f"{key} gs {_stroke(stroke)}")
        content.append((ink.name, drawn))
    return content


def _fade(strength: float) -> DictionaryObject:
    value = FloatObject(strength)
    return DictionaryObject({NameObject("/ca"): value, NameObject("/CA"): value})


def _stroke(stroke: Stroke) -> str:
    mean = float(stroke.widths.mean())
    if np.ptp(stroke.widths) > _EVEN * mean:
        return f"{_rings(pen_shape(stroke))} f"
    return f"{mean:.4g} w {_middle(stroke)} {'s' if stroke.closed else 'S'}"


def _middle(stroke: Stroke) -> str:
    if stroke.handles is None:
        return _polyline(stroke.points)
    points = controls(stroke)
    pattern = "%.10g %.10g m" + " %.10g %.10g %.10g %.10g %.10g %.10g c" * (len(points) // 3)
    return _numbers(pattern, points)


def _rings(rings: Sequence[Array]) -> str:
    return " ".join(f"{_polyline(ring)} h" for ring in rings)


def _polyline(points: Array) -> str:
    return _numbers("%.10g %.10g m" + " %.10g %.10g l" * (len(points) - 1), points)


def _numbers(pattern: str, points: Array) -> str:
    # Hundredths of a pixel; rounding first keeps exponents out, which PDF does not know.
    numbers = np.round(points.astype(np.float64), 2) + 0.0
    return pattern % tuple(numbers.ravel().tolist())


def _color(color: Sequence[int]) -> str:
    return " ".join(f"{value / 255:.3g}" for value in color)
