"""Width, strength and colour of the ink along every branch."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np

from ..values import LineMaps, PlanarGraph, Scan

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


def sample(image: Array, points: Array) -> Array:
    """Bilinear values (N,) or (N, C) float32 of an image at points (N, 2) in px."""
    maps = np.ascontiguousarray(points, np.float32).reshape(1, -1, 2) - np.float32(0.5)
    # OpenCV's remap takes at most 32767 columns; fold the list.
    rows = -(-maps.shape[1] // 16384)
    padded = np.zeros((rows * 16384, 2), np.float32)
    padded[: maps.shape[1]] = maps[0]
    padded = padded.reshape(rows, 16384, 2)
    values = cv2.remap(
        np.ascontiguousarray(image), padded, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE
    )
    return values.reshape(rows * 16384, *image.shape[2:])[: maps.shape[1]]
