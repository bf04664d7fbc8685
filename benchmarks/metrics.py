"""How close a traced drawing comes to the true pen strokes.

Every figure is taken with the long side of the drawing scaled to 1024 px, so that thresholds in
pixels mean the same on all drawings:

    chamfer       mean distance between the lines, both directions averaged
    length_diff   |traced length - true length|
    density       r_SD: strokes per length, traced over true; 1 = as few pieces as the artist drew
    crossings     points where strokes cross, or where one ends on another, found within 1.5 px
    f1            strokes recovered one to one: 90 % of the true stroke within 3 px, and less than
                  10 % of the traced one away from it
    routing       of the true continuations through a junction, how many one traced stroke makes
    false joins   of the wrong continuations, how many a traced stroke makes all the same

Chamfer, length, density and crossings follow "Stroke Vectorization via Involution Prediction",
section 6; the others say whether the strokes are the artist's strokes.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from os import PathLike
from xml.etree import ElementTree

import numpy as np
import shapely
from scipy.sparse import coo_matrix, csr_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

Array = np.ndarray

LONG_SIDE = 1024.0
CROSSING_RADII = (1.5, 3.0, 5.0)  # px; a crossing counts as found within the first
_TOUCH = 1.5  # px; a stroke that ends this near to another touches it
_MERGE = 3.0  # px; crossings and branches nearer than this are one
_NEAR = 3.0  # px; a line this near runs along the other
_COVER, _OFF = 0.9, 0.1  # shares that make a stroke recovered
_WALK = 8.0  # px along a branch, from its junction to where its course is read
_HOLD = 4.0  # px; strokes that pass a junction within this belong to it
_PASS = 6.0  # px along a stroke between two passes of one junction
_ALONG = 0.7  # cosine between a branch and the stroke that covers it


class Strokes:
    """Polylines, sampled every pixel along their length.

    Args:
        polylines: (N, 2) arrays, px, N >= 2, no point twice in a row.
    """

    def __init__(self, polylines: Sequence[Array]) -> None:
        self.polylines = [np.asarray(line, float) for line in polylines]
        arcs = [_arc_length(line) for line in self.polylines]
        self.length = np.array([arc[-1] for arc in arcs])
        gap = np.array([np.hypot(*(line[0] - line[-1])) for line in self.polylines])
        self.closed = (gap <= _TOUCH) & (self.length > 6)

        # One axis for all strokes: each takes its length and 1 px of air behind it.
        self._start = np.concatenate([[0.0], np.cumsum(self.length + 1.0)])[:-1]
        if self.polylines:
            along = [start + arc for start, arc in zip(self._start, arcs, strict=True)]
            self._axis = np.concatenate(along)
            self._vertices = np.concatenate(self.polylines)

        steps = np.maximum(1, np.rint(self.length)).astype(int)
        self.stroke = np.repeat(np.arange(len(self)), steps + 1)
        number = np.arange(len(self.stroke)) - np.repeat(
            np.cumsum(steps + 1) - (steps + 1), steps + 1
        )
        self.arc = np.minimum((self.length / steps)[self.stroke] * number, self.length[self.stroke])
        self.samples = self.at(self.stroke, self.arc)
        self.tree = cKDTree(self.samples) if len(self.samples) else None

    def __len__(self) -> int:
        return len(self.polylines)

    def at(self, stroke: Array, arc: Array) -> Array:
        """(K, 2) points at an arc length of a stroke; around the loop on a closed one."""
        if not len(stroke):
            return np.zeros((0, 2))
        length = self.length[stroke]
        # The end of a loop stays at its end: only what lies outside [0, length] wraps.
        outside = self.closed[stroke] & ((arc < 0) | (arc > length))
        arc = np.clip(np.where(outside, arc % length, arc), 0, length)
        place = self._start[stroke] + arc
        return np.stack([np.interp(place, self._axis, v) for v in self._vertices.T], -1)

    def inside(self, stroke: Array, arc: Array) -> Array:
        """Whether a stroke reaches an arc length; a closed one always does."""
        return self.closed[stroke] | ((arc >= 0) & (arc <= self.length[stroke]))

    def tangent(self, stroke: Array, arc: Array, reach: float = 2.0) -> Array:
        """(K, 2) unit directions of growing arc length, over 2 * reach px."""
        step = self.at(stroke, arc + reach) - self.at(stroke, arc - reach)
        norm = np.hypot(*step.T)[:, None]
        return np.divide(step, norm, out=step, where=norm > 0)


@dataclass(frozen=True)
class Score:
    """The counts and distances of one drawing; ratios are pooled by `summarize`.

    crossings_found: within each of `CROSSING_RADII`. branching_*: only the crossings with three
    or more branches, which are those that a raster method can see. branching_matched: predicted
    branching crossings that are true ones, within the first radius.
    """

    strokes: int
    true_strokes: int
    length: float
    true_length: float
    chamfer: float
    crossings: int
    true_crossings: int
    crossings_found: tuple[int, ...]
    branching: int
    true_branching: int
    branching_found: tuple[int, ...]
    branching_matched: int
    recovered: int
    continuations: int
    continuations_kept: int
    wrong_joins: int
    wrong_joins_made: int
    failed: bool = False

    @property
    def length_diff(self) -> float:
        return abs(self.length - self.true_length)

    @property
    def density(self) -> float:
        """r_SD; infinite when nothing was traced."""
        if not self.length or not self.true_strokes:
            return float("inf")
        return (self.strokes / self.length) / (self.true_strokes / self.true_length)

    @property
    def f1(self) -> float:
        return 2 * self.recovered / max(1, self.strokes + self.true_strokes)


def evaluate(predicted: Sequence[Array], truth: Sequence[Array], *, failed: bool = False) -> Score:
    """Compare traced strokes with the true ones.

    Args:
        predicted, truth: polylines (N, 2) in px, both scaled to a long side of 1024 px, as
            `read_svg` and `scaled` give them; a closed stroke repeats its first point.
        failed: nothing was traced, because of an error; counts as all wrong, wrong joins too.
    """
    pred, true = Strokes(predicted), Strokes(truth)
    found, actual = crossings(pred), crossings(true)
    true_branches, branches = _Branches(true, actual), _Branches(pred, found)
    branching, true_branching = found[branches.degree >= 3], actual[true_branches.degree >= 3]
    kept, continuations, made, wrong = _routing(pred, true, true_branches)
    return Score(
        strokes=len(pred),
        true_strokes=len(true),
        length=float(pred.length.sum()),
        true_length=float(true.length.sum()),
        chamfer=chamfer(pred, true),
        crossings=len(found),
        true_crossings=len(actual),
        crossings_found=tuple(_matched(actual, found, r) for r in CROSSING_RADII),
        branching=len(branching),
        true_branching=len(true_branching),
        branching_found=tuple(_matched(true_branching, found, r) for r in CROSSING_RADII),
        branching_matched=_matched(true_branching, branching, CROSSING_RADII[0]),
        recovered=recovered(pred, true),
        continuations=continuations,
        continuations_kept=kept,
        wrong_joins=wrong,
        wrong_joins_made=wrong if failed else made,
        failed=failed,
    )


def summarize(scores: Iterable[Score]) -> dict[str, float]:
    """The figures of many drawings: medians of what a drawing has, ratios of what is counted.

    A failed drawing has an infinite Chamfer distance and density, finds nothing, and makes every
    wrong join.
    """
    scores = list(scores)

    def median(name: str) -> float:
        return float(np.median([getattr(s, name) for s in scores])) if scores else float("nan")

    def ratio(part: float, whole: float) -> float:
        return part / whole if whole else float("nan")

    def total(name: str) -> int:
        return sum(getattr(s, name) for s in scores)

    return {
        "drawings": len(scores),
        "failed": total("failed"),
        "chamfer": median("chamfer"),
        "length_diff": median("length_diff"),
        "density": median("density"),
        "f1": median("f1"),
        "crossings": ratio(sum(s.crossings_found[0] for s in scores), total("true_crossings")),
        "branching": ratio(sum(s.branching_found[0] for s in scores), total("true_branching")),
        "precision": ratio(total("branching_matched"), total("branching")),
        "routing": ratio(total("continuations_kept"), total("continuations")),
        "false_joins": ratio(total("wrong_joins_made"), total("wrong_joins")),
    }


# --- reading ---------------------------------------------------------------------------------

_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


def read_svg(path: str | PathLike[str]) -> list[Array]:
    """The strokes of an SVG of absolute M, L, C and Z commands, scaled to a 1024-px long side.

    Every sub-path is a stroke; filled shapes (`fill` other than none) are no strokes. Curves are
    flattened to points about 1 px apart.

    Raises:
        ValueError: the file has no viewBox, or paths with other commands or transforms.
    """
    root = ElementTree.parse(path).getroot()
    if "viewBox" not in root.attrib:
        raise ValueError(f"{path} has no viewBox.")
    left, top, width, height = (float(v) for v in _NUMBER.findall(root.attrib["viewBox"]))
    strokes: list[Array] = []

    def collect(element: ElementTree.Element, fill: str) -> None:
        if "transform" in element.attrib:
            raise ValueError(f"{path} has transforms, which can't be read here.")
        fill = element.get("fill", fill)
        if element.tag.endswith("}path") and fill == "none":
            strokes.extend(_flatten(element.get("d", ""), max(width, height)))
        for child in element:
            collect(child, fill)

    collect(root, "black")
    return scaled([line - (left, top) for line in strokes], (width, height))


_FARTHEST = 100.0 * LONG_SIDE  # px; beyond it no line of a page lies


def scaled(polylines: Iterable[Array], size: tuple[float, float]) -> list[Array]:
    """Polylines of a page of (width, height) px at a long side of 1024 px, without repeated or
    infinite points; what is shorter than two points is left out.

    Raises:
        ValueError: a point lies so far off the page that its line can't be measured.
    """
    arrays = (np.asarray(line, float).reshape(-1, 2) for line in polylines)
    lines = [line[np.isfinite(line).all(1)] * (LONG_SIDE / max(size)) for line in arrays]
    if any((np.abs(line) > _FARTHEST).any() for line in lines):
        raise ValueError("A line runs far off the page.")
    cleaned = (
        line[np.concatenate([[True], np.abs(np.diff(line, axis=0)).sum(1) > 1e-9])]
        for line in lines
        if len(line)
    )
    return [line for line in cleaned if len(line) >= 2]


def _flatten(commands: str, long_side: float) -> list[Array]:
    """The sub-paths of an SVG path."""
    strokes: list[list[Array]] = []
    for command, text in re.findall(r"([A-Za-z])([^A-Za-z]*(?:[eE][-+]?\d+[^A-Za-z]*)*)", commands):
        numbers = np.array([float(v) for v in _NUMBER.findall(text)]).reshape(-1, 2)
        if command == "M":
            strokes.append([numbers])
        elif command == "L":
            strokes[-1].append(numbers)
        elif command == "C":
            for handles in numbers.reshape(-1, 3, 2):
                strokes[-1].append(_curve(strokes[-1][-1][-1], handles, long_side))
        elif command in "Zz":
            strokes[-1].append(strokes[-1][0][:1])
        else:
            raise ValueError(f"Path command {command} can't be read here.")
    return [np.concatenate(parts) for parts in strokes]


def _curve(start: Array, handles: Array, long_side: float) -> Array:
    """Points of a cubic Bezier curve after its start, about 1 px apart at 1024 px."""
    corners = np.vstack([start, handles])
    length = np.hypot(*np.diff(corners, axis=0).T).sum()
    t = np.linspace(0, 1, max(2, int(length * LONG_SIDE / long_side) + 1) + 1)[1:, None]
    weights = np.hstack([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3])
    return weights @ corners


# --- distances and strokes -------------------------------------------------------------------


def _arc_length(line: Array) -> Array:
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])


def chamfer(pred: Strokes, true: Strokes) -> float:
    """Mean distance from the samples of one to those of the other, both directions averaged, px."""
    if pred.tree is None or true.tree is None:
        return float("inf")
    there = true.tree.query(pred.samples)[0].mean()
    back = pred.tree.query(true.samples)[0].mean()
    return float(there + back) / 2


def _coverage(strokes: Strokes, others: Strokes, within: float = _NEAR) -> csr_matrix:
    """(S, T): the share of each stroke that runs within so many px of each other one (sparse)."""
    shape = (len(strokes), len(others))
    if strokes.tree is None or others.tree is None:
        return coo_matrix(shape).tocsr()
    near = strokes.tree.sparse_distance_matrix(others.tree, within, output_type="ndarray")
    once = np.unique(near["i"] * shape[1] + others.stroke[near["j"]])
    sample, other = np.divmod(once, max(1, shape[1]))
    share = 1.0 / np.bincount(strokes.stroke, minlength=shape[0])
    stroke = strokes.stroke[sample]
    return coo_matrix((share[stroke], (stroke, other)), shape).tocsr()


def recovered(
    pred: Strokes, true: Strokes, within: float = _NEAR, cover: float = _COVER, off: float = _OFF
) -> int:
    """Strokes recovered one to one, the best fitting first.

    Args:
        within: px. cover: share of the true stroke that must be covered. off: share of the traced
            one that may be away from it.
    """
    covers, covered = _coverage(true, pred, within).tocoo(), _coverage(pred, true, within)
    t, p, forth = covers.row, covers.col, covers.data
    back = np.asarray(covered[p, t]).ravel() if len(p) else forth
    good = (forth >= cover - 1e-9) & (back > 1 - off)
    t, p, quality = t[good], p[good], (forth + back)[good]
    return _one_to_one(t, p, np.lexsort((p, t, quality))[::-1])


def _one_to_one(a: Array, b: Array, order: Array) -> int:
    """How many pairs (a, b) can be taken in this order with nothing taken twice."""
    used_a: set[int] = set()
    used_b: set[int] = set()
    for i, j in zip(a[order].tolist(), b[order].tolist(), strict=True):
        if i not in used_a and j not in used_b:
            used_a.add(i)
            used_b.add(j)
    return len(used_a)


# --- crossings -------------------------------------------------------------------------------


def crossings(strokes: Strokes) -> Array:
    """(K, 2) points where strokes cross each other or themselves, or end on one another.

    Points within 3 px of each other are one.
    """
    if not len(strokes):
        return np.zeros((0, 2))
    segments = _Segments(strokes)
    return merged(np.vstack([segments.crossings(), segments.touches()]))


class _Segments:
    """All straight pieces of the strokes, findable by place."""

    def __init__(self, strokes: Strokes) -> None:
        lines = [_straightened(line) for line in strokes.polylines]
        arcs = [_arc_length(line) for line in lines]
        self.strokes = strokes
        self.stroke = np.repeat(np.arange(len(lines)), [len(line) - 1 for line in lines])
        self.a = np.concatenate([line[:-1] for line in lines])
        self.b = np.concatenate([line[1:] for line in lines])
        self.from_arc = np.concatenate([arc[:-1] for arc in arcs])
        self.to_arc = self.from_arc + np.hypot(*(self.b - self.a).T)
        self.total = np.array([arc[-1] for arc in arcs])[self.stroke]
        self.shapes = shapely.linestrings(np.stack([self.a, self.b], 1))
        self.tree = shapely.STRtree(self.shapes)

    def crossings(self) -> Array:
        """Where two segments meet that do not follow each other on one stroke."""
        i, j = self.tree.query(self.shapes, predicate="intersects")
        i, j = i[i < j], j[i < j]
        between = self.from_arc[j] - self.to_arc[i]
        around = self.from_arc[i] + self.total[i] - self.to_arc[j]
        around = np.where(self.strokes.closed[self.stroke[i]], around, np.inf)
        follow = (self.stroke[i] == self.stroke[j]) & (np.minimum(between, around) < 1e-6)
        i, j = i[~follow], j[~follow]
        # Two pieces that lie on each other share a piece: its middle stands for it.
        shared = shapely.centroid(shapely.intersection(self.shapes[i], self.shapes[j]))
        return shapely.get_coordinates(shared[~shapely.is_empty(shared)])

    def touches(self) -> Array:
        """Where a stroke ends on another, or far back on itself."""
        strokes = self.strokes
        open_ones = np.flatnonzero(~strokes.closed)
        stroke = np.concatenate([open_ones, open_ones])
        arc = np.concatenate([np.zeros(len(open_ones)), strokes.length[open_ones]])
        tips = np.array(
            [strokes.polylines[s][0 if t == 0 else -1] for s, t in zip(stroke, arc, strict=True)]
        ).reshape(-1, 2)
        tip, seg = self.tree.query(shapely.points(tips), predicate="dwithin", distance=_TOUCH)
        along = self.b[seg] - self.a[seg]
        share = ((tips[tip] - self.a[seg]) * along).sum(1)
        share = np.clip(share / np.maximum((along**2).sum(1), 1e-12), 0, 1)
        foot = self.a[seg] + share[:, None] * along
        distance = np.hypot(*(foot - tips[tip]).T)
        on_arc = self.from_arc[seg] + share * (self.to_arc - self.from_arc)[seg]
        own = (self.stroke[seg] == stroke[tip]) & (np.abs(on_arc - arc[tip]) < _PASS)
        tip, seg, foot, distance = (v[~own] for v in (tip, seg, foot, distance))
        # The nearest place on each stroke that the tip touches.
        order = np.lexsort((distance, self.stroke[seg], tip))
        key = (tip * (len(strokes) + 1) + self.stroke[seg])[order]
        return foot[order][np.unique(key, return_index=True)[1]]


def _straightened(line: Array) -> Array:
    """A polyline with its nearly straight runs as one segment: far fewer pairs to test, nothing
    moves. Where it turns back, it stays as it is: over there and back is no straight run."""
    step = np.diff(line, axis=0)
    back = 1 + np.flatnonzero((step[1:] * step[:-1]).sum(1) < 0)
    cuts = [0, *back.tolist(), len(line) - 1]
    runs = [shapely.LineString(line[a : b + 1]).simplify(0.02) for a, b in pairwise(cuts)]
    corners = [shapely.get_coordinates(run) for run in runs]
    return np.concatenate([corners[0], *(run[1:] for run in corners[1:])])


def merged(points: Array, radius: float = _MERGE) -> Array:
    """Centres of the groups of points that hang together by steps of at most `radius`."""
    if not len(points):
        return np.zeros((0, 2))
    pairs = cKDTree(points).query_pairs(radius, output_type="ndarray")
    count, label = _groups(pairs, len(points))
    sums = [np.bincount(label, axis, count) for axis in points.T]
    return np.stack(sums, -1) / np.bincount(label, minlength=count)[:, None]


def _groups(pairs: Array, size: int) -> tuple[int, Array]:
    links = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), (size, size))
    return connected_components(links, directed=False)


def _matched(truth: Array, found: Array, radius: float) -> int:
    """Points found within the radius, one to one, nearest first."""
    if not len(truth) or not len(found):
        return 0
    near = cKDTree(truth).sparse_distance_matrix(
        cKDTree(found), radius + 1e-9, output_type="ndarray"
    )
    return _one_to_one(near["i"], near["j"], np.argsort(near["v"], kind="stable"))


# --- routing ---------------------------------------------------------------------------------


class _Branches:
    """The branches of strokes that leave each junction.

    junction: (B,) the junction each branch leaves; point, tangent: (B, 2) where it is 8 px on;
    run: (B,) branches of one run are the two sides of a stroke that runs through.
    degree: (J,) branches told apart at each junction.
    """

    def __init__(self, strokes: Strokes, junctions: Array) -> None:
        self.junction = self.run = np.zeros(0, int)
        self.point = self.tangent = np.zeros((0, 2))
        if strokes.tree is not None and len(junctions):
            self._find(strokes, junctions)
        a, b = self.couples()
        near = np.hypot(*(self.point[a] - self.point[b]).T) <= _MERGE
        _, label = _groups(np.stack([a[near], b[near]], 1), len(self.junction))
        first = np.unique(label, return_index=True)[1]
        self.degree = np.bincount(self.junction[first], minlength=len(junctions))

    def _find(self, strokes: Strokes, junctions: Array) -> None:
        assert strokes.tree is not None
        near = strokes.tree.query_ball_point(junctions, _HOLD)
        junction = np.repeat(np.arange(len(junctions)), [len(hits) for hits in near])
        sample = np.concatenate([np.asarray(hits, int) for hits in near])
        order = np.lexsort((strokes.arc[sample], strokes.stroke[sample], junction))
        junction, sample = junction[order], sample[order]
        stroke, arc = strokes.stroke[sample], strokes.arc[sample]

        # One run = one pass of one stroke; a closed stroke may pass over its own start.
        change = np.concatenate([[True], (np.diff(junction) != 0) | (np.diff(stroke) != 0)])
        later = np.concatenate([[True], np.diff(arc) >= _PASS])
        run = np.cumsum(change | later) - 1
        first = np.flatnonzero(change)
        last = np.append(first[1:], len(run)) - 1
        around = arc[first] + strokes.length[stroke[first]] - arc[last]
        wraps = strokes.closed[stroke[first]] & (run[first] != run[last]) & (around < _PASS)
        renamed = np.arange(run[-1] + 1)
        renamed[run[last[wraps]]] = run[first[wraps]]
        run = renamed[run]

        away = np.hypot(*(strokes.samples[sample] - junctions[junction]).T)
        order = np.lexsort((away, run))
        closest = order[np.unique(run[order], return_index=True)[1]]
        # Two branches a run: back along the stroke, and on.
        both = np.repeat(closest, 2)
        stroke, reach = stroke[both], arc[both] + np.tile([-_WALK, _WALK], len(closest))
        there = strokes.inside(stroke, reach)
        self.junction, self.run = junction[both][there], run[both][there]
        self.point = strokes.at(stroke[there], reach[there])
        self.tangent = strokes.tangent(stroke[there], reach[there])

    def couples(self) -> tuple[Array, Array]:
        """All pairs a < b of branches of the same junction."""
        size = np.bincount(self.junction)
        place = np.arange(len(self.junction)) - (np.cumsum(size) - size)[self.junction]
        rest = size[self.junction] - 1 - place
        a = np.repeat(np.arange(len(self.junction)), rest)
        nth = np.arange(len(a)) - np.repeat(np.cumsum(rest) - rest, rest)
        return a, a + 1 + nth


def _routing(pred: Strokes, true: Strokes, branches: _Branches) -> tuple[int, int, int, int]:
    """Continuations kept, all continuations, wrong joins made, all wrong joins possible."""
    a, b = branches.couples()
    # Where only two branches meet there is nothing to route.
    enough = np.bincount(branches.junction)[branches.junction[a]] >= 3 if len(a) else a > 0
    a, b = a[enough], b[enough]
    joined = branches.run[a] == branches.run[b]
    apart = np.hypot(*(branches.point[a] - branches.point[b]).T) >= 2 * _NEAR
    a, b, joined = (v[joined | apart] for v in (a, b, joined))
    # The truth may join two branches elsewhere: a sharp turn, junctions that were merged.
    sound = joined | ~_joins(true, branches, a, b)
    a, b, joined = a[sound], b[sound], joined[sound]
    made = _joins(pred, branches, a, b)
    return (
        int(made[joined].sum()),
        int(joined.sum()),
        int(made[~joined].sum()),
        int((~joined).sum()),
    )


def _joins(strokes: Strokes, branches: _Branches, a: Array, b: Array) -> Array:
    """(K,) bool: whether one stroke runs along branch a and then, without a detour, branch b."""
    joins = np.zeros(len(a), bool)
    if strokes.tree is None or not len(a):
        return joins
    near = strokes.tree.query_ball_point(branches.point, _NEAR)
    owner = np.repeat(np.arange(len(near)), [len(hits) for hits in near])
    sample = np.concatenate([np.asarray(hits, int) for hits in near])
    course = strokes.tangent(strokes.stroke[sample], strokes.arc[sample])
    along = np.abs((course * branches.tangent[owner]).sum(1)) > _ALONG
    owner, sample = owner[along], sample[along]
    count = np.bincount(owner, minlength=len(near))
    start = np.cumsum(count) - count

    # Every sample along a with every sample along b, some pairs at a time to bound the memory.
    work = np.cumsum(count[a] * count[b])
    cuts = np.searchsorted(work, np.arange(0, work[-1] + 1, 2_000_000)[1:])
    for part in np.split(np.arange(len(a)), cuts):
        size = count[a[part]] * count[b[part]]
        pair = np.repeat(part, size)
        nth = np.arange(len(pair)) - np.repeat(np.cumsum(size) - size, size)
        i = sample[start[a[pair]] + nth // count[b[pair]]]
        j = sample[start[b[pair]] + nth % count[b[pair]]]
        stroke = strokes.stroke[i]
        walk = np.abs(strokes.arc[i] - strokes.arc[j])
        walk = np.where(
            strokes.closed[stroke], np.minimum(walk, strokes.length[stroke] - walk), walk
        )
        straight = np.hypot(*(branches.point[a[pair]] - branches.point[b[pair]]).T)
        direct = (walk >= 0.5 * straight) & (walk <= 2 * straight + _WALK)
        joins[pair[direct & (stroke == strokes.stroke[j])]] = True
    return joins
