"""All strokes of a drawing laid end to end, so that each step runs over all of them at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays.ragged import count_up
from ..values import Array
from .shared import Page
from .walk import Walk


@dataclass(frozen=True, eq=False)
class Lines:
    """Strokes as runs of samples; a closed stroke is continued round its seam on both sides.

    sample: (N,) index into the samples of the page, and branch: (N,) the branch it is on.
    first, last: (N,) index of the first and last sample of the run that each sample is in.
    joint: (N,) bool; a vertex of the graph that the stroke runs through.
    start: (S,) where the stroke itself begins in its run, and
    stop: (S,) one past its last sample; the sample there repeats the first for closed strokes.
    """

    sample: Array
    branch: Array
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
        inside = count_up(count)
        of_half = np.repeat(np.arange(len(half)), count)
        backward = (half & 1)[of_half] == 1
        branch = half[of_half] >> 1
        joint = (inside == 0) & page.crossed[half[of_half]]  # a corner is no junction
        sample = np.where(
            backward, page.offsets[branch + 1] - 1 - inside, page.offsets[branch] + inside
        )
        size = np.add.reduceat(count, np.cumsum(steps) - steps)
        origin = np.cumsum(size) - size

        # One more sample at the end of an open stroke; for a closed one the first again.
        final = half[np.cumsum(steps) - 1]
        tip = np.where(final & 1, page.offsets[final >> 1], page.offsets[(final >> 1) + 1] - 1)
        before = np.where(closed, margin, 0)
        total = size + 1 + 2 * before
        run = np.repeat(np.arange(len(walks)), total)
        place = count_up(total) - before[run]
        at_tip = ~closed[run] & (place == size[run])
        source = origin[run] + np.where(at_tip, 0, place % size[run])
        begin = np.cumsum(total) - total
        return cls(
            sample=np.where(at_tip, tip[run], sample[source]),
            branch=np.where(at_tip, (final >> 1)[run], branch[source]),
            first=begin[run],
            last=(begin + total - 1)[run],
            joint=joint[source] & (closed[run] | ((place > 0) & ~at_tip)),
            start=begin + before,
            stop=begin + before + size + 1,
        )


class Pieces:
    """Stretches first..last of samples (ends included), each with a margin on both sides.

    With the margins filled, a convolution is a sum of shifted slices over everything at once.
    """

    def __init__(self, first: Array, last: Array, margin: int) -> None:
        count = last - first + 1 + 2 * margin
        of_piece = np.repeat(np.arange(len(first)), count)
        first, last = first[of_piece], last[of_piece]
        place = first - margin + count_up(count)
        self.margin = margin
        self.inside = (place >= first) & (place <= last)
        self._edge = np.clip(place, first, last)
        self._mirror = np.clip(2 * self._edge - place, first, last)

    def mirrored(self, values: Array) -> Array:
        """(M, D) values, going on point-mirrored at both ends of each stretch."""
        found = values[self._mirror]
        outside = ~self.inside
        found[outside] = 2 * values[self._edge[outside]] - found[outside]
        return found

    def alone(self, values: Array) -> Array:
        """(M, D) values, with zeros beyond the ends of each stretch."""
        return np.where(self.inside[:, None], values[self._edge], 0.0)

    def blur(self, values: Array, sigma: float) -> Array:
        """A Gaussian of `sigma` samples, cut off at the margin: (M, D), valid inside."""
        kernel = np.exp(-0.5 * (np.arange(self.margin + 1) / sigma) ** 2)
        kernel /= kernel[0] + 2 * kernel[1:].sum()
        total = kernel[0] * values
        for k in range(1, self.margin + 1):
            total[k:-k] += kernel[k] * (values[: -2 * k] + values[2 * k :])
        return total

    def put(self, values: Array, into: Array) -> None:
        """Write the insides back to where they came from."""
        into[self._edge[self.inside]] = values[self.inside]
