"""All junctions of a drawing as arrays: for lists, filters, overlay and picking. Pure NumPy."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ...engine import Drawing
    from ..grease_pencil.state import Trace

Array = np.ndarray

_MAX_TABLES = 16
_tables: OrderedDict[tuple[str, bytes], JunctionTable] = OrderedDict()


@dataclass(frozen=True, eq=False)
class JunctionTable:
    """A row for each junction, corner and bundle, by its number; corners are listed nowhere.

    positions: (J, 2) px, NaN for corners and where the artist left no stroke. degree: (J,) int, of
    a bundle 2. doubt: (J,) in [0, 1]. locked: (J,) bool. cost: (J,) px of stroke at risk.
    doubtful: (J,) bool, see `Drawing.doubtful`.
    """

    positions: Array
    degree: Array
    doubt: Array
    locked: Array
    cost: Array
    doubtful: Array

    @staticmethod
    def of(drawing: Drawing, halves: Array | None = None) -> JunctionTable:
        """The table of a drawing.

        Args:
            halves: first half-branches of the strokes that are there; None = all are.
        """
        graph, bundles = drawing.graph, drawing.bundles
        junctions = graph.vertices[graph.junctions].astype(np.float32)
        if halves is not None:
            junctions[~_passed(drawing, halves)] = np.nan
        none = np.zeros(len(graph.corners), np.float32)
        between = np.array([b.position for b in bundles], np.float32).reshape(-1, 2)
        positions = np.concatenate([junctions, np.full((len(none), 2), np.nan), between])
        doubts = drawing.doubts, none, [b.doubt for b in bundles]
        locked = drawing.routing.locked, np.array([b.locked for b in bundles], bool)
        return JunctionTable(
            positions.astype(np.float32),
            np.concatenate([graph.degrees[graph.places], np.full(len(bundles), 2)]),
            np.concatenate(doubts).astype(np.float32),
            np.concatenate(locked),
            np.concatenate([drawing.costs, none, drawing.bundle_costs]),
            np.isin(np.arange(len(positions)), drawing.doubtful),
        )

    def __len__(self) -> int:
        return len(self.doubt)

    @property
    def count(self) -> int:
        """How many junctions and bundles there are."""
        corners = (self.degree == 2) & np.isnan(self.positions[:, 0])
        return len(self) - int(corners.sum())

    def at_least(self, certainty: float) -> Array:
        """(J,) bool: not locked, and the routing in force is that probable."""
        there = np.isfinite(self.positions[:, 0])
        return there & ~self.locked & (1.0 - self.doubt >= certainty)

    def listed(
        self, order: str = "DOUBT", doubtful: bool = False, degree: int = 0, unlocked: bool = False
    ) -> Array:
        """Which junctions a list shows, in its order.

        Args:
            order: "COST" = where a wrong answer changes most first; "DOUBT" = the most doubtful
                first; "PLACE" = in reading order.
            doubtful: leave out those that are certain or change little.
            degree: 3, 4, or 5 for five and more; 2 = bundles; 0 = any.
            unlocked: leave out what the user has fixed.
        """
        keep = np.isfinite(self.positions[:, 0])
        if doubtful:
            keep &= self.doubtful
        if degree:
            keep &= (self.degree == degree) if degree < 5 else (self.degree >= 5)
        if unlocked:
            keep &= ~self.locked
        chosen = np.flatnonzero(keep)
        if order != "PLACE":
            worst = self.cost if order == "COST" else self.doubt
            return chosen[np.argsort(-worst[chosen], kind="stable")]
        x, y = self.positions[chosen].T
        line = np.ptp(y) / 20 if len(y) else 1.0
        return chosen[np.lexsort((x, np.floor(y / max(line, 1e-6))))]


def table_of(trace: Trace, halves: Array) -> JunctionTable:
    """The table of a trace, made once for each state of it and of its strokes."""
    key = trace.stamp, halves.tobytes()
    table = _tables.get(key)
    if table is None:
        table = _tables[key] = JunctionTable.of(trace.drawing, halves)
        while len(_tables) > _MAX_TABLES:
            _tables.popitem(last=False)
    return table


def _passed(drawing: Drawing, halves: Array) -> Array:
    """(J,) bool: the junctions that the strokes with these first half-branches pass."""
    strokes = [s.branches for s in drawing.strokes if len(s.branches)]
    there = np.isin([branches[0] for branches in strokes], halves)
    kept = [branches for branches, is_there in zip(strokes, there, strict=True) if is_there]
    passed = np.zeros(len(drawing.graph.vertices), bool)
    if kept:
        passed[drawing.graph.ends[np.concatenate(kept) >> 1].reshape(-1)] = True
    return passed[drawing.graph.junctions]
