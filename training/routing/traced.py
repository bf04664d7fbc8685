"""Graphs as our own centerline and graph stages really make them, matched back to the true strokes.

`python -m training.routing.traced --data DIR --out FILE --pages N` draws pages of true strokes,
traces them and writes the graphs with their routing: after the rasterised set of "Stroke
Vectorization via Involution Prediction" (routing data), but from real drawings as well.
"""

from __future__ import annotations

import argparse
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
from involute.engine.centerline import provider_for
from involute.engine.graph import build_graph, measure
from involute.engine.routing.encoding import along
from involute.engine.settings import Settings
from involute.engine.values import LineMaps, PlanarGraph, Scan
from scipy.spatial import cKDTree

from .augment import Page
from .pages import Library, loosened
from .planar import single_lines

Array = np.ndarray

_MARGIN = 12.0  # px around the drawing
_LARGEST = 1100.0  # px; a page is cut to this, so that tracing stays quick
_PROBE = 8.0  # px along a half-branch, where it is compared with the true strokes
_NEAR = 2.5  # px; a true stroke this near is the one that was traced
_RIVAL = 0.7  # px; strokes this much farther off than the nearest one are others
_ALONG = 0.8  # cosine between a half-branch and the stroke it traces


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True, help="folder of SOURCE.npz drawings")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--pages", type=int, default=1500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--provider", default="auto", help="centerline: network or classical")
    parser.add_argument("--held-out", action="store_true", help="from the validation drawings")
    args = parser.parse_args()
    library = Library.load(args.data, args.held_out)
    settings = Settings(provider=args.provider)
    rng = np.random.default_rng(args.seed)
    pages: list[Page] = []
    while len(pages) < args.pages:
        page = traced_page(rng, library, settings)
        if len(page.graph.junctions):
            pages.append(page)
    save(args.out, pages)


def traced_page(rng: np.random.Generator, library: Library, settings: Settings) -> Page:
    """One random page, traced from an ideal centerline or from pen strokes on paper."""
    strokes = _on_canvas(loosened(rng, library.page(rng)))
    trace = trace_ideal if rng.random() < 0.5 else trace_ink
    return matched(trace(rng, strokes, settings), strokes)


def _on_canvas(strokes: list[Array]) -> list[Array]:
    """Strokes moved to positive coordinates; those that leave the largest page are dropped."""
    low = np.min([line.min(0) for line in strokes], 0) if strokes else np.zeros(2)
    moved = [line - low + _MARGIN for line in strokes]
    return [line for line in moved if line.max() < _LARGEST]


def _canvas(strokes: list[Array]) -> Array:
    size = np.max([line.max(0) for line in strokes], 0) if strokes else np.zeros(2)
    width, height = np.ceil(size + _MARGIN).astype(int)
    return np.zeros((height, width), np.uint8)


def _draw(image: Array, line: Array, thickness: int, level: int, scale: int = 1) -> None:
    # OpenCV's pixel centres are whole numbers, ours lie at one half.
    fixed = np.round((line * scale - 0.5) * 256).astype(np.int32)
    cv2.polylines(image, [fixed], False, level, thickness, cv2.LINE_AA, 8)


def trace_ideal(rng: np.random.Generator, strokes: list[Array], settings: Settings) -> PlanarGraph:
    """The graph of a perfect centerline: a thin white line, sometimes softened."""
    image = _canvas(strokes)
    for line in strokes:
        _draw(image, line, 1, 255)
    maps = image.astype(np.float32) / 255
    if rng.random() < 0.7:
        maps = np.minimum(1, 2.2 * cv2.GaussianBlur(maps, (0, 0), rng.uniform(0.6, 1.0)))
    return build_graph(LineMaps(maps), 2.0, settings)


def trace_ink(rng: np.random.Generator, strokes: list[Array], settings: Settings) -> PlanarGraph:
    """The graph of pen strokes on paper, through the centerline provider that ships."""
    image = _canvas(strokes)
    pen = rng.uniform(2.0, 5.5)
    ink = np.zeros(np.array(image.shape) * 2, np.uint8)
    for line in strokes:
        wide = max(1, round(2 * pen * np.exp(rng.normal(0, 0.12))))
        _draw(ink, line, wide, int(rng.integers(190, 256)), 2)
    ink = cv2.resize(ink, image.shape[::-1], interpolation=cv2.INTER_AREA).astype(np.float32) / 255
    ink = cv2.GaussianBlur(ink, (0, 0), rng.uniform(0.4, 1.0))
    grain = cv2.GaussianBlur(rng.normal(0, 1, ink.shape).astype(np.float32), (0, 0), 0.8)
    ink = ink * (1 + rng.uniform(0, 0.5) * grain) + rng.uniform(0, 0.06) * grain
    ink = np.clip(ink, 0, 1).astype(np.float32)
    height, width = ink.shape
    scan = Scan(ink, None, 1.0, (width, height), pen)
    maps = provider_for(settings)(scan, lambda fraction: None)
    return measure(build_graph(maps, pen, settings), scan, maps)


def matched(graph: PlanarGraph, strokes: list[Array]) -> Page:
    """The page of a traced graph: pairs that one true stroke runs through are allowed.

    Lines drawn twice count once, as in `planar`. Where allowed pairs still contradict each other,
    because the tracer made one branch of two strokes, `partner` takes those that were matched
    first.
    """
    strokes = single_lines(strokes)
    partner = np.arange(2 * graph.branch_count)
    stroke = np.zeros(len(graph.points))
    loop = np.flatnonzero(graph.degrees[graph.half_vertex] == 2)
    partner[loop] = loop ^ 1
    if not strokes or not len(graph.junctions):
        return Page(graph, partner, stroke, np.zeros((0, 2), int))
    half, line, arc, sign, reach, length = _traces(graph, strokes)
    stroke[:] = np.repeat(_first(half >> 1, line, graph.branch_count), np.diff(graph.offsets))

    a, b = _same(np.stack([graph.half_vertex[half], line], 1))
    # The pen came along the one with the lower arc length and went on along the other one.
    onward = (sign[a] < 0) & (sign[b] > 0) & (half[a] != half[b])
    a, b = a[onward], b[onward]
    gap = arc[b] - arc[a]
    gap = np.where(gap < 0, gap + length[line[a]], gap)
    span = reach[a] + reach[b]
    joined = (gap > 0.4 * span) & (gap < 1.8 * span + 4)
    pairs = np.unique(np.sort(np.stack([half[a[joined]], half[b[joined]]], 1), axis=1), axis=0)
    for c, d in pairs:
        if partner[c] == c and partner[d] == d:
            partner[c], partner[d] = d, c
    return Page(graph, partner, stroke, pairs)


def _first(branch: Array, line: Array, count: int) -> Array:
    """A true stroke for every branch: the first that was found, 0 where none was."""
    found = np.zeros(count)
    found[branch[::-1]] = line[::-1]
    return found


def _same(keys: Array) -> tuple[Array, Array]:
    """All ordered pairs of different rows that are equal, as two index arrays."""
    _, group = np.unique(keys, axis=0, return_inverse=True)
    group = group.reshape(-1)
    order = np.argsort(group, kind="stable")
    size = np.bincount(group)
    start = np.cumsum(size) - size
    each = size[group[order]]
    inside = np.arange(each.sum()) - np.repeat(np.cumsum(each) - each, each)
    a, b = np.repeat(order, each), order[np.repeat(start[group[order]], each) + inside]
    return a[a != b], b[a != b]


def _traces(graph: PlanarGraph, strokes: list[Array]) -> tuple[Array, ...]:
    """Which true strokes each half-branch traces.

    Returns:
        half, line, arc, sign, reach: for every match the half-branch, the stroke, where on it, +1
        if the half-branch runs away from its junction as the pen did, and how far out it was
        compared; and the length of every stroke (inf for open ones).
    """
    samples, owner, arcs, length = [], [], [], []
    for index, line in enumerate(strokes):
        arc = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
        at = np.linspace(0, arc[-1], max(2, round(arc[-1]) + 1))
        samples.append(np.stack([np.interp(at, arc, line[:, c]) for c in (0, 1)], 1))
        owner.append(np.full(len(at), index))
        arcs.append(at)
        closed = np.hypot(*(line[0] - line[-1])) < 2
        length.append(arc[-1] if closed else np.inf)
    tangent = np.concatenate([np.gradient(s, axis=0) for s in samples])
    tangent /= np.maximum(np.hypot(*tangent.T), 1e-9)[:, None]
    place, owner, arcs = np.concatenate(samples), np.concatenate(owner), np.concatenate(arcs)

    half = np.flatnonzero(graph.degrees[graph.half_vertex] >= 3)
    probe, heading, reach = _probes(graph, half)
    near = cKDTree(place).query_ball_point(probe, _NEAR)
    row = np.repeat(np.arange(len(half)), [len(n) for n in near])
    hit = np.concatenate([np.asarray(n, int) for n in near]) if len(row) else row
    along = (heading[row] * tangent[hit]).sum(1)
    row, hit, along = (v[np.abs(along) > _ALONG] for v in (row, hit, along))
    distance = np.hypot(*(place[hit] - probe[row]).T)
    best = np.full(len(half), np.inf)
    np.minimum.at(best, row, distance)
    close = distance < best[row] + _RIVAL
    row, hit, along, distance = (v[close] for v in (row, hit, along, distance))
    # The nearest sample of every pass of every stroke; passes in opposite directions differ.
    order = np.lexsort((distance, along > 0, owner[hit], row))
    key = np.stack([row, owner[hit], along > 0], 1)[order]
    first = np.concatenate([[True], (np.diff(key, axis=0) != 0).any(1)])[: len(key)]
    row, hit, along = (v[order][first] for v in (row, hit, along))
    return half[row], owner[hit], arcs[hit], np.sign(along), reach[row], np.array(length)


def _probes(graph: PlanarGraph, half: Array) -> tuple[Array, Array, Array]:
    """A point some way out on each half-branch, its outward direction, and how far out it is."""
    length = along(graph, np.array([np.inf]))[1]
    reach = np.minimum(_PROBE, 0.5 * length)
    near, _ = along(graph, np.maximum(reach - 1.5, 0)[:, None])
    far, _ = along(graph, np.minimum(reach + 1.5, length)[:, None])
    at, _ = along(graph, reach[:, None])
    heading = (far - near)[half, 0]
    heading /= np.maximum(np.abs(heading), 1e-9)
    origin = graph.vertices[graph.half_vertex]
    point = origin[half] + np.stack([at.real, at.imag], -1)[half, 0]
    return point, np.stack([heading.real, heading.imag], 1), reach[half]


def save(path: Path, pages: list[Page]) -> None:
    """Write traced pages as one compressed file."""
    arrays: dict[str, Array] = {}
    for name in ("vertices", "points", "offsets", "ends"):
        arrays[name] = np.concatenate([getattr(page.graph, name) for page in pages])
    for name in ("widths", "strength"):
        arrays[name] = np.concatenate([_or_nan(page, name) for page in pages])
    for name in ("partner", "stroke", "allowed"):
        arrays[name] = np.concatenate([getattr(page, name) for page in pages])
    sizes = [
        (len(p.graph.vertices), len(p.graph.points), p.graph.branch_count, len(p.allowed))
        for p in pages
    ]
    np.savez_compressed(path, sizes=np.array(sizes), **arrays)


def _or_nan(page: Page, name: str) -> Array:
    values = getattr(page.graph, name)
    return np.full(len(page.graph.points), np.nan if values is None else values, np.float16)


def load(path: Path) -> list[Page]:
    """Read what `save` wrote."""
    data = dict(np.load(path))
    pages = []
    bounds = np.concatenate([np.zeros((1, 4), int), np.cumsum(data["sizes"], axis=0)])
    for number, ((v0, p0, b0, k0), (v1, p1, b1, k1)) in enumerate(pairwise(bounds)):
        given = {name: data[name][p0:p1].astype(np.float32) for name in ("widths", "strength")}
        graph = PlanarGraph(
            data["vertices"][v0:v1],
            data["points"][p0:p1],
            data["offsets"][b0 + number : b1 + number + 1],
            data["ends"][b0:b1],
            **{name: None if np.isnan(v).any() else v for name, v in given.items()},
        )
        partner, stroke = data["partner"][2 * b0 : 2 * b1], data["stroke"][p0:p1]
        pages.append(Page(graph, partner, stroke, data["allowed"][k0:k1]))
    return pages


if __name__ == "__main__":
    main()
