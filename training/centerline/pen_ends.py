"""Where the pen was lifted: a ridge that rises along the last px of every stroke to its end.

Sampled a few px from a junction or a corner it says of each half-branch by itself whether its
stroke ends there: of a T only the stem is lit, of two lines that cross none, of a corner where the
pen was lifted both sides, of one that it ran around neither.
"""

from __future__ import annotations

import numpy as np

from ...synthesis.line_art import Array
from ...synthesis.media import Samples, nearest

LIT = 10.0  # px before an end; a junction's own blot is about 3 px, corners are read to 10
LIT_PENS = 2.5  # half-widths at least: one of them lies under the line that the stroke ends on
LIT_SIGMA = 1.2  # px; wider than the centerline's, whose crest is found within a px
_MEET = 1.5  # px between the ends of a closed stroke
_CLOSED = 8.0  # px of stroke; shorter ones are dots
_TIP = 4.0  # px of a stroke whose ink says that its end can be seen
_INKED = 0.5  # share of them


def lit_ends(samples: Samples, half_width: Array, size: int, inked: Array | None = None) -> Array:
    """The (size, size) float32 map of the strokes that can be seen: 1 at an end, falling evenly
    to 0 over the last stretch before it, 0 on a stroke that goes on; short strokes are lit whole.

    Ends that the page cuts off, and ends without ink, are none. Nor is the seam of a closed stroke:
    one that meets itself at a corner looks there as at its other corners.

    Args:
        half_width: (N,) px of each sample. inked: (size, size) bool, where ink can be seen; None =
            wherever there are samples.
    """
    value = _values(samples, half_width, size, inked)
    lit = value > 0
    if not lit.any():
        return np.zeros((size, size), np.float32)
    distance, owner = nearest(samples.take(lit), np.zeros(lit.sum()), size, 4 * LIT_SIGMA)
    level = np.where(owner >= 0, value[lit][owner], 0)
    return (level * np.exp(-0.5 * (distance / LIT_SIGMA) ** 2)).astype(np.float32)


def _values(samples: Samples, half_width: Array, size: int, inked: Array | None) -> Array:
    """(N,) how near each sample is to an end that can be seen: 1 at it, 0 far away."""
    stroke = samples.stroke
    drawn = np.bincount(stroke)
    half = np.bincount(stroke, half_width) / np.maximum(drawn, 1)
    reach = np.maximum(LIT, LIT_PENS * half)[stroke]
    on_page = ((samples.position >= 0) & (samples.position < size)).all(1)
    seen = on_page
    if inked is not None:
        cell = np.clip(samples.position.astype(int), 0, size - 1)
        seen = on_page & inked[cell[:, 1], cell[:, 0]]
    open_ = ~_is_closed(samples, len(drawn))
    value = np.zeros(len(samples))
    for away in (samples.arc, samples.length - samples.arc):
        near = away < _TIP
        shown = np.bincount(stroke, near & seen, len(drawn))
        shown = shown >= _INKED * np.bincount(stroke, near, len(drawn))
        there = np.zeros(len(drawn), bool)
        there[stroke[(away < 1e-6) & on_page]] = True
        ends = (open_ & shown & there)[stroke]
        value = np.maximum(value, np.where(ends, 1 - away / reach, 0))
    return value


def _is_closed(samples: Samples, count: int) -> Array:
    """(S,) bool: both ends of a stroke lie upon each other."""
    first = np.full((count, 2), np.inf)
    last = np.full((count, 2), -np.inf)
    long = samples.length > _CLOSED
    for table, at in ((first, samples.arc < 1e-6), (last, samples.length - samples.arc < 1e-6)):
        table[samples.stroke[at & long]] = samples.position[at & long]
    return np.hypot(*(first - last).T) < _MEET
