"""Projecting and picking: plain NumPy in screen space, so it needs neither GPU nor window."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ...engine import Bundle, Drawing, Junction

Array = np.ndarray

REACH = 60.0  # px of the drawing; how far a half-branch counts as belonging to its junction


def project(points: Array, matrix: Array, width: float, height: float) -> Array:
    """Where points appear in a region.

    Args:
        points: (N, 3) in the space that `matrix` starts from.
        matrix: (4, 4) perspective matrix of the view times the object's world matrix.

    Returns:
        (N, 2) pixels from the lower left corner; NaN behind the eye.
    """
    points = np.asarray(points, np.float64).reshape(-1, 3)
    seen = points @ matrix[:3, :3].T + matrix[:3, 3]
    depth = points @ matrix[3, :3] + matrix[3, 3]
    depth = np.where(depth > 1e-9, depth, np.nan)
    return (seen[:, :2] / depth[:, None] + 1.0) * (0.5 * width, 0.5 * height)


def unproject(places: Array, matrix: Array, plane: Array, width: float, height: float) -> Array:
    """Where places of a region lie on a plane: the way back of `project`.

    Args:
        places: (N, 2) pixels from the lower left corner.
        plane: (3, 3) rows: one step along x, one along y, the origin; in the space of `matrix`.

    Returns:
        (N, 2) steps along x and y.
    """
    places = np.asarray(places, np.float64).reshape(-1, 2)
    rows = matrix[[0, 1, 3]]
    seen = rows[:, :3] @ np.asarray(plane, np.float64).T
    seen[:, 2] += rows[:, 3]
    clip = places / (0.5 * width, 0.5 * height) - 1.0
    found = np.column_stack([clip, np.ones(len(clip))]) @ np.linalg.pinv(seen).T
    return found[:, :2] / np.where(found[:, 2:] == 0, np.nan, found[:, 2:])


def nearest(places: Array, mouse: tuple[float, float], radius: float) -> int:
    """The place nearest to the mouse within a radius; -1 when there is none."""
    distance = np.linalg.norm(places - np.asarray(mouse, float), axis=1)
    if not np.isfinite(distance).any():
        return -1
    best = int(np.nanargmin(distance))
    return best if distance[best] <= radius else -1


def inside(places: Array, outline: Array) -> Array:
    """(N,) bool: which places lie inside a closed outline (M, 2), by the even-odd rule."""
    places = np.asarray(places, np.float64).reshape(-1, 2)
    a, b = outline, np.roll(outline, -1, axis=0)
    x, y = places[:, :1], places[:, 1:]
    passes = (a[:, 1] > y) != (b[:, 1] > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        at = a[:, 0] + (y - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
        return (passes & (x < at)).sum(1) % 2 == 1


def distance_to_line(line: Array, mouse: tuple[float, float]) -> float:
    """How far the mouse is from a polyline; infinite where none of it can be seen."""
    line = line[np.isfinite(line).all(axis=1)]
    if len(line) < 2:
        return np.inf
    start, side = line[:-1], np.diff(line, axis=0)
    share = ((mouse - start) * side).sum(1) / np.maximum((side**2).sum(1), 1e-12)
    foot = start + np.clip(share, 0, 1)[:, None] * side
    return float(np.linalg.norm(foot - mouse, axis=1).min())


def nearest_pair(
    first: dict[int, float], second: dict[int, float], vertex: Array
) -> tuple[int, int] | None:
    """Of two sets of half-branches the nearest two that meet at one vertex.

    Args:
        first, second: half-branches and their distances from where a drag began and ended.
        vertex: (2B,) where each half-branch starts.
    """
    meeting = [
        (first[a] + second[b], a, b)
        for a in first
        for b in second
        if a != b and vertex[a] == vertex[b]
    ]
    return min(meeting)[1:] if meeting else None


def is_bundle(drawing: Drawing, place: Junction | Bundle) -> bool:
    """Is it about pencil strokes beside each other, and not about lines that meet?"""
    return place.index >= len(drawing.graph.places)


def lines_at(drawing: Drawing, place: Junction | Bundle) -> list[Array]:
    """(N, 2) px each: the lines that a junction or a bundle is about, near it."""
    if is_bundle(drawing, place):
        return list(drawing.parts_of(place))
    return [near_part(drawing, half) for half in place.half_branches]


def near_part(drawing: Drawing, half: int, reach: float = REACH, share: float = 0.5) -> np.ndarray:
    """(N, 2) px: a half-branch from its junction outward, no farther than a share of the branch."""
    points = drawing.graph.half_branch(half).astype(np.float64)
    lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    end = min(reach, share * lengths[-1])
    inside = lengths < end
    last = [np.interp(end, lengths, points[:, k]) for k in (0, 1)]
    return np.concatenate([points[inside], [last]])
