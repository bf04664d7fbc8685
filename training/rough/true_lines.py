"""What the true lines of a page say of its pencil strokes, and of the lines redrawn from them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from involute.engine.arrays.ragged import along, arc, owners
from involute.engine.graph.gaps import looks
from involute.engine.graph.topology import lengths
from involute.engine.rough.beside import Rungs
from involute.engine.rough.sampled import Sampled
from involute.engine.values import PlanarGraph
from scipy.spatial import cKDTree

Array = np.ndarray

_SAME_WAY = 0.75  # cosine between a stroke and the line that it is part of
_NEAREST = 12  # places of true lines that are looked at
_LEAST, _STRAYS = 3.0, 1.5  # px, and times the spread, that a redrawn line may lie off
_PENCIL_LEAST, _PENCIL_STRAYS = 3.5, 2.5  # the same of a pencil stroke
_AGAIN = 3.0  # reaches along one line from which on it is another part of it
_BIN = 3.0  # px of a true line that are claimed at a time
_SECOND = 1.2  # px that a second line may lie farther off than the first, to be as true
_NEW = 0.4  # share of a branch that must be the first to say its line ...
_MEETING = 5  # ... without so many points at its ends
UNKNOWN = -1


@dataclass(frozen=True, eq=False)
class TrueLines:
    """All true lines, sampled every pixel: place, tangent (N, 2), line, arc (N,); length (L,) px of
    those that are closed, else inf."""

    place: Array
    tangent: Array
    line: Array
    arc: Array
    length: Array

    @staticmethod
    def of(lines: list[Array]) -> TrueLines:
        place, tangent, arcs, length = [], [], [], []
        for line in lines:
            whole = arc(line)[-1]
            at = np.linspace(0, whole, max(2, int(whole) + 1))
            place.append(along(line, at))
            way = np.gradient(place[-1], axis=0)
            tangent.append(way / np.maximum(np.hypot(*way.T), 1e-9)[:, None])
            arcs.append(at)
            length.append(whole if np.hypot(*(line[0] - line[-1])) < 2 else np.inf)
        number = np.repeat(np.arange(len(place)), [len(p) for p in place])
        return TrueLines(
            np.concatenate(place),
            np.concatenate(tangent),
            number,
            np.concatenate(arcs),
            np.array(length),
        )

    def owner(self, points: Array, tangent: Array, reach: float) -> tuple[Array, Array, Array]:
        """(P,) the line that runs the same way within `reach` px, or -1; px along it; px off it."""
        away, near = cKDTree(self.place).query(points, _NEAREST, distance_upper_bound=reach)
        near = np.minimum(near, len(self.place) - 1)
        same = np.abs((self.tangent[near] * tangent[:, None]).sum(2)) > _SAME_WAY
        away = np.where(np.isfinite(away) & same, away, np.inf)
        best = away.argmin(1)
        row = np.arange(len(points))
        away, near = away[row, best], near[row, best]
        return np.where(np.isfinite(away), self.line[near], -1), self.arc[near], away

    def heading(self, line: Array, place: Array) -> Array:
        """(P, 2) tangents of some lines at so many px along them."""
        first = np.searchsorted(self.line, line)
        last = np.searchsorted(self.line, line, "right") - 1
        return self.tangent[np.clip(first + np.round(place).astype(int), 0, np.maximum(last, 0))]


def one_line(strokes: Sampled, rungs: Rungs, true: TrueLines, spread: float, reach: float) -> Array:
    """(R,) int8 for each stretch: 1 = one line, 0 = not, UNKNOWN where neither is any line's."""
    far = max(_PENCIL_LEAST, _PENCIL_STRAYS * spread + 1.0)
    line, place, _ = true.owner(strokes.points, strokes.tangent, far)
    a, b = rungs.a, rungs.b
    along_line = np.abs(place[a] - place[b])
    whole = true.length[line[a]]
    along_line = np.where(
        np.isfinite(whole), np.minimum(along_line, np.abs(whole - along_line)), along_line
    )
    same = (line[a] == line[b]) & (line[a] >= 0) & (along_line < _AGAIN * reach)
    none = (line[a] < 0) & (line[b] < 0)
    count = np.bincount(rungs.stretch)
    share, nothing = (np.bincount(rungs.stretch, v) / count for v in (same, none))
    return np.where(nothing > 0.5, UNKNOWN, share > 0.5).astype(np.int8)


def meant(graph: PlanarGraph, true: TrueLines, spread: float) -> Array:
    """(B,) bool: the branches that lie on a true line, nearer than any other that does; of two that
    lie there for long, the longer one."""
    count = np.diff(graph.offsets)
    index = np.arange(len(graph.points))
    first, last = np.repeat(graph.offsets[:-1], count), np.repeat(graph.offsets[1:] - 1, count)
    points = graph.points.astype(np.float64)
    way = points[np.minimum(index + 3, last)] - points[np.maximum(index - 3, first)]
    way /= np.maximum(np.hypot(*way.T), 1e-9)[:, None]
    line, place, away = true.owner(points, way, max(_LEAST, _STRAYS * spread))
    claim = np.where(line >= 0, line * 10_000_000 + (place / _BIN).astype(int), -1)
    _, of = np.unique(claim, return_inverse=True)
    nearest = np.full(int(of.max()) + 1, np.inf)
    np.minimum.at(nearest, of, away)
    best = (line >= 0) & (away <= nearest[of] + _SECOND)
    near = np.bincount(owners(graph.offsets), best, graph.branch_count) > 0.5 * count
    good = np.zeros(graph.branch_count, bool)
    taken: set[int] = set()
    for branch in np.argsort(-lengths(graph), kind="stable").tolist():
        said = claim[graph.offsets[branch] : graph.offsets[branch + 1]]
        # Where it meets others, they say the same.
        inner = said[_MEETING:-_MEETING] if len(said) > 3 * _MEETING else said[:0]
        new = [c not in taken for c in inner[inner >= 0].tolist()]
        if near[branch] and (not new or np.mean(new) > _NEW):
            good[branch] = True
            taken.update(said[said >= 0].tolist())
    return good


def goes_on(graph: PlanarGraph, halves: Array, true: TrueLines, spread: float) -> Array:
    """(K,) bool: the pairs of half-branches, (K, 2), between whose loose ends a true line runs."""
    tips, outward = looks(graph, halves.ravel())
    reach = max(_PENCIL_LEAST, _STRAYS * spread)
    line, place, _ = true.owner(tips, outward, reach)
    forward = (true.heading(line, place) * outward).sum(1) > 0
    gap = np.hypot(*(tips[::2] - tips[1::2]).T)
    step = (place[1::2] - place[::2]) * np.where(forward[::2], 1, -1)
    whole = true.length[line[::2]]
    step = np.where(np.isfinite(whole) & (step < -0.5 * whole), step + whole, step)
    one = (line[::2] == line[1::2]) & (line[::2] >= 0) & (forward[::2] != forward[1::2])
    return one & (step > -reach) & (step < 1.5 * gap + reach)


def nearest_first(graph: PlanarGraph, halves: Array) -> Array:
    """Of some pairs of half-branches, (K, 2), as many as have no half-branch in common."""
    gap = graph.vertices[graph.half_vertex[halves]]
    used: set[int] = set()
    kept = []
    for row in np.argsort(np.hypot(*(gap[:, 0] - gap[:, 1]).T), kind="stable").tolist():
        if used.isdisjoint(halves[row].tolist()):
            used.update(halves[row].tolist())
            kept.append(row)
    return halves[kept]
