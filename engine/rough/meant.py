"""Which branches of the redrawn graph the artist means: not what runs on beyond an end, not light
construction lines that belong to nothing, not what is left over of a bundle.

A small network judges each branch from its length, how many pencil strokes say it and how dark they
are, compared with those it hangs on and with the whole page, and how it lies at its ends.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..arrays.ragged import owners
from ..arrays.sampling import sample
from ..graph.at_vertices import AtVertices
from ..graph.topology import join, lengths, means, select
from ..values import Array, PlanarGraph
from .beside import rungs
from .grouping import probability
from .redrawn import SAID, Bundles, nearest_of, pixels_of
from .sampled import Sampled, reach_of

FEATURES = 13 + 8 + 6 + 2 * 9  # of a branch: its own, of what is beside it, its strokes, its ends
_MOSTLY = 0.6  # share of a pencil stroke from which on it says nothing but this branch
_SURE = 0.75  # probability of being meant below which a branch goes: crumbs are many
_NAMED = 0.5  # share of a branch that the artist called a line, from which on it stays
_ROUNDS = 2  # what hung on something that went is looked at again
_LOOK = 8  # points of a branch that tell its direction


def meant_lines(
    graph: PlanarGraph,
    bundles: Bundles,
    pen: float,
    net: Mapping[str, Array] | None = None,
    named: Array | None = None,
) -> PlanarGraph:
    """The graph without the branches that most probably mean nothing.

    Args:
        net: other weights.
        named: (N,) bool, samples of which the artist said that they are a line of their own.
    """
    for _ in range(_ROUNDS):
        if graph.branch_count == 0:
            break
        stays = probability(features(graph, bundles, pen), "meant", net) > _SURE
        if named is not None and named.any():
            stays |= means(graph, named[bundles.at(graph.points)]) > _NAMED
        if stays.all():
            break
        graph = join(select(graph, stays))
    return graph


def features(graph: PlanarGraph, bundles: Bundles, pen: float) -> Array:
    """(B, F) float64: what tells a branch that is meant from one that is not."""
    assert graph.strength is not None, "a redrawn graph is measured"
    length = lengths(graph)
    said = sample(bundles.count, graph.points).astype(np.float64)
    number, dark = means(graph, said), means(graph, graph.strength)
    weight = length / max(length.sum(), 1e-6)
    page = np.array([(number * weight).sum(), (dark * weight).sum()])
    chord = np.hypot(*(graph.vertices[graph.ends[:, 0]] - graph.vertices[graph.ends[:, 1]]).T)
    least, most = (how.reduceat(said, graph.offsets[:-1]) for how in (np.minimum, np.maximum))
    alone = [
        np.log(np.maximum(length, 0.5)),
        np.log(np.maximum(length, 0.5) / pen),
        number,
        least,
        most,
        dark,
        np.log((number + 0.2) / (page[0] + 0.2)),
        dark - page[1],
        chord / np.maximum(length, 1e-3),
        graph.ends[:, 0] == graph.ends[:, 1],
        np.full(len(length), np.log(pen)),
        np.full(len(length), page[0]),
        np.full(len(length), page[1]),
    ]
    alone += _doubled(graph, bundles.shape, pen, [number, dark, np.log(length + 1)])
    alone += _said(graph, bundles, pen)
    ends = _at_ends(graph, length, number, dark).reshape(len(length), 2, -1)
    return np.column_stack([*alone, ends.min(1), ends.max(1)])


def _doubled(
    graph: PlanarGraph, shape: tuple[int, int], pen: float, worth: list[Array]
) -> list[Array]:
    """How much of each branch runs beside another one, how near, and how much more than that one it
    is worth, (B,) each; what is left over of a bundle runs beside its line."""
    strokes = Sampled.of(graph, np.arange(2 * graph.branch_count))
    found = rungs(strokes, shape, reach_of(pen))
    branch, size = owners(strokes.offsets), np.diff(strokes.offsets)
    far = np.full(len(branch), 9.0)
    np.minimum.at(far, found.a, np.abs(found.aside) / pen)
    held = far < 9.0
    a, b = branch[found.a], branch[found.b]
    rows = np.bincount(a, minlength=len(size))

    def over(values: Array) -> Array:
        return np.bincount(a, values, len(size)) / np.maximum(rows, 1)

    share = np.bincount(branch, held, len(size)) / size
    within = np.bincount(branch, far < 1.5, len(size)) / size
    apart = np.bincount(branch, np.where(held, far, 0.0), len(size))
    nearest = np.full(len(size), 9.0)
    np.minimum.at(nearest, branch, far)
    apart = np.where(share > 0, apart / np.maximum(share * size, 1), 9.0)
    more = [over(values[a] - values[b]) for values in worth]
    longest = np.full(len(size), -1.0)
    np.maximum.at(longest, a, worth[-1][b])
    return [share, within, apart, nearest, *more, np.where(rows > 0, worth[-1] - longest, 0.0)]


def _said(graph: PlanarGraph, bundles: Bundles, pen: float) -> list[Array]:
    """What the pencil strokes do that say each branch, (B,) each: an end that sticks out is a small
    part of strokes that are elsewhere."""
    nearest, away = nearest_of(graph.points, bundles.shape)
    place = pixels_of(bundles.moved, bundles.shape)
    near = away[place] <= SAID
    branch = owners(graph.offsets)[nearest[place][near]]
    stroke = bundles.strokes.stroke[near]
    held, count = np.unique(stroke * graph.branch_count + branch, return_counts=True)
    stroke, branch = np.divmod(held, graph.branch_count)
    share = count / np.bincount(bundles.strokes.stroke)[stroke]
    weight = np.bincount(branch, count, graph.branch_count)
    most, longest = np.zeros(graph.branch_count), np.zeros(graph.branch_count)
    np.maximum.at(most, branch, share)
    np.maximum.at(longest, branch, bundles.strokes.length[stroke])
    return [
        np.bincount(branch, share * count, graph.branch_count) / np.maximum(weight, 1),
        most,
        np.bincount(branch, share > _MOSTLY, graph.branch_count),
        np.bincount(branch, minlength=graph.branch_count),
        np.log(longest / pen + 1),
        weight / np.maximum(np.diff(graph.offsets), 1),
    ]


def _at_ends(graph: PlanarGraph, length: Array, number: Array, dark: Array) -> Array:
    """(2B, E): how each half-branch lies at its vertex."""
    degree = graph.degrees[graph.half_vertex]
    there = AtVertices.of(graph, _LOOK, least=2)
    own = np.repeat(np.stack([number, dark], 1), 2, axis=0)
    return np.column_stack(
        [
            degree == 1,
            degree == 3,
            degree >= 5,
            there.straight,
            there.beside,
            there.past,
            np.log1p(there.most(length)),
            np.where(degree > 1, own[:, 0] - there.most(number), 0.0),
            np.where(degree > 1, own[:, 1] - there.most(dark), 0.0),
        ]
    )
