"""Which branchings of the skeleton are one cluster, to be resolved together.

A skeleton turns a crossing into two forks with a piece of line between them: a short one when the
lines cross steeply, thirty pixels when they cross at five degrees. Three lines that almost meet
make several. The paper merges what touches in the pixel grid. We merge what is thereby explained
better: branchings become one cluster when their outer half-branches pair up to smooth curves that
lie on the ink and cover the pieces between, and that costs less than the pairings that the
branchings find on their own. Two stems on one line stay two.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..arrays.ragged import ranges
from ..involution import least_cost
from ..values import Array, PlanarGraph
from .continuations import ALONE, Continuations, pairs_within
from .limits import LIMITS
from .topology import connected, lengths

LARGEST = 8  # half-branches of one cluster
BATCH = 8192  # candidates looked at together, which bounds the memory


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
    members = _Members.of(graph, cluster, inner, long)
    candidates = _candidates(sides, long[links], members)
    alone = np.unique(candidates[candidates >= 0])
    single = np.zeros(len(cluster))
    for some in _batches(np.pad(alone[:, None], ((0, 0), (0, 2)), constant_values=-1)):
        single[some[:, 0]] = _paired(members, fits, some)[0]

    gains, taken_in = [np.zeros(0)], [np.zeros((0, 2), np.int64)]
    for at, some in enumerate(_batches(candidates)):
        cost, pairs, owner = _paired(members, fits, some)
        gain = np.where(some >= 0, single[some], 0).sum(1) - cost
        row, branch = members.between(some)
        promising = gain > LIMITS.cluster_gain
        row, branch = row[promising[row]], branch[promising[row]]
        used = promising[owner]
        covered = _covered(graph, fits, pairs[used], owner[used], row, branch)
        gain[row[~covered]] = 0.0
        gains.append(gain)
        taken_in.append(np.stack([row + at * BATCH, branch], -1))
    gain, inside = np.concatenate(gains), np.concatenate(taken_in)

    taken = np.zeros(len(cluster), bool)
    accepted = np.zeros(len(candidates), bool)
    good = np.flatnonzero(gain > LIMITS.cluster_gain)
    for i in good[np.argsort(-gain[good], kind="stable")]:
        merged = candidates[i][candidates[i] >= 0]
        if not taken[merged].any():
            taken[merged] = accepted[i] = True
    return np.unique(inside[accepted[inside[:, 0]], 1])


def _batches(rows: Array) -> Iterator[Array]:
    for at in range(0, len(rows), BATCH):
        yield rows[at : at + BATCH]


@dataclass(frozen=True, eq=False)
class _Members:
    """The half-branches of all clusters, and how clusters are linked.

    home: (2B,) the cluster of each half-branch, -1 for those inside one; long: (B,) px.
    order (2B,), begin (C + 1,): half-branches grouped by cluster.
    keys, counts: links shorter than `cluster_shared` between two clusters a < b, at a * C + b.
    """

    home: Array
    long: Array
    order: Array
    begin: Array
    keys: Array
    counts: Array

    @staticmethod
    def of(graph: PlanarGraph, cluster: Array, inner: Array, long: Array) -> _Members:
        home = np.where(np.repeat(inner, 2), -1, cluster[graph.half_vertex]).astype(np.int64)
        order = np.argsort(home, kind="stable")
        begin = np.searchsorted(home[order], np.arange(len(cluster) + 1))
        a, b = np.sort(home.reshape(-1, 2), axis=1).T
        linked = (a != b) & (long < LIMITS.cluster_shared)
        keys, counts = np.unique(a[linked] * len(cluster) + b[linked], return_counts=True)
        return _Members(home, long, order, begin, keys, counts)

    def size(self, which: Array) -> Array:
        """How many half-branches clusters have; none for number -1."""
        return np.where(which >= 0, self.begin[which + 1] - self.begin[which], 0)

    def links(self, a: Array, b: Array) -> Array:
        """How many links there are between clusters."""
        key = np.minimum(a, b) * (len(self.begin) - 1) + np.maximum(a, b)
        place = np.minimum(np.searchsorted(self.keys, key), len(self.keys) - 1)
        return np.where((self.keys[place] == key) & (a >= 0) & (b >= 0), self.counts[place], 0)

    def slots(self, candidates: Array) -> tuple[Array, Array]:
        """Rows of candidates (K, 3), and the half-branches of their clusters."""
        row, column = np.nonzero(candidates >= 0)
        which = candidates[row, column]
        size = self.size(which)
        return np.repeat(row, size), self.order[ranges(self.begin[which], size)]

    def inside(self, candidates: Array, row: Array, slot: Array) -> Array:
        """(N,) bool: half-branches that a merger of these clusters would take inside."""
        other = self.home[slot ^ 1]
        both = (candidates[row] == other[:, None]).any(1)
        return both & (other != self.home[slot]) & (self.long[slot >> 1] < LIMITS.cluster_shared)

    def between(self, candidates: Array) -> tuple[Array, Array]:
        """Rows of candidates, and the branches that link their clusters."""
        row, slot = self.slots(candidates)
        kept = self.inside(candidates, row, slot) & (slot % 2 == 0)
        return row[kept], slot[kept] >> 1


def _paired(
    members: _Members, fits: Continuations, candidates: Array
) -> tuple[Array, Array, Array]:
    """What the best pairing of the outer half-branches of each candidate costs.

    Returns:
        (K,) costs; the pairs (P, 2) of half-branches that are joined, and the candidate of each.
    """
    owner, slot = members.slots(candidates)
    outer = ~members.inside(candidates, owner, slot)
    owner, slot = owner[outer], slot[outer]
    count = np.bincount(owner, minlength=len(candidates))
    pairs = pairs_within(owner)
    costs = fits.cost(slot[pairs])
    chosen = least_cost(owner, pairs, costs, ALONE)
    used = owner[pairs[chosen, 0]]
    cost = ALONE * (count - 2.0 * np.bincount(used, minlength=len(candidates)))
    cost += np.bincount(used, costs[chosen], len(candidates))
    return cost, slot[pairs[chosen]], used


def _candidates(sides: Array, long: Array, members: _Members) -> Array:
    """Clusters that might merge: (K, 3), two or three linked ones; -1 fills up.

    None has more than `LARGEST` half-branches that would lead out of it.
    """
    two = _distinct(sides)
    short = _distinct(sides[long < LIMITS.cluster_shared / 2])
    # Three in a row: two short links that share a cluster.
    arms = np.concatenate([short, short[:, ::-1]])
    arms = arms[members.size(arms[:, 0]) - 2 * members.links(*arms.T) <= LARGEST]
    arms = arms[np.lexsort((arms[:, 1], arms[:, 0]))]
    pairs = pairs_within(arms[:, 0])
    three = np.stack([arms[pairs[:, 0], 0], arms[pairs[:, 0], 1], arms[pairs[:, 1], 1]], -1)
    three = _distinct(np.sort(three, axis=1))
    found = np.concatenate([np.pad(two, ((0, 0), (0, 1)), constant_values=-1), three])
    a, b, c = found.T
    outer = members.size(found).sum(1)
    outer -= 2 * (members.links(a, b) + members.links(a, c) + members.links(b, c))
    return found[outer <= LARGEST]


def _distinct(rows: Array) -> Array:
    """The different rows of whole numbers (K, N), in lexicographic order."""
    rows = rows[np.lexsort(rows.T[::-1])]
    return rows[np.diff(rows, axis=0, prepend=rows[:1] - 1).any(1)]


def _covered(
    graph: PlanarGraph,
    fits: Continuations,
    pairs: Array,
    used: Array,
    owner: Array,
    branch: Array,
) -> Array:
    """(N,) bool: whether one of the curves chosen by its owner runs along each branch."""
    order = np.argsort(used, kind="stable")
    begin = np.searchsorted(used[order], owner)
    size = np.searchsorted(used[order], owner, side="right") - begin
    curve = order[ranges(begin, size)]
    first, last = graph.offsets[branch], graph.offsets[branch + 1] - 1
    place = np.rint(first[:, None] + (last - first)[:, None] * np.linspace(0.2, 0.8, 7))
    points = graph.points[place.astype(np.int64)].astype(np.float64)
    row = np.repeat(np.arange(len(branch)), size)
    aside = fits.of(pairs).pick(curve).distance(points[row]).max(1)
    covered = np.zeros(len(branch), bool)
    covered[row[aside < LIMITS.cluster_aside]] = True
    return covered
