"""Lines that are not wanted go, and those that they crossed are whole again."""

from __future__ import annotations

from ...ink.pencil import neutral, pencil
from ...settings import Settings
from ...values import PlanarGraph
from ..evidence import Evidence
from ..topology import join, lengths, select


def remove_pencil(graph: PlanarGraph, evidence: Evidence, settings: Settings) -> PlanarGraph:
    """Drop the pencil that lies under the ink, where it is not wanted.

    What is clearly pencil is gone from the scan already (`unmixing`); lines tell it better.

    Reads: Settings.ignore_inks; widths, strength and colours.
    Promises: to be measured anew where something went.
    """
    if "gray" not in settings.ignore_inks:
        return graph
    found, _ = pencil(graph, neutral(graph), lengths(graph))
    return join(select(graph, ~found)) if found.any() else graph
