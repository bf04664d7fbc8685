"""How a stroke is dashed: the lengths of its dashes and of its gaps, where these are even."""

from __future__ import annotations

import numpy as np

from ..values import Array
from .lines import Lines

_FEWEST = 3  # gaps that make a line dashed
_UNEVEN = 0.4  # share that a gap may be longer or shorter than usual
_MOST = 0.7  # share of the gaps that are not


def dashes(bare: Array, points: Array, lines: Lines) -> list[tuple[float, float] | None]:
    """For each stroke how long its dashes and gaps are, px; None where it is not dashed.

    Args:
        bare: (N,) bool, samples in a gap. points: (N, 2) of the samples.
    """
    step = np.hypot(*np.diff(points, axis=0, append=points[-1:]).T)
    found: list[tuple[float, float] | None] = []
    for start, stop in zip(lines.start.tolist(), lines.stop.tolist(), strict=True):
        found.append(_even(bare[start:stop], step[start:stop]))
    return found


def _even(bare: Array, step: Array) -> tuple[float, float] | None:
    """The same for one line: samples in a gap, and px from each to the next."""
    if np.count_nonzero(bare) < _FEWEST:
        return None
    arc = np.concatenate([[0.0], np.cumsum(step[:-1])])
    flips = np.flatnonzero(bare[1:] != bare[:-1])
    where = (arc[flips] + arc[flips + 1]) / 2
    runs, gap = np.diff(where), bare[flips[:-1] + 1]  # those with both ends on the line
    gaps, marks = runs[gap], runs[~gap]
    if len(gaps) < _FEWEST or not len(marks):
        return None
    usual = float(np.median(gaps))
    if np.mean(np.abs(gaps - usual) <= _UNEVEN * usual) < _MOST:
        return None
    return float(np.median(marks)), usual
