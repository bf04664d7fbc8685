"""The values that the stages hand to each other: frozen dataclasses over NumPy arrays.

Coordinates are image coordinates in pixels, x to the right, y down; the centre of the pixel in
column i, row j is (i + 0.5, j + 0.5). Until `strokes`, pixels are working pixels: the drawing at
the scale where its pens are 2 to 8 px wide; `Scan.scale` leads back to the pixels of the input.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


@dataclass(frozen=True)
class Pose:
    """One of the eight ways in which a sheet can lie: how a page was turned to be looked at.

    transposed: rows and columns are exchanged, first; mirrored, flipped: then it is mirrored left
        to right, and top to bottom.
    """

    transposed: bool = False
    mirrored: bool = False
    flipped: bool = False

    def turned(self, page: Array) -> Array:
        """A page (H, W, ...) as it is looked at."""
        page = np.swapaxes(page, 0, 1) if self.transposed else page
        return np.ascontiguousarray(page[self._ways])

    def back(self, page: Array) -> Array:
        """A page (H, W, ...) that was turned, as it lay."""
        page = page[self._ways]
        return np.ascontiguousarray(np.swapaxes(page, 0, 1) if self.transposed else page)

    @property
    def _ways(self) -> tuple[slice, slice]:
        rows, columns = (-1 if way else 1 for way in (self.flipped, self.mirrored))
        return slice(None, None, rows), slice(None, None, columns)

    def points_back(self, points: Array, size: tuple[float, float]) -> Array:
        """Points (..., 2) on a turned page, on the page as it lay, `size` = (width, height)."""
        width, height = size[::-1] if self.transposed else size
        x, y = points[..., 0], points[..., 1]
        x = np.asarray(width, points.dtype) - x if self.mirrored else x
        y = np.asarray(height, points.dtype) - y if self.flipped else y
        return np.stack([y, x] if self.transposed else [x, y], -1)


@dataclass(frozen=True, eq=False)
class Scan:
    """A page, ready to trace.

    ink: (H, W) float32 in [0, 1]; 1 = full ink, paper and shading taken out.
    color: (H, W, 3) uint8 sRGB over white, or None for a grey page.
    scale: input pixels per working pixel.
    size: (width, height) of the input in its own pixels.
    pen_width: typical width of a line, in working pixels.
    aligned: False when it was to be aligned to other pages and has nothing to align by.
    light: whether it was taken, by itself, for light lines on a dark ground.
    notes: what was left out of it, a sentence each.
    pose: how the page was turned; ink and color are as it is looked at, size as it lay.
    overlooked: (H, W) bool, clear ink that was taken for paper; None = there is none.
    """

    ink: Array
    color: Array | None
    scale: float
    size: tuple[int, int]
    pen_width: float
    aligned: bool = True
    light: bool = False
    notes: tuple[str, ...] = ()
    pose: Pose = Pose()
    overlooked: Array | None = None

    def as_it_lay(self) -> Scan:
        """The same page, turned back."""
        if self.pose == Pose():
            return self
        color = None if self.color is None else self.pose.back(self.color)
        left = None if self.overlooked is None else self.pose.back(self.overlooked)
        ink = self.pose.back(self.ink)
        return replace(self, ink=ink, color=color, pose=Pose(), overlooked=left)


@dataclass(frozen=True, eq=False)
class LineMaps:
    """What a centerline provider sees in a scan; all maps (H, W) float32.

    centerline: probability that a line's centre runs through the pixel; a ridge about 2 px wide
        whose crest is the centre of the line.
    junctions, endpoints: heatmaps in [0, 1], or None.
    half_width: half the width of the line, in working pixels, valid near the ridge; or None.
    solid: probability of a solid black area, or None.
    doubled: probability that two lines or more share the ridge, valid near it; or None.
    apart: how far apart these lie, in working pixels, valid where they do; or None.
    clean: the ridge of the line that several pencil strokes mean; where each line is drawn once,
        the same as centerline; or None.
    lifted: along the last 10 px of every line that was drawn without lifting the pen, how near its
        end is: 1 at it, 0 where the line goes on; valid on the ridge; or None.
    features: (F, H / 2, W / 2) float32, what the maps are made of, to be sampled by whoever reads
        the picture; 0 on blank paper; or None.
    """

    centerline: Array
    junctions: Array | None = None
    endpoints: Array | None = None
    half_width: Array | None = None
    solid: Array | None = None
    doubled: Array | None = None
    apart: Array | None = None
    clean: Array | None = None
    lifted: Array | None = None
    features: Array | None = None


@dataclass(frozen=True, eq=False)
class PlanarGraph:
    """A planar straight-line graph: one vertex per junction, one polyline per branch.

    vertices: (V, 2) float32, px. Degree 1 = endpoint, >= 3 = junction, 2 = corner: a place where
        the pen may have been lifted, or where a closed loop begins (both ends of one branch).
    points: (P, 2) float32, px; the polylines of all branches one after the other. The first and
        last point of a branch ARE its end vertices.
    offsets: (B + 1,) int32; branch b is points[offsets[b]:offsets[b + 1]], at least 2 points.
    ends: (B, 2) int32 vertex ids of the first and last point.
    widths: (P,) float32 full line width in px, or None before it was measured.
    strength: (P,) float32 darkness of the ink in [0, 1], or None.
    colors: (P, 3) uint8 sRGB of the ink, or None.
    bare: (P,) bool, where a line goes on between its dashes or dots, over bare paper; or None.
    clues: (C, K) float32 what the picture says about a lift at each corner (`graph.lifts`), in
        order of `corners`; or None.

    Half-branches: 2 * b starts at ends[b, 0], 2 * b + 1 at ends[b, 1]; h ^ 1 is the counterpart.
    """

    vertices: Array
    points: Array
    offsets: Array
    ends: Array
    widths: Array | None = None
    strength: Array | None = None
    colors: Array | None = None
    clues: Array | None = None
    bare: Array | None = None

    @staticmethod
    def empty() -> PlanarGraph:
        """The graph of a blank page."""
        return PlanarGraph(
            np.zeros((0, 2), np.float32),
            np.zeros((0, 2), np.float32),
            np.zeros(1, np.int32),
            np.zeros((0, 2), np.int32),
        )

    def moved(self, place: Callable[[Array], Array]) -> PlanarGraph:
        """The same graph where a function puts its vertices and points, (N, 2) -> (N, 2)."""
        return replace(self, vertices=place(self.vertices), points=place(self.points))

    def scaled(self, factor: float) -> PlanarGraph:
        """The same graph in other pixels, `factor` times as many."""
        times = np.float32(factor)
        widths = None if self.widths is None else self.widths * times
        return replace(self.moved(lambda points: points * times), widths=widths)

    def measures(self, points: Array) -> dict[str, Array | None]:
        """What was measured at some of the points, by the name of its field.

        points: index of points, or (P,) bool.
        """
        found = {name: getattr(self, name) for name in ("widths", "strength", "colors", "bare")}
        return {name: None if of is None else of[points] for name, of in found.items()}

    @property
    def branch_count(self) -> int:
        return len(self.offsets) - 1

    def branch(self, index: int) -> Array:
        """The polyline of one branch, (N, 2)."""
        return self.points[self.offsets[index] : self.offsets[index + 1]]

    def half_branch(self, half: int) -> Array:
        """The polyline of the whole branch, read outward from the vertex that `half` starts at."""
        points = self.branch(half >> 1)
        return points[::-1] if half & 1 else points

    @cached_property
    def half_vertex(self) -> Array:
        """(2B,) int32: the vertex that each half-branch starts at."""
        return np.ascontiguousarray(self.ends.reshape(-1), np.int32)

    @cached_property
    def degrees(self) -> Array:
        """(V,) int32: the number of half-branches at each vertex."""
        return np.bincount(self.half_vertex, minlength=len(self.vertices)).astype(np.int32)

    @cached_property
    def halves_at(self) -> tuple[Array, Array]:
        """Half-branches grouped by vertex: (2B,) ids and (V + 1,) offsets."""
        order = np.argsort(self.half_vertex, kind="stable").astype(np.int32)
        starts = np.concatenate([[0], np.cumsum(self.degrees)]).astype(np.int32)
        return order, starts

    @cached_property
    def junctions(self) -> Array:
        """(J,) int32: vertex ids of degree >= 3, ascending; a junction's number indexes this."""
        return np.flatnonzero(self.degrees >= 3).astype(np.int32)

    @cached_property
    def corners(self) -> Array:
        """(C,) int32: vertex ids of degree 2, ascending: where the pen may have been lifted."""
        return np.flatnonzero(self.degrees == 2).astype(np.int32)

    @cached_property
    def places(self) -> Array:
        """(J + C,) int32: the vertices at which routing decides, junctions first, then corners."""
        return np.concatenate([self.junctions, self.corners])

    @cached_property
    def place_at(self) -> Array:
        """(V,) int64: the number of each vertex in `places`, -1 where routing decides nothing."""
        number = np.full(len(self.vertices), -1)
        number[self.places] = np.arange(len(self.places))
        return number

    def halves_of(self, vertex: int) -> Array:
        """The half-branches that start at a vertex, ascending."""
        order, starts = self.halves_at
        return order[starts[vertex] : starts[vertex + 1]]


Pair = tuple[int, int]


@dataclass(frozen=True)
class Alternative:
    """One way to route a junction: the joined pairs (a < b, ascending) and its probability."""

    pairs: tuple[Pair, ...]
    probability: float


@dataclass(frozen=True, eq=False)
class Routing:
    """Which half-branches continue in which: an involution.

    partner: (2B,) int32; partner[partner[h]] == h; partner[h] == h ends the stroke at h's vertex.
        Partners always start at the same vertex.
    pairs: (K, 2) int32 candidate pairs (a < b, same junction or corner), and
    pair_score: (K,) float32 log-odds of joining a pair against ending both.
    alternatives: for each junction and each corner (graph.places order) the ranked ways to route
        it.
    locked: (J + C,) bool; junctions and corners that the user has fixed.
    """

    partner: Array
    pairs: Array
    pair_score: Array
    alternatives: tuple[tuple[Alternative, ...], ...]
    locked: Array


@dataclass(frozen=True, eq=False)
class Stroke:
    """One line of the drawing, in input pixels.

    points: (N, 2) float32; for a Bezier stroke the anchors.
    widths: (N,) float32 full width; opacity: (N,) float32 in [0, 1].
    closed: the last point continues in the first (which is not repeated).
    color: sRGB 0..255.
    branches: (n,) int32 half-branches in walking order; h means branch h >> 1, walked from its
        start when h is even, from its end when h is odd.
    handles: (N, 2, 2) float32 left and right Bezier handle of every anchor, or None (polyline).
    dash: of a dashed or dotted line how long its dashes and the gaps between are, px; or None.
    """

    points: Array
    widths: Array
    opacity: Array
    closed: bool
    color: tuple[int, int, int]
    branches: Array
    handles: Array | None = None
    dash: tuple[float, float] | None = None


@dataclass(frozen=True, eq=False)
class Beside:
    """How pencil strokes run beside each other: all that the lines are made of, without the page.

    graph: the pencil strokes in evenly spaced samples, in input pixels.
    partner: (2B,) int32 involution of its half-branches; stroke s is the s-th of its walks.
    strokes: (R, 2) int32 for each stretch the stroke that it lies on, and the one beside it.
    right: (R,) bool whether that one lies to the right, along the first.
    spans: (R, 2) float32 where it begins and ends along the first of them, px.
    probability: (R,) float32 that both mean one line there.
    """

    graph: PlanarGraph
    partner: Array
    strokes: Array
    right: Array
    spans: Array
    probability: Array


@dataclass(frozen=True, eq=False)
class Answers:
    """What the artist said of pencil strokes that run beside each other, the latest last.

    strokes: (A, 2) int32 pencil strokes, the lower number first.
    spans: (A, 2) float32 from where to where along the first of them, px.
    one: (A,) bool: they are one line; else two.
    """

    strokes: Array
    spans: Array
    one: Array

    @classmethod
    def none(cls) -> Answers:
        return cls(np.zeros((0, 2), np.int32), np.zeros((0, 2), np.float32), np.zeros(0, bool))


@dataclass(frozen=True, eq=False)
class Pencil:
    """The strokes of a rough drawing, of which a clean one was made.

    strokes: as they were drawn, in input pixels; they run through no branches.
    said: (K, 2) int32: a pencil stroke, and a branch of the clean graph that it is a part of;
        what is in no row belongs to nothing. Sorted.
    beside: what the lines were made of; None in files of before it was kept.
    answers: what the artist said of it.
    """

    strokes: tuple[Stroke, ...]
    said: Array
    beside: Beside | None = None
    answers: Answers = field(default_factory=Answers.none)


@dataclass(frozen=True)
class Bundle:
    """Two pencil strokes beside each other, and what else is drawn with them, as the user sees it:
    is it one line or two?

    index: goes on after the numbers of the corners. position: between them, input pixels.
    strokes: the two pencil strokes. span: from where to where along the first, px.
    pairs: the two joined = one line; none = two lines.
    """

    index: int
    position: tuple[float, float]
    strokes: Pair
    span: tuple[float, float]
    pairs: tuple[Pair, ...]
    alternatives: tuple[Alternative, ...]
    locked: bool

    @property
    def degree(self) -> int:
        return 2

    @property
    def doubt(self) -> float:
        """1 - probability of the answer that is in force; 0 when the user has given it."""
        return _doubt(self)


@dataclass(frozen=True)
class Junction:
    """A junction, or a corner (of two half-branches), as the user sees it; position in input
    pixels; index into graph.places."""

    index: int
    position: tuple[float, float]
    half_branches: tuple[int, ...]
    pairs: tuple[Pair, ...]
    alternatives: tuple[Alternative, ...]
    locked: bool

    @property
    def degree(self) -> int:
        return len(self.half_branches)

    @property
    def doubt(self) -> float:
        """1 - probability of the routing that is in force; 0 when the user has locked it."""
        return _doubt(self)


def _doubt(place: Junction | Bundle) -> float:
    if place.locked:
        return 0.0
    chosen = (a.probability for a in place.alternatives if a.pairs == place.pairs)
    return 1.0 - next(chosen, 0.0)
