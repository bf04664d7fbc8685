"""How half-branches leave their junction, and how well two of them would make one line.

All lengths are in units of the pen width, so that the numbers mean the same on every scan.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..values import PlanarGraph

Array = np.ndarray

DEFAULT_WIDTH = 4.0  # px; for graphs whose widths were not measured
_SKIP = 0.6  # pen widths next to the junction that are not looked at: there the lines run together
_REACH = 3.5  # pen widths up to where the direction is fitted
_SAMPLES = 8


@dataclass(frozen=True, eq=False)
class HalfFeatures:
    """One row per half-branch; directions point away from the junction.

    unit: the pen width of the drawing in px.
    points: (2B, S, 2) samples along the half-branch, relative to its vertex, in pen widths.
    arc: (2B, S) how far along they lie, in pen widths.
    direction: (2B, 2) unit direction in which the line leaves, fitted beyond the blob.
    curvature: (2B,) signed, per pen width; positive turns right (y down) as seen walking away.
    length: (2B,) of the whole branch, in pen widths.
    width, strength: (2B,) medians near the junction, relative width and ink in [0, 1].
    color: (2B, 3) in [0, 1].
    """

    unit: float
    points: Array
    arc: Array
    direction: Array
    curvature: Array
    length: Array
    width: Array
    strength: Array
    color: Array


def half_features(graph: PlanarGraph) -> HalfFeatures:
    """Measure every half-branch; total cost linear in points."""
    unit = pen_width(graph)
    arc, length = arc_lengths(graph)
    half_length = np.repeat(length, 2) / unit
    low = np.minimum(_SKIP, 0.2 * half_length)
    high = np.minimum(_SKIP + _REACH, half_length)
    along = low[:, None] + (high - low)[:, None] * np.linspace(0, 1, _SAMPLES)
    at = _position(graph, arc, length, along * unit)
    points = _interp(at, graph.points) - graph.vertices[graph.half_vertex][:, None]
    points = points / unit

    # One quadratic per half-branch in its own window, by least squares with one shared design.
    u = np.linspace(-1, 1, _SAMPLES)
    fit = np.linalg.pinv(np.stack([np.ones_like(u), u, u * u / 2], 1))
    _, first, second = np.einsum("ks,hsc->khc", fit, points)
    span = np.maximum((high - low)[:, None] / 2, 1e-6)
    velocity, bend = first / span, second / span**2
    speed = np.maximum(np.hypot(*velocity.T), 1e-6)
    curvature = (velocity[:, 0] * bend[:, 1] - velocity[:, 1] * bend[:, 0]) / speed**3

    def near(values: Array | None, default: float, channels: int = 1) -> Array:
        if values is None:
            return np.full((len(at), channels), default)
        values = np.asarray(values, np.float64).reshape(len(values), channels)
        return np.median(_interp(at, values), axis=1)

    return HalfFeatures(
        unit=unit,
        points=points,
        arc=along,
        direction=velocity / speed[:, None],
        curvature=curvature,
        length=half_length,
        width=near(graph.widths, unit)[:, 0] / unit,
        strength=near(graph.strength, 1.0)[:, 0],
        color=near(graph.colors, 0.0, 3) / 255.0,
    )


def pen_width(graph: PlanarGraph) -> float:
    """The typical width of a line in px."""
    if graph.widths is None or not len(graph.widths):
        return DEFAULT_WIDTH
    return max(float(np.median(graph.widths)), 1e-3)


def arc_lengths(graph: PlanarGraph) -> tuple[Array, Array]:
    """Arc length of every point from the start of its branch (P,), and of every branch (B,)."""
    step = np.hypot(*np.diff(graph.points.astype(np.float64), axis=0).T)
    total = np.concatenate([[0.0], np.cumsum(step)])[: len(graph.points)]
    start = graph.offsets[:-1]
    size = np.diff(graph.offsets)
    arc = total - np.repeat(total[start], size)
    return arc, arc[graph.offsets[1:] - 1]


def _position(graph: PlanarGraph, arc: Array, length: Array, along: Array) -> Array:
    """Fractional point index at distances `along` (2B, S) px from the start of each half-branch."""
    margin = np.arange(graph.branch_count) + np.concatenate([[0.0], np.cumsum(length)])[:-1]
    key = arc + np.repeat(margin, np.diff(graph.offsets))
    branch = np.arange(len(along)) >> 1
    backward = (np.arange(len(along)) & 1).astype(bool)[:, None]
    s = np.where(backward, length[branch][:, None] - along, along) + margin[branch][:, None]
    at = np.interp(s, key, np.arange(len(key), dtype=np.float64))
    return np.clip(at, graph.offsets[branch][:, None], graph.offsets[branch + 1][:, None] - 1)


def _interp(at: Array, values: Array) -> Array:
    """Values at fractional indices `at` (...,): (..., C)."""
    low = np.minimum(at.astype(np.int64), max(len(values) - 2, 0))
    share = (at - low)[..., None]
    return values[low] * (1 - share) + values[low + 1] * share
