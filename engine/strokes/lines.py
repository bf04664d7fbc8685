"""All strokes of a drawing laid end to end, so that each step runs over all of them at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .page import Page
from .walk import Walk

Array = np.ndarray


@dataclass(frozen=True, eq=False)
class Lines:
    """Strokes as runs of samples; a closed stroke is continued round its seam on both sides.

    sample: (N,) index into the samples of the page.
    first, last: (N,) index of the first and last sample of the run that each sample is in.
    joint: (N,) bool; a vertex of the graph that the stroke runs through.
    start: (S,) where the stroke itself begins in its run, and
    stop: (S,) one past its last sample; the sample there repeats the first for closed strokes.
    """

    sample: Array
    first: Array
    last: Array
    joint: Array
    start: Array
    stop: Array

    @classmethod
    def of(cls, page: Page, walks: Sequence[Walk], margin: int) -> Lines:
        """Gather the samples of walks; `margin`: how far closed strokes are continued."""
        half = np.concatenate([np.array(w.halves, np.int64) for w in walks])
        steps = np.array([len(w.halves) for w in walks])
        closed = np.array([w.closed for w in walks])
        count = np.diff(page.offsets)[half >> 1] - 1  # the last sample is the next one's first
        inside = _ramp(count)
        of_half = np.repeat(np.arange(len(half)), count)
        backward = (half & 1)[of_half] == 1
        branch = half[of_half] >> 1
        sample = np.where(
            backward, page.offsets[branch + 1] - 1 - inside, page.offsets[branch] + inside
        )
        joint = inside == 0
        size = np.add.reduceat(count, np.concatenate([[0], np.cumsum(steps)[:-1]]))
        origin = np.concatenate([[0], np.cumsum(size)[:-1]])

        # One more sample at the end of an open stroke; for a closed one the first again.
        final = half[np.cumsum(steps) - 1]
        tip = np.where(final & 1, page.offsets[final >> 1], page.offsets[(final >> 1) + 1] - 1)
        before = np.where(closed, margin, 0)
        total = size + 1 + 2 * before
        run = np.repeat(np.arange(len(walks)), total)
        place = _ramp(total) - before[run]
        at_tip = ~closed[run] & (place == size[run])
        source = origin[run] + np.where(at_tip, 0, place % size[run])
        begin = np.cumsum(total) - total
        return cls(
            sample=np.where(at_tip, tip[run], sample[source]),
            first=begin[run],
            last=(begin + total - 1)[run],
            joint=joint[source] & (closed[run] | ((place > 0) & ~at_tip)),
            start=begin + before,
            stop=begin + before + size + 1,
        )


def _ramp(count: Array) -> Array:
    """0, 1, ..., count[0] - 1, 0, 1, ..., count[1] - 1, ..."""
    return np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
