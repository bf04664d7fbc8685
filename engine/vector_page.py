"""From a drawing that is vectors already to one of ours: its lines routed anew at every junction.

    SVG -> VectorPage -> PlanarGraph -> Routing -> Drawing

An SVG of shapes only, as tracers of outlines write them, is drawn as a picture and traced as one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import TypeGuard

import cv2
import numpy as np

from .drawing import Drawing
from .formats import read_text
from .formats.plot_paths import undoubled
from .formats.svg_lines import VectorPage, read_lines
from .graph.from_lines import graph_of_lines
from .routing import route
from .settings import Settings
from .values import Array, Scan

_PEN = 3.0  # working px that the middle one of all lines is made
_LONGEST = 8192.0  # working px of a page: bounds memory and time when all lines are hairlines
_PICTURE = (2048, 4096)  # px of the long side of a picture of shapes, at least and at most
_DARK = 90.0  # grey levels; darker shapes are solid blacks, lighter ones are left out
_SUB = 4  # binary digits of sub-pixel positions

Trace = Callable[[Array, Settings], Drawing]


def is_vector(source: object) -> TypeGuard[str | PathLike[str]]:
    """Whether a source is the path of an SVG, by its name."""
    return isinstance(source, str | PathLike) and Path(source).suffix.lower() == ".svg"


def drawing_of_vectors(path: Path, settings: Settings, trace: Trace) -> Drawing:
    """Route the lines of an SVG file.

    Args:
        trace: makes a drawing of a picture, for files of shapes only.

    Raises:
        InvoluteError: it can't be read, or there is no line in it.
    """
    page = read_lines(read_text(path), path.name)
    if page.lines:
        return _routed(page, settings)
    return _traced(page, settings, trace)


def _routed(page: VectorPage, settings: Settings) -> Drawing:
    pen = float(np.median(page.widths))
    scale = max(pen / _PEN, max(page.size) / _LONGEST)  # pixels of the page per working pixel
    colors = page.colors if settings.inks else np.zeros_like(page.colors)
    pieces = undoubled([line / scale for line in page.lines], _PEN)
    of = [number for number, _ in pieces]
    lines = [line for _, line in pieces]
    graph = graph_of_lines(lines, page.widths[of] / scale, page.strength[of], colors[of])
    solids = [rings for rings, color in page.areas if _gray(color) < _DARK] * settings.solids
    left_out = len(page.areas) - len(solids)
    notes = (f"{left_out} filled shapes were left out.",) if left_out else ()
    scan = Scan(np.zeros((1, 1), np.float32), None, scale, page.size, pen / scale, notes=notes)
    fills = [tuple((ring / scale).astype(np.float32) for ring in rings) for rings in solids]
    drawing = Drawing.from_routing(graph, route(graph, settings), scan, settings, fills)
    return replace(drawing, dpi=page.dpi)


def _traced(page: VectorPage, settings: Settings, trace: Trace) -> Drawing:
    """Draw the shapes, trace that, and bring it back to the pixels of the page."""
    longest = max(page.size)
    zoom = float(np.clip(longest, *_PICTURE)) / longest
    width, height = (max(16, round(side * zoom)) for side in page.size)
    picture: Array = np.full((height, width, 3), 255, np.uint8)
    for rings, color in page.areas:
        fixed = [np.round((ring * zoom - 0.5) * 2**_SUB).astype(np.int32) for ring in rings]
        cv2.fillPoly(picture, fixed, color, cv2.LINE_AA, _SUB)
    found = trace(picture, settings)
    shrink = np.float32(1 / found.scale)
    graph = found.graph.scaled(1 / found.scale)
    scan = Scan(
        np.zeros((1, 1), np.float32), None, found.scale / zoom, page.size, 1.0, notes=found.notes
    )
    fills = [tuple(ring * shrink for ring in fill) for fill in found.fills]
    drawing = Drawing.from_routing(graph, found.routing, scan, settings, fills)
    return replace(drawing, dpi=page.dpi, fidelity=found.fidelity, warnings=found.warnings)


def _gray(color: tuple[int, int, int]) -> float:
    red, green, blue = color
    return 0.299 * red + 0.587 * green + 0.114 * blue
