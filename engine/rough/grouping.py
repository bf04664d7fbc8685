"""Which pencil strokes mean one line: a small network judges every stretch that two of them run
beside each other.

What speaks for one line: near, beside each other for long, joined at the ends, nothing but pencil
between them, and a page on which many strokes lie like that. What speaks against: even distances
to a third stroke and equal lengths, as hatching has them. Trained by training/rough.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from .. import perceptron, weights
from ..arrays.sampling import sample
from ..values import Array
from .beside import Rungs
from .sampled import SPACING, Sampled

WEIGHTS = weights.FOLDER / "rough.npz"
_BETWEEN = (0.3, 0.5, 0.7)  # of the way across: there we look for paper
FEATURES = 37  # of a stretch
_FAR = 20.0  # pens; as far as we look for a third stroke


def available() -> bool:
    """Whether the weights are there."""
    return WEIGHTS.exists()


def probability(rows: Array, name: str, given: Mapping[str, Array] | None = None) -> Array:
    """(K,) what one of the networks in `WEIGHTS` says of rows of features, (K, F)."""
    return perceptron.probability(log_odds(rows, name, given))


def log_odds(rows: Array, name: str, given: Mapping[str, Array] | None = None) -> Array:
    """(K,) the same as log-odds."""
    of = perceptron.load(WEIGHTS) if given is None else given
    scaled = np.clip((rows - of[f"{name}_mean"]) / of[f"{name}_spread"], -4, 4)
    return perceptron.forward(scaled, of, f"{name}_")[:, 0]


def features(strokes: Sampled, rungs: Rungs, ink: Array, pen: float) -> Array:
    """(R, F) float64: what tells of each stretch whether it is one line.

    Args:
        ink: (H, W) of the page. pen: width of its typical pencil stroke, px.
    """
    if not len(rungs.a):
        return np.zeros((0, FEATURES))
    far = np.abs(rungs.aside) / pen
    cut = _Cut.of(rungs)
    columns = [
        *_apart(rungs, far, cut),
        *_long(strokes, rungs, pen, cut),
        *_inked(strokes, rungs, ink, cut),
        *_between(strokes, rungs, far, pen, cut),
        np.full(len(cut.first), np.log(pen)),
    ]
    return np.column_stack([*columns, np.tile(_page(strokes, rungs, far), (len(cut.first), 1))])


@dataclass(frozen=True, eq=False)
class _Cut:
    """Where the stretches begin in the rungs, (R,), how many rungs they have, and the numbers of
    the uncut ones."""

    first: Array
    size: Array
    whole: Array

    @staticmethod
    def of(rungs: Rungs) -> _Cut:
        first = np.flatnonzero(np.diff(rungs.stretch, prepend=-1))
        return _Cut(first, np.diff(np.append(first, len(rungs.a))), rungs.whole[first])

    def mean(self, values: Array) -> Array:
        """(R,) of (K,) values of the rungs."""
        return np.add.reduceat(values, self.first) / self.size


def _apart(rungs: Rungs, far: Array, cut: _Cut) -> list[Array]:
    """How far the strokes lie apart, px and pens, and how that changes along the stretch."""
    mean = cut.mean(far)
    most = np.zeros(int(rungs.whole.max()) + 1)
    np.maximum.at(most, rungs.whole, far)
    return [
        np.log(mean + 0.1),
        mean,
        np.log(cut.mean(np.abs(rungs.aside)) + 0.5),
        np.maximum.reduceat(far, cut.first),
        np.minimum.reduceat(far, cut.first),
        np.sqrt(np.maximum(cut.mean(far**2) - mean**2, 0)),
        far[cut.first] / (mean + 0.2),
        far[cut.first + cut.size - 1] / (mean + 0.2),
        (np.bincount(rungs.whole, far) / np.bincount(rungs.whole))[cut.whole],
        most[cut.whole],
    ]


def _long(strokes: Sampled, rungs: Rungs, pen: float, cut: _Cut) -> list[Array]:
    """How long they run beside each other, of how long strokes, and how parallel."""
    own, other = strokes.stroke[rungs.a[cut.first]], strokes.stroke[rungs.b[cut.first]]
    shorter = np.maximum(np.minimum(strokes.length[own], strokes.length[other]), 1.0)
    longer = np.maximum(np.maximum(strokes.length[own], strokes.length[other]), 1.0)
    whole = np.bincount(rungs.whole)[cut.whole] * SPACING
    turn = np.abs((strokes.tangent[rungs.a] * strokes.tangent[rungs.b]).sum(1))
    return [
        np.log(cut.size * SPACING / pen),
        np.log(whole / pen),
        whole / shorter,
        whole / longer,
        np.log(shorter / pen),
        np.log(longer / pen),
        shorter / longer,
        cut.mean(turn),
        np.minimum.reduceat(turn, cut.first),
    ]


def _inked(strokes: Sampled, rungs: Rungs, ink: Array, cut: _Cut) -> list[Array]:
    """How dark and wide the strokes are, and how much paper is seen between them."""
    a, b = rungs.a, rungs.b
    dark = strokes.strength[a], strokes.strength[b]
    weaker = np.maximum(np.minimum(*dark), 0.02)
    paper = np.min(
        [sample(ink, strokes.points[a] * (1 - t) + strokes.points[b] * t) for t in _BETWEEN], 0
    )
    pen = max(float(np.median(strokes.width)), 1.0)
    return [
        cut.mean(weaker),
        cut.mean(weaker / np.maximum(np.maximum(*dark), 0.02)),
        cut.mean(paper / weaker),
        np.minimum.reduceat(paper / weaker, cut.first),
        cut.mean(strokes.width[a] / pen),
        cut.mean(strokes.width[b] / pen),
    ]


def _between(strokes: Sampled, rungs: Rungs, far: Array, pen: float, cut: _Cut) -> list[Array]:
    """What lies beyond the two: hatching has a third stroke as far away as the second."""
    behind, beyond = _thirds(strokes, rungs, pen)
    return [
        cut.mean(np.log(behind)),
        cut.mean(np.log(beyond)),
        cut.mean(np.abs(np.log(np.minimum(behind, beyond) / (far + 0.1)))),
        cut.mean(np.bincount(rungs.a, minlength=len(strokes.points))[rungs.a]),
    ]


def _thirds(strokes: Sampled, rungs: Rungs, pen: float) -> tuple[Array, Array]:
    """(K,) pens from a to the nearest stroke on its other side, and from b to that on its."""
    count = len(strokes.points)
    nearest = np.full((2, count), _FAR)
    side = (rungs.aside > 0).astype(int)
    np.minimum.at(nearest, (side, rungs.a), np.abs(rungs.aside) / pen + 0.1)
    behind = nearest[1 - side, rungs.a]
    # Seen from b, a lies on the side that its own normal tells.
    back = strokes.points[rungs.a] - strokes.points[rungs.b]
    of_b = ((back * strokes.normal[rungs.b]).sum(1) > 0).astype(int)
    return behind, nearest[1 - of_b, rungs.b]


def _page(strokes: Sampled, rungs: Rungs, far: Array) -> Array:
    """(7,) how this artist draws: how far apart strokes run, and how much of all does."""
    held = np.zeros(len(strokes.points), bool)
    held[rungs.a] = True
    within = far < 2
    near = np.zeros(len(strokes.points), bool)
    near[rungs.a[within]] = True
    return np.array(
        [
            *np.quantile(far, (0.1, 0.25, 0.5, 0.75)),
            held.mean(),
            near.mean(),
            np.log(np.median(strokes.length) + 1),
        ]
    )
