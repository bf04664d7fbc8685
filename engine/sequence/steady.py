"""What did not move is routed alike: decisions taken together with the frame before.

Two scans of one drawing differ by noise, and so do their networks' answers where they are in doubt.
Therefore the frame before is heard as a second witness: wherever two half-branches lie on one of
its strokes, one behind the other, they are more probably one line than the picture alone says, and
wherever they lie on two of its strokes, less. A line that moved lies on none, and hears nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import cv2
import numpy as np

from ..arrays.ragged import offsets_of, owners, ranges, steps
from ..drawing import Drawing
from ..graph.editing import Step
from ..graph.nearby import near_between
from ..values import Array, PlanarGraph, Stroke
from .stroke_matching import match_strokes

HEARD = 8.0  # log-odds of what the frame before says about two half-branches
_NEAR, _LEAST_NEAR = 0.8, 1.5  # pen widths and px: so near, a line lies where it lay before
_ARM = 8.0  # pen widths of a half-branch that tell which stroke it is on
_ASIDE = 0.2  # pen widths that one stroke may lie farther from an arm than another it is on, too
_ON = 0.85  # share of an arm that lies on a stroke
_TIP = 2.0  # pen widths of a stroke at its end that tell from where it came
_OVER = 0.5  # pen widths that two ends may reach past each other
_GAP = 10.0  # pen widths between two ends that the frame before may bridge or part
_BLOCK = 4096  # half-branches looked at together: what bounds the memory
_MEET = 3.0  # pen widths along the stroke between two half-branches that follow each other on it


def steadied(drawing: Drawing, before: Sequence[Stroke]) -> Drawing:
    """The drawing with its strokes joined and ended as those of the frame before are.

    Args:
        before: the strokes of that frame, in pixels of the same page.
    """
    if not drawing.strokes or not before or drawing.graph.widths is None:
        return drawing
    pen = float(np.median(drawing.graph.widths))
    # Strokes that were routed quite otherwise don't match: the page may all the same lie as it lay.
    motions = np.eye(2, 3), match_strokes(before, drawing.strokes).motion
    seen = [_Lines.of(before, motion) for motion in motions]
    both = [_Runs.of(drawing.graph, lines, pen) for lines in seen]
    lines, runs = max(zip(seen, both, strict=True), key=lambda found: len(found[1].half))
    pairs, score = drawing.routing.pairs, drawing.routing.pair_score
    said = _said(drawing.graph, pairs, score, runs, pen)
    drawing = drawing.heard(HEARD * said)
    if drawing.pencil:  # its strokes are told by the numbers of branches
        return drawing
    return _parted(_bridged(drawing, runs, pen), lines, pen)


def _bridged(drawing: Drawing, runs: _Runs, pen: float) -> Drawing:
    """Join loose ends that face each other over a gap where a stroke ran through before."""
    graph = drawing.graph
    loose = np.flatnonzero(graph.degrees[graph.half_vertex[runs.half]] == 1)
    order = loose[np.lexsort((runs.start[loose], runs.stroke[loose]))]
    a, b = order[:-1], order[1:]
    faces = (runs.stroke[a] == runs.stroke[b]) & (runs.sense[a] < 0) & (runs.sense[b] > 0)
    faces &= runs.start[b] - runs.start[a] <= _GAP * pen
    taken: set[int] = set()
    steps = []
    for pair in np.stack([runs.half[a], runs.half[b]], -1)[faces].tolist():
        if pair[0] != pair[1] and taken.isdisjoint(pair):
            taken.update(pair)
            steps.append((pair[0], pair[1]))
    return _with_steps(drawing, steps)


def _parted(drawing: Drawing, lines: _Lines, pen: float) -> Drawing:
    """Cut branches where one stroke ended before and another began."""
    graph = drawing.graph
    tips, inner = lines.tips(_TIP * pen)
    reach = max(_LEAST_NEAR, _NEAR * pen)
    there = [_nearest(graph.points, place, 1.5 * reach) for place in (tips, inner)]
    branch = [np.searchsorted(graph.offsets, t, "right") - 1 for t in there]
    good = (there[0] >= 0) & (there[1] >= 0) & (branch[0] == branch[1])
    at, side = there[0][good], np.sign(there[1][good] - there[0][good])
    order = np.argsort(at + side * (_OVER * pen / 2), kind="stable")
    at, side, own = at[order], side[order], branch[0][good][order]
    meet = (own[1:] == own[:-1]) & (side[:-1] < 0) & (side[1:] > 0)
    meet &= at[1:] - at[:-1] <= _GAP * pen
    middle = (at[1:][meet] + at[:-1][meet]) // 2
    first, last = graph.offsets[:-1][own[1:][meet]], graph.offsets[1:][own[1:][meet]] - 1
    clear = (middle - first > reach) & (last - middle > reach)
    return _with_steps(drawing, [(int(p), -1) for p in sorted(set(middle[clear]))[::-1]])


def _with_steps(drawing: Drawing, steps: list[Step]) -> Drawing:
    """Cut and join; it is part of the graph, as if it had been traced so."""
    return replace(drawing.with_edits(steps), edits=None) if steps else drawing


@dataclass(frozen=True, eq=False)
class _Lines:
    """Strokes as points about 1 px apart: (P, 2) px, which stroke (P,), px along it (P,).

    length: (S,) px. closed: (S,) bool.
    """

    points: Array
    stroke: Array
    way: Array
    length: Array
    closed: Array

    @property
    def around(self) -> Array:
        """(S,) px, the length of a closed stroke; infinite for an open one."""
        return np.where(self.closed, np.maximum(self.length, 1e-6), np.inf)

    @staticmethod
    def of(strokes: Sequence[Stroke], motion: Array) -> _Lines:
        """Strokes, moved by a (2, 3) motion."""
        rows = [np.vstack([s.points, s.points[:1]]) if s.closed else s.points for s in strokes]
        offsets = offsets_of([len(row) for row in rows])
        packed = cv2.transform(np.concatenate(rows)[None].astype(np.float64), motion)[0]
        step = steps(packed, offsets)
        # As many points in each step as it has px; a row's first step is its first point.
        count = np.maximum(np.ceil(step), 1).astype(np.int64)
        count[offsets[:-1]] = 1
        index = np.repeat(np.arange(len(packed)), count)
        share = (ranges(np.ones(len(count), np.int64), count) / count[index])[:, None]
        first = np.isin(index, offsets[:-1])
        earlier = np.where(first, index, index - 1)
        points = packed[earlier] * (1 - share) + packed[index] * share
        stroke = owners(offsets)
        way = np.cumsum(step)
        way -= way[offsets[:-1]][stroke]
        along = way[earlier] * (1 - share[:, 0]) + way[index] * share[:, 0]
        closed = np.array([s.closed for s in strokes])
        return _Lines(points, stroke[index], along, way[offsets[1:] - 1], closed)

    def tips(self, arm: float) -> tuple[Array, Array]:
        """Both ends (2 S, 2) of open strokes, and where each stroke is `arm` px from them."""
        first = np.searchsorted(self.stroke, np.arange(len(self.closed)))
        last = np.append(first[1:], len(self.stroke)) - 1
        keep = ~self.closed & (last > first)
        first, last = first[keep], last[keep]
        step = np.minimum(
            np.maximum(1, (last - first) * arm / np.maximum(self.way[last], arm)), last - first
        )
        step = np.round(step).astype(np.int64)
        ends = np.concatenate([self.points[first], self.points[last]])
        return ends, np.concatenate([self.points[first + step], self.points[last - step]])


@dataclass(frozen=True, eq=False)
class _Runs:
    """Where the arms of half-branches lie on strokes.

    half, stroke: (R,). start: (R,) px along the stroke, where the arm begins at its vertex.
    sense: (R,) 1 where the arm leads on along the stroke, else -1. around: as in `_Lines`.
    behind: (R,) px of the stroke that lie behind the arm's beginning; infinite on a closed stroke.
    """

    half: Array
    stroke: Array
    start: Array
    sense: Array
    around: Array
    behind: Array

    @staticmethod
    def of(graph: PlanarGraph, lines: _Lines, pen: float) -> _Runs:
        """The runs of all half-branches of a graph."""
        arms = _Arms.of(graph, _ARM * pen)
        stops = np.searchsorted(arms.half, np.arange(0, len(arms.count) + _BLOCK, _BLOCK))
        blocks = [arms.part(*block) for block in pairwise(stops.tolist())]
        found = [_on_strokes(block, lines, pen) for block in blocks]
        half, stroke, start, sense = (np.concatenate(column) for column in zip(*found, strict=True))
        behind = np.where(sense > 0, start, lines.length[stroke] - start)
        behind[lines.closed[stroke]] = np.inf
        return _Runs(half, stroke, start, sense, lines.around, behind)


@dataclass(frozen=True, eq=False)
class _Arms:
    """The first points of half-branches from their vertex on: (A, 2) px, and of each point its
    half-branch (A,), ascending, and its rank in that (A,). count: (2B,) points of each one.
    """

    points: Array
    half: Array
    rank: Array
    count: Array
    spacing: float  # px from one to the next

    @staticmethod
    def of(graph: PlanarGraph, length: float) -> _Arms:
        step = steps(graph.points, graph.offsets)
        spacing = max(float(step.sum()) / max(len(step) - graph.branch_count, 1), 1e-3)
        most = max(3, round(length / spacing))
        count = np.repeat(np.minimum(np.diff(graph.offsets), most), 2)
        rank = ranges(np.zeros(len(count), np.int64), count)
        half = np.repeat(np.arange(len(count)), count)
        first, last = graph.offsets[:-1][half >> 1], graph.offsets[1:][half >> 1] - 1
        index = np.where(half & 1, last - rank, first + rank)
        return _Arms(graph.points[index].astype(np.float64), half, rank, count, spacing)

    def part(self, first: int, last: int) -> _Arms:
        """Some of the points."""
        part = slice(first, last)
        return replace(self, points=self.points[part], half=self.half[part], rank=self.rank[part])


def _on_strokes(arms: _Arms, lines: _Lines, pen: float) -> tuple[Array, Array, Array, Array]:
    """Half-branch, stroke, start and sense of every run, as `_Runs` has them."""
    reach = max(_LEAST_NEAR, _NEAR * pen)
    arm, there = near_between(arms.points, lines.points, reach)
    order = np.lexsort((lines.way[there], lines.stroke[there], arms.half[arm]))
    arm, there = arm[order], there[order]
    half, stroke, way = arms.half[arm], lines.stroke[there], lines.way[there]
    # A stroke that passes twice makes two runs: the way along it jumps between them.
    fresh = np.ones(len(half), bool)
    fresh[1:] = (np.diff(half) != 0) | (np.diff(stroke) != 0) | (np.diff(way) > 2 * reach)
    head, total = np.flatnonzero(fresh), int(fresh.sum())
    half, stroke = half[head], stroke[head]
    # Of each run and each point of the arm the middle of what is near, and the nearest.
    key = (np.cumsum(fresh) - 1) * (1 << 32) + arms.rank[arm]
    key, place = np.unique(key, return_inverse=True)
    way = np.bincount(place, way) / np.bincount(place)
    away = np.full(len(key), np.inf)
    np.minimum.at(away, place, np.hypot(*(arms.points[arm] - lines.points[there]).T))
    run, rank = key >> 32, (key & 0xFFFFFFFF).astype(np.float64)
    size = np.bincount(run, minlength=total)
    rank_mean, way_mean, aside = (np.bincount(run, v, total) / size for v in (rank, way, away))
    rank, way = rank - rank_mean[run], way - way_mean[run]
    slope = np.bincount(run, rank * way, total) / np.maximum(np.bincount(run, rank**2, total), 1e-9)
    good = (size >= _ON * arms.count[half]) & (np.abs(slope) > 0.5 * arms.spacing)
    best = np.full(len(arms.count), np.inf)
    np.minimum.at(best, half[good], aside[good])
    good &= aside <= best[half] + _ASIDE * pen
    start = way_mean - slope * rank_mean
    return half[good], stroke[good], start[good], np.sign(slope)[good]


def _said(graph: PlanarGraph, pairs: Array, score: Array, runs: _Runs, pen: float) -> Array:
    """(K,) of each pair: 1 one line in the frame before, -1 two lines, 0 nobody knows."""
    order = np.argsort(runs.half, kind="stable")
    starts = np.searchsorted(runs.half[order], np.arange(2 * graph.branch_count + 1))
    many = np.diff(starts)
    a, b = pairs.T
    size = many[a] * many[b]
    pair = np.repeat(np.arange(len(pairs)), size)
    within = ranges(np.zeros(len(size), np.int64), size)
    x = order[starts[a][pair] + within // np.maximum(many[b][pair], 1)]
    y = order[starts[b][pair] + within % np.maximum(many[b][pair], 1)]
    gap = np.abs(runs.start[x] - runs.start[y])
    around = runs.around[runs.stroke[x]]
    gap = np.minimum(gap, np.abs(around - gap))
    one = (runs.stroke[x] == runs.stroke[y]) & (runs.sense[x] != runs.sense[y])
    one &= gap <= _MEET * pen
    said = np.where(size > 0, -1.0, 0.0)
    said[pair[one]] = 1.0
    said[_anew(graph, pairs, score, runs, many, pen)] = -1.0
    return said


def _anew(
    graph: PlanarGraph, pairs: Array, score: Array, runs: _Runs, many: Array, pen: float
) -> Array:
    """The pairs at corners where a stroke ended before, and where nothing was what goes on now.

    Of what lies between two such corners one end is named alone, the less probable one: so it
    goes with the other stroke, and is none of its own.
    """
    ended = np.zeros(len(many), bool)
    ended[runs.half[runs.behind <= _OVER * pen]] = True
    a, b = pairs.T
    fresh = np.where(many[a] == 0, a, b)
    known = np.where(many[a] == 0, b, a)
    found = ended[known] & (many[fresh] == 0) & (graph.degrees[graph.half_vertex[a]] == 2)
    rows = np.flatnonzero(found)
    rows = rows[np.lexsort((score[rows], fresh[rows] >> 1))]
    return rows[np.diff(fresh[rows] >> 1, prepend=-1) != 0]


def _nearest(points: Array, places: Array, reach: float) -> Array:
    """(K,) the point (P, 2) nearest to each place (K, 2), -1 where none is within `reach` px."""
    place, point = near_between(places, points.astype(np.float64), reach)
    away = ((places[place] - points[point]) ** 2).sum(1)
    order = np.lexsort((away, place))
    first = np.searchsorted(place[order], np.arange(len(places)))
    found = np.full(len(places), -1)
    there = np.unique(place)
    found[there] = point[order][first[there]]
    return found
