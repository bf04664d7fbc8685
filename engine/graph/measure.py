"""Width, strength and colour of the ink along every branch."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np

from ..values import LineMaps, PlanarGraph, Scan
from .sampling import sample

Array = np.ndarray


def measure(graph: PlanarGraph, scan: Scan, maps: LineMaps) -> PlanarGraph:
    """Fill in widths (px), strength and colours of a graph, from the page it was traced on."""
    if graph.branch_count == 0:
        return graph
    half = maps.half_width
    if half is None:
        # The distance to the paper, from the middle of the pixels: half a pixel short.
        half = cv2.distanceTransform(
            (scan.ink > 0.5).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE
        )
    widths = np.clip(2 * sample(half, graph.points), 1.0, 8 * scan.pen_width)
    strength = np.clip(sample(scan.ink, graph.points), 0.0, 1.0)
    colors = None
    if scan.color is not None:
        colors = np.rint(sample(scan.color, graph.points)).astype(np.uint8)
    return replace(graph, widths=widths, strength=strength, colors=colors)
