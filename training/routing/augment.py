"""What a tracer does to a perfect graph, done at random: the network must not expect perfection.

Everything here keeps the truth right: a page is bent and mirrored as a whole, short branches are
contracted (two junctions become one, spurs vanish) with the involution followed through them,
junctions move and their branches follow smoothly, lines wobble, and pens get widths and inks.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from involute.engine.arrays.ragged import owners, steps
from involute.engine.values import Pair, PlanarGraph
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ...synthesis.true_graph import dissolve

Array = np.ndarray


@dataclass(frozen=True, eq=False)
class Page:
    """A graph, its true involution (2B,), and the pen stroke that each point belongs to (P,).

    traced: the graph is a tracer's own; its junctions must not be merged once more.
    """

    graph: PlanarGraph
    partner: Array
    stroke: Array
    traced: bool = False


def augmented(rng: np.random.Generator, page: Page) -> Page:
    """A random variation of a page, from untouched but turned to roughly traced."""
    page = replace(page, graph=_bent(rng, page.graph))
    traced = page.traced
    if not traced and rng.random() < 0.5:
        page = contracted(page, rng.uniform(0.5, 4.5))
    if rng.random() < (0.2 if traced else 0.6) and page.graph.branch_count:
        page = replace(page, graph=_shaken(rng, page.graph))
    if traced and rng.random() < 0.8:
        return page
    return replace(page, graph=_inked(rng, page))


def random_fixed(rng: np.random.Generator, page: Page, share: float) -> dict[int, tuple[Pair, ...]]:
    """The truth at a random share of the junctions, as a user would have locked it."""
    fixed = {}
    for number in np.flatnonzero(rng.random(len(page.graph.junctions)) < share):
        halves = page.graph.halves_of(int(page.graph.junctions[number]))
        fixed[int(number)] = tuple(
            (int(h), int(page.partner[h])) for h in halves if h < page.partner[h]
        )
    return fixed


def _bent(rng: np.random.Generator, graph: PlanarGraph) -> PlanarGraph:
    """Mirror, scale, stretch and softly warp a whole page; lines that met still meet."""
    scale = np.exp(rng.normal(0, 0.25))
    angle = rng.uniform(0, 2 * np.pi)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    stretch = np.exp(rng.normal(0, 0.12))
    matrix = turn @ np.diag([scale * stretch, scale / stretch * rng.choice([-1, 1])])
    wave = rng.uniform(1 / 160, 1 / 45, 4) * 2 * np.pi
    toward = rng.uniform(0, 2 * np.pi, 4)
    k = wave * np.stack([np.cos(toward), np.sin(toward)])
    phase = rng.uniform(0, 2 * np.pi, 4)
    # Slope below 0.25, so that the warp never folds the page.
    size = rng.uniform(0, 0.25) * rng.normal(0, 1, (4, 2)) / wave[:, None] / 3

    def bend(points: Array) -> Array:
        points = points.astype(np.float64) @ matrix
        return (points + np.sin(points @ k + phase) @ size).astype(np.float32)

    return replace(graph, vertices=bend(graph.vertices), points=bend(graph.points))


def contracted(page: Page, length: float) -> Page:
    """The page with all branches shorter than `length` px taken out and their vertices merged."""
    graph, partner = page.graph, page.partner
    short = _lengths(graph) < length
    if not short.any() or short.all():
        return page
    count = len(graph.vertices)
    link = graph.ends[short]
    group = coo_matrix((np.ones(len(link)), link.T), (count, count))
    parts, of_vertex = connected_components(group, directed=False)
    size = np.bincount(of_vertex, minlength=parts)
    merged = np.stack(
        [np.bincount(of_vertex, graph.vertices[:, c], parts) / size for c in (0, 1)], 1
    )
    moved = _reattached(graph, merged[of_vertex] - graph.vertices, 5.0)

    goes = partner.copy()
    gone = short[goes >> 1]
    for _ in range(64):  # a chain of short branches is followed to its end
        if not gone.any():
            break
        beyond = partner[goes ^ 1]
        ends = beyond == (goes ^ 1)
        goes = np.where(gone, np.where(ends, np.arange(len(goes)), beyond), goes)
        gone &= ~ends & short[goes >> 1]
    kept = np.flatnonzero(~short)
    halves = np.stack([2 * kept, 2 * kept + 1], 1).reshape(-1)
    new_of = np.full(2 * len(short), -1)
    new_of[halves] = np.arange(len(halves))
    goes = np.where(short[goes >> 1], np.arange(len(goes)), goes)
    lines = [moved.branch(b).astype(np.float64) for b in kept]
    strokes = [page.stroke[graph.offsets[b] : graph.offsets[b + 1]] for b in kept]
    graph, stroke, partner = dissolve(
        merged, lines, strokes, of_vertex[graph.ends[kept]], new_of[goes[halves]]
    )
    return Page(graph, partner, stroke)


def _lengths(graph: PlanarGraph) -> Array:
    return np.add.reduceat(steps(graph.points, graph.offsets), graph.offsets[:-1])


def _arcs(graph: PlanarGraph) -> tuple[Array, Array, Array]:
    """Per point: its branch, the arc length from the branch's start, and the branch's length."""
    arc, branch = np.cumsum(steps(graph.points, graph.offsets)), owners(graph.offsets)
    arc -= arc[graph.offsets[:-1]][branch]
    return branch, arc, arc[graph.offsets[1:] - 1][branch]


def _reattached(graph: PlanarGraph, shift: Array, reach: float) -> PlanarGraph:
    """Move vertices by `shift` (V, 2); their branches follow, less and less over `reach` px."""
    branch, arc, length = _arcs(graph)
    share = np.clip(arc / np.maximum(length, 1e-6), 0, 1)
    head = np.maximum(0, 1 - arc / reach) ** 2 * (1 - share)
    tail = np.maximum(0, 1 - (length - arc) / reach) ** 2 * share
    first, last = graph.ends[branch].T
    points = graph.points + head[:, None] * shift[first] + tail[:, None] * shift[last]
    return replace(
        graph,
        vertices=(graph.vertices + shift).astype(np.float32),
        points=points.astype(np.float32),
    )


def _shaken(rng: np.random.Generator, graph: PlanarGraph) -> PlanarGraph:
    """Junctions out of place, lines that wobble: the errors of a centerline and its graph."""
    error = rng.uniform(0, 1.2) * rng.normal(0, 1, graph.vertices.shape)
    graph = _reattached(graph, error, rng.uniform(2.5, 8.0))
    _, arc, length = _arcs(graph)
    noise = rng.normal(0, 1, graph.points.shape)
    for _ in range(int(rng.integers(1, 6))):
        noise[1:-1] = (noise[:-2] + 2 * noise[1:-1] + noise[2:]) / 4
    noise *= rng.uniform(0, 0.5) / max(float(noise.std()), 1e-6)
    fade = np.minimum(1, np.minimum(arc, length - arc) / 2.5)
    return replace(graph, points=(graph.points + noise * fade[:, None]).astype(np.float32))


def _inked(rng: np.random.Generator, page: Page) -> PlanarGraph:
    """Widths, darkness and colours of random pens, each page with all, some or none of them."""
    graph, stroke = page.graph, page.stroke.astype(int)
    if not len(stroke) or rng.random() < 0.4:
        return replace(graph, widths=None, strength=None, colors=None)
    count = max(int(stroke.max()) + 1, 1)
    branch = owners(graph.offsets)
    noise = rng.normal(0, 1, graph.branch_count)[branch]
    pen = np.log(rng.uniform(1.5, 7)) + rng.normal(0, rng.choice([0.0, 0.1, 0.3]), count)
    width = np.exp(pen[stroke] + rng.uniform(0.02, 0.2) * noise)
    tip, near = _tips(rng, page)
    width *= np.exp(rng.uniform(0, 0.15) * near) * (1 - rng.choice([0.0, 0.4, 0.8]) * tip)
    dark = np.clip(rng.uniform(0.4, 1) + rng.normal(0, rng.choice([0.0, 0.1]), count), 0.1, 1)
    dark = dark[stroke] + rng.uniform(0.01, 0.08) * noise + rng.uniform(0, 0.1) * near
    strength = np.clip(dark * (1 - rng.choice([0.0, 0.0, 0.4]) * tip), 0, 1)
    colors = None
    if rng.random() < 0.4:
        inks = rng.integers(0, 200, (int(rng.choice([1, 1, 2, 3])), 3))
        mine = inks[rng.integers(0, len(inks), count)][stroke] + 8 * noise[:, None]
        colors = np.clip(mine, 0, 255).astype(np.uint8)
    return replace(
        graph, widths=width.astype(np.float32), strength=strength.astype(np.float32), colors=colors
    )


def _tips(rng: np.random.Generator, page: Page) -> tuple[Array, Array]:
    """Two values for every point: how much of a tip of its stroke it is, 1 at the very end and 0
    from some px on; and random blots at both ends of every branch, of spread 1."""
    branch, arc, length = _arcs(page.graph)
    reach = np.exp(rng.uniform(np.log(8), np.log(50)))
    tip, near = np.zeros(len(arc)), np.zeros(len(arc))
    for side, away in enumerate((arc, length - arc)):
        half = 2 * np.arange(page.graph.branch_count) + side
        ends = (page.partner[half] == half) & (rng.random(len(half)) < 0.85)
        tip = np.maximum(tip, ends[branch] * (1 - np.sqrt(np.minimum(away / reach, 1))))
        near += rng.normal(0, 1, len(half))[branch] * np.exp(-away / 8)
    return tip, near
