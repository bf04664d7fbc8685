"""Whether a drawing that comes from outside is one: what is wrong with it, and where.

Drawings that the engine makes are sound. What is read from a file is checked once, completely, so
that nobody who uses a drawing has to ask again.
"""

from __future__ import annotations

from itertools import pairwise
from math import isfinite
from typing import TYPE_CHECKING

import numpy as np

from .strokes.walk import walk
from .values import Alternative, Array, Beside, PlanarGraph, Routing, Stroke

if TYPE_CHECKING:
    from .drawing import Drawing

_LARGEST_SIDE = 1_000_000  # px; pages have at most 20,000
_FARTHEST = 10.0 * _LARGEST_SIDE  # px from the page's corner
_THICKEST = float(_LARGEST_SIDE)  # px
_APART = 0.05  # px between the end of a branch and its vertex, for rounding
_SCALES = (1e-3, 1e3)  # input pixels per working pixel
_MOST_PIXELS = 20_000**2  # working pixels of a page that is cleaned again; no picture has more
_DPI = (1.0, 100_000.0)  # pixels per inch; microscopes scan at some 25,000


class UnsoundError(ValueError):
    """A phrase: what is wrong with a drawing, and where."""


def check_drawing(drawing: Drawing) -> None:
    """Make sure of everything that the code that uses drawings relies on.

    Raises:
        UnsoundError: says what is wrong first.
    """
    for side in drawing.size:
        _need(1 <= side <= _LARGEST_SIDE, "its size is not that of a page")
    _need(_SCALES[0] <= drawing.scale <= _SCALES[1], "its scale can't be")
    _need(drawing.dpi is None or _DPI[0] <= drawing.dpi <= _DPI[1], "its dpi can't be")
    for stage, seconds in drawing.seconds.items():
        _need(isinstance(stage, str) and _is_number(seconds), "its seconds are no numbers")
    for number, stroke in enumerate(drawing.strokes):
        _check_stroke(stroke, f"stroke {number}")
    check_graph(drawing.graph)
    _check_pencil(drawing)
    check_routing(drawing.graph, drawing.routing)
    _check_walks(drawing)
    _check_lengths(drawing)
    for number, fill in enumerate(drawing.fills):
        _need(len(fill) > 0, f"fill {number} has no outline")
        _need(min(map(len, fill)) > 0, f"an outline of fill {number} has no points")
        rings = np.concatenate(fill)
        _table(rings, "f", (None, 2), f"the outline of fill {number}")
        _within(rings, _FARTHEST, f"the outline of fill {number}")
    _check_fidelity(drawing)
    if drawing.region_colors is not None:
        _table(drawing.region_colors, "u", (None, 3), "the colors of its regions")
        if drawing.settings.regions:
            count = len(drawing.regions)
            _need(len(drawing.region_colors) == count, "the colors of its regions don't fit them")


def _check_pencil(drawing: Drawing) -> None:
    pencil = drawing.pencil
    if pencil is None:
        return
    for number, stroke in enumerate(pencil.strokes):
        _check_stroke(stroke, f"pencil stroke {number}", runs=False)
    what = "which pencil strokes say which lines"
    _table(pencil.said, "i", (None, 2), what)
    _numbered(pencil.said[:, 0], len(pencil.strokes), what)
    _numbered(pencil.said[:, 1], drawing.graph.branch_count, what)
    if pencil.beside is not None:
        _check_beside(pencil.beside, len(pencil.strokes))
        width, height = (side / drawing.scale for side in drawing.size)
        _need(width * height <= _MOST_PIXELS, "its page is too large to clean it again")
    _check_spans(pencil.answers.strokes, pencil.answers.spans, len(pencil.strokes), "the answers")
    _table(pencil.answers.one, "b", (len(pencil.answers.strokes),), "the answers")
    first, second = pencil.answers.strokes.T
    _need(bool((first < second).all()), "an answer is not about two pencil strokes")
    _need(pencil.beside is not None or not len(first), "there are answers to no question")


def _check_beside(kept: Beside, count: int) -> None:
    """What a drawing is cleaned again from: as many strokes, well measured."""
    check_graph(kept.graph)
    _need(kept.graph.branch_count > 0, "its pencil strokes have no lines")
    _need(kept.graph.strength is not None, "its pencil strokes have no strength")
    check_involution(kept.graph, kept.partner)
    _need(len(walk(kept.partner)) == count, "its pencil strokes are not those of their lines")
    what = "what runs beside each other"
    _check_spans(kept.strokes, kept.spans, count, what)
    _table(kept.right, "b", (len(kept.strokes),), what)
    _table(kept.probability, "f", (len(kept.strokes),), what)
    _need(bool(((kept.probability >= 0) & (kept.probability <= 1)).all()), what)


def _check_spans(strokes: Array, spans: Array, count: int, what: str) -> None:
    _table(strokes, "i", (None, 2), what)
    _numbered(strokes, count, what)
    _table(spans, "f", (len(strokes), 2), what)
    _within(spans, _FARTHEST, what)


def _check_fidelity(drawing: Drawing) -> None:
    found = drawing.fidelity
    if found is None:
        return
    _need(0 <= found.lost <= 1 and 0 <= found.invented <= 1, "its fidelity is no share")
    boxes = [side for box in (*found.lost_at, *found.invented_at) for side in box]
    _need(all(abs(side) <= _FARTHEST for side in boxes), "the places of its fidelity can't be")


def check_graph(graph: PlanarGraph) -> None:
    """Make sure that a graph is one: what it says of its branches fits together.

    Raises:
        UnsoundError: says what is wrong first.
    """
    _table(graph.vertices, "f", (None, 2), "the vertices")
    _table(graph.points, "f", (None, 2), "the points of the branches")
    _table(graph.offsets, "i", (None,), "the beginnings of the branches")
    offsets, count = graph.offsets, len(graph.points)
    _need(len(offsets) > 0 and offsets[0] == 0, "the branches begin nowhere")
    _need(offsets[-1] == count, "the branches don't fit their points")
    _need((np.diff(offsets) >= 2).all(), "a branch has fewer than two points")
    _table(graph.ends, "i", (graph.branch_count, 2), "the ends of the branches")
    _numbered(graph.ends, len(graph.vertices), "the ends of the branches")
    _within(graph.vertices, _FARTHEST, "the vertices")
    _within(graph.points, _FARTHEST, "the points of the branches")
    tips = np.stack([graph.points[offsets[:-1]], graph.points[offsets[1:] - 1]], 1)
    apart = np.abs(tips - graph.vertices[graph.ends])
    _need((apart <= _APART).all(), "a branch does not end at its vertex")
    for name, kind, shape in (
        ("widths", "f", (count,)),
        ("strength", "f", (count,)),
        ("colors", "u", (count, 3)),
        ("bare", "b", (count,)),
    ):
        values = getattr(graph, name)
        if values is not None:
            _table(values, kind, shape, f"the {name} of the branches")
            _within(values, _THICKEST, f"the {name} of the branches")
    if graph.clues is not None:  # of a corner that the artist made there are none
        _need(graph.clues.ndim == 2, "the clues of the corners are not a table of the right size")
        _table(graph.clues, "f", (len(graph.corners), None), "the clues of the corners")
    _need(graph.widths is not None or not graph.branch_count, "the branches have no widths")
    if graph.widths is not None:
        _need((graph.widths >= 0).all(), "the widths of the branches are below zero")


def check_routing(graph: PlanarGraph, routing: Routing) -> None:
    """Make sure that a routing is one of this graph: an involution, at every vertex for itself.

    Raises:
        UnsoundError: says what is wrong first.
    """
    halves, at = 2 * graph.branch_count, graph.half_vertex
    check_involution(graph, routing.partner)
    _table(routing.pairs, "i", (None, 2), "the pairs of half-branches")
    _numbered(routing.pairs, halves, "the pairs of half-branches")
    a, b = routing.pairs.T
    _need((at[a] == at[b]).all(), "a pair of half-branches does not meet")
    _table(routing.pair_score, "f", (len(routing.pairs),), "the scores of the pairs")
    _need(not np.isnan(routing.pair_score).any(), "the scores of the pairs are no numbers")
    places = graph.places
    _table(routing.locked, "b", (len(places),), "which junctions are locked")
    _need(len(routing.alternatives) == len(places), "the alternatives don't fit the junctions")
    for number, ways in enumerate(routing.alternatives):
        _check_ways(ways, set(graph.halves_of(places[number]).tolist()), f"junction {number}")


def check_involution(graph: PlanarGraph, partner: Array) -> None:
    """Each half-branch ends, or continues in one that continues in it, at the same vertex.

    Args:
        partner: (2B,) int32.

    Raises:
        UnsoundError: it does not; to walk along it might never end.
    """
    halves, at = 2 * graph.branch_count, graph.half_vertex
    _table(partner, "i", (halves,), "the partners of the half-branches")
    _numbered(partner, halves, "the partners of the half-branches")
    _need((partner[partner] == np.arange(halves)).all(), "its routing is no involution")
    _need((at[partner] == at).all(), "its routing joins what does not meet")


def _check_ways(ways: tuple[Alternative, ...], halves: set[int], where: str) -> None:
    _need(len(ways) > 0, f"{where} has no alternatives")
    total, before = 0.0, np.inf
    for way in ways:
        chance = way.probability
        _need(_is_number(chance) and 0 <= chance <= 1, f"{where} has a probability that can't be")
        _need(chance <= before, f"the alternatives of {where} are not ranked")
        total, before = total + chance, chance
        named = [half for pair in way.pairs for half in pair]
        _need(
            all(type(half) is int for half in named)
            and len(set(named)) == len(named)
            and halves.issuperset(named),
            f"an alternative of {where} joins what does not meet there",
        )
    _need(total <= 1.001, f"the probabilities of {where} are more than one")


def _check_stroke(stroke: Stroke, where: str, runs: bool = True) -> None:
    count = len(stroke.points)
    _table(stroke.points, "f", (None, 2), f"the points of {where}")
    _need(count >= (1 if stroke.closed else 2), f"{where} has too few points")
    _within(stroke.points, _FARTHEST, f"the points of {where}")
    _table(stroke.widths, "f", (count,), f"the widths of {where}")
    _within(stroke.widths, _THICKEST, f"the widths of {where}")
    _need(stroke.widths.min() > 0, f"the widths of {where} are not above zero")
    _table(stroke.opacity, "f", (count,), f"the opacity of {where}")
    _need(bool(((stroke.opacity >= 0) & (stroke.opacity <= 1)).all()), f"the opacity of {where}")
    _table(stroke.branches, "i", (None,), f"the branches of {where}")
    _need(len(stroke.branches) > 0 or not runs, f"{where} runs through no branch")
    _need(len(stroke.color) == 3, f"the color of {where} is none")
    if stroke.handles is not None:
        _table(stroke.handles, "f", (count, 2, 2), f"the handles of {where}")
        _within(stroke.handles, _FARTHEST, f"the handles of {where}")


def _check_lengths(drawing: Drawing) -> None:
    """No stroke is a point, unless it stands for a line between junctions that is one."""
    graph = drawing.graph
    for number, stroke in enumerate(drawing.strokes):
        # A ring may have one anchor, and its length from the handles.
        places = stroke.points if stroke.handles is None else stroke.handles.reshape(-1, 2)
        alike = (places == stroke.points[0]).all() and (stroke.points == stroke.points[0]).all()
        if alike:
            branches = (stroke.branches >> 1).tolist()
            course = [graph.points[graph.offsets[b] : graph.offsets[b + 1]] for b in branches]
            ends = graph.ends[branches]
            ends = ends[ends[:, 0] != ends[:, 1]]
            hangs = (graph.degrees[ends] > 1).any()  # two junctions in one place
            point = hangs and not np.ptp(np.concatenate(course), axis=0).any()
            _need(point, f"stroke {number} has no length: all its points are one")


def _check_walks(drawing: Drawing) -> None:
    """Strokes run through every branch once, from half-branch to partner."""
    count, partner = drawing.graph.branch_count, drawing.routing.partner
    seen = np.zeros(count, bool)
    for number, stroke in enumerate(drawing.strokes):
        halves = stroke.branches
        _numbered(halves, 2 * count, f"the branches of stroke {number}")
        walked = halves >> 1
        _need(not seen[walked].any(), f"stroke {number} runs through a branch of another")
        seen[walked] = True
        _need(len(set(walked.tolist())) == len(walked), f"stroke {number} runs twice over a branch")
        for one, following in pairwise(halves.tolist()):
            _need(partner[one ^ 1] == following, f"stroke {number} leaves the routing")
    _need(bool(seen.all()), "a branch is in no stroke")


def _need(good: bool | np.bool_, phrase: str) -> None:
    if not good:
        raise UnsoundError(phrase)


def _table(values: Array, kind: str, shape: tuple[int | None, ...], what: str) -> None:
    """An array of that kind of numbers and that shape; None = any length."""
    fits = (
        isinstance(values, np.ndarray)
        and values.dtype.kind == kind
        and values.ndim == len(shape)
        and all(n in (None, m) for n, m in zip(shape, values.shape, strict=True))
    )
    _need(fits, f"{what} are not a table of the right size")


def _within(values: Array, most: float, what: str) -> None:
    # Also false for what is no number.
    _need(bool((np.abs(values.astype(np.float64)) <= most).all()), f"{what} are not in range")


def _numbered(values: Array, count: int, what: str) -> None:
    good = values.size == 0 or (values.min() >= 0 and values.max() < count)
    _need(bool(good), f"{what} name what is not there")


def _is_number(value: object) -> bool:
    # A bool is an int to isinstance, and no number here.
    return isinstance(value, (int, float)) and type(value) is not bool and isfinite(value)
