"""One synthetic page of a rough drawing: its ink, and as targets the lines that it means.

Channels as those of a clean page, so that one loss and one loop serve both networks; what there is
of centerlines, junctions, ends and widths is that of the lines which are meant.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...synthesis import composed_pages, line_art
from ...synthesis.line_art import Array, Rng
from ...synthesis.media import sample
from ...synthesis.rough_drawings import RoughDrawing, rough_drawing
from .training_page import Layer, looked_at, page

# Kinds of pages and how often they are drawn. Clean ones stay as they are: whoever calls a clean
# page rough loses nothing.
KINDS = {"keyframe": 0.45, "sketch": 0.29, "hatched": 0.08, "clean": 0.18}
_CLEAN = ("paper", "paper", "digital", "many pens")
_DIGITAL = {"keyframe": 0.6, "sketch": 0.25, "hatched": 0.3}  # share that never was on paper
_STRAYS = 1.5  # times the spread of its strokes, that a line lies off the ink, and ...
_STRAYS_MOST = 9.0  # px at most


@dataclass(frozen=True, eq=False)
class RoughLibrary:
    """The true drawings, as pages of both kinds ask for them."""

    clean: line_art.Library
    training: composed_pages.Library
    held_out: composed_pages.Library

    @staticmethod
    def load(folder: Path) -> RoughLibrary:
        """Read the sets that a folder holds.

        Raises:
            FileNotFoundError: the folder holds none of them.
        """
        sides = [composed_pages.Library.load(folder, held_out) for held_out in (False, True)]
        return RoughLibrary(line_art.Library.load(folder), *sides)


def rough_page(
    rng: Rng, library: RoughLibrary, size: int, held_out: bool = False, kind: str | None = None
) -> Array:
    """A page as (10, size, size) uint8, channels as in `training_page.CHANNELS`; kind: of KINDS.

    The same generator state gives the same page.
    """
    if kind is None:
        kind = str(rng.choice(list(KINDS), p=list(KINDS.values())))
    if kind == "clean":
        return page(rng, library.clean, size, held_out, kind=str(rng.choice(_CLEAN)))
    drawing = rough_drawing(rng, library.held_out if held_out else library.training, kind, size)
    digital = bool(rng.random() < _DIGITAL[kind])
    return looked_at(rng, [_meant(drawing, size)], library.clean, size, held_out, digital)


def _meant(drawing: RoughDrawing, size: int) -> Layer:
    """The lines that a drawing means, as if a pen of its width had drawn them."""
    samples = sample(drawing.lines, size)
    half = np.full(len(samples), 0.5 * drawing.pen)
    strays = min(_STRAYS * drawing.spread, _STRAYS_MOST)
    return Layer(samples, half, drawing.ink, strays=strays)
