"""Width, darkness and colour of the ink along every branch."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np

from ..arrays.sampling import sample
from ..settings import Settings
from ..values import Array, PlanarGraph, Scan
from .evidence import Evidence
from .limits import LIMITS
from .topology import lengths

_STEP = 0.5  # px between the samples across a line
_AROUND = 12  # points on either side of which one is the middle of a dash
_FULL = 0.85  # share of the most ink so near that the middle of a dash has
_SHORT = 1.0  # px; a shorter branch is a dot, as `skeleton_graph` makes them ...
# ... and so is, in pen widths, one that hangs on nothing: of 216 dots of 1 to 2.6 pens, nine in ten
# are at most 23 % off as the network measures them, and 6 % as the ink does.
_DOT = 0.5  # pen widths


def measure(graph: PlanarGraph, evidence: Evidence, settings: Settings) -> PlanarGraph:
    """Fill in what the ink says along a graph; one that is measured stays as it is.

    Reads: the scan, and the map of half widths where there is one; points about 1 px apart.
    Promises: widths (of the whole line, px), strength in [0, 1], and colors, None on a grey page.
    """
    scan, maps = evidence.scan, evidence.maps
    if graph.branch_count == 0 or graph.widths is not None or scan is None:
        return graph
    if maps.half_width is not None:
        widths = 2 * sample(maps.half_width, graph.points)
        # Of a dot the network sees half; nothing where another provider has seen the line.
        unknown = np.isnan(widths) | np.repeat(_dots(graph, scan), np.diff(graph.offsets))
        asked = np.flatnonzero(unknown)
        if len(asked):
            widths[asked] = _widths(graph, scan, asked)
    else:
        widths = _widths(graph, scan, np.arange(len(graph.points)))
    widths = np.where(np.isfinite(widths) & (widths > 0), widths, scan.pen_width)
    bare = over_paper(graph, scan) if settings.dashes else None
    near = slice(None) if bare is None else _nearest_ink(graph, scan, bare)
    widest = max(LIMITS.width_widest * scan.pen_width, 8.0)
    widths = np.clip(_agreed(graph, widths[near]), 0.5, widest).astype(np.float32)
    strength = np.clip(_agreed(graph, sample(scan.ink, graph.points)[near]), 0.0, 1.0)
    colors = None
    if scan.color is not None:
        colors = _agreed(graph, sample(scan.color, graph.points)[near])
        colors = np.rint(colors).astype(np.uint8)
    return replace(
        graph, widths=widths, strength=strength.astype(np.float32), colors=colors, bare=bare
    )


def over_paper(graph: PlanarGraph, scan: Scan) -> Array:
    """(P,) bool: where a branch runs over bare paper, compared with its ink and that of others."""
    ink = sample(scan.ink, graph.points)
    most = np.maximum.reduceat(ink, graph.offsets[:-1])
    most = np.maximum(most, np.median(most) / 2)
    bare: Array = ink < LIMITS.dash_bare * np.repeat(most, np.diff(graph.offsets))
    return bare


def _nearest_ink(graph: PlanarGraph, scan: Scan, bare: Array) -> Array:
    """(P,) for each point of a dashed line the nearest one on the full ink of a dash; for all other
    points themselves."""
    ink = sample(scan.ink, graph.points)
    around = cv2.dilate(ink[None], np.ones((1, 2 * _AROUND + 1), np.uint8))[0]
    full = np.flatnonzero(~bare & (ink >= _FULL * around))
    every = np.arange(len(bare))
    after = np.clip(np.searchsorted(full, every), 0, len(full) - 1)
    before = np.maximum(after - 1, 0)
    of = np.repeat(np.arange(graph.branch_count), np.diff(graph.offsets))
    away = [
        np.where(of[full[side]] == of, np.abs(full[side] - every), len(bare))
        for side in (before, after)
    ]
    nearest = full[np.where(away[0] < away[1], before, after)]
    dashed = np.logical_or.reduceat(bare, graph.offsets[:-1])[of]
    return np.where(dashed & (np.minimum(*away) < len(bare)), nearest, every)


def _dots(graph: PlanarGraph, scan: Scan) -> Array:
    """(B,) bool: which branches are dots of the pen."""
    length = lengths(graph)
    degree = np.bincount(graph.ends.ravel(), minlength=len(graph.vertices))
    alone = (degree[graph.ends] == 1).all(1)
    return (length < _SHORT) | (alone & (length < _DOT * scan.pen_width))


def _widths(graph: PlanarGraph, scan: Scan, asked: Array) -> Array:
    """(N,) width of the ink across the line at the points `asked` (N,): to half the darkness of its
    middle on either side."""
    reach = np.arange(0.0, max(3.0, 2.5 * scan.pen_width) + _STEP, _STEP)
    points, normal = graph.points[asked], _normals(graph)[asked]
    sides = []
    middle = sample(scan.ink, points)
    for sign in (-1.0, 1.0):
        at = points[:, None] + sign * reach[:, None] * normal[:, None]
        profile = sample(scan.ink, at)
        # The darkest point of the line need not be the traced one.
        level = 0.5 * np.maximum(middle, profile[:, :3].max(1))[:, None]
        paper = profile < level
        out = np.where(paper.any(1), paper.argmax(1), len(reach) - 1)
        inside = np.maximum(out - 1, 0)
        rows = np.arange(len(out))
        high, low = profile[rows, inside], profile[rows, out]
        part = np.clip((high - level[:, 0]) / np.maximum(high - low, 1e-6), 0.0, 1.0)
        sides.append(np.where(out > 0, reach[inside] + part * _STEP, 0.0))
    return sides[0] + sides[1]


def _normals(graph: PlanarGraph) -> Array:
    """(P, 2) unit vectors across the branches."""
    count = np.diff(graph.offsets)
    index = np.arange(len(graph.points))
    first, last = np.repeat(graph.offsets[:-1], count), np.repeat(graph.offsets[1:] - 1, count)
    points = graph.points.astype(np.float64)
    along = points[np.minimum(index + 2, last)] - points[np.maximum(index - 2, first)]
    along[np.hypot(*along.T) < 1e-6] = (1.0, 0.0)  # a dot: it is as wide in every direction
    return np.stack([-along[:, 1], along[:, 0]], -1) / np.hypot(*along.T)[:, None]


def _agreed(graph: PlanarGraph, values: Array) -> Array:
    """Running median along each branch: at a junction the other line counts for nothing."""
    count = np.diff(graph.offsets)
    index = np.arange(len(graph.points))[:, None]
    first = np.repeat(graph.offsets[:-1], count)[:, None]
    last = np.repeat(graph.offsets[1:] - 1, count)[:, None]
    window = np.clip(index + np.arange(-LIMITS.width_agreed, LIMITS.width_agreed + 1), first, last)
    middle = LIMITS.width_agreed
    agreed: Array = np.partition(values[window], middle, axis=1)[:, middle]
    return agreed
