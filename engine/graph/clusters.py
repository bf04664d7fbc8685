"""Which branchings of the skeleton are one cluster, to be resolved together.

A skeleton turns a crossing into two forks with a piece of line between them: a short one when the
lines cross steeply, thirty pixels when they cross at five degrees. Three lines that almost meet
make several. The paper merges what touches in the pixel grid. We merge what is thereby explained
better: branchings become one cluster when their outer half-branches pair up to smooth curves that
lie on the ink and cover the pieces between, and that costs less than the pairings that the
branchings find on their own. Two stems on one line stay two.
"""

from __future__ import annotations

import numpy as np

from ..arrays.ragged import ranges
from ..involution import least_cost
from ..values import Array, PlanarGraph
from .continuations import ALONE, Continuations, Fits, pairs_within
from .limits import LIMITS
from .topology import connected, lengths

LARGEST = 8  # half-branches of one cluster


def find_clusters(graph: PlanarGraph, fits: Continuations) -> tuple[Array, Array]:
    """Group the junctions of a graph.

    Args:
        graph: the skeleton's graph.
        fits: smooth continuations of its half-branches.

    Returns:
        (V,) int32 the cluster of every vertex; (B,) bool the branches inside a cluster.
    """
    a, b = graph.ends.T
    fork = graph.degrees >= 3
    long = lengths(graph)
    link = fork[a] & fork[b] & (a != b)
    inner = link & (long < LIMITS.cluster_link)
    cluster = connected(len(fork), graph.ends[inner])
    inner = link & (cluster[a] == cluster[b]) & (long < 2 * LIMITS.cluster_link)
    near = np.flatnonzero(link & (long < LIMITS.cluster_shared))
    for _ in range(4):
        merged = _best_mergers(graph, fits, cluster, inner, near, long)
        if not len(merged):
            break
        inner[merged] = True
        cluster = connected(len(fork), cluster[graph.ends[merged]])[cluster]
        # Only what has changed may merge again.
        grown = np.zeros(len(fork), bool)
        grown[cluster[graph.ends[merged]]] = True
        near = near[grown[cluster[graph.ends[near]]].any(1)]
    return cluster, inner


def _best_mergers(
    graph: PlanarGraph,
    fits: Continuations,
    cluster: Array,
    inner: Array,
    near: Array,
    long: Array,
) -> Array:
    """The branches that mergers of two or three clusters would take inside."""
    links = near[~inner[near]]
    sides = np.sort(cluster[graph.ends[links]], axis=1)
    links, sides = links[sides[:, 0] != sides[:, 1]], sides[sides[:, 0] != sides[:, 1]]
    if not len(links):
        return links
    candidates = _candidates(sides, long[links])

    # Slots: one per candidate and half-branch of its clusters; its own inner links left out.
    home = np.where(np.repeat(inner, 2), -1, cluster[graph.half_vertex])
    order = np.argsort(home, kind="stable")
    begin = np.searchsorted(home[order], np.arange(len(cluster) + 1))
    row, column = np.nonzero(candidates >= 0)
    which = candidates[row, column]
    size = begin[which + 1] - begin[which]
    owner = np.repeat(row, size)
    slot = order[ranges(begin[which], size)]
    alone = np.unique(which)
    # The clusters on their own come after the candidates, to compare with.
    size = begin[alone + 1] - begin[alone]
    owner = np.concatenate([owner, len(candidates) + np.repeat(np.arange(len(alone)), size)])
    slot = np.concatenate([slot, order[ranges(begin[alone], size)]])

    other = home[slot ^ 1]
    both = (candidates[np.minimum(owner, len(candidates) - 1)] == other[:, None]).any(1)
    inside = (
        both
        & (owner < len(candidates))
        & (other != home[slot])
        & (long[slot >> 1] < LIMITS.cluster_shared)
    )
    inner_owner, inner_branch = owner[inside & (slot % 2 == 0)], slot[inside & (slot % 2 == 0)] >> 1
    owner, slot = owner[~inside], slot[~inside]

    groups = len(candidates) + len(alone)
    count = np.bincount(owner, minlength=groups)
    fits_in = count <= LARGEST
    owner, slot = owner[fits_in[owner]], slot[fits_in[owner]]
    pairs = pairs_within(owner)
    found = fits.of(slot[pairs])
    chosen = least_cost(owner, pairs, found.cost, ALONE)
    used = owner[pairs[chosen, 0]]
    cost = ALONE * (count - 2.0 * np.bincount(used, minlength=groups))
    cost += np.bincount(used, found.cost[chosen], groups)

    single = np.zeros(len(cluster))
    single[alone] = cost[len(candidates) :]
    gain = np.where(candidates >= 0, single[candidates], 0).sum(1) - cost[: len(candidates)]
    covered = _covered(graph, found, np.flatnonzero(chosen), used, inner_owner, inner_branch)
    bad = np.zeros(groups, bool)
    bad[inner_owner[~covered]] = True
    good = (gain > LIMITS.cluster_gain) & ~bad[: len(candidates)] & fits_in[: len(candidates)]

    taken = np.zeros(len(cluster), bool)
    accepted = np.zeros(groups, bool)
    for i in np.flatnonzero(good)[np.argsort(-gain[good], kind="stable")]:
        members = candidates[i][candidates[i] >= 0]
        if not taken[members].any():
            taken[members] = accepted[i] = True
    return np.unique(inner_branch[accepted[inner_owner]])


def _candidates(sides: Array, long: Array) -> Array:
    """Clusters that might merge: (K, 3), two or three linked ones; -1 fills up."""
    two = np.unique(sides, axis=0)
    short = np.unique(sides[long < LIMITS.cluster_shared / 2], axis=0)
    # Three in a row: two short links that share a cluster.
    arms = np.concatenate([short, short[:, ::-1]])
    arms = arms[np.lexsort((arms[:, 1], arms[:, 0]))]
    pairs = pairs_within(arms[:, 0])
    three = np.stack([arms[pairs[:, 0], 0], arms[pairs[:, 0], 1], arms[pairs[:, 1], 1]], -1)
    three = np.unique(np.sort(three, axis=1), axis=0)
    return np.concatenate([np.pad(two, ((0, 0), (0, 1)), constant_values=-1), three])


def _covered(
    graph: PlanarGraph, fits: Fits, chosen: Array, used: Array, owner: Array, branch: Array
) -> Array:
    """(N,) bool: whether one of the curves chosen by its owner runs along each branch."""
    order = np.argsort(used, kind="stable")
    begin = np.searchsorted(used[order], owner)
    size = np.searchsorted(used[order], owner, side="right") - begin
    curve = chosen[order[ranges(begin, size)]]
    first, last = graph.offsets[branch], graph.offsets[branch + 1] - 1
    place = np.rint(first[:, None] + (last - first)[:, None] * np.linspace(0.2, 0.8, 7))
    points = graph.points[place.astype(np.int64)].astype(np.float64)
    row = np.repeat(np.arange(len(branch)), size)
    aside = fits.pick(curve).distance(points[row]).max(1)
    covered = np.zeros(len(branch), bool)
    covered[row[aside < LIMITS.cluster_aside]] = True
    return covered
