"""A file of traced pages with their true routing, small enough to be carried around.

Points are kept every 2 px, in 1/16 px, as differences of differences; widths in steps of 2 %,
strength in steps of 1/255. That is finer than a tracer is true.
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
from involute.engine.arrays.ragged import count_up, offsets_of, owners
from involute.engine.values import PlanarGraph

from .augment import Page

Array = np.ndarray

_EVERY = 2  # points of a branch from one that is kept to the next
_UNIT = 16.0  # steps a px
_OCTAVE = 32.0  # steps that a width takes to double ...
_THINNEST = 0.25  # ... from this on, px


def save(path: Path, pages: list[Page], tried: int = 0) -> None:
    """Write pages as one compressed file, and how many tries they took."""
    thin = [_thinned(page) for page in pages]
    graphs = [page.graph for page in thin]
    arrays = {
        "vertices": _packed(np.concatenate([graph.vertices for graph in graphs])),
        "points": _packed(np.concatenate([graph.points for graph in graphs])),
        "counts": np.concatenate([np.diff(graph.offsets) for graph in graphs]).astype(np.uint16),
        "ends": np.concatenate([graph.ends for graph in graphs]).astype(np.uint16),
        "partner": np.concatenate([page.partner for page in thin]).astype(np.uint16),
        "stroke": np.concatenate([_first(page, page.stroke) for page in thin]).astype(np.int16),
        "measured": np.array([graph.widths is not None for graph in graphs]),
        "widths": _steps([_logarithm(graph.widths) for graph in graphs]),
        "strength": _steps([_shade(graph.strength) for graph in graphs]),
        "sizes": np.array([(len(g.vertices), g.branch_count) for g in graphs]).reshape(-1, 2),
        "tried": np.array(tried),
    }
    np.savez_compressed(path, **arrays)


def load(path: Path) -> list[Page]:
    """Read the pages that `save` wrote."""
    with np.load(path) as file:
        data = dict(file)
    points, vertices = _unpacked(data["points"]), _unpacked(data["vertices"])
    widths = (_THINNEST * 2 ** (_sums(data["widths"]) / _OCTAVE)).astype(np.float32)
    strength = (_sums(data["strength"]) / 255).astype(np.float32)
    vertex, branch = (offsets_of(counts) for counts in data["sizes"].T)
    point = offsets_of(data["counts"].astype(np.int64))
    inked = offsets_of(np.where(data["measured"], np.diff(point[branch]), 0))
    pages = []
    for k, (v, b, i) in enumerate(
        zip(pairwise(vertex), pairwise(branch), pairwise(inked), strict=True)
    ):
        own = slice(point[b[0]], point[b[1]])
        offsets = (point[b[0] : b[1] + 1] - point[b[0]]).astype(np.int32)
        seen = {"widths": widths[slice(*i)], "strength": strength[slice(*i)]}
        graph = PlanarGraph(
            vertices[slice(*v)],
            points[own],
            offsets,
            data["ends"][slice(*b)].astype(np.int32),
            **(seen if data["measured"][k] else {}),
        )
        partner = data["partner"][2 * b[0] : 2 * b[1]].astype(np.int64)
        stroke = np.repeat(data["stroke"][slice(*b)], np.diff(offsets)).astype(float)
        pages.append(Page(graph, partner, stroke, traced=True))
    return pages


def with_tries(path: Path) -> tuple[list[Page], int]:
    """The pages, and how many tries they took."""
    with np.load(path) as data:
        return load(path), int(data["tried"])


def _thinned(page: Page) -> Page:
    """The page with every other point of its branches; the first and last ones stay."""
    graph = page.graph
    count = np.diff(graph.offsets)
    place, of_branch = count_up(count), owners(graph.offsets)
    kept = (place % _EVERY == 0) | (place == count[of_branch] - 1)
    values = (graph.widths, graph.strength)
    widths, strength = (None if v is None else v[kept] for v in values)
    offsets = offsets_of(np.bincount(of_branch[kept], minlength=graph.branch_count))
    thin = PlanarGraph(
        graph.vertices, graph.points[kept], offsets.astype(np.int32), graph.ends, widths, strength
    )
    return Page(thin, page.partner, page.stroke[kept], page.traced)


def _first(page: Page, values: Array) -> Array:
    return values[page.graph.offsets[:-1]]


def _packed(places: Array) -> Array:
    """(N, 2) uint16 second differences; they wrap around, and back when they are summed up."""
    whole = np.rint(places.astype(np.float64) * _UNIT).astype(np.int64).astype(np.uint16)
    for _ in range(2):
        whole = np.diff(whole, axis=0, prepend=np.zeros((1, 2), np.uint16))
    return whole


def _unpacked(packed: Array) -> Array:
    for _ in range(2):
        packed = np.cumsum(packed, axis=0, dtype=np.uint16)
    return (packed / _UNIT).astype(np.float32)


def _logarithm(widths: Array | None) -> Array:
    if widths is None:
        return np.zeros(0)
    return _OCTAVE * np.log2(np.maximum(widths.astype(np.float64), _THINNEST) / _THINNEST)


def _shade(strength: Array | None) -> Array:
    return np.zeros(0) if strength is None else 255.0 * strength.astype(np.float64)


def _steps(parts: list[Array]) -> Array:
    """(N,) uint8 differences of whole numbers from 0 to 255."""
    whole = np.rint(np.concatenate(parts)).clip(0, 255).astype(np.uint8)
    return np.diff(whole, prepend=np.uint8(0))


def _sums(steps: Array) -> Array:
    return np.cumsum(steps, dtype=np.uint8)
