"""The true routing of a traced graph: which of its half-branches one pen stroke ran through.

Each half-branch gets one owner, the stroke that lies nearest over its course, and continues in the
half-branch in which its owner went on. So labels never contradict each other: where a tracer made
one branch of two strokes, one of them has it, and the other one ends there. What no stroke made
(a rung between two hatch lines, a spur) continues in nothing, and the stroke that it hangs on runs
past it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from involute.engine.arrays.ragged import along as along_line
from involute.engine.arrays.ragged import arc, ranges, steps
from involute.engine.routing.encoding import along
from involute.engine.values import PlanarGraph
from scipy.spatial import cKDTree

from ...synthesis.true_graph import single_lines
from .augment import Page

Array = np.ndarray

_COURSE = 48  # px of a half-branch that are compared with the strokes
_FADE = 16.0  # px; what lies farther from the junction counts less
_WHOLE = 24.0  # px; both halves of a branch shorter than this have one owner
_SHORT = 8.0  # px; such a branch has a direction only as a whole
_NEAR = 2.5  # px; a stroke this near may be the one that was traced
_ALONG, _ALONG_SHORT = 0.7, 0.5  # cosine between a half-branch and the stroke it traces
_COVER = 0.5  # share of its course along which a half-branch must have a stroke beside it
_STRAIGHT = 0.2  # what running straight on is worth, where several strokes fit as well
_GAP = 10.0  # px along a stroke between the ends of two half-branches that it joins


@dataclass(frozen=True, eq=False)
class _Claims:
    """Strokes that could have made half-branches, all (K,) arrays.

    half, stroke; sign: +1 = the pen went away from the junction; fit in [0, 1]: how much of the
    half-branch the stroke covers, and how closely; start: px along the stroke at the junction.
    """

    half: Array
    stroke: Array
    sign: Array
    fit: Array
    start: Array

    def take(self, rows: Array) -> _Claims:
        names = self.__dataclass_fields__
        return _Claims(*(getattr(self, name)[rows] for name in names))


def labelled(graph: PlanarGraph, strokes: list[Array], near: float = _NEAR) -> Page:
    """The page of a traced graph whose true strokes are known, (N, 2) px each.

    Lines drawn twice count once, as in `planar`; points that no stroke made have stroke -1.

    Args:
        near: px; a stroke this near may be the one that was traced.
    """
    strokes = single_lines(strokes)
    partner = np.arange(2 * graph.branch_count)
    owner = np.full(len(partner), -1)
    if strokes and graph.branch_count:
        lines = _Lines.of(strokes)
        claims = _claims(graph, lines, near)
        claims = claims.take(_owners(graph, claims, lines))
        owner[claims.half] = claims.stroke
        for a, b in _continued(graph, claims, lines):
            if partner[a] == a and partner[b] == b:
                partner[a], partner[b] = b, a
    of_branch = owner.reshape(-1, 2).max(1)
    return Page(graph, partner, np.repeat(of_branch, np.diff(graph.offsets)).astype(float), True)


def unowned(page: Page) -> float:
    """Which share of the length of all branches no stroke made."""
    step = steps(page.graph.points, page.graph.offsets)
    return float(step[page.stroke < 0].sum() / max(step.sum(), 1e-6))


@dataclass(frozen=True, eq=False)
class _Lines:
    """All strokes, sampled every pixel: place, tangent (N, 2), stroke, arc (N,); length (S,) of
    those that are closed, else inf."""

    place: Array
    tangent: Array
    stroke: Array
    arc: Array
    length: Array

    @staticmethod
    def of(strokes: list[Array]) -> _Lines:
        place, arcs, length = [], [], []
        for line in strokes:
            whole = arc(line)[-1]
            at = np.linspace(0, whole, max(2, round(whole) + 1))
            place.append(along_line(line, at))
            arcs.append(at)
            closed = np.hypot(*(line[0] - line[-1])) < 2
            length.append(whole if closed else np.inf)
        tangent = np.concatenate([np.gradient(line, axis=0) for line in place])
        tangent /= np.maximum(np.hypot(*tangent.T), 1e-9)[:, None]
        stroke = np.repeat(np.arange(len(place)), [len(line) for line in place])
        return _Lines(
            np.concatenate(place), tangent, stroke, np.concatenate(arcs), np.array(length)
        )


def _claims(graph: PlanarGraph, lines: _Lines, reach: float) -> _Claims:
    """Every stroke, in each of its directions, that runs along enough of a half-branch."""
    half, out, place, heading, weight, least = _course(graph)
    tree = cKDTree(place)
    near = tree.sparse_distance_matrix(cKDTree(lines.place), reach, output_type="ndarray")
    row, hit, distance = near["i"], near["j"], near["v"]
    turn = (heading[row] * lines.tangent[hit]).sum(1)
    good = np.abs(turn) > least[row]
    row, hit, distance, sign = row[good], hit[good], distance[good], np.sign(turn[good])
    # The nearest place of every stroke and direction beside each sample of the course.
    order = np.lexsort((distance, sign, lines.stroke[hit], row))
    row, hit, distance, sign = (v[order] for v in (row, hit, distance, sign))
    first = _changes(row, lines.stroke[hit], sign)
    row, hit, distance, sign = (v[first] for v in (row, hit, distance, sign))

    worth = weight[row] * (1 - (distance / (reach + 0.5)) ** 2)
    start = lines.arc[hit] - sign * out[row]
    order = np.lexsort((start, sign, lines.stroke[hit], half[row]))
    row, hit, sign, worth, start = (v[order] for v in (row, hit, sign, worth, start))
    first = np.flatnonzero(_changes(half[row], lines.stroke[hit], sign))
    count = np.diff(np.append(first, len(row)))
    total = np.bincount(half, weight, 2 * graph.branch_count)
    fit = np.add.reduceat(worth, first) / total[half[row[first]]] if len(first) else worth
    found = _Claims(
        half[row[first]], lines.stroke[hit[first]], sign[first], fit, start[first + count // 2]
    )
    return found.take(np.flatnonzero(fit > _COVER * 0.7))


def _changes(*keys: Array) -> Array:
    """True where any of the sorted keys differs from the row before."""
    new = np.zeros(len(keys[0]), bool)
    new[:1] = True
    for key in keys:
        new[1:] |= key[1:] != key[:-1]
    return new


def _course(graph: PlanarGraph) -> tuple[Array, ...]:
    """Samples along the first px of every half-branch.

    Returns:
        half (N,); px from the junction (N,); place (N, 2); direction (N, 2); weight (N,); least
        cosine to a stroke that it may trace (N,).
    """
    length = along(graph, np.array([np.inf]))[1]
    step = np.arange(_COURSE) + 0.5
    # As many samples as the half-branch has px, at least two, evenly over short ones.
    count = np.clip(np.ceil(length), 2, _COURSE)
    out = np.where(length[:, None] < _COURSE, step * (length / count)[:, None], step)
    inside = step < count[:, None]
    wide = np.where(length < _SHORT, _SHORT, 1.5)[:, None]
    near = along(graph, np.maximum(out - wide, 0))[0]
    far = along(graph, np.minimum(out + wide, length[:, None]))[0]
    heading = far - near
    heading /= np.maximum(np.abs(heading), 1e-9)
    place = along(graph, out)[0] + (graph.vertices[graph.half_vertex] @ [1, 1j])[:, None]
    half = np.repeat(np.arange(len(length)), count.astype(int))
    out, heading, place = out[inside], heading[inside], place[inside]
    return (
        half,
        out,
        np.stack([place.real, place.imag], 1),
        np.stack([heading.real, heading.imag], 1),
        np.exp(-out / _FADE),
        np.where(length < _SHORT, _ALONG_SHORT, _ALONG)[half],
    )


def _owners(graph: PlanarGraph, claims: _Claims, lines: _Lines) -> Array:
    """Which claim each half-branch grants, as rows; none where no stroke covers it."""
    a, b, _ = _meeting(graph, claims, lines)
    ahead = along(graph, np.array([8.0]))[0][:, 0]
    ahead /= np.maximum(np.abs(ahead), 1e-9)
    straight = -(ahead[claims.half[a]] * np.conj(ahead[claims.half[b]])).real
    best = np.zeros(len(claims.half))
    np.maximum.at(best, a, straight)
    np.maximum.at(best, b, straight)
    score = claims.fit + _STRAIGHT * best

    # The two halves of a short branch decide together: the same stroke, seen from the other end.
    length = along(graph, np.array([np.inf]))[1][claims.half]
    side = claims.half & 1
    key = np.stack([claims.half >> 1, claims.stroke, claims.sign * (1 - 2 * side)], 1)
    _, group = np.unique(key, axis=0, return_inverse=True)
    group = group.reshape(-1)
    both = np.bincount(group, score)[group] / 2
    score = np.where(length < _WHOLE, both, score)
    order = np.lexsort((-score, claims.half))
    return order[_changes(claims.half[order])]


def _continued(graph: PlanarGraph, claims: _Claims, lines: _Lines) -> list[tuple[int, int]]:
    """Pairs of half-branches that their owner joins, the nearest along the stroke first."""
    a, b, gap = _meeting(graph, claims, lines)
    order = np.argsort(gap, kind="stable")
    a, b = claims.half[a[order]], claims.half[b[order]]
    return list(zip(a.tolist(), b.tolist(), strict=True))


def _meeting(graph: PlanarGraph, claims: _Claims, lines: _Lines) -> tuple[Array, Array, Array]:
    """Claims a, b of one stroke that comes to a vertex along a and goes on along b, and the px of
    the stroke between them."""
    a, b = _same(np.stack([graph.half_vertex[claims.half], claims.stroke], 1))
    onward = (claims.sign[a] < 0) & (claims.sign[b] > 0) & (claims.half[a] != claims.half[b])
    a, b = a[onward], b[onward]
    gap = np.abs(claims.start[a] - claims.start[b])
    length = lines.length[claims.stroke[a]]
    gap = np.where(np.isfinite(length), np.minimum(gap, np.abs(length - gap)), gap)
    return a[gap < _GAP], b[gap < _GAP], gap[gap < _GAP]


def _same(keys: Array) -> tuple[Array, Array]:
    """All ordered pairs of different rows that are equal, as two index arrays."""
    if not len(keys):
        return np.zeros(0, int), np.zeros(0, int)
    _, group = np.unique(keys, axis=0, return_inverse=True)
    group = group.reshape(-1)
    order = np.argsort(group, kind="stable")
    size = np.bincount(group)
    start = np.cumsum(size) - size
    each = size[group[order]]
    a, b = np.repeat(order, each), order[ranges(start[group[order]], each)]
    return a[a != b], b[a != b]
