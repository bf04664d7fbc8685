"""Grease Pencil strokes as NumPy arrays, without Blender.

Every stroke that comes from a trace carries three attributes, so that it can be told after the
artist has worked on it (named with a dot: hidden from the lists in the interface):

    .involute_trace   per stroke   key of the drawing in the data-block (see `state`); 0 = by hand
    .involute_half    per stroke   first half-branch of the stroke in that drawing, counted from 1;
                                   negative for what has no branches (solid blacks)
    .involute_routing per stroke   which routing of the drawing the stroke is in (see
                                   `stored_trace.mark_of`); 0 or missing = the one before the first
                                   change
    involute_line     per stroke   of a pencil stroke: `.involute_half` of the line that it is part
                                   of, as it was traced; 0 = of none
    involute_dash     per stroke   how long the dashes and the gaps of a dashed line are; (0, 0) of
                                   another line; missing where there is none
    .involute_along   per point    length along the stroke as it was traced, in pixels

Blender interpolates the last one when points are added and keeps it when they move, so it still
says which part of the traced line a point belongs to.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from .pixel_map import PixelMap

if TYPE_CHECKING:
    from ....engine import Stroke

Array = np.ndarray

POLY, BEZIER = 1, 2  # Blender's numbers for the types of a curve
TRACE, HALF, ALONG = ".involute_trace", ".involute_half", ".involute_along"
ROUTING = ".involute_routing"
LINE = "involute_line"
DASH = "involute_dash"

WEIGHT = "WEIGHT"  # no attribute but a vertex group: see `vertex_weights`

# What foreach_set calls the value, its NumPy type and its length, for each type of attribute.
FORMATS: dict[str, tuple[str, type, int]] = {
    "FLOAT": ("value", np.float32, 1),
    "INT": ("value", np.int32, 1),
    "INT8": ("value", np.int8, 1),
    "BOOLEAN": ("value", np.bool_, 1),
    "FLOAT_VECTOR": ("vector", np.float32, 3),
    "FLOAT2": ("vector", np.float32, 2),
    "FLOAT_COLOR": ("color", np.float32, 4),
    "BYTE_COLOR": ("color", np.float32, 4),
    "INT32_2D": ("value", np.int32, 2),
    "QUATERNION": ("value", np.float32, 4),
    WEIGHT: ("", np.float32, 1),
}


@dataclass(frozen=True, eq=False)
class Column:
    """One attribute: Blender's type, and an (N, k) array."""

    type: str
    values: Array


@dataclass(frozen=True, eq=False)
class Curves:
    """Strokes of one Grease Pencil drawing as arrays.

    offsets: (n + 1,) int32; stroke i has the points offsets[i]:offsets[i + 1].
    points, curves: attributes per point and per stroke, by name.
    """

    offsets: Array
    points: dict[str, Column] = field(default_factory=dict)
    curves: dict[str, Column] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.offsets) - 1

    @property
    def sizes(self) -> Array:
        """(n,) how many points each stroke has."""
        return np.diff(self.offsets)

    def mark(self, name: str) -> Array:
        """(n,) int64: one of the attributes that mark strokes as traced; 0 where it is not ours."""
        made = self.curves.get(name)
        if made is None or made.type != "INT":
            return np.zeros(len(self), np.int64)
        return made.values[:, 0].astype(np.int64)

    def point(self, name: str, default: float = 0.0) -> Array:
        """An attribute of the points, (N,) or (N, k); full of `default` where there is none."""
        return self._get(self.points, name, int(self.offsets[-1]), default)

    def curve(self, name: str, default: float = 0.0) -> Array:
        """The same for the strokes."""
        return self._get(self.curves, name, len(self), default)

    @staticmethod
    def _get(columns: dict[str, Column], name: str, count: int, default: float) -> Array:
        if name not in columns:
            return np.full(count, default)
        values = columns[name].values
        return values[:, 0] if values.shape[1] == 1 else values


def column(kind: str, values: Array) -> Column:
    """A column of one of Blender's attribute types."""
    _, dtype, width = FORMATS[kind]
    return Column(kind, np.ascontiguousarray(values, dtype).reshape(-1, width))


def stroke_curves(
    strokes: Sequence[Stroke], pixel_map: PixelMap, key: int, material: int
) -> Curves:
    """The engine's strokes as Grease Pencil attributes."""
    sizes = np.fromiter((len(s.points) for s in strokes), np.int32, len(strokes))
    offsets = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32)
    points = np.concatenate([s.points for s in strokes])
    radius = np.concatenate([s.widths for s in strokes]) * (0.5 * pixel_map.unit)
    halves = np.fromiter(
        (int(s.branches[0]) + 1 if len(s.branches) else -1 for s in strokes), np.int32, len(sizes)
    )
    curved = np.fromiter((s.handles is not None for s in strokes), bool, len(sizes))
    point_columns = {
        "position": column("FLOAT_VECTOR", pixel_map.to_object(points)),
        "radius": column("FLOAT", radius),
        "opacity": column("FLOAT", np.concatenate([s.opacity for s in strokes])),
        ALONG: column("FLOAT", lengths_along(points, offsets)),
    }
    if curved.any():
        handles = pixel_map.to_object(np.concatenate([_handles(s) for s in strokes]))
        point_columns |= {
            "handle_left": column("FLOAT_VECTOR", handles[:, 0]),
            "handle_right": column("FLOAT_VECTOR", handles[:, 1]),
            "handle_type_left": column("INT8", np.zeros(len(points))),  # free
            "handle_type_right": column("INT8", np.zeros(len(points))),
        }
    closed = np.fromiter((s.closed for s in strokes), bool, len(sizes))
    curve_columns = {
        "cyclic": column("BOOLEAN", closed),
        "material_index": column("INT", np.full(len(sizes), material)),
        "curve_type": column("INT8", np.where(curved, BEZIER, POLY)),
        TRACE: column("INT", np.full(len(sizes), key)),
        HALF: column("INT", halves),
    }
    dashes = np.array([s.dash or (0.0, 0.0) for s in strokes])
    if dashes.any():
        curve_columns[DASH] = column("FLOAT2", dashes * pixel_map.unit)
    return Curves(offsets, point_columns, curve_columns)


def lengths_along(points: Array, offsets: Array) -> Array:
    """(N,) float64: length from the start of each polyline to each of its points."""
    if len(points) == 0:
        return np.zeros(0)
    steps = np.zeros(len(points))
    steps[1:] = np.linalg.norm(np.diff(points.astype(np.float64), axis=0), axis=1)
    steps[offsets[:-1]] = 0.0
    total = np.cumsum(steps)
    return total - np.repeat(total[offsets[:-1]], np.diff(offsets))


def bridge_holes(rings: Sequence[Array]) -> Array:
    """One outline that leaves the holes out: each is reached by a bridge walked there and back.

    Args:
        rings: (N, 2) outlines, the outer one first.
    """
    outline = np.asarray(rings[0], np.float32)
    holes = [np.asarray(hole, np.float32) for hole in rings[1:] if len(hole) >= 3]
    while holes:
        bridges = [_shortest_bridge(outline, hole) for hole in holes]
        nearest = int(np.argmin([bridge[0] for bridge in bridges]))
        _, at, start = bridges[nearest]
        hole = np.roll(holes.pop(nearest), -start, axis=0)
        if _area(hole) * _area(outline) > 0:
            hole = np.roll(hole[::-1], 1, axis=0)
        outline = np.concatenate([outline[: at + 1], hole, hole[:1], outline[at:]])
    return outline


def _shortest_bridge(outline: Array, hole: Array) -> tuple[float, int, int]:
    """Distance and the two point numbers; a few dozen points of the hole are enough to try."""
    tried = np.arange(0, len(hole), max(1, len(hole) // 48))
    squares = ((outline[:, None] - hole[None, tried]) ** 2).sum(-1)
    at, column = np.unravel_index(np.argmin(squares), squares.shape)
    return float(squares[at, column]), int(at), int(tried[column])


def _area(ring: Array) -> float:
    x, y = ring.astype(np.float64).T
    return float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2


def _handles(stroke: Stroke) -> Array:
    """(N, 2, 2) handles; a polyline's lie on its points."""
    if stroke.handles is not None:
        return stroke.handles
    return np.repeat(stroke.points[:, None], 2, axis=1)


def concatenate(parts: Sequence[Curves]) -> Curves:
    """Strokes of several sets in one; an attribute that one lacks is zero there."""
    sizes = np.concatenate([part.sizes for part in parts]) if parts else np.zeros(0, int)
    return Curves(
        np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32),
        _stacked([part.points for part in parts], [int(part.offsets[-1]) for part in parts]),
        _stacked([part.curves for part in parts], [len(part) for part in parts]),
    )


def _stacked(columns: Sequence[dict[str, Column]], counts: Sequence[int]) -> dict[str, Column]:
    types = {name: c.type for part in columns for name, c in part.items()}
    blank: dict[str, np.ndarray] = {
        name: np.zeros((1, FORMATS[kind][2]), FORMATS[kind][1]) for name, kind in types.items()
    }
    return {
        name: Column(
            kind,
            np.concatenate(
                [
                    part[name].values if name in part else np.repeat(blank[name], count, 0)
                    for part, count in zip(columns, counts, strict=True)
                ]
            ),
        )
        for name, kind in types.items()
    }
