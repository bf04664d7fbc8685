"""Pages of true pen strokes to learn routing from: real drawings, composed, and drawn-up graphs.

A page is a list of (N, 2) polylines in px, one per pen stroke. Three kinds: one drawing as its
artist made it; several of one source laid over each other at random scale and rotation, since
single doodles seldom cross themselves; and smooth random nets (`net`) that are rich in what
drawings have little of: tangents, shallow crossings, high degrees, ends inside junctions.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from involute.engine.arrays.ragged import along, arc
from scipy.spatial import Delaunay

from .library import BOX, DrawingSet, read_sets

Array = np.ndarray

# How often a source is drawn from; see the data's own README for why.
SOURCES = {
    "openclipart": 3.0,
    "streamline": 3.0,
    "quickdraw_raw": 2.5,
    "quickdraw_simplified": 0.5,
    "excalidraw": 1.5,
    "openmoji": 1.5,
    "kanjivg": 1.0,
    "arcticons": 1.0,
    "icons_permissive": 0.5,
    "fishdraw": 0.3,
    "tangles": 1.0,
    "own": 6.0,  # of whoever trains: `own_drawings`
}
# Drawings with so few strokes that they say little alone.
_DOODLES = {"quickdraw_raw", "quickdraw_simplified", "icons_permissive", "kanjivg"}
_MAX_STROKES = 220
# Typical length of a stroke on a page, px, shortest and longest; and the same for a drawing.
_STROKE = (50.0, 220.0)
_SIZE = (120.0, 1600.0)


@dataclass(frozen=True, eq=False)
class Library:
    """The drawings of one side of the split, by source; `held_out` says which side."""

    sources: dict[str, DrawingSet]
    held_out: bool

    @staticmethod
    def load(folder: Path, held_out: bool) -> Library:
        """Read the sets of SOURCES that a folder holds.

        Raises:
            FileNotFoundError: the folder holds none of them.
        """
        sets = read_sets(folder, SOURCES)
        return Library({k: v for k, v in sets.items() if len(v.part(held_out))}, held_out)

    def pick(self, rng: np.random.Generator, source: str) -> list[Array]:
        """One drawing of a source; its longer side is about 1."""
        drawn = self.sources[source]
        lines = drawn.strokes(int(rng.choice(drawn.part(self.held_out))))
        return [line / BOX - 0.5 for line in lines if len(line) > 1]

    def page(self, rng: np.random.Generator) -> list[Array]:
        """A random page of random kind."""
        if rng.random() < 0.12:
            return net(rng)
        names = list(self.sources)
        weight = np.array([SOURCES[name] for name in names])
        source = str(rng.choice(names, p=weight / weight.sum()))
        doodle = source in _DOODLES
        if rng.random() < (0.1 if doodle else 0.6):
            drawing = self.pick(rng, source)
            return _placed(rng, drawing, _size(rng, drawing), np.zeros(2))
        return self._composed(
            rng, source, int(rng.integers(4, 12) if doodle else rng.integers(2, 5))
        )

    def _composed(self, rng: np.random.Generator, source: str, count: int) -> list[Array]:
        drawings = [self.pick(rng, source) for _ in range(count)]
        sizes = [_size(rng, drawing) for drawing in drawings]
        spread = np.median(sizes) * rng.uniform(0.3, 0.9) * np.sqrt(count) / 2
        page: list[Array] = []
        for drawing, size in zip(drawings, sizes, strict=True):
            if page and len(page) + len(drawing) > _MAX_STROKES:
                break
            page += _placed(rng, drawing, size, rng.uniform(-spread, spread, 2))
        return page


def _size(rng: np.random.Generator, drawing: list[Array]) -> float:
    """A size in px at which the strokes of a drawing are as long as on a drawn page."""
    lengths = [np.hypot(*np.diff(line, axis=0).T).sum() for line in drawing]
    wanted = np.exp(rng.uniform(*np.log(_STROKE)))
    return float(np.clip(wanted / max(float(np.median(lengths)), 1e-3), *_SIZE))


def _placed(
    rng: np.random.Generator, drawing: list[Array], size: float, where: Array
) -> list[Array]:
    """A drawing (longer side about 1) at a size in px, turned at random; a part of it if large."""
    if len(drawing) > _MAX_STROKES:
        middle = np.array([line[len(line) // 2] for line in drawing])
        far = np.hypot(*(middle - middle[rng.integers(len(middle))]).T)
        drawing = [drawing[k] for k in np.argsort(far)[:_MAX_STROKES]]
    angle = rng.uniform(0, 2 * np.pi)
    cos, sin = size * np.cos(angle), size * np.sin(angle)
    return [line @ np.array([[cos, sin], [-sin, cos]]) + where for line in drawing]


def loosened(rng: np.random.Generator, page: list[Array]) -> list[Array]:
    """A page as a looser hand draws it: some strokes missing, ends too short or too long."""
    if rng.random() < 0.5:
        return page
    drop, reach = rng.uniform(0, 0.5 if rng.random() < 0.3 else 0.15), rng.uniform(0.3, 3.0)
    kept = [line for line in page if rng.random() >= drop]
    return [with_ends(line, *rng.normal(0.3, reach, 2)) for line in kept] or page


def with_ends(line: Array, head: float, tail: float) -> Array:
    """Lengthen (or shorten, when negative) a polyline at both ends, px; closed ones stay."""
    way = arc(line)
    if way[-1] < 25 or np.hypot(*(line[0] - line[-1])) < 3:
        return line
    low, high = max(0.0, -head), way[-1] - max(0.0, -tail)
    inside = (way > low) & (way < high)
    tips = along(line, np.array([low, high]))
    line = np.vstack([tips[:1], line[inside], tips[1:]])
    step = np.hypot(*np.diff(line, axis=0).T)
    line = line[np.concatenate([[True], step > 1e-6])]
    if len(line) < 2:
        return line
    first = line[:1] + max(head, 0.0) * _unit(line[0] - line[1])
    last = line[-1:] + max(tail, 0.0) * _unit(line[-1] - line[-2])
    return np.vstack([first, line, last])


def _unit(v: Array) -> Array:
    return v / max(float(np.hypot(*v)), 1e-9)


def net(rng: np.random.Generator) -> list[Array]:
    """Strokes through a random planar net, crossing, touching and ending in its vertices.

    After the planar-graph sampler of "Stroke Vectorization via Involution Prediction" (routing
    data): a Delaunay triangulation, edges taken out, a random involution at every vertex whose
    pairs share a tangent there (all pairs the same one at a tangent vertex), cubic edges.
    """
    count, size = int(rng.integers(12, 70)), rng.uniform(180, 500)
    points = rng.uniform(0, size, (count * 3, 2))
    apart = size / np.sqrt(count) * 0.45
    chosen: list[int] = []
    for k in range(len(points)):
        if all(np.hypot(*(points[k] - points[c])) > apart for c in chosen[:count]):
            chosen.append(k)
    points = points[chosen[:count]]
    triangles = Delaunay(points).simplices
    edges = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    edges = edges[rng.random(len(edges)) > rng.uniform(0.15, 0.6)]
    if not len(edges):
        return []
    chord = points[edges[:, 1]] - points[edges[:, 0]]
    leaving = np.stack([chord, -chord], 1).reshape(-1, 2)
    leaving /= np.hypot(*leaving.T)[:, None]
    partner = np.arange(len(leaving))
    vertex = edges.reshape(-1)
    straight, tangent_share = rng.uniform(0.0, 1.0), rng.uniform(0.0, 0.5)
    for v in np.unique(vertex):
        _route(rng, np.flatnonzero(vertex == v), leaving, partner, straight, tangent_share)
    t = np.linspace(0, 1, 24)[:, None]
    reach = rng.uniform(0.25, 0.4) * np.hypot(*chord.T)
    curves = []
    for e, (a, b) in enumerate(edges):
        p, q = points[a], points[b]
        u, w = p + reach[e] * leaving[2 * e], q + reach[e] * leaving[2 * e + 1]
        curves.append(
            (1 - t) ** 3 * p + 3 * (1 - t) ** 2 * t * u + 3 * (1 - t) * t**2 * w + t**3 * q
        )
    return _walk(curves, partner)


def _route(
    rng: np.random.Generator,
    halves: Array,
    leaving: Array,
    partner: Array,
    straight: float,
    tangent_share: float,
) -> None:
    """Pair the half-branches of one vertex at random and turn each pair to a common tangent."""
    left = list(rng.permutation(halves))
    all_tangent = rng.random() < tangent_share
    shared = None
    while len(left) > 1:
        a = left.pop()
        if rng.random() < 0.25:
            continue
        turn = [leaving[a] @ leaving[b] for b in left]
        k = int(np.argmin(turn)) if rng.random() < straight else int(rng.integers(len(left)))
        if turn[k] > 0.3:
            continue
        b = left.pop(k)
        partner[a], partner[b] = b, a
        along = _unit(leaving[a] - leaving[b]) if shared is None else shared
        if along @ (leaving[a] - leaving[b]) < 0:
            along = -along
        shared = along if all_tangent else None
        leaving[a], leaving[b] = along, -along


def _walk(curves: list[Array], partner: Array) -> list[Array]:
    """Join curves into strokes along an involution of their ends (2e = start, 2e + 1 = end)."""
    used = np.zeros(len(curves), bool)
    seeds = [*np.flatnonzero(partner == np.arange(len(partner))), *range(len(partner))]
    strokes = []
    for half in seeds:
        parts = []
        while not used[half >> 1]:
            used[half >> 1] = True
            parts.append(curves[half >> 1][::-1] if half & 1 else curves[half >> 1])
            half = partner[half ^ 1]
        if parts:
            strokes.append(np.concatenate([parts[0], *(p[1:] for p in parts[1:])]))
    return strokes
