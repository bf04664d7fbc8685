"""The result of a trace, and every change that a user can make to its routing.

A drawing is never changed: every method returns a new one. Strokes that a change does not touch
are the same objects in the new drawing, so whoever shows them can tell by identity.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from os import PathLike

import numpy as np

from .errors import InvoluteError
from .routing import checked_pairs, route
from .settings import Settings
from .strokes import Page, build, walk
from .values import Junction, Pair, PlanarGraph, Routing, Scan, Stroke

Array = np.ndarray
Fill = tuple[Array, ...]

DOUBTFUL = 0.3  # doubt from which on a junction is worth a look


@dataclass(frozen=True, eq=False)
class Drawing:
    """One traced drawing, in pixels of the input.

    graph: all lines, cut at junctions.
    routing: which half-branches continue in which.
    strokes: the lines, sorted by their lowest branch.
    fills: solid areas; each the rings of one area, (N, 2) float32, the outer one first, then holes.
    size: (width, height).
    seconds: how long each stage took.
    scale: input pixels per working pixel, the unit in which routing judges lengths.
    aligned: False when the page was to be aligned and had nothing to align by; not kept in files.
    region_colors: (R, 3) uint8 sRGB of `regions`; None = all are white.
    page: what all strokes share, for rerouting; None = found from the graph when first needed. Not
        kept in files.
    """

    graph: PlanarGraph
    routing: Routing
    strokes: tuple[Stroke, ...]
    fills: tuple[Fill, ...]
    size: tuple[int, int]
    settings: Settings
    seconds: Mapping[str, float] = field(default_factory=dict)
    scale: float = 1.0
    aligned: bool = True
    region_colors: Array | None = None
    page: Page | None = field(default=None, repr=False)

    @classmethod
    def from_routing(
        cls,
        graph: PlanarGraph,
        routing: Routing,
        scan: Scan,
        settings: Settings,
        fills: Iterable[Fill] = (),
    ) -> Drawing:
        """Make the strokes of a routed graph; graph and fills come in working pixels."""
        widths = graph.widths
        if widths is None:
            widths = np.full(len(graph.points), scan.pen_width, np.float32)
        graph = _scaled(replace(graph, widths=widths), scan.scale)
        page = Page.of(graph, settings)
        drawing = cls(
            graph=graph,
            routing=routing,
            strokes=tuple(build(page, walk(routing.partner))),
            fills=tuple(tuple(ring * np.float32(scan.scale) for ring in fill) for fill in fills),
            size=scan.size,
            settings=settings,
            scale=float(scan.scale),
            aligned=scan.aligned,
            page=page,
        )
        if settings.regions and scan.color is not None:
            from .fills.region_colors import region_colors

            colors = region_colors(drawing.regions, graph, scan)
            drawing = replace(drawing, region_colors=colors)
        return drawing

    def with_seconds(self, seconds: Mapping[str, float]) -> Drawing:
        """The same drawing with the time that each stage took."""
        return replace(self, seconds=dict(seconds))

    @cached_property
    def junctions(self) -> tuple[Junction, ...]:
        """All junctions as the user sees them, in graph.junctions order."""
        graph, routing = self.graph, self.routing
        order, starts = (values.tolist() for values in graph.halves_at)
        partner, position = routing.partner.tolist(), graph.vertices.tolist()
        locked = routing.locked.tolist()
        found = []
        for index, vertex in enumerate(graph.junctions.tolist()):
            halves = tuple(order[starts[vertex] : starts[vertex + 1]])
            found.append(
                Junction(
                    index=index,
                    position=tuple(position[vertex]),
                    half_branches=halves,
                    pairs=tuple((h, partner[h]) for h in halves if h < partner[h]),
                    alternatives=routing.alternatives[index],
                    locked=locked[index],
                )
            )
        return tuple(found)

    @cached_property
    def regions(self) -> tuple[Fill, ...]:
        """The closed regions between the lines, the largest first; specks are left out."""
        from .fills.faces import closed_regions

        if self.graph.branch_count == 0:
            return ()
        return closed_regions(self.graph, 4.0 * float(np.median(self.graph.widths)) ** 2)

    @property
    def doubtful(self) -> tuple[int, ...]:
        """The doubtful junctions that are not locked, most doubtful first."""
        doubt = np.array([junction.doubt for junction in self.junctions])
        order = np.argsort(-doubt, kind="stable")
        return tuple(int(index) for index in order if doubt[index] >= DOUBTFUL)

    def reroute(self, junction: int, pairs: Iterable[Pair]) -> Drawing:
        """Join exactly these half-branches at a junction, end the others there, and lock it.

        Raises:
            InvoluteError: not disjoint pairs of half-branches of that junction.
        """
        pairs = checked_pairs(self.graph, junction, tuple(pairs))
        halves = self.graph.halves_of(self.graph.junctions[junction])
        partner = self.routing.partner.copy()
        partner[halves] = halves
        for a, b in pairs:
            partner[a], partner[b] = b, a
        return self._with_partner(partner)._with_locked([junction], True)

    def lock(self, junction: int) -> Drawing:
        """Keep this junction as it is: it counts as certain, and `ask_again` learns from it."""
        return self._with_locked([junction], True)

    def unlock(self, junction: int) -> Drawing:
        """Let `ask_again` decide this junction anew."""
        return self._with_locked([junction], False)

    def accept_above(self, probability: float) -> Drawing:
        """Lock every junction whose routing is at least this probable."""
        sure = [j.index for j in self.junctions if not j.locked and 1 - j.doubt >= probability]
        return self._with_locked(sure, True)

    def with_routing(self, partner: Array, locked: Array) -> Drawing:
        """The drawing as it was when its routing was this, for what stores only that.

        Args:
            partner: (2B,) int32 and locked: (J,) bool, as in `Routing`.
        """
        drawing = self._with_partner(partner)
        return replace(drawing, routing=replace(drawing.routing, locked=locked))

    def ask_again(self) -> Drawing:
        """Route the junctions that are not locked anew, given those that are."""
        fixed = {j.index: j.pairs for j in self.junctions if j.locked}
        routing = route(_scaled(self.graph, 1 / self.scale), self.settings, fixed)
        return replace(self._with_partner(routing.partner), routing=routing)

    def save(self, path: str | PathLike[str]) -> None:
        """Write the drawing; the suffix says how (.json keeps everything)."""
        from .formats import save

        save(self, path)

    @staticmethod
    def load(path: str | PathLike[str]) -> Drawing:
        """Read a drawing that `save` wrote."""
        from .formats import load

        return load(path)

    @cached_property
    def _page(self) -> Page:
        return self.page or Page.of(self.graph, self.settings)

    def _with_locked(self, junctions: Iterable[int], value: bool) -> Drawing:
        locked = self.routing.locked.copy()
        for junction in junctions:
            if not 0 <= junction < len(locked):
                raise InvoluteError(f"There is no junction {junction}; there are {len(locked)}.")
            locked[junction] = value
        return replace(self, routing=replace(self.routing, locked=locked))

    def _with_partner(self, partner: Array) -> Drawing:
        """Walk anew what the changed half-branches belong to; keep all other strokes."""
        old = self.routing.partner
        changed = set((np.flatnonzero(partner != old) >> 1).tolist())
        again = [s for s in self.strokes if not changed.isdisjoint((s.branches >> 1).tolist())]
        branches = changed.union(*((s.branches >> 1).tolist() for s in again))
        gone = {id(s) for s in again}
        kept = [s for s in self.strokes if id(s) not in gone]
        made = build(self._page, walk(partner, branches))
        strokes = sorted([*kept, *made], key=lambda s: int(s.branches.min()) >> 1)
        routing = replace(self.routing, partner=np.asarray(partner, np.int32))
        return replace(self, strokes=tuple(strokes), routing=routing, page=self._page)


def _scaled(graph: PlanarGraph, scale: float) -> PlanarGraph:
    """The graph in other pixels."""
    factor = np.float32(scale)
    return replace(
        graph,
        vertices=graph.vertices * factor,
        points=graph.points * factor,
        widths=None if graph.widths is None else graph.widths * factor,
    )
