"""Lines stay on their page."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..settings import Settings
from ..values import PlanarGraph
from .evidence import Evidence


def stay_on_page(graph: PlanarGraph, evidence: Evidence, settings: Settings) -> PlanarGraph:
    """Hold a curve that was continued beyond the edge of the page at that edge.

    Reads: the size of the page.
    Promises: all points on the page.
    """
    page = np.array(evidence.shape[::-1], np.float32)
    return replace(
        graph, vertices=np.clip(graph.vertices, 0, page), points=np.clip(graph.points, 0, page)
    )
