"""From an image to a drawing: the whole method on one page.

    image -> Scan -> LineMaps -> PlanarGraph -> Routing -> Drawing

Every stage takes the value of the stage before it and returns a new one; see `values`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from itertools import accumulate
from os import PathLike
from pathlib import Path
from time import perf_counter
from typing import Any, TypeVar

from .centerline import provider_for
from .centerline.frame_before import FrameBefore
from .centerline.mending import mended
from .drawing import Drawing, Fill
from .errors import Cancelled
from .fills.solids import split_solids
from .grain import is_decided, is_torn, note, simplest
from .graph import Evidence, routed, run_passes
from .graph.passes import ROUTED
from .ink.unmixing import without_inks
from .kept_stages import KeptStages, Source, keys
from .rough import grouping
from .rough.asking import cleaned_again
from .rough.cleaning import Bundled, bundled, is_rough
from .rough.remembered import remembered
from .routing import route
from .scan import read_scan
from .scan.registration import set_aside
from .scan.resolution import dots_per_inch
from .scan.screentone import without_screentone
from .scan.show_through import without_show_through
from .scan.wide_lines import WideLines, find_wide_lines
from .settings import Settings
from .values import Answers, Array, Beside, LineMaps, PlanarGraph, Pose, Routing, Scan
from .vector_page import drawing_of_vectors, is_vector
from .wide_pens import look_again

Progress = Callable[[str, float], None]
T = TypeVar("T")

# What each stage takes of the whole time, for a progress bar that moves evenly.
_SHARES = {
    "scan": 0.1,
    "solids": 0.05,
    "centerline": 0.55,
    "graph": 0.1,
    "routing": 0.1,
    "strokes": 0.08,
    "check": 0.02,
}
_BEGINS = dict(zip(_SHARES, accumulate([0.0, *_SHARES.values()]), strict=False))


def vectorize(
    source: Source,
    settings: Settings | None = None,
    progress: Progress | None = None,
    *,
    page: int = 0,
    turn: bool = True,
    kept: KeptStages | None = None,
    before: FrameBefore | None = None,
) -> Drawing:
    """Trace one drawing.

    Args:
        source: path of an image, or an (H, W), (H, W, 3) or (H, W, 4) array, 8 or 16 bit or float
            in [0, 1]; or an .svg, whose lines are routed anew.
        settings: see `Settings`.
        progress: called as progress(stage, fraction of the whole); may raise `Cancelled`.
        page: which page of a TIFF with several.
        turn: look at the drawing in the same pose however its page was turned or mirrored. False
            for the frames of a sequence, which are looked at alike, each as it lies.
        kept: what was made in earlier traces; only what the settings have changed since runs, and
            what it makes is kept there, too, even when the trace is cancelled.
        before: the frame before it in a sequence; what is unchanged is not looked at again.

    Returns:
        The drawing in pixels of the input; `drawing.seconds` says how long each stage took that
        ran.

    Raises:
        InvoluteError: the source can't be read, or a setting can't be met.
        Cancelled: the progress callback asked to stop.
    """
    clock = _Clock(progress)
    if is_vector(source):
        with clock("graph"):
            drawing = drawing_of_vectors(Path(source), settings or Settings(), vectorize)
    else:

        def trace(settings: Settings) -> _Trace:
            return _Trace(source, page, settings, turn, clock, kept, before)

        settings = settings or Settings()
        alike = before is not None or not turn  # the frames of a sequence
        grain = "fine"
        if alike or is_decided(settings):
            drawing = trace(_closely(settings)).drawing()
        else:
            drawing, grain = _seen_well(trace, settings)
        notes = drawing.notes if grain == "fine" else (*drawing.notes, note(grain))
        drawing = replace(drawing, settings=settings, notes=notes)
    return drawing.with_seconds(clock.seconds)


def grain_of(source: Source, settings: Settings, page: int = 0) -> str:
    """The value of `Settings.grain` that suits a page, for it and for all like it.

    Raises:
        InvoluteError: the source can't be read.
    """
    if is_decided(settings) or is_vector(source):
        return settings.grain

    def trace(settings: Settings) -> _Trace:
        return _Trace(source, page, settings, False, _Clock(None), None)

    return _seen_well(trace, settings)[1]


def _seen_well(trace: Callable[[Settings], _Trace], settings: Settings) -> tuple[Drawing, str]:
    """The drawing of a page, seen from farther away where its lines are torn, and its grain."""
    close = trace(_closely(settings))
    scan, drawing = close.scan(), close.drawing()
    if not is_torn(drawing, scan):
        return drawing, "fine"
    return simplest(drawing, lambda grain: trace(replace(settings, grain=grain)))


def _closely(settings: Settings) -> Settings:
    """Without a choice of its own a page is looked at from close by."""
    return replace(settings, grain="fine") if settings.grain == "auto" else settings


class _Trace:
    """One page on its way. Each stage asks for those before it when it has to run itself."""

    def __init__(
        self,
        source: Source,
        page: int,
        settings: Settings,
        turn: bool,
        clock: _Clock,
        kept: KeptStages | None,
        before: FrameBefore | None = None,
    ) -> None:
        self._before = before
        self._source, self._page, self._settings = source, page, settings
        self._turn = turn and not settings.align  # those places are of the page as it lies
        self._clock, self._kept = clock, kept
        self._keys: Mapping[str, str] = {}
        if kept:
            with suppress(OSError):  # the first stage says what is wrong with the picture
                self._keys = keys(source, page, settings, turn)
        self._own: dict[str, object] = {}  # what several stages of this trace want

    def _recalled(self, stage: str) -> Any | None:
        if stage in self._own:
            return self._own[stage]
        return self._kept.recall(self._keys[stage]) if self._kept and self._keys else None

    def _made(self, stage: str, made: T) -> T:
        if self._kept and self._keys:
            self._kept.keep(self._keys[stage], made)
        return made

    def scan(self) -> Scan:
        if (found := self._recalled("scan")) is None:
            settings = self._settings
            with self._clock("scan"):
                found = read_scan(self._source, settings, page=self._page, turn=self._turn)
                found = without_show_through(set_aside(found, settings), settings)
                found = without_screentone(without_inks(found, settings), settings)
            self._made("scan", found)
        self._own["scan"] = found
        return found

    def solids(self) -> tuple[WideLines, Scan, list[Fill]]:
        """What is wide on the page, the page with lines alone, and its solid areas."""
        if (found := self._recalled("solids")) is None:
            scan = self.scan()
            with self._clock("solids"):
                wide = find_wide_lines(scan, self._settings)
                near = wide.near if wide.any else None
                found = wide, *split_solids(scan, self._settings, near)
            self._made("solids", found)
        self._own["solids"] = found
        return found

    def area_count(self) -> int:
        return len(self.solids()[2])

    def maps(self) -> LineMaps:
        if (found := self._recalled("centerline")) is not None:
            return found
        settings, (wide, lines, _) = self._settings, self.solids()
        with self._clock("centerline") as tick:
            look = provider_for(settings)
            seen_before = self._before
            maps = seen_before.look(lines, settings, tick) if seen_before else look(lines, tick)
            if wide.any:
                maps = look_again(maps, lines, wide, look, settings)
            if settings.provider in ("auto", "network", "lean") and maps.half_width is not None:
                maps = mended(maps, lines, wide.near if wide.any else None)
        return self._made("centerline", maps)

    def _evidence(self) -> Evidence:
        maps = self.maps()
        return Evidence.of(self.solids()[1], maps)

    def graph(self) -> tuple[PlanarGraph, Evidence | None]:
        """The lines, not routed yet, and what they were made of where that is at hand."""
        if (found := self._recalled("graph")) is not None:
            return found, None
        evidence = self._evidence()
        with self._clock("graph"):
            graph = run_passes(evidence, self._settings, until=ROUTED)
        return self._made("graph", graph), evidence

    def routed(self) -> tuple[PlanarGraph, Routing]:
        if (found := self._recalled("routing")) is not None:
            return found
        graph, evidence = self.graph()
        evidence = evidence or self._evidence()
        with self._clock("routing"):
            found = routed(graph, evidence, self._settings, route)
        return self._made("routing", found)

    def _dpi(self) -> float | None:
        source = self._source
        return dots_per_inch(source, self._page) if isinstance(source, str | PathLike) else None

    def drawing(self) -> Drawing:
        if (found := self._recalled("strokes")) is not None:
            return found
        graph, routing = self.routed()
        scan, (_, _, fills) = self.scan(), self.solids()
        self._own = {}  # the strokes need no more than that
        with self._clock("strokes"):
            graph, fills, scan = _as_they_lay(graph, fills, scan)
            drawing = Drawing.from_routing(graph, routing, scan, self._settings, fills)
            bundles = _bundles(graph, routing, scan, self._settings)
            if bundles is not None:
                kept = remembered(bundles, graph, routing.partner, scan.scale)
                drawing = _clean(drawing, kept, scan, self._settings, fills)
        with self._clock("check"):
            drawing = replace(drawing.compared_with(scan), dpi=self._dpi())
        return self._made("strokes", drawing)


def _bundles(
    graph: PlanarGraph, routing: Routing, scan: Scan, settings: Settings
) -> Bundled | None:
    """The bundles of pencil strokes of a rough drawing; None for a clean one."""
    known = grouping.available() or settings.drawing == "rough"
    if settings.drawing == "clean" or not known or graph.branch_count == 0:
        return None
    found = bundled(graph, routing.partner, scan.ink)
    return found if is_rough(found, graph, settings) else None


def _clean(
    drawn: Drawing, kept: Beside, scan: Scan, settings: Settings, fills: list[Fill]
) -> Drawing:
    """The clean drawing of a rough one, made of what it keeps, as it is after an answer."""
    made = cleaned_again(kept, Answers.none(), settings, scan.scale, scan.size)
    lines = Drawing.from_routing(made.graph, made.routing, scan, settings, fills)
    return lines.cleaned_from(drawn, made.said, kept)


def _as_they_lay(
    graph: PlanarGraph, fills: list[Fill], scan: Scan
) -> tuple[PlanarGraph, list[Fill], Scan]:
    """The lines and areas of a page that was turned, and the page, as it lay."""
    size = scan.size[0] / scan.scale, scan.size[1] / scan.scale

    def place(points: Array) -> Array:
        return scan.pose.points_back(points, size)

    if scan.pose == Pose():
        return graph, fills, scan
    areas = [tuple(place(ring) for ring in fill) for fill in fills]
    return graph.moved(place), areas, scan.as_it_lay()


class _Clock:
    """Times each stage and turns its own fraction into the fraction of the whole."""

    def __init__(self, progress: Progress | None) -> None:
        self.seconds: dict[str, float] = {}
        self._progress = progress
        self._shown = 0.0
        self._stage = ""

    def __call__(self, stage: str) -> _Clock:
        self._stage = stage
        return self

    def __enter__(self) -> Callable[[float], None]:
        self._start = perf_counter()
        self._tick(0.0)
        return self._tick

    def __exit__(self, *error: object) -> None:
        taken = perf_counter() - self._start
        self.seconds[self._stage] = self.seconds.get(self._stage, 0.0) + taken

    def _tick(self, fraction: float) -> None:
        if self._progress:
            done = min(1.0, _BEGINS[self._stage] + _SHARES[self._stage] * fraction)
            self._shown = max(self._shown, done)  # a page that is looked at again is not begun anew
            self._progress(self._stage, self._shown)


__all__ = ["Cancelled", "FrameBefore", "KeptStages", "Progress", "Source", "grain_of", "vectorize"]
