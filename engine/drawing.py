"""The result of a trace, and every change that a user can make to its routing.

A drawing is never changed: every method returns a new one. Strokes that a change does not touch
are the same objects in the new drawing, so whoever shows them can tell by identity.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from os import PathLike

import numpy as np

from .errors import InvoluteError
from .fidelity import Fidelity, fidelity, warnings
from .graph.editing import Edits, Step, edited, place_on
from .ink.known_inks import with_known_inks
from .rough.asking import cleaned_again, parts_of, questions, with_answers, with_lines
from .rough.unchanged import unchanged
from .routing import around, checked_pairs, place_of_pairs, rescored, route, taught
from .routing.cost import costs
from .routing.lifting import goes_on
from .routing.ways import Ways
from .settings import Settings
from .strokes import Page, build, walk
from .values import (
    Answers,
    Array,
    Beside,
    Bundle,
    Junction,
    Pair,
    Pencil,
    PlanarGraph,
    Routing,
    Scan,
    Stroke,
)

Fill = tuple[Array, ...]

STROKE_SETTINGS = ("smoothing", "curve", "tolerance")  # change nothing but the last stage
# Pen widths of stroke that a junction's answer puts at risk (doubt x length) from which on it is
# worth a look. On 48 held-out pages (2,952 junctions) 16 % are, and they hold 61 % of the length of
# stroke that was wrong; as many of the most doubtful ones hold 26 %.
DOUBTFUL = 20.0
_ROUGH = "Taken for a rough drawing"  # so a note about it begins
NOT_KEPT = "This drawing does not know what its lines were made of; trace the picture again."
# What a px is worth over which a bundle is in doubt, in px of stroke at a junction: so that as many
# are asked. On 16 held-out rough pages (2,769 bundles, 15 % of them wrong) 22 % of the bundles are,
# and they hold 59 % of the length that was wrong.
BUNDLE = 10.0
USUAL_DPI = 300.0  # pixels per inch of a scan whose file does not say: what the manual advises


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
    fidelity: how faithful it was to the ink when it was traced; None when nobody looked.
    notes: what was left out of it on purpose, a sentence each.
    warnings: what is wrong with it, each with what to do about it.
    pencil: the strokes of a rough drawing, of which the lines were made; None for a clean one.
    edits: what was cut and joined since it was traced or read; None = nothing. Not kept in files,
        whose graph has it.
    dpi: pixels of the input per inch of paper, as its file says; None = it does not say.
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
    fidelity: Fidelity | None = None
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    pencil: Pencil | None = None
    edits: Edits | None = field(default=None, repr=False)
    dpi: float | None = None
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
        graph = replace(graph, widths=widths).scaled(scan.scale)
        page = Page.of(graph, settings, scan.size)
        drawing = cls(
            graph=graph,
            routing=routing,
            strokes=tuple(build(page, walk(routing.partner))),
            fills=tuple(tuple(ring * np.float32(scan.scale) for ring in fill) for fill in fills),
            size=scan.size,
            settings=settings,
            scale=float(scan.scale),
            aligned=scan.aligned,
            notes=scan.notes,
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

    def compared_with(self, scan: Scan) -> Drawing:
        """The same drawing, checked against the ink of the page that it was traced from."""
        drawn = self.pencil.strokes if self.pencil else self.strokes
        wider, left = self.settings.width_scale, scan.overlooked
        found = fidelity(drawn, self.fills, scan.ink, self.scale, wider, left)
        return replace(self, fidelity=found, warnings=warnings(found, scan.light))

    def cleaned_from(self, drawn: Drawing, said: Array, beside: Beside) -> Drawing:
        """The same drawing, with the rough one that it was made of behind it.

        Args:
            said: (K, 2) int32, strokes of the rough drawing and branches of this one's graph.
            beside: what these lines were made of.
        """
        none = np.zeros(0, np.int32)
        strokes = tuple(replace(s, branches=none) for s in drawn.strokes)
        notes = (*self.notes, _note(len(strokes), len(self.strokes)))
        return replace(self, pencil=Pencil(strokes, said, beside), notes=notes)

    def answered(self, answers: Answers) -> Drawing:
        """The lines that the pencil strokes say, one or two as the artist answers; all other
        decisions are made again, and lines keep number, direction and ink as in a sequence.

        Raises:
            InvoluteError: the drawing is a clean one, or it does not know what it was made of.
        """
        from .decisions import decided_again

        pencil = self.pencil
        if pencil is None or pencil.beside is None:
            raise InvoluteError(NOT_KEPT)
        made = cleaned_again(pencil.beside, answers, self.settings, self.scale, self.size)
        page = Scan(np.zeros((1, 1), np.float32), None, self.scale, self.size, 1.0)
        lines = Drawing.from_routing(made.graph, made.routing, page, self.settings)
        said = _note(len(pencil.strokes), len(lines.strokes))
        cleaned = replace(
            self,
            graph=lines.graph,
            routing=lines.routing,
            strokes=lines.strokes,
            page=lines.page,
            edits=None,
            region_colors=None,
            pencil=replace(pencil, said=made.said, answers=answers),
            notes=tuple(said if note.startswith(_ROUGH) else note for note in self.notes),
        )
        if self.region_colors is not None:
            from .fills.region_colors import same_colors

            colors = same_colors(self.regions, self.region_colors, cleaned.regions)
            cleaned = replace(cleaned, region_colors=colors)
        return decided_again(self, cleaned).drawing._drawn_like(self)

    def _drawn_like(self, before: Drawing) -> Drawing:
        """The same lines, drawn as they were in another drawing wherever they are there, too."""
        from .sequence.follow import follow

        if not self.strokes:
            return self
        inks = list(dict.fromkeys(stroke.color for stroke in before.strokes))
        strokes = follow(before.strokes, with_known_inks(self.strokes, inks))
        return replace(self, strokes=unchanged(before.strokes, strokes))

    def pencil_of(self, stroke: int) -> tuple[int, ...]:
        """The numbers of the pencil strokes that say a stroke, ascending; none for a clean drawing.

        Raises:
            InvoluteError: there is no such stroke.
        """
        branches = self._stroke(stroke).branches >> 1
        if self.pencil is None:
            return ()
        drawn, line = self.pencil.said.T
        return tuple(np.unique(drawn[np.isin(line, branches)]).tolist())

    @property
    def line_of_pencil(self) -> Array:
        """(P,) int32: for each pencil stroke the first half-branch, counted from 1, of the line
        that it says; of several the first one; 0 = of none."""
        assert self.pencil is not None, "a clean drawing has no pencil strokes"
        first = np.zeros(self.graph.branch_count, np.int32)
        for stroke in self.strokes:
            first[stroke.branches >> 1] = stroke.branches[0] + 1
        line = np.zeros(len(self.pencil.strokes), np.int32)
        drawn, branch = self.pencil.said[::-1].T
        line[drawn] = first[branch]
        return line

    @cached_property
    def junctions(self) -> tuple[Junction, ...]:
        """All junctions as the user sees them, in graph.junctions order."""
        return self._places[: len(self.graph.junctions)]

    @cached_property
    def corners(self) -> tuple[Junction, ...]:
        """Where only two half-branches meet and the pen may have been lifted, in graph.corners
        order; their numbers go on after those of the junctions."""
        return self._places[len(self.graph.junctions) :]

    @cached_property
    def bundles(self) -> tuple[Bundle, ...]:
        """Which pencil strokes of a rough drawing may be one line or two; their numbers go on after
        those of the corners."""
        if self.pencil is None:
            return ()
        return questions(self.pencil, self.scale, self.size, len(self.graph.places))

    def parts_of(self, bundle: Bundle) -> tuple[Array, Array]:
        """(N, 2) px: the part of either pencil stroke that a question is about."""
        assert self.pencil is not None, "a clean drawing has no bundles"
        return parts_of(self.pencil, bundle, self.scale, self.size)

    def asked(self, number: int) -> Junction | Bundle:
        """One junction, corner or bundle by its number."""
        first = len(self.graph.places)
        return self.place(number) if number < first else self.bundles[number - first]

    @cached_property
    def _places(self) -> tuple[Junction, ...]:
        return tuple(self.place(number) for number in range(len(self.graph.places)))

    def place(self, number: int) -> Junction:
        """One junction or corner, without looking at the others."""
        graph, routing = self.graph, self.routing
        order, starts = graph.halves_at
        vertex = graph.places[number]
        halves = order[starts[vertex] : starts[vertex + 1]]
        pairs = zip(halves.tolist(), routing.partner[halves].tolist(), strict=True)
        return Junction(
            index=int(number),
            position=tuple(graph.vertices[vertex].tolist()),
            half_branches=tuple(halves.tolist()),
            pairs=tuple((a, b) for a, b in pairs if a < b),
            alternatives=routing.alternatives[number],
            locked=bool(routing.locked[number]),
        )

    @cached_property
    def regions(self) -> tuple[Fill, ...]:
        """The closed regions between the lines, the largest first; specks are left out."""
        from .fills.faces import closed_regions

        if self.graph.branch_count == 0:
            return ()
        assert self.graph.widths is not None, "a drawing's graph is measured"
        return closed_regions(self.graph, 4.0 * float(np.median(self.graph.widths)) ** 2)

    @cached_property
    def _decided(self) -> dict[int, tuple[Pair, ...]]:
        """The pairs at each place that is locked."""
        locked = np.flatnonzero(self.routing.locked).tolist()
        return {number: self.place(number).pairs for number in locked}

    @cached_property
    def costs(self) -> Array:
        """(J,) px: the doubt of each junction times the length of stroke that another answer would
        change; 0 where it is locked."""
        return costs(self.graph, self.routing, self.strokes)

    @cached_property
    def doubts(self) -> Array:
        """(J,) the doubt of each junction: 1 - probability of its routing; 0 where it is locked."""
        return Ways.of(self.graph, self.routing).doubts(self.routing)

    @cached_property
    def bundle_costs(self) -> Array:
        """(M,) px: the doubt of each bundle times the length over which it is in doubt, weighed
        so that it compares with `costs`."""
        return np.array([BUNDLE * b.doubt * (b.span[1] - b.span[0]) for b in self.bundles])

    @property
    def mm_per_px(self) -> float:
        """Millimetres of paper to a pixel of the input, for formats with real sizes."""
        return 25.4 / (self.dpi or USUAL_DPI)

    @cached_property
    def doubtful(self) -> tuple[int, ...]:
        """The junctions and bundles whose answer matters and is not certain, the most costly
        first."""
        corners = np.zeros(len(self.graph.corners))
        costs = np.concatenate([self.costs, corners, self.bundle_costs])
        if not len(costs) or not self.graph.branch_count:
            return ()
        assert self.graph.widths is not None, "a drawing's graph is measured"
        least = DOUBTFUL * float(np.median(self.graph.widths))
        order = np.argsort(-costs, kind="stable")
        return tuple(order[costs[order] >= least].tolist())

    @property
    def doubtful_bundles(self) -> tuple[int, ...]:
        """Those of the doubtful ones that are bundles."""
        first = len(self.graph.places)
        return tuple(number for number in self.doubtful if number >= first)

    def reroute(self, junction: int, pairs: Iterable[Pair]) -> Drawing:
        """Join exactly these half-branches at a junction or corner, end the others there, and lock
        it; or say that the strokes of a bundle are one line, as a pair, or two.

        Raises:
            InvoluteError: not disjoint pairs of half-branches of that junction.
        """
        if junction >= len(self.graph.places):
            return self._with_locked([junction], True, tuple(pairs))
        pairs = checked_pairs(self.graph, junction, tuple(pairs))
        halves = self.graph.halves_of(self.graph.places[junction])
        partner = self.routing.partner.copy()
        partner[halves] = halves
        for a, b in pairs:
            partner[a], partner[b] = b, a
        return self._with_partner(partner)._with_locked([junction], True)

    def reroute_along(self, halves: Sequence[int]) -> Drawing:
        """Let one stroke run through these half-branches, in walking order; what else meets at the
        places that it passes is decided anew around it, and all of them are locked.

        Raises:
            InvoluteError: they do not follow each other, or pass no place.
        """
        vertex = self.graph.half_vertex
        steps = [(int(a) ^ 1, int(b)) for a, b in pairwise(halves)]
        if not steps or any(a == b or vertex[a] != vertex[b] for a, b in steps):
            raise InvoluteError("Lines that follow each other at a junction are needed.")
        asked: dict[int, list[Pair]] = {}
        for a, b in steps:
            asked.setdefault(int(vertex[b]), []).append((min(a, b), max(a, b)))
        drawing = self
        for at, pairs in asked.items():
            ways = around(self.graph.halves_of(at), self.routing, set(pairs))
            drawing = drawing.reroute(self._at_vertex(at).index, ways)
        return drawing

    def lock(self, junction: int) -> Drawing:
        """Keep this junction, corner or bundle as it is: it counts as certain, and `ask_again`
        learns from it."""
        return self._with_locked([junction], True)

    def unlock(self, junction: int) -> Drawing:
        """Let `ask_again` decide this junction or corner anew; a bundle is as it was traced."""
        return self._with_locked([junction], False)

    def accept_above(self, probability: float) -> Drawing:
        """Lock every junction and bundle whose routing is at least this probable."""
        free = ~self.routing.locked[: len(self.doubts)]
        sure = np.flatnonzero(free & (1 - self.doubts >= probability)).tolist()
        bundles = [b.index for b in self.bundles if not b.locked and 1 - b.doubt >= probability]
        return self.lock_all([*sure, *bundles])

    def lock_all(self, junctions: Iterable[int]) -> Drawing:
        """Keep these junctions, corners and bundles as they are."""
        return self._with_locked(junctions, True)

    def with_routing(self, partner: Array, locked: Array) -> Drawing:
        """The drawing as it was when its routing was this, for what stores only that.

        Args:
            partner: (2B,) int32 and locked: (J + C,) bool, as in `Routing`; what is missing at its
                end, as in files of before corners were decided, is not locked.
        """
        drawing = self._with_partner(partner)
        whole = np.zeros(len(self.graph.places), bool)
        whole[: len(locked)] = locked[: len(whole)]
        return replace(drawing, routing=replace(drawing.routing, locked=whole))

    def with_corners(self, bias: float) -> Drawing:
        """Decide all corners that are not locked anew, without asking the picture again.

        A page that was traced with `Settings.corners` at -1 has only the corners that were cut.

        Args:
            bias: -1 = strokes run through all corners, 0 = where that is more probable, 1 = they
                end wherever the pen may have been lifted.

        Raises:
            InvoluteError: the bias is out of range.
        """
        settings = replace(self.settings, corners=float(bias))
        first = len(self.graph.junctions)
        free = ~self.routing.locked[first:]
        pairs = self._pairs_at_corners[free]
        on = goes_on(self.routing.pair_score[len(self.routing.pairs) - len(free) :][free], bias)
        partner = self.routing.partner.copy()
        partner[pairs] = np.where(on[:, None], pairs[:, ::-1], pairs)
        return replace(self._with_partner(partner), settings=settings)

    def cut(self, stroke: int, point: tuple[float, float]) -> Drawing:
        """End a stroke at its place nearest to a point, px, where another one begins; locked.

        Where a corner or a junction is there already, it is decided there.

        Raises:
            InvoluteError: there is no such stroke, or it ends there anyway.
        """
        place = place_on(self.graph, self._stroke(stroke).branches, np.asarray(point, float))
        if place.half < 0:
            return self.with_edits([(place.point, -1)])
        if self.routing.partner[place.half] == place.half:
            raise InvoluteError("This stroke ends there already.")
        there = self._at_vertex(int(self.graph.half_vertex[place.half]))
        return self.reroute(there.index, [p for p in there.pairs if place.half not in p])

    def join(self, a: int, b: int) -> Drawing:
        """Make one stroke of the two that end with half-branches a and b; locked.

        Both end at one junction or corner, or each of them freely; then the first goes on in a
        straight line to where the second begins.

        Raises:
            InvoluteError: they are no two ends.
        """
        partner, vertex = self.routing.partner, self.graph.half_vertex
        if not all(0 <= half < len(partner) for half in (a, b)) or a == b:
            raise InvoluteError("To join, two different ends of strokes are needed.")
        if partner[a] != a or partner[b] != b:
            raise InvoluteError("Only ends can be joined; cut the stroke that goes on there first.")
        if vertex[a] == vertex[b]:
            there = self._at_vertex(int(vertex[a]))
            return self.reroute(there.index, [*there.pairs, (a, b)])
        if (self.graph.degrees[vertex[[a, b]]] != 1).any():
            raise InvoluteError("Only ends that meet, or that hang on nothing, can be joined.")
        return self.with_edits([(a, b)])

    def with_edits(self, steps: Iterable[Step]) -> Drawing:
        """Cut and join, as `edits.steps` of another drawing tell it: each step makes a corner, the
        last one, which is locked. Strokes that have none of the changed branches stay.

        Raises:
            ValueError: a step does not fit the graph.
        """
        steps = tuple(steps)
        graph, routing, touched = edited(self.graph, self.routing, steps)
        if not steps:
            return self
        page = Page.of(graph, self.settings, self.size)
        gone = [s for s in self.strokes if not touched.isdisjoint((s.branches >> 1).tolist())]
        branches = touched.union(*((s.branches >> 1).tolist() for s in gone))
        left = {id(s) for s in gone}
        kept = [s for s in self.strokes if id(s) not in left]
        made = build(page, walk(routing.partner, branches))
        strokes = tuple(sorted([*kept, *made], key=lambda s: int(s.branches.min()) >> 1))
        before = self.edits or Edits(self.graph, ())
        edits = Edits(before.graph, before.steps + steps)
        return replace(self, graph=graph, routing=routing, strokes=strokes, page=page, edits=edits)

    def with_scores(self, pair_score: Array) -> Drawing:
        """The same routing with other log-odds of the pairs, and the alternatives that follow.

        Args:
            pair_score: (K,) as in `Routing`.
        """
        routing = rescored(self.graph, self.routing, pair_score, self._decided)
        return replace(self, routing=routing)

    def heard(self, said: Array) -> Drawing:
        """The places that are not locked, decided anew with what somebody says of their pairs.

        The probabilities stay what the picture alone says: who decided against it is in doubt.

        Args:
            said: (K,) log-odds that each pair of `Routing.pairs` is one line; 0 = nothing is said.
        """
        routing, decided = self.routing, self._decided
        where = np.unique(place_of_pairs(self.graph, routing.pairs[said != 0]))
        where = where[~routing.locked[where]]
        if not len(where):
            return self
        heard = rescored(self.graph, routing, routing.pair_score + said, decided, where)
        ways = {place: heard.alternatives[place][0].pairs for place in where.tolist()}
        first = len(self.graph.junctions)
        on = goes_on(heard.pair_score[-len(self.graph.places) + first :], self.settings.corners)
        for place in where[where >= first].tolist():
            a, b = self._pairs_at_corners[place - first].tolist()
            ways[place] = ((a, b),) if on[place - first] else ()
        shown = rescored(self.graph, routing, routing.pair_score, {**decided, **ways}, where)
        return self._with_ways(ways, shown)

    def ask_again(self) -> Drawing:
        """Route the junctions and corners that are not locked anew, given those that are."""
        if self.pencil:  # there, each junction is judged for itself
            free = np.flatnonzero(~self.routing.locked).tolist()
            ways = {place: self.routing.alternatives[place][0].pairs for place in free}
            return self._with_ways(ways, self.routing)
        graph = self.graph.scaled(1 / self.scale)
        routing = route(graph, self.settings, self._decided)
        return replace(self._with_partner(routing.partner), routing=routing)

    def ask_around(self, before: Drawing) -> Drawing:
        """Route the junctions around those that were decided or unlocked since `before` anew, given
        what is decided; what is locked stays. Takes a hundredth of a second.

        Args:
            before: the same graph.
        """
        if self.pencil:  # there, each junction is judged for itself
            return self
        graph, decided = self.graph.scaled(1 / self.scale), self._decided
        score, heard = taught(graph, self.routing, before._decided, decided, self.settings)
        heard = heard[~self.routing.locked[heard]]
        if not len(heard):
            return self
        routing = rescored(self.graph, self.routing, score, decided, heard)
        ways = {place: routing.alternatives[place][0].pairs for place in heard.tolist()}
        return self._with_ways(ways, routing)

    def merge(self, strokes: Iterable[int]) -> Drawing:
        """Make one line of several in a rough drawing, wherever their pencil strokes run beside
        each other; the bundles there are locked.

        Raises:
            InvoluteError: there is no such stroke, or none of them run beside each other.
        """
        return self._bundled([self.pencil_of(number) for number in strokes], True)

    def split(self, stroke: int) -> Drawing:
        """Make a line of each of the pencil strokes that say a stroke of a rough drawing, as far as
        these lie apart; the bundles there are locked.

        Raises:
            InvoluteError: there is no such stroke, or a single pencil stroke says it.
        """
        return self._bundled([self.pencil_of(stroke)], False)

    def _bundled(self, lines: Sequence[Sequence[int]], one: bool) -> Drawing:
        if self.pencil is None or self.pencil.beside is None:
            raise InvoluteError(NOT_KEPT)
        return self.answered(with_lines(self.pencil, lines, one, self.scale, self.size))

    def restroked(self, settings: Settings) -> Drawing:
        """The same lines and decisions with the strokes made anew.

        Args:
            settings: may differ in `STROKE_SETTINGS` only.
        """
        page = Page.of(self.graph, settings, self.size)
        strokes = tuple(build(page, walk(self.routing.partner)))
        return replace(self, strokes=strokes, settings=settings, page=page)

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
        return self.page or Page.of(self.graph, self.settings, self.size)

    def _with_locked(
        self, junctions: Iterable[int], value: bool, pairs: tuple[Pair, ...] | None = None
    ) -> Drawing:
        """Lock or unlock; the bundles among them as some pairs say, else as they are."""
        locked, given = self.routing.locked.copy(), []
        for junction in junctions:
            bundle = junction - len(locked)
            if not 0 <= junction < len(locked) + len(self.bundles):
                raise InvoluteError(f"There is no junction {junction}; there are {len(locked)}.")
            if bundle >= 0:
                asked = self.bundles[bundle]
                said = asked.pairs if pairs is None else pairs
                if said not in ((), (asked.strokes,)):
                    raise InvoluteError("The pencil strokes of a bundle are one line or two.")
                given.append((asked, bool(said) if value else None))
            else:
                locked[junction] = value
        drawing = replace(self, routing=replace(self.routing, locked=locked))
        if not given or drawing.pencil is None:
            return drawing
        return drawing.answered(with_answers(drawing.pencil.answers, given))

    def _stroke(self, number: int) -> Stroke:
        if not 0 <= number < len(self.strokes):
            raise InvoluteError(f"There is no stroke {number}; there are {len(self.strokes)}.")
        return self.strokes[number]

    def _at_vertex(self, vertex: int) -> Junction:
        return self.place(int(self.graph.place_at[vertex]))

    @property
    def _pairs_at_corners(self) -> Array:
        """(C, 2) int32: the two half-branches of each corner."""
        return self.routing.pairs[len(self.routing.pairs) - len(self.graph.corners) :]

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

    def _with_ways(self, ways: Mapping[int, tuple[Pair, ...]], routing: Routing) -> Drawing:
        """Route some places so; all that is said of the routing but its partners is given."""
        partner = self.routing.partner.copy()
        for place, pairs in ways.items():
            halves = self.graph.halves_of(self.graph.places[place])
            partner[halves] = halves
            for a, b in pairs:
                partner[a], partner[b] = b, a
        changed = self._with_partner(partner)
        return replace(changed, routing=replace(routing, partner=changed.routing.partner))


def _note(strokes: int, lines: int) -> str:
    return f"Taken for a rough drawing: its {strokes} pencil strokes say {lines} lines."
