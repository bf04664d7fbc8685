"""SVG for pen plotters, in mm: a layer per pen, the center lines in few long paths without doubles.

Names of layers begin with a number, as AxiDraw's software and vpype ask. Solid areas are outlined
and hatched with the pen that draws the most lines.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..drawing import Drawing
from ..strokes.simplify import simplify
from ..strokes.small_parts import layers_of
from ..values import Array
from . import svg
from .areas import SOLIDS
from .flatten import outline
from .plot_paths import hatched, in_short_order, joined, without_doubles
from .whole_file import write_text

_FLAT = 0.02  # mm; what a plotter of this class can't show
_HATCH = 0.8  # pen widths from line to line, so that they overlap


def write(drawing: Drawing, path: Path) -> None:
    """Write the lines of a drawing to an SVG file for plotters."""
    mm = drawing.mm_per_px
    lines = svg.opening(drawing, "mm", mm)
    number = 0
    for ink in layers_of(drawing):
        number += 1
        strokes = [drawing.strokes[k] for k in ink.numbers]
        pen = float(np.median([stroke.widths.mean() for stroke in strokes]))
        paths = joined(without_doubles([outline(s) for s in strokes], pen), pen)
        lines += _layer(f"{number} {ink.name}", paths, ink.color, pen, mm)
    if drawing.fills:
        widths = [s.widths.mean() for s in drawing.strokes]
        pen = float(np.median(widths)) if widths else 1.0
        paths = [np.concatenate([ring, ring[:1]]) for fill in drawing.fills for ring in fill]
        for fill in drawing.fills:
            paths += hatched(fill, _HATCH * pen)
        lines += _layer(f"{number + 1} {SOLIDS}", paths, (0, 0, 0), pen, mm)
    write_text("\n".join([*lines, "</svg>", ""]), path)


def _layer(
    name: str, paths: list[Array], color: tuple[int, int, int], pen: float, mm: float
) -> list[str]:
    mark = f' fill="none" stroke="#{bytes(color).hex()}" stroke-width="{pen * mm:.3g}"'
    mark += ' stroke-linecap="round" stroke-linejoin="round"'
    drawn = [f'<path d="{svg.polyline(_plain(line * mm))}"/>' for line in in_short_order(paths)]
    return [svg.layer(name, mark), *drawn, "</g>"]


def _plain(line: Array) -> Array:
    """A polyline without points that a plotter can't show."""
    ends = np.zeros(len(line), bool)
    ends[[0, -1]] = True
    middle = len(line) // 2
    ends[middle] = True  # of a closed line both ends are one place
    return line[simplify(line.astype(np.float64), ends, _FLAT)]
