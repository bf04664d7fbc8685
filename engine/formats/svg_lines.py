"""The lines of any SVG, whoever made it: what Illustrator, Inkscape or another tracer has written.

Shapes of every kind, curves, transforms, units and styles are svgelements' to understand. A shape
with a stroke is a line; a filled one without is an area.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import InvoluteError
from ..values import Array

NEEDS = ("svgelements", "svgelements==1.9.6")
_PPI = 96.0  # SVG's pixels per inch
_UNITS = ("mm", "cm", "in", "pt", "pc", "Q")  # of a page that has a real size
_FINEST, _COARSEST = 4, 64  # pieces of a curve
_CHORDS = 400  # of the page's long side: a piece of a curve is about as long


@dataclass(frozen=True, eq=False)
class VectorPage:
    """What is drawn on a page of vectors, in its pixels.

    size: width and height.
    dpi: pixels per inch where the file says how large the page is; None = it does not say.
    lines: (N, 2) float64 each; closed ones end where they begin.
    widths, strength: (L,). colors: (L, 3) uint8.
    areas: the rings (N, 2) of each filled shape, and its color; from the lowest up.
    """

    size: tuple[int, int]
    dpi: float | None
    lines: tuple[Array, ...]
    widths: Array
    strength: Array
    colors: Array
    areas: tuple[tuple[tuple[Array, ...], tuple[int, int, int]], ...]


def read_lines(text: str, name: str) -> VectorPage:
    """Understand the text of an SVG.

    Raises:
        InvoluteError: it is none, or there is nothing in it.
    """
    if "<!ENTITY" in text:  # they can blow up a small file
        raise InvoluteError(f"{name} declares entities; save it as plain SVG first.")
    try:
        import svgelements
    except ImportError:
        raise InvoluteError(
            f"Reading {name} needs the library svgelements; install Involute with its extra "
            f"'exchange', or {NEEDS[1]} with pip into the Python that runs it."
        ) from None
    try:
        document = svgelements.SVG.parse(io.StringIO(text), reify=True, ppi=_PPI)
        found = list(_shapes(document, svgelements))
        size = (float(document.width), float(document.height))
    except (ArithmeticError, AttributeError, LookupError, SyntaxError, TypeError, ValueError) as e:
        raise InvoluteError(f"{name} isn't an SVG that can be read ({e}); save it anew.") from None
    if not found:
        raise InvoluteError(f"There is no line in {name}; pictures inside of an SVG are not read.")
    if not all(1 <= side <= 1e6 for side in size):
        size = _extent([line for lines, *_ in found for line in lines])
    step = max(size) / _CHORDS
    page: tuple[list[Any], ...] = ([], [], [], [], [])
    for rings, width, color, strength, fill in found:
        lines = [_flat(ring, step) for ring in rings]
        lines = [line for line in lines if len(line) > 1 and np.isfinite(line).all()]
        if width > 0:
            for line in lines:
                for column, value in zip(page, (line, width, color, strength), strict=False):
                    column.append(value)
        elif fill is not None and lines:
            page[4].append((tuple(lines), fill))
    real = str(document.values.get("attributes", {}).get("width", "")).strip().endswith(_UNITS)
    return VectorPage(
        (max(1, round(size[0])), max(1, round(size[1]))),
        _PPI if real else None,
        tuple(page[0]),
        np.array(page[1], np.float32),
        np.array(page[3], np.float32),
        np.array(page[2], np.uint8).reshape(-1, 3),
        tuple(page[4]),
    )


Rings = list[list[Array]]  # each ring its cubic Bezier segments, (4, 2)


def _shapes(
    document: Any, svgelements: Any
) -> Iterator[tuple[Rings, float, tuple[int, int, int], float, tuple[int, int, int] | None]]:
    """The rings of each shape, its stroke's width (0 = none), colour and strength, and its fill."""
    for element in document.elements():
        if not isinstance(element, svgelements.Shape):
            continue
        if element.values.get("visibility") == "hidden":
            continue
        path = abs(svgelements.Path(element))
        path.approximate_arcs_with_cubics()
        rings = [ring for part in path.as_subpaths() if (ring := list(_segments(part)))]
        stroke, fill = element.stroke, element.fill
        drawn = stroke is not None and stroke.value is not None and stroke.opacity > 0
        width = float(element.stroke_width or 0) if drawn else 0.0
        color = (stroke.red, stroke.green, stroke.blue) if drawn else (0, 0, 0)
        filled = fill is not None and fill.value is not None and fill.opacity > 0
        if rings:
            inside = (fill.red, fill.green, fill.blue) if filled else None
            yield rings, width, color, float(stroke.opacity) if drawn else 1.0, inside


def _segments(part: Any) -> Iterator[Array]:
    for segment in part:
        start, end = segment.start, segment.end
        kind = type(segment).__name__
        if kind == "Move" or start is None or end is None:
            continue
        if kind == "CubicBezier":
            points = [start, segment.control1, segment.control2, end]
        elif kind == "QuadraticBezier":
            control = segment.control
            points = [
                start,
                start + (control - start) * (2 / 3),
                end + (control - end) * (2 / 3),
                end,
            ]
        else:
            points = [start, start, end, end]
        yield np.array([[point.x, point.y] for point in points])


def _flat(ring: list[Array], step: float) -> Array:
    """The polyline of Bezier segments."""
    pieces = [ring[0][:1]]
    for a, b, c, d in ring:
        if np.array_equal(a, b) and np.array_equal(c, d):
            pieces.append(d[None])
            continue
        reach = np.hypot(*(b - a)) + np.hypot(*(c - b)) + np.hypot(*(d - c))
        count = int(np.clip(np.ceil(reach / step), _FINEST, _COARSEST))
        t = np.linspace(0, 1, count + 1)[1:, None]
        u = 1 - t
        pieces.append(u**3 * a + 3 * u**2 * t * b + 3 * u * t**2 * c + t**3 * d)
    return np.concatenate(pieces)


def _extent(rings: list[list[Array]]) -> tuple[float, float]:
    points = np.concatenate([np.concatenate(ring) for ring in rings])
    width, height = np.maximum(points.max(0), 1.0).tolist()
    return width, height


__all__ = ["VectorPage", "read_lines"]
