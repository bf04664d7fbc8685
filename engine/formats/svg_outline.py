"""SVG in which every stroke has its true, varying width: a filled shape beside its center line.

The shapes are in a layer per ink; the lines that they were made of, as in a plain SVG of ours, in a
hidden layer on top, from which Involute reads the drawing back.
"""

from __future__ import annotations

from pathlib import Path

from ..drawing import Drawing
from ..strokes.small_parts import layers_of
from ..values import Stroke
from . import svg
from .pen_shape import pen_shape
from .whole_file import write_text


def write(drawing: Drawing, path: Path) -> None:
    """Write a drawing as shapes to an SVG file."""
    lines = [*svg.opening(drawing), *svg.below(drawing)]
    for ink in layers_of(drawing):
        lines.append(svg.layer(ink.name, ' stroke="none" fill-rule="nonzero"'))
        lines += [_shape(number, drawing.strokes[number]) for number in ink.numbers]
        lines.append("</g>")
    lines.append(svg.layer("Center Lines", ' style="display:none" fill="none"'))
    lines += svg.center_lines(drawing)
    write_text("\n".join([*lines, "</g>", "</svg>", ""]), path)


def _shape(number: int, stroke: Stroke) -> str:
    opacity = float(stroke.opacity.mean())
    faded = f' fill-opacity="{opacity:.3g}"' if opacity < 1 else ""
    data = svg.rings(pen_shape(stroke))
    return f'<path data-outline="{number}" d="{data}" fill="#{bytes(stroke.color).hex()}"{faded}/>'
