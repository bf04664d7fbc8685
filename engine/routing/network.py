"""Log-odds that two half-branches are one line, by the trained network.

The network sees the whole drawing at once: see `encoding` for its input and training/routing for
its making. Its cost grows linearly with the number of junctions, and
large drawings are looked at in parts (`windows`), so that its memory is bounded.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import numpy as np

from .. import weights
from ..errors import InvoluteError
from ..values import Array, Pair, PlanarGraph
from . import geometric
from .encoding import encode
from .transformer import Transformer
from .windows import windows


def available() -> bool:
    """Whether the weights are there."""
    return (weights.FOLDER / "routing.onnx").exists()


def score(
    graph: PlanarGraph,
    pairs: Array,
    fixed: Mapping[int, tuple[Pair, ...]] | None = None,
) -> Array:
    """Calibrated log-odds of joining pairs of half-branches.

    Args:
        graph: the drawing.
        pairs: (K, 2) half-branches that share a junction.
        fixed: junction number -> the pairs that the user has decided there; the network takes
            them as given.

    Returns:
        (K,) float32 log-odds of joining each pair against ending both. Pairs at junctions with
        more half-branches than the network has learnt get their geometric score.

    Raises:
        InvoluteError: the weights are missing or can't be read.
    """
    encoding = encode(graph, fixed)
    count, slots = encoding.halves.shape
    places = graph.vertices[graph.half_vertex[encoding.halves[:, 0]]]
    table = np.zeros((count, slots, slots), np.float32)
    for window in windows(encoding, places):
        part, own, few = window.part, len(window.rows), window.slots
        scores = _forward(part.tokens, part.pairs, part.sibling, part.mask)
        table[window.rows, :few, :few] = scores[:own]
    slot = np.full(2 * graph.branch_count, -1)
    filled = np.flatnonzero(encoding.halves.reshape(-1) >= 0)
    slot[encoding.halves.reshape(-1)[filled]] = filled
    a, b = slot[pairs[:, 0]], slot[pairs[:, 1]]
    known = (a >= 0) & (b >= 0)
    found = np.zeros(len(pairs), np.float32)
    found[known] = table[a[known] // slots, a[known] % slots, b[known] % slots]
    if not known.all():
        found[~known] = geometric.score(graph, pairs[~known])
    return found


def _forward(tokens: Array, pairs: Array, sibling: Array, mask: Array) -> Array:
    """(J, D, D) calibrated scores."""
    net, calibration = load(weights.FOLDER)
    return calibrated(net(tokens, pairs, sibling, mask), mask.sum(1), calibration)


def calibrated(scores: Array, degree: Array, calibration: Mapping[str, list[float]]) -> Array:
    """Raw scores made into log-odds that hold: scale and shift by the degree of the junction.

    Args:
        scores: (J, D, D); degree: (J,) half-branches at each junction.
        calibration: "scale" and "shift", one number for each degree from 3; the last one also
            serves all higher degrees.
    """
    scale, shift = (np.asarray(calibration[name], np.float32) for name in ("scale", "shift"))
    row = np.clip(degree.astype(int) - 3, 0, len(scale) - 1)
    return scores * scale[row][:, None, None] + shift[row][:, None, None]


@cache
def load(folder: Path) -> tuple[Transformer, dict[str, list[float]]]:
    """The network and its calibration: routing.onnx and routing.json of a folder.

    Raises:
        InvoluteError: they are missing or can't be read.
    """
    try:
        calibration = json.loads(weights.read(folder / "routing.json"))
        net = Transformer(weights.read(folder / "routing.onnx"))
    except (OSError, ValueError) as error:
        raise InvoluteError("The weights of the routing network are missing or damaged.") from error
    return net, calibration
