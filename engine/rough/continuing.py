"""Which redrawn lines go on in which: the scores of pairs of half-branches on a rough page.

Where bundles meet, nothing is exact: the directions at a junction say less than on a clean page,
and those farther along the lines more. So the features of the geometric router are read at three
scales, and a small network makes probabilities of them. A second one has these as well, of all
pairs around (`around`): what goes on at one place hangs on what does at the next.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..arrays.ragged import end_to_end, owners, ranges
from ..graph.topology import lengths
from ..routing import geometric, network
from ..routing.features import FEATURES as OF_PAIRS
from ..routing.features import pair_features
from ..values import Array, PlanarGraph
from . import around, fronts
from .grouping import probability
from .redrawn import SAID, Bundles, nearest_of, pixels_of

_SCALES = (1.0, 2.0, 4.0)  # times the pen
FEATURES = len(_SCALES) * len(OF_PAIRS) + 7 + 5 + fronts.FEATURES + 1  # of a pair
_LEAST = 1e-5  # probability of a pair at least
_ENDS = 0.03  # and of a half-branch to end; 0.1 is no better on held-out pages
_FROM, _TO = 2.0, 16.0  # px from a junction between which a pencil stroke is part of a half-branch


def score(graph: PlanarGraph, pairs: Array, bundles: Bundles) -> Array:
    """(K,) float32 log-odds of joining each of the (K, 2) pairs against ending both.

    The networks say how often each pair is one line, whatever the others at its junction are. The
    involution that is most probable in all needs weights from which these probabilities follow: on
    a tree they are p (1 - p) / (e e') with the probabilities e that a half-branch ends (Bethe's
    approximation of monomers and dimers).
    """
    rows = features(graph, pairs, bundles)
    again = seen_again(graph, pairs, rows, probability(rows, "goes_on"))
    one = probability(again, "goes_on_again")
    one = np.clip(one, _LEAST, 1 - _LEAST)
    going = np.zeros(2 * graph.branch_count)
    for half in pairs.T:
        np.add.at(going, half, one)
    ends = np.maximum(1 - going, _ENDS)
    a, b = pairs.T
    return np.log(one * (1 - one) / (ends[a] * ends[b])).astype(np.float32)


def features(graph: PlanarGraph, pairs: Array, bundles: Bundles) -> Array:
    """(K, F) float64: what tells of two half-branches whether they are one line."""
    assert graph.widths is not None, "a redrawn graph is measured"
    scaled = [
        pair_features(replace(graph, widths=graph.widths * np.float32(k)), pairs) for k in _SCALES
    ]
    turn = scaled[1][:, 3]
    a, b = pairs.T
    pen = float(np.median(graph.widths))
    length = np.log(np.maximum(lengths(graph), 0.5) / pen)
    degree = graph.degrees[graph.half_vertex[a]]
    rival_a, rival_b = _rivals(pairs, turn, len(graph.half_vertex))
    straightest = turn <= np.minimum(rival_a, rival_b)
    extra = [
        np.minimum(length[a >> 1], length[b >> 1]),
        np.maximum(length[a >> 1], length[b >> 1]),
        degree,
        turn - np.minimum(rival_a, rival_b),
        turn - np.maximum(rival_a, rival_b),
        straightest,
        (a >> 1) == (b >> 1),
    ]
    in_front = fronts.fronts(graph, pairs, turn, straightest, pen)
    through = _drawn_through(graph, pairs, bundles)
    return np.column_stack([*scaled, *extra, *through, *in_front, _as_clean(graph, pairs)])


def seen_again(graph: PlanarGraph, pairs: Array, rows: Array, first: Array) -> Array:
    """(K, F + around.FEATURES) float64: the `features` of all pairs, and what the answers (K,) of a
    first look at them say around each."""
    assert graph.widths is not None, "a redrawn graph is measured"
    pen = float(np.median(graph.widths))
    return np.column_stack([rows, around.features(graph, pairs, first, pen)])


def _as_clean(graph: PlanarGraph, pairs: Array) -> Array:
    """(K,) log-odds of joining each pair, if these were the lines of a clean page."""
    score = network.score if network.available() else geometric.score
    return score(graph, pairs)


def _drawn_through(graph: PlanarGraph, pairs: Array, bundles: Bundles) -> list[Array]:
    """How many pencil strokes run through both half-branches of each pair, (K,) each; and how many
    through either, and through one of them into any other."""
    half, stroke = _strokes_at(graph, bundles)
    strokes = int(stroke.max(initial=0)) + 1
    held = np.unique(half * strokes + stroke)
    half, stroke = np.divmod(held, strokes)
    first = np.searchsorted(half, np.arange(2 * graph.branch_count + 1))
    count = np.diff(first)
    vertex = graph.half_vertex[half]
    # A stroke that is on several half-branches of a vertex runs through it.
    passing = np.unique(vertex * strokes + stroke, return_inverse=True, return_counts=True)
    through = np.bincount(half, passing[2][passing[1].ravel()] > 1, 2 * graph.branch_count)
    a, b = pairs.T
    row = np.repeat(np.arange(len(pairs)), count[a])
    here = ranges(first[a], count[a])
    both = np.bincount(row, np.isin(b[row] * strokes + stroke[here], held), len(pairs))
    fewer, more = np.minimum(count[a], count[b]), np.maximum(count[a], count[b])
    return [
        both,
        both / np.maximum(fewer, 1),
        both / np.maximum(more, 1),
        np.maximum(through[a], through[b]) - both,
        fewer,
    ]


def _strokes_at(graph: PlanarGraph, bundles: Bundles) -> tuple[Array, Array]:
    """The half-branch and the pencil stroke of every sample of pencil not far from a junction."""
    nearest, away = nearest_of(graph.points, bundles.shape)
    branch = owners(graph.offsets)
    way = end_to_end(graph.points, graph.offsets)
    sides = way - way[graph.offsets[:-1]][branch], way[graph.offsets[1:] - 1][branch] - way
    place = pixels_of(bundles.moved, bundles.shape)
    point = nearest[place][away[place] <= SAID]
    stroke = bundles.strokes.stroke[away[place] <= SAID]
    found = []
    for side, far in enumerate(sides):
        near = (far[point] >= np.minimum(_FROM, 0.3 * (sides[0] + sides[1])[point])) & (
            far[point] <= _TO
        )
        found.append((2 * branch[point[near]] + side, stroke[near]))
    half, stroke = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return half.astype(np.int64), stroke.astype(np.int64)


def _rivals(pairs: Array, turn: Array, halves: int) -> tuple[Array, Array]:
    """For both half-branches of each pair the least turn that any other pair offers them."""
    a, b = pairs.T
    half, of = np.concatenate([a, b]), np.tile(np.arange(len(pairs)), 2)
    order = np.lexsort((turn[of], half))
    half, value = half[order], turn[of][order]
    first = np.flatnonzero(np.diff(half, prepend=-1))
    best, second = np.full(halves, np.pi), np.full(halves, np.pi)
    best[half[first]] = value[first]
    more = first[np.diff(np.append(first, len(half))) > 1]
    second[half[more]] = value[more + 1]
    found = []
    for side in (a, b):
        found.append(np.where(turn <= best[side], second[side], best[side]))
    return found[0], found[1]
