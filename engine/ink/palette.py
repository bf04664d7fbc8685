"""The few inks of a page: every stroke takes the exact colour of one of them.

Colours are told apart by their hue, pencil under black ink by its strength.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..values import Array, PlanarGraph
from .hue_peaks import hue_peaks, turn
from .pencil import pencil
from .tint import NEUTRAL, branch_colors, chroma_and_hue, tint

Color = tuple[int, int, int]

_BLACK = 110.0  # grey value below which a neutral ink is simply black
_PENCIL = (130.0, 190.0)  # grey values of pencil under ink, so that it looks like that
_SMALLEST = 8.0  # pen widths of line that an ink of its own must have


@dataclass(frozen=True, eq=False)
class Inks:
    """palette: sRGB of each ink; ink: (B,) which one a branch is drawn in."""

    palette: tuple[Color, ...]
    ink: Array

    @classmethod
    def black(cls, branches: int) -> Inks:
        """One black ink for everything."""
        return cls(((0, 0, 0),), np.zeros(branches, np.int64))

    @classmethod
    def of(cls, graph: PlanarGraph, length: Array, pen: float) -> Inks:
        """Find the inks of a page.

        Args:
            length: (B,) px of each branch; pen: px.
        """
        if graph.branch_count == 0:
            return cls.black(0)
        weight = length + 1e-6
        palette, ink = _colored(graph, weight, pen)
        faint, strength = pencil(graph, ink == 0, length)
        if faint.any():
            ink[faint] = len(palette)
            if graph.colors is not None:
                color = branch_colors(graph)
                palette[0] = _neutral(color[ink == 0], weight[ink == 0])
            grey = round(float(np.interp(1 - strength, (0, 1), _PENCIL)))
            palette.append((grey, grey, grey))
        return cls(tuple(palette), ink)

    def color_of(self, branches: Array, length: Array) -> Color:
        """The ink in which most of a stroke is drawn; `length` of each of the branches."""
        total = np.bincount(self.ink[branches], length, minlength=len(self.palette))
        return self.palette[int(total.argmax())]


def _colored(graph: PlanarGraph, weight: Array, pen: float) -> tuple[list[Color], Array]:
    """The palette by hue, what is black or grey first; and (B,) which of it each branch is."""
    ink = np.zeros(graph.branch_count, np.int64)
    if graph.colors is None:
        return [(0, 0, 0)], ink
    color = branch_colors(graph)
    chroma, hue = chroma_and_hue(tint(color))
    peaks = hue_peaks(hue, np.where(chroma > NEUTRAL, weight, 0.0), _SMALLEST * pen)
    if len(peaks):
        apart = np.abs(turn(hue[:, None] - peaks))
        ink = np.where(chroma > NEUTRAL, apart.argmin(1) + 1, 0)
    palette = [_neutral(color[ink == 0], weight[ink == 0])]
    palette += [_typical(color[ink == k], weight[ink == k]) for k in range(1, len(peaks) + 1)]
    return palette, ink


def _typical(color: Array, weight: Array) -> Color:
    """The weighted median of the darker half: where the pen touched the paper fully."""
    if not len(color):
        return (0, 0, 0)
    grey = color.mean(1)
    order = np.argsort(grey, kind="stable")
    reach = np.cumsum(weight[order])
    dark = order[: np.searchsorted(reach, reach[-1] / 2) + 1]
    red, green, blue = (round(_weighted_median(color[dark, c], weight[dark])) for c in range(3))
    return red, green, blue


def _neutral(color: Array, weight: Array) -> Color:
    """Black, or the grey of a pencil."""
    grey = round(float(np.mean(_typical(color, weight))))
    return (0, 0, 0) if grey < _BLACK else (grey, grey, grey)


def _weighted_median(values: Array, weight: Array) -> float:
    order = np.argsort(values, kind="stable")
    reach = np.cumsum(weight[order])
    return float(values[order[np.searchsorted(reach, reach[-1] / 2)]])
