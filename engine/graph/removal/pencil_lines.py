"""Lines that are not wanted go, and those that they crossed are whole again."""

from __future__ import annotations

from ...ink.pencil import neutral, pencil
from ...values import PlanarGraph
from ..topology import join, lengths, select


def without_pencil(graph: PlanarGraph) -> PlanarGraph:
    """A measured graph without the pencil that lies under its ink, to be measured anew.

    What is clearly pencil is gone from the scan already (`unmixing`); lines tell it better.
    """
    found, _ = pencil(graph, neutral(graph), lengths(graph))
    return join(select(graph, ~found)) if found.any() else graph
