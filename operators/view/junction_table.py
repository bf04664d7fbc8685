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
_tables: OrderedDict[str, JunctionTable] = OrderedDict()


@dataclass(frozen=True, eq=False)
class JunctionTable:
    """positions: (J, 2) px. degree: (J,) int. doubt: (J,) in [0, 1]. locked: (J,) bool."""

    positions: Array
    degree: Array
    doubt: Array
    locked: Array

    @staticmethod
    def of(drawing: Drawing) -> JunctionTable:
        """The table of a drawing."""
        junctions = drawing.junctions
        return JunctionTable(
            np.array([j.position for j in junctions], np.float32).reshape(-1, 2),
            np.array([j.degree for j in junctions], np.int32),
            np.array([j.doubt for j in junctions], np.float32),
            np.array([j.locked for j in junctions], bool),
        )

    def __len__(self) -> int:
        return len(self.doubt)

    def listed(
        self, order: str = "DOUBT", at_least: float = 0.0, degree: int = 0, unlocked: bool = False
    ) -> Array:
        """Which junctions a list shows, in its order.

        Args:
            order: "DOUBT" = the most doubtful first; "PLACE" = in reading order.
            at_least: least doubt.
            degree: 3, 4, or 5 for five and more; 0 = any.
            unlocked: leave out what the user has fixed.
        """
        keep = self.doubt >= at_least
        if degree:
            keep &= (self.degree == degree) if degree < 5 else (self.degree >= 5)
        if unlocked:
            keep &= ~self.locked
        chosen = np.flatnonzero(keep)
        if order == "DOUBT":
            return chosen[np.argsort(-self.doubt[chosen], kind="stable")]
        x, y = self.positions[chosen].T
        line = np.ptp(self.positions[:, 1]) / 20 if len(self) else 1.0
        return chosen[np.lexsort((x, np.floor(y / max(line, 1e-6))))]


def table_of(trace: Trace) -> JunctionTable:
    """The table of a trace, made once for each state of it."""
    table = _tables.get(trace.stamp)
    if table is None:
        table = _tables[trace.stamp] = JunctionTable.of(trace.drawing)
        while len(_tables) > _MAX_TABLES:
            _tables.popitem(last=False)
    return table
