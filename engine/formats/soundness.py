"""Is a drawing that was read what the engine would have made? Checked once, completely.

Files are cut short, edited and damaged. What is checked here need not be checked anywhere else:
walking, splicing and drawing rely on it.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..drawing import Drawing
from ..values import Array, PlanarGraph, Routing, Stroke

_FAR = 1e7  # px; no page is that large, and float32 still tells pixels apart there


def check(drawing: Drawing) -> None:
    """Refuse what would only fail later, somewhere else.

    Raises:
        ValueError: says which part is wrong.
    """
    width, height = drawing.size
    _need(0 < width < _FAR and 0 < height < _FAR, "size")
    _need(np.isfinite(drawing.scale) and 0 < drawing.scale < _FAR, "scale")
    _need(isinstance(drawing.seconds, dict), "seconds")
    _need(all(isinstance(v, int | float) for v in drawing.seconds.values()), "seconds")
    _graph(drawing.graph)
    routing(drawing.graph, drawing.routing)
    _strokes(drawing.strokes, drawing.graph.branch_count)
    for ring in (ring for fill in drawing.fills for ring in fill):
        _array(ring, "f", (None, 2), "fills")
    if drawing.region_colors is not None:
        _array(drawing.region_colors, "u", (None, 3), "region_colors")


def routing(graph: PlanarGraph, found: Routing) -> None:
    """Is it an involution of the half-branches of a sound graph, with its alternatives?

    Raises:
        ValueError: says which part is wrong.
    """
    halves, junctions = 2 * graph.branch_count, graph.junctions
    involution(graph, found.partner)
    _array(found.locked, "b", (len(junctions),), "locked")
    _array(found.pairs, "i", (None, 2), "pairs")
    _array(found.pair_score, "f", (len(found.pairs),), "pair_score")
    _within(found.pairs, halves, "pairs")
    _need(len(found.alternatives) == len(junctions), "alternatives")
    vertex = graph.half_vertex.tolist()
    for junction, ways in zip(junctions.tolist(), found.alternatives, strict=True):
        _need(len(ways) > 0, "alternatives")
        for way in ways:
            chosen = [half for pair in way.pairs for half in pair]
            _need(all(isinstance(h, int) and 0 <= h < halves for h in chosen), "alternatives")
            _need(all(vertex[h] == junction for h in chosen), "alternatives")
            _need(len(set(chosen)) == len(chosen) == 2 * len(way.pairs), "alternatives")
            _need(isinstance(way.probability, int | float), "alternatives")
            _need(-1e-6 <= way.probability <= 1 + 1e-6, "alternatives")


def involution(graph: PlanarGraph, partner: Array) -> None:
    """Does each half-branch end, or continue in one that continues in it, at the same vertex?

    Raises:
        ValueError: it does not.
    """
    halves = 2 * graph.branch_count
    _array(partner, "i", (halves,), "partner")
    _within(partner, halves, "partner")
    _need(np.array_equal(partner[partner], np.arange(halves)), "partner")
    _need(np.array_equal(graph.half_vertex[partner], graph.half_vertex), "partner")


def _graph(graph: PlanarGraph) -> None:
    _array(graph.vertices, "f", (None, 2), "vertices")
    _array(graph.points, "f", (None, 2), "points")
    _array(graph.offsets, "i", (None,), "offsets")
    count = len(graph.points)
    _need(len(graph.offsets) > 0 and graph.offsets[0] == 0, "offsets")
    _need(graph.offsets[-1] == count and (np.diff(graph.offsets) >= 2).all(), "offsets")
    _array(graph.ends, "i", (graph.branch_count, 2), "ends")
    _within(graph.ends, len(graph.vertices), "ends")
    for name, kind, shape in (
        ("widths", "f", (count,)),
        ("strength", "f", (count,)),
        ("colors", "u", (count, 3)),
    ):
        if getattr(graph, name) is not None:
            _array(getattr(graph, name), kind, shape, name)


def _strokes(strokes: Iterable[Stroke], branches: int) -> None:
    """No branch belongs to two strokes; points and what goes with them are as many."""
    walked = np.zeros(branches, np.int64)
    for stroke in strokes:
        count = len(stroke.points)
        _need(count > 0, "strokes")
        _array(stroke.points, "f", (count, 2), "strokes")
        _array(stroke.widths, "f", (count,), "widths")
        _array(stroke.opacity, "f", (count,), "opacity")
        if stroke.handles is not None:
            _array(stroke.handles, "f", (count, 2, 2), "handles")
        _array(stroke.branches, "i", (None,), "branches")
        _within(stroke.branches, 2 * branches, "branches")
        np.add.at(walked, stroke.branches >> 1, 1)
    _need((walked <= 1).all(), "branches")


def _array(values: Array, kind: str, shape: tuple[int | None, ...], name: str) -> None:
    """Is it an array of that kind ("f", "i", "u", "b") and shape (None = any length), finite?"""
    _need(isinstance(values, np.ndarray) and values.dtype.kind == kind, name)
    fits = values.ndim == len(shape) and all(
        wanted in (None, size) for wanted, size in zip(shape, values.shape, strict=True)
    )
    _need(fits, name)
    if kind == "f" and values.size:
        _need(bool(np.isfinite(values).all()) and float(np.abs(values).max()) < _FAR, name)


def _within(values: Array, count: int, name: str) -> None:
    """Are these numbers of things of which there are so many?"""
    _need(values.size == 0 or (values.min() >= 0 and values.max() < count), name)


def _need(holds: object, name: str) -> None:
    if not holds:
        raise ValueError(f"unsound {name}")
