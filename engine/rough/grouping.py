"""Which pencil strokes mean one line: a small network judges every stretch that two of them run
beside each other.

What speaks for one line: near, beside each other for long, joined at the ends, nothing but pencil
between them, and a page on which many strokes lie like that. What speaks against: even distances
to a third stroke and equal lengths, as hatching has them. Trained by training/rough.
"""

from __future__ import annotations

import io
from collections.abc import Mapping
from functools import cache

import numpy as np

from .. import weights
from ..arrays.sampling import sample
from ..graph.clues import forward
from ..values import Array
from .beside import Rungs
from .sampled import SPACING, Sampled

WEIGHTS = weights.FOLDER / "rough.npz"
_BETWEEN = (0.3, 0.5, 0.7)  # of the way across: there we look for paper
FEATURES = 37  # of a stretch
_FAR = 20.0  # pens; as far as we look for a third stroke


@cache
def net() -> dict[str, Array]:
    """The weights of all that rough drawings need.

    Raises:
        InvoluteError: the weights are damaged.
        OSError: there are none.
    """
    with np.load(io.BytesIO(weights.read(WEIGHTS))) as file:
        return {name: file[name].astype(np.float64) for name in file.files}


def available() -> bool:
    """Whether the weights are there."""
    return WEIGHTS.exists()


def probability(rows: Array, name: str, given: Mapping[str, Array] | None = None) -> Array:
    """(K,) what a network of `net` says of rows of features, (K, F)."""
    return 1 / (1 + np.exp(-np.clip(log_odds(rows, name, given), -50, 50)))


def log_odds(rows: Array, name: str, given: Mapping[str, Array] | None = None) -> Array:
    """(K,) the same as log-odds."""
    of = net() if given is None else given
    scaled = np.clip((rows - of[f"{name}_mean"]) / of[f"{name}_spread"], -4, 4)
    return forward(scaled, of, name)[:, 0]


def features(strokes: Sampled, rungs: Rungs, ink: Array, pen: float) -> Array:
    """(R, F) float64: what tells of each stretch whether it is one line.

    Args:
        ink: (H, W) of the page. pen: width of its typical pencil stroke, px.
    """
    if not len(rungs.a):
        return np.zeros((0, FEATURES))
    first = np.flatnonzero(np.diff(rungs.stretch, prepend=-1))
    size = np.diff(np.append(first, len(rungs.a)))
    a, b = rungs.a, rungs.b
    far = np.abs(rungs.aside) / pen

    def mean(values: Array) -> Array:
        return np.add.reduceat(values, first) / size

    own, other = strokes.stroke[a[first]], strokes.stroke[b[first]]
    whole = np.bincount(rungs.whole)[rungs.whole[first]] * SPACING
    whole_far = (np.bincount(rungs.whole, far) / np.bincount(rungs.whole))[rungs.whole[first]]
    whole_most = np.zeros(len(whole))
    most = np.zeros(int(rungs.whole.max()) + 1)
    np.maximum.at(most, rungs.whole, far)
    whole_most = most[rungs.whole[first]]
    lengths = strokes.length[own], strokes.length[other]
    shorter, longer = np.minimum(*lengths), np.maximum(*lengths)
    turn = np.abs((strokes.tangent[a] * strokes.tangent[b]).sum(1))
    dark = strokes.strength[a], strokes.strength[b]
    weaker = np.maximum(np.minimum(*dark), 0.02)
    paper = np.min(
        [sample(ink, strokes.points[a] * (1 - t) + strokes.points[b] * t) for t in _BETWEEN], 0
    )
    behind, beyond = _thirds(strokes, rungs, pen)
    around = np.bincount(a, minlength=len(strokes.points))[a]
    page = _page(strokes, rungs, far)
    columns = [
        np.log(mean(far) + 0.1),
        mean(far),
        np.log(mean(np.abs(rungs.aside)) + 0.5),
        np.maximum.reduceat(far, first),
        np.minimum.reduceat(far, first),
        np.sqrt(np.maximum(mean(far**2) - mean(far) ** 2, 0)),
        far[first] / (mean(far) + 0.2),
        far[first + size - 1] / (mean(far) + 0.2),
        np.log(size * SPACING / pen),
        np.log(whole / pen),
        whole_far,
        whole_most,
        whole / np.maximum(shorter, 1),
        whole / np.maximum(longer, 1),
        np.log(np.maximum(shorter, 1) / pen),
        np.log(np.maximum(longer, 1) / pen),
        shorter / np.maximum(longer, 1),
        mean(turn),
        np.minimum.reduceat(turn, first),
        mean(weaker),
        mean(weaker / np.maximum(np.maximum(*dark), 0.02)),
        mean(paper / weaker),
        np.minimum.reduceat(paper / weaker, first),
        mean(strokes.width[a] / pen),
        mean(strokes.width[b] / pen),
        mean(np.log(behind)),
        mean(np.log(beyond)),
        mean(np.abs(np.log(np.minimum(behind, beyond) / (far + 0.1)))),
        mean(around),
        np.full(len(first), np.log(pen)),
    ]
    return np.column_stack([*columns, np.tile(page, (len(first), 1))])


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
