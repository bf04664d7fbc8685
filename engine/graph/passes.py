"""The passes that make a graph of a page, in their order: the one list that all of it runs.

A pass maps (graph, evidence, settings) to a graph; its docstring says in a line what it reads and
in another what it promises. All of them promise that the ends of branches lie on their vertices,
and return the very graph they were given when there is nothing to do.

The tracer, the training of its networks and the benchmarks run this list, cut by name; a pass may
be left out (`without`) to see what it brings. To add one, write its file and one line here.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass

from ..errors import InvoluteError
from ..settings import Settings
from ..values import PlanarGraph, Routing
from .dashes import join_dashes
from .ends import place_ends
from .evidence import Evidence
from .forks import merge_forks
from .gaps import bridge_gaps
from .junctions import resolve_junctions
from .lifts import mark_lifts
from .measure import measure
from .page_edge import stay_on_page
from .planarity import planarize
from .removal.dust import remove_dust
from .removal.pencil_lines import remove_pencil
from .removal.rungs import remove_rungs
from .removal.spurs import remove_spurs
from .removal.stubs import remove_stubs
from .removal.undrawn import remove_undrawn
from .skeleton_graph import trace_ridges
from .smoothing import smooth_lines, space_points
from .tips import open_tips, split_bends
from .topology import join_bends

Run = Callable[[PlanarGraph, Evidence, Settings], PlanarGraph]
Router = Callable[[PlanarGraph, Settings], Routing]


@dataclass(frozen=True)
class Pass:
    """One step: its name, what it does, and whether a graph can be made without it."""

    name: str
    run: Run
    optional: bool = True


PASSES = (
    Pass("skeleton", trace_ridges, optional=False),
    Pass("forks", merge_forks),
    Pass("spurs", remove_spurs),
    Pass("rungs", remove_rungs),
    Pass("tips", open_tips),
    Pass("bends", split_bends),
    Pass("junctions", resolve_junctions),
    Pass("spacing", space_points),
    Pass("ends", place_ends),
    Pass("dashes", join_dashes),
    Pass("gaps", bridge_gaps),
    Pass("smoothing", smooth_lines),
    Pass("joining", join_bends),
    Pass("undrawn", remove_undrawn),
    Pass("planarity", planarize),
    Pass("page", stay_on_page),
    Pass("measure", measure, optional=False),  # from here on with the ink of the page
    Pass("pencil", remove_pencil),
    Pass("measure-inked", measure, optional=False),
    Pass("dust", remove_dust),
    Pass("stubs", remove_stubs),  # from here on with a routing
    Pass("measure-strokes", measure, optional=False),
    Pass("lifts", mark_lifts),
)
MEASURED, ROUTED = "measure", "stubs"  # the first passes that need the ink, and a routing
_PLACE = {one.name: place for place, one in enumerate(PASSES)}


def run_passes(
    evidence: Evidence,
    settings: Settings,
    graph: PlanarGraph | None = None,
    *,
    start: str | None = None,
    until: str | None = None,
    without: Collection[str] = (),
) -> PlanarGraph:
    """Run the list, or a part of it.

    Args:
        evidence: the page.
        settings: how clean the drawing shall be.
        graph: what the passes before `start` made; None at the beginning.
        start, until: names of the first pass, and of the first one that isn't run any more.
        without: names of passes that are left out.

    Returns:
        A valid graph for any page; empty when nothing is left.

    Raises:
        InvoluteError: there is no such pass, or it can't be left out.
    """
    for name in without:
        if not PASSES[_place(name)].optional:
            raise InvoluteError(f"The pass {name!r} can't be left out")
    first = _place(start) if start else 0
    graph = graph or PlanarGraph.empty()
    for one in PASSES[first : _place(until) if until else None]:
        if one.name not in without and (graph.branch_count or one is PASSES[0]):
            graph = one.run(graph, evidence, settings)
    return graph


def _place(name: str) -> int:
    if name not in _PLACE:
        raise InvoluteError(f"There is no pass {name!r} among {', '.join(_PLACE)}")
    return _PLACE[name]


def build_graph(evidence: Evidence, settings: Settings) -> PlanarGraph:
    """The graph as far as a centerline tells it, not measured."""
    return run_passes(evidence, settings, until=MEASURED)


def routed(
    graph: PlanarGraph,
    evidence: Evidence,
    settings: Settings,
    router: Router,
    without: Collection[str] = (),
) -> tuple[PlanarGraph, Routing]:
    """A measured graph with its strokes, after the passes that needed a first routing."""
    routing = router(graph, settings)
    known = evidence.routed(routing.partner)
    left = run_passes(known, settings, graph, start=ROUTED, without=without)
    return (graph, routing) if left is graph else (left, router(left, settings))


def traced(
    evidence: Evidence, settings: Settings, router: Router, without: Collection[str] = ()
) -> tuple[PlanarGraph, Routing]:
    """The whole list on a scanned page: its final graph, and the routing of that.

    Args:
        router: routes a measured graph; called again when strokes were taken away.
    """
    graph = run_passes(evidence, settings, until=ROUTED, without=without)
    return routed(graph, evidence, settings, router, without)
