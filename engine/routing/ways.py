"""The alternatives of all junctions as arrays, for whoever looks at all of them at once."""

from __future__ import annotations

from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np

from ..values import Alternative, Array, PlanarGraph, Routing

_Alternatives = tuple[tuple[Alternative, ...], ...]


@dataclass(frozen=True, eq=False)
class Ways:
    """J junctions, up to K ways to route each, up to D half-branches.

    halves: (J, D) int32, -1 = no half-branch.
    partner: (J, K, D) int32, what each half-branch goes on in; itself where it ends.
    probability: (J, K) float64, -1 = no such way.
    """

    halves: Array
    partner: Array
    probability: Array

    @staticmethod
    def of(graph: PlanarGraph, routing: Routing) -> Ways:
        """Of the junctions of a graph; what did not change since the last call is not made anew."""
        alternatives = routing.alternatives[: len(graph.junctions)]
        known = _known.get(graph)
        if known is None or known[1].probability.shape[1] < max(map(len, alternatives), default=0):
            halves = _halves(graph)
            most = max(map(len, alternatives), default=0) + 1
            shape = (len(halves), most, halves.shape[1])
            known = ((), Ways(halves, np.zeros(shape, np.int32), np.full(shape[:2], -1.0)))
        before, ways = known
        if before != () and all(a is b for a, b in zip(before, alternatives, strict=True)):
            return ways
        ways = _updated(ways, before, alternatives)
        _known[graph] = alternatives, ways
        return ways

    def doubts(self, routing: Routing) -> Array:
        """(J,) float64: 1 - probability of the way in force; 0 where it is locked."""
        force = self._in_force(routing)
        chosen = np.where(force, self.probability, 0.0).max(1, initial=0.0)
        return np.where(routing.locked[: len(force)], 0.0, 1.0 - chosen)

    def costs(self, routing: Routing, beyond: Array) -> Array:
        """(J,) px: doubt times the length of stroke that the likeliest other way moves; the longest
        of the parts that change stays in place.

        Args:
            beyond: (2B,) px, the length of stroke behind each half-branch.
        """
        others = ~self._in_force(routing) & (self.probability >= 0)
        other = np.take_along_axis(self.partner, others.argmax(1)[:, None, None], 1)[:, 0]
        now = routing.partner[self.halves]
        changed = (other != now) & (self.halves >= 0) & others.any(1)[:, None]
        moved = np.where(changed, beyond[self.halves], 0.0)
        return self.doubts(routing) * (moved.sum(1) - moved.max(1, initial=0.0))

    def _in_force(self, routing: Routing) -> Array:
        """(J, K) bool."""
        same = self.partner == routing.partner[self.halves][:, None]
        return (same | (self.halves < 0)[:, None]).all(2) & (self.probability >= 0)


_known: WeakKeyDictionary[PlanarGraph, tuple[_Alternatives, Ways]] = WeakKeyDictionary()


def _halves(graph: PlanarGraph) -> Array:
    """(J, D) int32: the half-branches of each junction, ascending."""
    order, starts = graph.halves_at
    degree = graph.degrees[graph.junctions]
    place = np.arange(int(degree.max(initial=0)))
    filled = place < degree[:, None]
    halves = np.full(filled.shape, -1, np.int32)
    halves[filled] = order[(starts[graph.junctions][:, None] + place)[filled]]
    return halves


def _updated(ways: Ways, before: _Alternatives, after: _Alternatives) -> Ways:
    partner, probability = ways.partner.copy(), ways.probability.copy()
    for junction, some in enumerate(after):
        if before and before[junction] is some:
            continue
        halves = ways.halves[junction]
        slot = {half: k for k, half in enumerate(halves.tolist())}
        partner[junction], probability[junction] = halves, -1.0
        for k, way in enumerate(some):
            probability[junction, k] = way.probability
            for a, b in way.pairs:
                partner[junction, k, slot[a]], partner[junction, k, slot[b]] = b, a
    return Ways(ways.halves, partner, probability)
