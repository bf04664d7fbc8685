"""One line through some strokes that the artist says are one.

The strokes move together (`consensus`), and the line follows the longest way through the shortest
tree that has all of their samples: so it also goes on where they lie end to end, over gaps.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays.ragged import along, arc
from ..values import Array, PlanarGraph
from .beside import rungs
from .consensus import consensus
from .sampled import SPACING, Sampled

_REACH = 6.0  # pens and more between strokes that move together; the artist said that they are one
_MOST = 1500  # samples; more are thinned out, since every one is compared with every other
_SMOOTH = 6  # times that the line's neighbours are averaged: sigma of about 2 samples
_RING = 0.15  # of its length; ends nearer than that, and side by side, close the line


def one_line(strokes: Sequence[tuple[Array, Array]]) -> tuple[Array, Array, bool]:
    """The line that strokes mean together: (N, 2) points, (N,) widths, and whether it is closed.

    Args:
        strokes: points (N, 2), N >= 2, and widths (N,) of each, px.
    """
    graph = _graph(strokes)
    samples = Sampled.of(graph, np.arange(2 * graph.branch_count))
    low = samples.points.min(0) - 2
    page = Sampled.of(graph.moved(lambda points: points - low), np.arange(2 * graph.branch_count))
    height, width = (int(v) + 3 for v in page.points.max(0)[::-1])
    pen = float(np.median(page.width))
    found = rungs(page, (height, width), _REACH * pen + _spread(page.points))
    moved = consensus(page, found, np.ones(len(found.a)))
    every = -(-len(moved) // _MOST)
    way = _longest_way(moved[::every])
    line = moved[::every][way]
    closed = _is_ring(line)
    line = _smoothed(line, closed)
    points = along(line, np.linspace(0, arc(line)[-1], max(int(arc(line)[-1] / SPACING), 2) + 1))
    return points + low, np.full(len(points), pen), closed


def _graph(strokes: Sequence[tuple[Array, Array]]) -> PlanarGraph:
    count = np.array([len(points) for points, _ in strokes])
    points = np.concatenate([points for points, _ in strokes]).astype(np.float32)
    ends = np.concatenate([points[[0, -1]] for points, _ in strokes]).astype(np.float32)
    return PlanarGraph(
        vertices=ends,
        points=points,
        offsets=np.concatenate([[0], np.cumsum(count)]).astype(np.int32),
        ends=np.arange(2 * len(count), dtype=np.int32).reshape(-1, 2),
        widths=np.concatenate([widths for _, widths in strokes]).astype(np.float32),
        strength=np.ones(len(points), np.float32),
    )


def _spread(points: Array) -> float:
    """A hundredth of how far the strokes reach, px: long lines are drawn less exactly."""
    return 0.01 * float(np.hypot(*np.ptp(points, axis=0)))


def _longest_way(points: Array) -> Array:
    """Numbers of the points along the longest way through their shortest tree."""
    parent, order, place = _shortest_tree(points)
    start = _way_up(parent, int(place.argmax()))
    # The other end is farthest from the first one, over wherever the ways to them part.
    fork = np.arange(len(points))
    on_way = np.zeros(len(points), bool)
    on_way[start] = True
    for point in order:
        if not on_way[point]:
            fork[point] = fork[parent[point]]
    other = int((place - 2 * place[fork]).argmax())
    second = _way_up(parent, other)
    first = start[: int(np.flatnonzero(start == fork[other])[0]) + 1]
    return np.concatenate([first, second[: int(np.flatnonzero(second == fork[other])[0])][::-1]])


def _shortest_tree(points: Array) -> tuple[Array, list[int], Array]:
    """Prim's: (N,) parent of each point, -1 at the root; their order from it; (N,) px to it."""
    count = len(points)
    parent, place = np.full(count, -1), np.zeros(count)
    away, nearest = np.full(count, np.inf), np.zeros(count, np.int64)
    order = [0]
    while len(order) < count:
        here = order[-1]
        away[here] = -1.0
        step = np.hypot(*(points - points[here]).T)
        closer = step < away
        away[closer], nearest[closer] = step[closer], here
        here = int(np.where(away < 0, np.inf, away).argmin())
        parent[here] = nearest[here]
        place[here] = place[parent[here]] + away[here]
        order.append(here)
    return parent, order, place


def _way_up(parent: Array, point: int) -> Array:
    """The points from one up to the root."""
    way = [point]
    while parent[way[-1]] >= 0:
        way.append(int(parent[way[-1]]))
    return np.array(way)


def _is_ring(line: Array) -> bool:
    gap = float(np.hypot(*(line[0] - line[-1])))
    whole = float(arc(line)[-1])
    return len(line) > 8 and gap < _RING * whole and gap < 0.3 * float(np.ptp(line, axis=0).max())


def _smoothed(line: Array, closed: bool) -> Array:
    """The line without the steps from stroke to stroke; its ends stay."""
    if closed:
        line = np.concatenate([line, line[:1]])
    for _ in range(_SMOOTH):
        inner = 0.25 * line[:-2] + 0.5 * line[1:-1] + 0.25 * line[2:]
        if closed:
            tip = 0.25 * line[-2:-1] + 0.5 * line[:1] + 0.25 * line[1:2]
            line = np.concatenate([tip, inner, tip])
        else:
            line = np.concatenate([line[:1], inner, line[-1:]])
    return line
