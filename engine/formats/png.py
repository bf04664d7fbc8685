"""A picture to check a drawing by eye: every stroke in a colour of its own, junctions ringed."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np

from ..drawing import Drawing
from ..errors import InvoluteError
from ..values import Array
from .flatten import outline
from .whole_file import write_bytes

_LONGEST = 4096  # px; larger pages are drawn smaller
_SUB = 4  # binary digits of sub-pixel positions


def write(drawing: Drawing, path: Path) -> None:
    """Write the preview of a drawing to a PNG file."""
    ok, data = cv2.imencode(".png", render(drawing)[..., ::-1])
    if not ok:
        raise InvoluteError(f"Can't make a picture of {drawing.size} px; use .svg instead.")
    write_bytes(data.tobytes(), path)


def render(drawing: Drawing, paper: Array | None = None, *, rings: bool = True) -> Array:
    """Draw the strokes, each in its own colour, with a ring at every junction.

    The rings go from green (certain) over yellow to red (doubtful); blue = locked by the user.

    Args:
        drawing: what to draw.
        paper: (h, w, 3) uint8 RGB to show faded underneath, or None for white.
        rings: show the junctions.

    Returns:
        (h, w, 3) uint8 RGB; the size of the input, or less when that is over 4096 px.
    """
    width, height = drawing.size
    zoom = min(1.0, _LONGEST / max(width, height))
    shape = (max(1, round(height * zoom)), max(1, round(width * zoom)))
    over = 2 if max(shape) <= 2048 else 1  # thin lines keep their width when drawn twice as large
    canvas: Array = np.full((shape[0] * over, shape[1] * over, 3), 255, np.uint8)
    if paper is not None:
        faded = cv2.resize(paper, canvas.shape[1::-1], interpolation=cv2.INTER_AREA)
        canvas = cv2.addWeighted(faded, 0.3, canvas, 0.7, 0)
    scale = zoom * over
    for fill in drawing.fills:
        cv2.fillPoly(
            canvas, [_fixed(ring, scale) for ring in fill], (90, 90, 90), cv2.LINE_AA, _SUB
        )
    for index, stroke in enumerate(drawing.strokes):
        line = [_fixed(outline(stroke), scale)]
        thick = _thickness(float(stroke.widths.mean()) * scale)
        cv2.polylines(canvas, line, False, _color(index), thick, cv2.LINE_AA, _SUB)
    if over > 1:
        canvas = cv2.resize(canvas, shape[::-1], interpolation=cv2.INTER_AREA)
    radius = round(_ring_radius(drawing) * zoom * 2**_SUB)
    for junction in drawing.junctions if rings else ():
        center = _fixed(np.array([junction.position]), zoom)[0]
        color = (40, 90, 255) if junction.locked else _doubt_color(junction.doubt)
        cv2.circle(canvas, center.tolist(), radius, color, 1, cv2.LINE_AA, _SUB)
    return canvas


def _fixed(points: Array, scale: float) -> Array:
    """Coordinates as OpenCV draws them: pixel centres on whole numbers, fixed point."""
    return np.round((np.asarray(points) * scale - 0.5) * 2**_SUB).astype(np.int32)


def _thickness(width: float) -> int:
    """OpenCV's thickness for a true width: its 1 is 1.4 px wide, its 2 is 3.4, its 3 is 5.5."""
    step = round((width - 1.4) / 2.08)
    return (1, 2)[max(0, step)] if step < 2 else 2 * step - 1


def _color(index: int) -> tuple[int, int, int]:
    """Well apart for neighbouring numbers: hues by the golden angle, three brightnesses."""
    hue = index * 0.618034 % 1.0
    wheel = np.abs((hue * 6.0 + np.array([0.0, 4.0, 2.0])) % 6.0 - 3.0) - 1.0
    rgb = np.clip(wheel, 0.0, 1.0) * (0.9, 0.7, 0.55)[index % 3]
    # Yellow and cyan vanish on white: darken what the eye sees as bright.
    rgb *= min(1.0, 0.5 / max(float(rgb @ [0.3, 0.59, 0.11]), 1e-3))
    red, green, blue = (rgb * 255).round().astype(int).tolist()
    return red, green, blue


def _doubt_color(doubt: float) -> tuple[int, int, int]:
    worry = min(1.0, doubt / 0.5)
    return round(255 * min(1.0, 2 * worry)), round(170 * min(1.0, 2 - 2 * worry)), 0


def _ring_radius(drawing: Drawing) -> float:
    widths = drawing.graph.widths
    pen = float(np.median(widths)) if widths is not None and len(widths) else 2.0
    return max(4.0, 1.6 * pen)
