"""Which branches of the redrawn graph the artist means: not what runs on beyond an end, not light
construction lines that belong to nothing, not what is left over of a bundle.

A small network judges each branch from its length, how many pencil strokes say it and how dark they
are, compared with those it hangs on and with the whole page, and how it lies at its ends.
"""

from __future__ import annotations

import numpy as np

from ..arrays.sampling import sample
from ..graph.at_vertices import AtVertices
from ..graph.topology import join, lengths, means, select
from ..values import Array, PlanarGraph
from .grouping import probability
from .redrawn import Bundles

FEATURES = 13 + 2 * 9  # of a branch: its own, and those of its two ends
_SURE = 0.5  # probability of being meant below which a branch goes
_ROUNDS = 2  # what hung on something that went is looked at again
_LOOK = 8  # points of a branch that tell its direction


def meant_lines(graph: PlanarGraph, bundles: Bundles, pen: float) -> PlanarGraph:
    """The graph without the branches that most probably mean nothing."""
    for _ in range(_ROUNDS):
        if graph.branch_count == 0:
            break
        stays = probability(features(graph, bundles, pen), "meant") > _SURE
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
    ends = _at_ends(graph, length, number, dark).reshape(len(length), 2, -1)
    return np.column_stack([*alone, ends.min(1), ends.max(1)])


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
