"""The closed regions of a drawing: faces of its planar graph, to be filled below the lines.

Walking along a branch and turning as sharply as can be to one side at every vertex goes round a
face; every half-branch belongs to exactly one (de Berg et al., "Computational Geometry", ch. 2).
"""

from __future__ import annotations

import cv2
import numpy as np

from ..values import Array, PlanarGraph

Region = tuple[Array, ...]


def closed_regions(graph: PlanarGraph, smallest: float = 0.0) -> tuple[Region, ...]:
    """The bounded faces of a graph, the largest first.

    Args:
        smallest: area below which a face is left out, px².

    Returns:
        For each face its rings, (N, 2) float32 px: the outer one, then those of the lines that
        stand free inside it. Lines that end inside a face do not bound it.
    """
    kept = _without_dead_ends(graph)
    if not kept.any():
        return ()
    following = _next_halves(graph, kept)
    face = _cycles(following)
    area = np.bincount(face, np.where(np.repeat(kept, 2), _half_areas(graph), 0.0))
    walked = np.bincount(face, np.repeat(kept, 2)) > 0
    inner = np.flatnonzero(walked & (area > max(smallest, 1e-3)))
    rings = {int(f): _ring(graph, following, f) for f in inner}
    # Seen from outside, the rim of a group of lines runs the other way round.
    rims = [_ring(graph, following, f) for f in np.flatnonzero(walked & (area < -1e-3))]
    regions = {f: [ring] for f, ring in rings.items()}
    boxes = np.array([[*r.min(axis=0), *r.max(axis=0)] for r in rings.values()]).reshape(-1, 4)
    for rim in rims:
        around = _innermost_around(rim, list(rings), rings, boxes, area)
        if around is not None:
            regions[around].append(rim)
    return tuple(tuple(regions[f]) for f in sorted(regions, key=lambda f: -area[f]))


def face_of_halves(graph: PlanarGraph) -> tuple[Array, Array]:
    """(2B,) the half-branch that lies before each one around its vertex, and (2B,) the face that is
    walked round along each; loose ends are walked out and back."""
    following = _next_halves(graph, np.ones(graph.branch_count, bool))
    return following[np.arange(len(following)) ^ 1], _cycles(following)


def areas_of(graph: PlanarGraph, face: Array) -> Array:
    """(2B,) px², by the number of the face; below zero where it is walked round from outside."""
    return np.bincount(face, _half_areas(graph), 2 * graph.branch_count)


def _without_dead_ends(graph: PlanarGraph) -> Array:
    """(B,) bool: branches that are left when loose ends are taken off until there are none."""
    kept = np.ones(graph.branch_count, bool)
    while True:
        degree = np.bincount(graph.ends[kept].ravel(), minlength=len(graph.vertices))
        loose = kept & (degree[graph.ends] == 1).any(axis=1)
        if not loose.any():
            return kept
        kept &= ~loose


def _next_halves(graph: PlanarGraph, kept: Array) -> Array:
    """(2B,) the half-branch to walk after each one, round the face on its side."""
    starts, stops = graph.offsets[:-1], graph.offsets[1:] - 1
    # The first step out of the vertex says how the branches lie around it.
    out = np.stack(
        [
            graph.points[starts + 1] - graph.points[starts],
            graph.points[stops - 1] - graph.points[stops],
        ],
        1,
    ).reshape(-1, 2)
    angle = np.arctan2(out[:, 1], out[:, 0])
    halves = np.flatnonzero(np.repeat(kept, 2))
    vertex = graph.half_vertex[halves]
    order = halves[np.lexsort((angle[halves], vertex))]
    at = graph.half_vertex[order]
    first = np.flatnonzero(np.diff(at, prepend=-1))
    before = np.arange(len(order)) - 1
    before[first] = np.append(first[1:], len(order)) - 1
    turn = np.arange(2 * graph.branch_count)
    turn[order] = order[before]
    return turn[np.arange(2 * graph.branch_count) ^ 1]


def _cycles(following: Array) -> Array:
    """The smallest member of each element's cycle, by pointer jumping."""
    label, jump = np.arange(len(following)), following
    for _ in range(int(np.ceil(np.log2(max(len(following), 2))))):
        label = np.minimum(label, label[jump])
        jump = jump[jump]
    return label


def _half_areas(graph: PlanarGraph) -> Array:
    """(2B,) what each half-branch adds to the area of its face, px²."""
    points = graph.points.astype(np.float64)
    step = np.zeros(len(points))
    step[:-1] = points[:-1, 0] * points[1:, 1] - points[:-1, 1] * points[1:, 0]
    step[graph.offsets[1:] - 1] = 0.0
    area = 0.5 * np.add.reduceat(step, graph.offsets[:-1])
    return np.stack([area, -area], 1).ravel()


def _ring(graph: PlanarGraph, following: Array, half: int) -> Array:
    """The outline of a face, walked from one of its half-branches."""
    pieces, at = [], int(half)
    while True:
        pieces.append(graph.half_branch(at)[:-1])
        at = int(following[at])
        if at == half:
            return np.concatenate(pieces).astype(np.float32)


def _innermost_around(
    rim: Array, faces: list[int], rings: dict[int, Array], boxes: Array, area: Array
) -> int | None:
    """The smallest face that a group of lines lies inside of, not being part of it."""
    low, high = rim.min(axis=0), rim.max(axis=0)
    near = (boxes[:, :2] < low).all(axis=1) & (boxes[:, 2:] > high).all(axis=1)
    point = (float(rim[0, 0]), float(rim[0, 1]))
    inside = [
        faces[k]
        for k in np.flatnonzero(near)
        if cv2.pointPolygonTest(rings[faces[k]].reshape(-1, 1, 2), point, False) > 0
    ]
    return min(inside, key=lambda f: area[f], default=None)
