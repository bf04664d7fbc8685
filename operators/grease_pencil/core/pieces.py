"""Cutting and joining the points of Grease Pencil strokes by their length along the traced line.

Pure NumPy. A piece may be polygon or Bezier; whatever attributes its points have stay with them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from .stroke_arrays import ALONG, BEZIER, FORMATS, Column, Curves, column

Array = np.ndarray

EPSILON = 0.02  # px; positions in metres and lengths in float32 are this exact
_BEYOND = 1.0  # px; how far float32 and smoothing may carry a point past the end of its line
_TURNS = (
    -1,
    0,
    1,
    2,
)  # a stretch of a closed stroke may begin before and end after its first point
_DEFAULTS = {"opacity": 1.0, "radius": 0.01}
_OPPOSITE = {
    "handle_left": "handle_right",
    "handle_right": "handle_left",
    "handle_type_left": "handle_type_right",
    "handle_type_right": "handle_type_left",
}


@dataclass(frozen=True, eq=False)
class Piece:
    """A stroke, or a part of one.

    cel, index: the Grease Pencil stroke that it comes from.
    points: attributes of its N points, (N, k) each.
    along: (N,) ascending length along the traced stroke, in pixels.
    cyclic: the last point continues in the first.
    """

    cel: int
    index: int
    points: dict[str, Column]
    along: Array
    cyclic: bool = False
    bezier: bool = False

    def __len__(self) -> int:
        return len(self.along)

    def rows(self, choice: Array | slice) -> Piece:
        """Some of the points, in any order."""
        points = {n: Column(c.type, c.values[choice]) for n, c in self.points.items()}
        return replace(self, points=points, along=self.along[choice])


def piece_of(cel: Curves, number: int, index: int, whole: float) -> Piece | None:
    """A stroke in the direction in which it was traced.

    Args:
        whole: length of the traced stroke, where a closed one begins again.

    Returns:
        None when its points can't be told any more: their order is not that of the traced line,
        or it is longer than that.
    """
    if ALONG not in cel.points or cel.points[ALONG].type != "FLOAT":
        return None
    part = slice(cel.offsets[index], cel.offsets[index + 1])
    piece = Piece(
        number,
        index,
        {name: Column(c.type, c.values[part]) for name, c in cel.points.items()},
        cel.point(ALONG)[part].astype(np.float64),
        bool(cel.curve("cyclic")[index]),
        cel.curve("curve_type", 1)[index] == BEZIER,
    )
    if not piece.bezier and "handle_left" in piece.points:  # joined to a Bezier it needs them
        places = piece.points["position"]
        piece = replace(piece, points=piece.points | dict.fromkeys(list(_OPPOSITE)[:2], places))
    if np.count_nonzero(np.diff(piece.along) < 0) > 0.5 * (len(piece) - 1):
        piece = reversed_piece(piece, piece.along[::-1])
    if piece.cyclic:  # its first point may have been moved along it
        piece = piece.rows(np.roll(np.arange(len(piece)), -int(np.argmin(piece.along))))
        if piece.along[-1] - piece.along[0] > whole + EPSILON:
            return None
    is_known = np.isfinite(piece.along).all() and piece.along.max(initial=0.0) <= whole + _BEYOND
    return piece if is_known and (np.diff(piece.along) >= -EPSILON).all() else None


def reversed_piece(piece: Piece, along: Array) -> Piece:
    """The points the other way round, with new lengths."""
    turned = piece.rows(slice(None, None, -1))
    points = {_OPPOSITE.get(name, name): c for name, c in turned.points.items()}
    return replace(turned, points=points, along=along)


def cut(piece: Piece, start: float, end: float, whole: float | None) -> Piece | None:
    """The part of a piece between two lengths, or None where it has none.

    Args:
        whole: length of a closed traced stroke, None for an open one.
    """
    if whole is not None and piece.cyclic:
        count = len(piece)
        along = np.concatenate([piece.along + turn * whole for turn in _TURNS])
        piece = replace(piece.rows(np.tile(np.arange(count), len(_TURNS))), along=along)
    piece = _with_point(_with_point(piece, start), end)
    inside = (piece.along >= start - EPSILON) & (piece.along <= end + EPSILON)
    if inside.sum() < min(2, len(piece)):
        return None
    return replace(piece.rows(inside), cyclic=False)


def join(pieces: Sequence[Piece], near: float, closed: bool) -> Piece:
    """Pieces one after the other; ends that lie together become one point.

    Args:
        near: distance in object units below which they do.
        closed: the last piece joins the first as well.
    """
    names = {name: c.type for piece in pieces for name, c in piece.points.items()}
    longest = max(pieces, key=len)
    points = {
        name: Column(kind, np.concatenate([_values(piece, name, kind) for piece in pieces]))
        for name, kind in names.items()
    }
    along = np.concatenate([piece.along for piece in pieces])
    whole = Piece(longest.cel, longest.index, points, along, closed, any(p.bezier for p in pieces))
    ends = np.cumsum([len(piece) for piece in pieces])
    seams = [(int(end) - 1, int(end) % len(along)) for end in (ends if closed else ends[:-1])]
    dropped = []
    places = points["position"].values
    for last, first in seams:
        if last == first or np.linalg.norm(places[last] - places[first]) > near:
            continue
        _fuse(points, last, first)
        dropped.append(last)
    return whole.rows(np.setdiff1d(np.arange(len(along)), dropped))


def _fuse(points: dict[str, Column], last: int, first: int) -> None:
    """Make the point `first` both points; arrays here are fresh copies."""
    middle = (points["position"].values[last] + points["position"].values[first]) / 2
    for name in ("handle_left", "handle_right"):
        if name in points:
            source = last if name == "handle_left" else first
            shift = middle - points["position"].values[source]
            points[name].values[first] = points[name].values[source] + shift
    for name in ("radius", "opacity"):
        if name in points:
            points[name].values[first] = (
                points[name].values[last] + points[name].values[first]
            ) / 2
    points["position"].values[first] = middle


def _values(piece: Piece, name: str, kind: str) -> Array:
    if name in piece.points:
        return piece.points[name].values
    if name in ("handle_left", "handle_right"):
        return piece.points["position"].values
    return column(kind, np.full(len(piece) * FORMATS[kind][2], _DEFAULTS.get(name, 0.0))).values


def _with_point(piece: Piece, at: float) -> Piece:
    """The piece with a point at that length, on the line between its neighbours."""
    after = int(np.searchsorted(piece.along, at))
    if after in (0, len(piece)) or np.abs(piece.along - at).min() <= EPSILON:
        return piece
    before = after - 1
    share = (at - piece.along[before]) / (piece.along[after] - piece.along[before])
    made = {}
    for name, col in piece.points.items():
        a, b = col.values[before], col.values[after]
        smooth = np.issubdtype(col.values.dtype, np.floating)
        value = (1 - share) * a + share * b if smooth else (a if share < 0.5 else b)
        made[name] = np.insert(col.values, after, value.astype(col.values.dtype), axis=0)
    if piece.bezier:
        _split_handles(made, after, share)
    points = {name: Column(piece.points[name].type, values) for name, values in made.items()}
    return replace(piece, points=points, along=np.insert(piece.along, after, at))


def _split_handles(points: dict[str, Array], new: int, share: float) -> None:
    """De Casteljau: the new point `new` divides the cubic between its neighbours."""
    corners = [
        points["position"][new - 1],
        points["handle_right"][new - 1],
        points["handle_left"][new + 1],
        points["position"][new + 1],
    ]
    a, b, c = ((1 - share) * p + share * q for p, q in pairwise(corners))
    ab, bc = (1 - share) * a + share * b, (1 - share) * b + share * c
    points["handle_right"][new - 1], points["handle_left"][new + 1] = a, c
    points["handle_left"][new], points["handle_right"][new] = ab, bc
    points["position"][new] = (1 - share) * ab + share * bc
