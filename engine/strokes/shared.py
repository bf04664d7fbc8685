"""What all strokes of a drawing share: the branches, evenly sampled, the pen, the inks.

Computed once per graph and never for a reroute: a stroke is then a list of half-branches into it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays.ragged import owners
from ..arrays.two_clusters import finer_pen
from ..ink.palette import Inks
from ..ink.pencil import undimmed
from ..settings import Settings
from ..values import Array, PlanarGraph

_RING = 4  # pieces of a line that comes back to where it began, however broad the pen is
SAMPLES_PER_PEN = 4  # samples along a line of one pen width
_BLOB = 1.0  # pen widths around a junction where other lines spoil the width; twice that to be sure
_UNKNOWN = 4.0  # px
_ENDLESS = (np.inf, np.inf)
# Mean change of opacity from point to point of a line: ink has up to 0.0073, pencil and charcoal
# 0.012 and more (held-out pages of all media).
_GRAIN = 0.0095
_FULL_INK = 60  # percentile of ink that counts as opaque


@dataclass(frozen=True, eq=False)
class Page:
    """Branches sampled at about a quarter of the pen width; the first and last sample of a branch
    are its vertices.

    pen: typical line width, px.
    points: (M, 2) float64; branch b has the samples offsets[b]:offsets[b + 1].
    widths, opacity: (M,) float64; trust: (M,) weight in [0, 1], 0 where a junction spoils them.
    length: (B,) px.
    crossed: (2B,) bool; the half-branch starts at a junction.
    inks: the colours of the page.
    solid: (K,) bool for each of them; its strokes are opaque.
    bare: (M,) bool, samples in a gap of a dashed line; None = nobody looked.
    size: width and height of the page, px, which no stroke leaves.
    """

    pen: float
    points: Array
    offsets: Array
    widths: Array
    opacity: Array
    trust: Array
    length: Array
    crossed: Array
    inks: Inks
    solid: Array
    settings: Settings
    bare: Array | None = None
    size: tuple[float, float] = _ENDLESS

    @classmethod
    def of(
        cls, graph: PlanarGraph, settings: Settings, size: tuple[float, float] = _ENDLESS
    ) -> Page:
        """Sample a graph; without widths, its lines are `_UNKNOWN` px wide."""
        widths = np.full(len(graph.points), _UNKNOWN) if graph.widths is None else graph.widths
        pen = max(float(np.median(finer_pen(widths))), 0.1) if len(widths) else _UNKNOWN
        branch = owners(graph.offsets)
        points = graph.points.astype(np.float64)
        step = np.hypot(*np.diff(points, axis=0, prepend=points[:1]).T)
        step[graph.offsets[:-1]] = 0.0
        # Multiples of 2^-20 add up without rounding, so that nothing depends on what else is here.
        arc = np.cumsum(np.round(step * 2.0**20) / 2.0**20)
        arc -= arc[graph.offsets[:-1]][branch]
        length = arc[graph.offsets[1:] - 1]

        begin, end = points[graph.offsets[:-1]], points[graph.offsets[1:] - 1]
        least = np.where((begin == end).all(1), _RING, 1)
        count = np.maximum(least, np.ceil(length / (pen / SAMPLES_PER_PEN))).astype(np.int64) + 1
        offsets = np.concatenate([[0], np.cumsum(count)])
        of_sample = np.repeat(np.arange(graph.branch_count), count)
        share = (np.arange(offsets[-1]) - offsets[of_sample]) / (count[of_sample] - 1)
        along = share * length[of_sample]

        # Find the segment of every sample: all branches laid end to end, one px apart.
        base = np.arange(graph.branch_count) + np.concatenate([[0.0], np.cumsum(length)])[:-1]
        low = np.searchsorted(base[branch] + arc, base[of_sample] + along, side="right") - 1
        low = np.clip(low, graph.offsets[of_sample], graph.offsets[of_sample + 1] - 2)
        gap = np.maximum(arc[low + 1] - arc[low], 1e-9)
        t = np.clip((along - arc[low]) / gap, 0.0, 1.0)

        def at(values: Array) -> Array:
            values = np.asarray(values, np.float64)
            values = values if values.ndim == 2 else values[:, None]
            return values[low] + t[:, None] * (values[low + 1] - values[low])

        way = np.stack([along, length[of_sample] - along], 1)  # to both ends of the branch
        meets = graph.degrees[graph.ends[of_sample]] >= 3
        near = np.where(meets, way, np.inf).min(1, initial=np.inf)
        inks = Inks.of(graph, length, pen) if settings.inks else Inks.black(graph.branch_count)
        opacity = np.ones(len(points))
        if graph.strength is not None:
            opacity = _opacity(undimmed(graph.strength, widths), inks.ink[branch])
        return cls(
            pen=pen,
            points=at(points),
            offsets=offsets,
            widths=at(widths)[:, 0],
            opacity=at(opacity)[:, 0],
            trust=np.clip(near / (_BLOB * pen) - 1.0, 0.0, 1.0),
            length=length,
            crossed=graph.degrees[graph.half_vertex] >= 3,
            inks=inks,
            solid=_solid(opacity, branch, inks, settings.opacity),
            settings=settings,
            bare=None if graph.bare is None else at(graph.bare)[:, 0] > 0.5,
            size=size,
        )


def _solid(opacity: Array, branch: Array, inks: Inks, wanted: str) -> Array:
    """(K,) bool: the inks whose strokes are opaque; by itself, those that cover evenly."""
    if wanted != "auto":
        return np.full(len(inks.palette), wanted == "solid")
    # Pencil and charcoal catch on the grain of the paper: their strength wavers within a line.
    step = np.abs(np.diff(opacity, prepend=opacity[:1]))
    within = np.diff(branch, prepend=-1) == 0
    count = np.bincount(inks.ink[branch[within]], minlength=len(inks.palette))
    wavers = np.bincount(inks.ink[branch[within]], step[within], len(inks.palette))
    return wavers < _GRAIN * np.maximum(count, 1)


def _opacity(ink: Array, of: Array) -> Array:
    """(P,) how dense the ink is, relative to all that is drawn in the same one; of: (P,) which."""
    full = np.ones(int(of.max(initial=0)) + 1)
    for number in np.unique(of):
        full[number] = max(float(np.percentile(ink[of == number], _FULL_INK)), 1e-3)
    return np.clip(ink / full[of], 0.0, 1.0)
