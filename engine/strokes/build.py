"""Walks -> strokes: points, widths, opacity and colour in input pixels."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np

from ..settings import Settings
from ..values import PlanarGraph, Stroke
from .walk import Walk

Array = np.ndarray


def build(graph: PlanarGraph, walks: Sequence[Walk], settings: Settings) -> list[Stroke]:
    """The strokes of walks, in their order; what is too short to be a line is left out."""
    return [stroke for w in walks if (stroke := _stroke(graph, w, settings)) is not None]


def _stroke(graph: PlanarGraph, walk: Walk, settings: Settings) -> Stroke | None:
    index = []
    for half in walk.halves:
        low, high = graph.offsets[half >> 1], graph.offsets[(half >> 1) + 1]
        part = np.arange(low, high)
        index.append((part[::-1] if half & 1 else part)[:-1])
    if not walk.closed:
        half = walk.halves[-1]
        index.append(
            graph.offsets[[half >> 1]] if half & 1 else graph.offsets[[(half >> 1) + 1]] - 1
        )
    index = np.concatenate(index)
    points = graph.points[index]
    step = np.hypot(*np.diff(points, axis=0).T)
    index = index[np.r_[True, step > 1e-6]]
    points = graph.points[index]
    if settings.tolerance > 0 and len(points) > 2:
        kept = cv2.approxPolyDP(points.reshape(-1, 1, 2), settings.tolerance, walk.closed).reshape(
            -1, 2
        )
        where = {tuple(p): k for k, p in enumerate(points.tolist())}
        index = index[[where[tuple(p)] for p in kept.tolist()]]
    points = graph.points[index]
    n = len(points)
    color = (0, 0, 0)
    if settings.inks and graph.colors is not None:
        color = tuple(int(c) for c in np.median(graph.colors[index], axis=0))
    return Stroke(
        points=np.ascontiguousarray(points, np.float32),
        widths=np.full(n, 4, np.float32)
        if graph.widths is None
        else graph.widths[index].astype(np.float32),
        opacity=np.ones(n, np.float32)
        if graph.strength is None
        else np.clip(graph.strength[index], 0, 1).astype(np.float32),
        closed=walk.closed,
        color=color,
        branches=np.array(walk.halves, np.int32),
    )
