"""From an image to a drawing: the whole method on one page.

    image -> Scan -> LineMaps -> PlanarGraph -> Routing -> Drawing

Every stage takes the value of the stage before it and returns a new one; see `values`.
"""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike
from pathlib import Path
from time import perf_counter

from .centerline import provider_for
from .centerline.mending import mended
from .drawing import Drawing
from .errors import Cancelled
from .fills.solids import split_solids
from .graph import Evidence, routed, run_passes
from .graph.passes import ROUTED
from .ink.unmixing import without_inks
from .routing import route
from .scan import read_scan
from .scan.registration import set_aside
from .scan.screentone import without_screentone
from .scan.wide_lines import find_wide_lines
from .settings import Settings
from .values import Array
from .vector_page import drawing_of_vectors, is_vector
from .wide_pens import look_again

Progress = Callable[[str, float], None]
Source = str | PathLike[str] | Array

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


def vectorize(
    source: Source,
    settings: Settings | None = None,
    progress: Progress | None = None,
    *,
    page: int = 0,
) -> Drawing:
    """Trace one drawing.

    Args:
        source: path of an image, or an (H, W), (H, W, 3) or (H, W, 4) array, 8 or 16 bit or float
            in [0, 1]; or an .svg, whose lines are routed anew.
        settings: see `Settings`.
        progress: called as progress(stage, fraction of the whole); may raise `Cancelled`.
        page: which page of a TIFF with several.

    Returns:
        The drawing in pixels of the input; `drawing.seconds` says how long each stage took.

    Raises:
        InvoluteError: the source can't be read, or a setting can't be met.
        Cancelled: the progress callback asked to stop.
    """
    settings = settings or Settings()
    clock = _Clock(progress)
    if is_vector(source):
        with clock("graph"):
            return drawing_of_vectors(Path(source), settings, vectorize)
    with clock("scan"):
        scan = set_aside(read_scan(source, settings, page=page), settings)
        scan = without_screentone(without_inks(scan, settings), settings)
    with clock("solids"):
        wide = find_wide_lines(scan, settings)
        lines, fills = split_solids(scan, settings, wide.near if wide.any else None)
    with clock("centerline") as tick:
        look = provider_for(settings)
        maps = look(lines, tick)
        if wide.any:
            maps = look_again(maps, lines, wide, look, settings)
        if settings.provider in ("auto", "network") and maps.half_width is not None:
            maps = mended(maps, lines, wide.near if wide.any else None)
    with clock("graph"):
        evidence = Evidence.of(lines, maps)
        graph = run_passes(evidence, settings, until=ROUTED)
    with clock("routing"):
        graph, routing = routed(graph, evidence, settings, route)
        del evidence
    with clock("strokes"):
        drawing = Drawing.from_routing(graph, routing, scan, settings, fills)
    with clock("check"):
        drawing = drawing.compared_with(scan)
    return drawing.with_seconds(clock.seconds)


class _Clock:
    """Times each stage and turns its own fraction into the fraction of the whole."""

    def __init__(self, progress: Progress | None) -> None:
        self.seconds: dict[str, float] = {}
        self._progress = progress
        self._stage = ""
        self._done = 0.0

    def __call__(self, stage: str) -> _Clock:
        self._stage = stage
        return self

    def __enter__(self) -> Callable[[float], None]:
        self._start = perf_counter()
        self._tick(0.0)
        return self._tick

    def __exit__(self, *error: object) -> None:
        self.seconds[self._stage] = perf_counter() - self._start
        self._done += _SHARES[self._stage]

    def _tick(self, fraction: float) -> None:
        if self._progress:
            self._progress(self._stage, min(1.0, self._done + _SHARES[self._stage] * fraction))


__all__ = ["Cancelled", "Progress", "Source", "vectorize"]
