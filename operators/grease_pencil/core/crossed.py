"""Where a swipe crosses strokes, as lengths along the strokes as they were traced. Pure NumPy."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....engine.arrays.ragged import along as places_along
from .pixel_map import PixelMap
from .stretches import corners, whole_length
from .stroke_arrays import ALONG, BEZIER, HALF, TRACE, Curves

if TYPE_CHECKING:
    from ....engine import Drawing, Stroke

Array = np.ndarray

_PARTS = 8  # straight lines that stand for one cubic of a Bezier stroke


class Crossing(NamedTuple):
    """half: of the stroke that is crossed, its first one; point: px, on the line as traced."""

    half: int
    point: tuple[float, float]


def crossed(
    drawing: Drawing, cels: Sequence[Curves], key: int, pixel_map: PixelMap, path: Array
) -> list[Crossing]:
    """The strokes of a trace that a path crosses, as they lie there now.

    Args:
        cels: what the layers show. key: of the trace. path: (N, 2) px of the page.
    """
    found = []
    owner = {int(h) >> 1: s for s in drawing.strokes for h in s.branches}
    for cel in cels:
        if not len(cel) or ALONG not in cel.points:
            continue
        mine = (cel.mark(TRACE) == key) & (cel.mark(HALF) > 0)
        for curve in np.flatnonzero(mine).tolist():
            stroke = owner.get((int(cel.mark(HALF)[curve]) - 1) >> 1)
            if stroke is None:
                continue
            whole = whole_length(stroke)
            line, along = line_on_page(cel, curve, pixel_map, whole)
            at = [_within(length, whole) for length in crossings(line, along, path)]
            if not at:
                continue
            for x, y in places_along(corners(stroke), np.array(at)).tolist():
                found.append(Crossing(int(stroke.branches[0]), (x, y)))
    return found


def crossings(line: Array, along: Array, path: Array) -> list[float]:
    """The lengths at which a polyline (M, 2) with lengths (M,) is crossed by another (N, 2)."""
    if len(line) < 2 or len(path) < 2:
        return []
    low, high = path.min(0), path.max(0)
    a, b = line[:-1], line[1:]
    near = ((np.minimum(a, b) <= high) & (np.maximum(a, b) >= low)).all(1)
    a, side, start = a[near][:, None], (b - a)[near][:, None], along[:-1][near][:, None]
    rise = np.diff(along)[near][:, None]
    p, way = path[None, :-1], np.diff(path, axis=0)[None]
    turn = _cross(side, way)
    with np.errstate(divide="ignore", invalid="ignore"):
        t, u = _cross(p - a, way) / turn, _cross(p - a, side) / turn
        hit = (t >= 0) & (t < 1) & (u >= 0) & (u < 1)
        return sorted((start + t * rise)[hit].tolist())


def cut_all(drawing: Drawing, places: Sequence[Crossing]) -> Drawing:
    """Cut strokes at all of these places; where one ends anyway, nothing is cut.

    Raises:
        InvoluteError: no stroke goes on at any of them.
    """
    from ....engine import InvoluteError

    pieces = {int(s.branches[0]): {int(h) >> 1 for h in s.branches} for s in drawing.strokes}
    problem, done = None, False
    for half, point in places:
        family = pieces[half]
        mine = [
            k
            for k, stroke in enumerate(drawing.strokes)
            if not family.isdisjoint((stroke.branches >> 1).tolist())
        ]
        away = [np.hypot(*(_dense(drawing.strokes[k]) - point).T).min() for k in mine]
        before = drawing.graph.branch_count
        try:
            drawing = drawing.cut(mine[int(np.argmin(away))], point)
        except InvoluteError as error:
            problem = error
            continue
        done = True
        family.update(range(before, drawing.graph.branch_count))
    if problem is not None and not done:
        raise problem
    return drawing


def _dense(stroke: Stroke) -> Array:
    """The polyline of a stroke with points between its own."""
    points = corners(stroke)
    share = np.linspace(0, 1, _PARTS, endpoint=False)[:, None, None]
    between = (1 - share) * points[:-1] + share * points[1:]
    return np.concatenate([between.reshape(-1, 2), points[-1:]])


def _within(along: float, whole: float) -> float:
    return along if 0.0 <= along <= whole else along % whole


def line_on_page(cel: Curves, curve: int, pixel_map: PixelMap, whole: float) -> tuple[Array, Array]:
    """A stroke as it lies on the page now, and the lengths at its points as it was traced.

    Args:
        whole: length of the stroke, where a closed one begins again.
    """
    part = slice(cel.offsets[curve], cel.offsets[curve + 1])
    points = pixel_map.to_pixels(cel.point("position")[part])
    along = cel.point(ALONG)[part].astype(float)
    closed = bool(cel.curve("cyclic")[curve]) and len(points) > 2
    order = np.arange(len(points))
    if closed:
        order = np.append(order, 0)
        along = np.unwrap(np.append(along, along[0] + whole), period=whole)
    if cel.curve("curve_type", 1)[curve] != BEZIER:
        return points[order], along
    right = pixel_map.to_pixels(cel.point("handle_right")[part])[order]
    left = pixel_map.to_pixels(cel.point("handle_left")[part])[order]
    return _sampled(points[order], left, right, along)


def _sampled(points: Array, left: Array, right: Array, along: Array) -> tuple[Array, Array]:
    a, b, c, d = points[:-1], right[:-1], left[1:], points[1:]
    t = np.linspace(0, 1, _PARTS, endpoint=False)[:, None, None]
    weights = ((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3)
    places = sum(w * p for w, p in zip(weights, (a, b, c, d), strict=True))
    places = np.swapaxes(places, 0, 1).reshape(-1, 2)
    lengths = (along[:-1, None] + np.diff(along)[:, None] * t[:, 0, 0]).reshape(-1)
    return np.concatenate([places, points[-1:]]), np.append(lengths, along[-1])


def _cross(a: Array, b: Array) -> Array:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
