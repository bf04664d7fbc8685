"""All runs of the benchmark by name: `python -m benchmarks run NAME`.

A run is a module here whose `main(argv)` prints its report and returns its figures. A new one is
one line in RUNS.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module

from .judged_pages import DATA
from .run_record import Figures


@dataclass(frozen=True)
class NamedRun:
    """module.function(argv) does it; arguments stand before those that the user gives."""

    module: str
    what: str
    arguments: tuple[str, ...] = ()
    function: str = "main"

    def __call__(self, argv: Sequence[str] = ()) -> Figures | None:
        """Run it; what it needs (bpy, rivals, drawings) is imported and asked for only now."""
        work = getattr(import_module(f"benchmarks.{self.module}"), self.function)
        return work([*self.arguments, *argv])


RUNS: dict[str, NamedRun] = {
    "quality": NamedRun("quality", "strokes against the true ones, ours and the rivals'"),
    "tangles": NamedRun(
        "quality",
        "the same on 20 pages of tangled, nearly parallel brush strokes",
        ("--data", str(DATA / "tangles")),
    ),
    "aliased": NamedRun("aliased", "ink lost and invented on 1-bit lines of 1 to 4 px"),
    "fidelity": NamedRun(
        "lost_and_invented", "ink lost and invented on the benchmark's pages, or --scans"
    ),
    "speed": NamedRun("speed", "seconds by page and stage, growth, rivals", ("--pages", "all")),
    "speed_against": NamedRun("speed_against", "processor time against an older checkout's"),
    "graph_stage": NamedRun("graph_stage", "the graph behind perfect centerlines", ("--ideal",)),
    "graph_limits": NamedRun("graph_limits", "every limit of the graph, halved and doubled"),
    "scan_limits": NamedRun("scan_limits", "limits of broad lines and rules, on held-out pages"),
    "true_graphs": NamedRun("true_graphs", "routing alone, on perfect graphs"),
    "offset": NamedRun("offset", "whether pages lie beside their truth"),
    "curve_points": NamedRun("curve_points", "points a stroke, as polylines and as curves"),
    "steadiness": NamedRun("steadiness", "strokes of a sequence keep number, order, direction"),
    "pencil_under_ink": NamedRun("pencil_under_ink", "pencil told from the ink over it"),
    "many_pages": NamedRun("many_pages", "hundreds of pages, killed and resumed"),
    "blender_costs": NamedRun("blender_costs", "writing, rerouting, overlay in Blender (bpy)"),
    "artist": NamedRun(
        "blender_costs",
        "what is waited for in a review and while adjusting (bpy)",
        function="seconds_of_an_artist",
    ),
    "rough": NamedRun("rough_to_clean", "the lines of held-out rough pages, --data DRAWINGS"),
    "review": NamedRun("review_worth", "what is flagged, calibration, what 30 decisions find"),
    "bundles": NamedRun("bundle_worth", "the same of bundles on rough pages, --data DRAWINGS"),
    "redraw": NamedRun("blender_costs", "an idle redraw in a window", function="in_window"),
    "extension": NamedRun("extension", "what the built ZIP weighs and costs to enable"),
    "junction_gallery": NamedRun("junction_gallery", "a picture of twelve kinds of junctions"),
    "routing_gallery": NamedRun("routing_gallery", "pictures of scans before and after routing"),
}
