"""What a drawing remembers of its pencil strokes: enough to clean it again without the page.

The samples of the strokes are kept, and how probably each stretch of two is one line. The rungs
between the samples follow from these; each is looked up among the stretches by its two strokes and
its place, so that what was kept is read by any later way to find rungs, too.
"""

from __future__ import annotations

from dataclasses import replace
from weakref import WeakKeyDictionary

import numpy as np

from ..values import Array, Beside, PlanarGraph
from .beside import Rungs
from .cleaning import ONE, Bundled, run_beside
from .sampled import SPACING, Sampled, samples_of

_OVERLAPS = 3  # stretches of the same two strokes at one place at most
_recalled: WeakKeyDictionary[Beside, Bundled] = WeakKeyDictionary()  # it takes a tenth of a second


def remembered(found: Bundled, graph: PlanarGraph, partner: Array, scale: float) -> Beside:
    """What to keep of bundles.

    Args:
        graph, partner: of the pencil strokes, in working pixels. scale: input pixels in each.
    """
    strokes, of = found.strokes, found.rungs
    first = np.flatnonzero(np.diff(of.stretch, prepend=-1))
    place = strokes.place[of.a]
    spans = np.zeros((0, 2))
    if len(first):
        spans = np.stack([how.reduceat(place, first) for how in (np.minimum, np.maximum)], 1)
    both = np.stack([strokes.stroke[of.a[first]], strokes.stroke[of.b[first]]], 1)
    return Beside(
        graph=samples_of(graph).scaled(scale),
        partner=partner.astype(np.int32),
        strokes=both.astype(np.int32),
        right=of.aside[first] > 0,
        spans=(scale * spans).astype(np.float32),
        probability=found.probability[first].astype(np.float32),
    )


def recalled(kept: Beside, scale: float, size: tuple[int, int]) -> Bundled:
    """The bundles that were kept, as they were judged; made once for each.

    Args:
        scale: input pixels per working pixel. size: (width, height) of the page, input pixels.
    """
    if kept not in _recalled:
        strokes = Sampled.from_samples(kept.graph.scaled(1 / scale), kept.partner)
        found = run_beside(strokes, working_shape(scale, size))
        probability = _looked_up(kept, strokes, found.rungs, scale)
        _recalled[kept] = replace(found, one=probability > ONE, probability=probability)
    return _recalled[kept]


def working_shape(scale: float, size: tuple[int, int]) -> tuple[int, int]:
    """(height, width) of a page in working pixels."""
    return max(1, round(size[1] / scale)), max(1, round(size[0] / scale))


def _looked_up(kept: Beside, strokes: Sampled, rungs: Rungs, scale: float) -> Array:
    """(K,) the probability of the stretch that each rung lies in; 0 where there is none."""
    if not len(kept.strokes) or not len(rungs.a):
        return np.zeros(len(rungs.a))
    count, far = len(strokes.length), float(strokes.length.max()) + 4 * SPACING
    spans = kept.spans.astype(np.float64) / scale
    # All pairs of strokes lie on one axis, one after the other, and either side of them.
    pair = kept.strokes[:, 0].astype(np.int64) * count + kept.strokes[:, 1]
    start = (2 * pair + kept.right) * far
    order = np.argsort(start + spans[:, 0], kind="stable")
    pair = strokes.stroke[rungs.a] * count + strokes.stroke[rungs.b]
    at = (2 * pair + (rungs.aside > 0)) * far + strokes.place[rungs.a]
    near = 0.5 * SPACING
    last = np.searchsorted((start + spans[:, 0])[order], at + near, "right") - 1
    probability = np.zeros(len(at))
    for back in reversed(range(_OVERLAPS)):
        stretch = order[np.maximum(last - back, 0)]
        inside = (last >= back) & (at <= start[stretch] + spans[stretch, 1] + near)
        probability[inside] = kept.probability[stretch[inside]]
    return probability
