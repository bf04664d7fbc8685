"""Strokes of before a cut or a join, told on the graph of after it.

Rerouting compares two routings of one graph. A cut is one, too: on the graph of after it, the
strokes of before run through the new corner.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ....engine import Drawing, Stroke

Array = np.ndarray


def regraphed(old: Drawing, new: Drawing) -> Drawing:
    """A drawing with all its strokes as they are, on the graph of one that was made from it.

    Args:
        new: what `cut`, `join` and rerouting have made of it; or of the same traced drawing.
    """
    before = old.edits.steps if old.edits else ()
    steps = new.edits.steps if new.edits else ()
    if steps == before:
        return old
    from ....engine.graph.editing import do_step

    graph, routing, strokes = old.graph, old.routing, old.strokes
    for step in steps[len(before) :]:
        branch = int(np.searchsorted(graph.offsets, step[0], "right")) - 1
        last = graph.branch_count
        graph, routing = do_step(graph, routing, step)
        joined = step[1] < 0
        partner = routing.partner.copy()
        a, b = graph.halves_of(graph.corners[-1]).tolist()
        partner[[a, b]] = (b, a) if joined else (a, b)
        routing = replace(routing, partner=partner)
        if joined:
            strokes = tuple(_through(stroke, branch, last) for stroke in strokes)
    return replace(old, graph=graph, routing=routing, strokes=strokes, edits=new.edits, page=None)


def _through(stroke: Stroke, branch: int, added: int) -> Stroke:
    """The stroke where the branch has become two, itself and what was added after it."""
    where = np.flatnonzero(stroke.branches >> 1 == branch)
    if not len(where):
        return stroke
    at = int(where[0])
    two = (2 * branch, 2 * added)
    if stroke.branches[at] & 1:
        two = (2 * added + 1, 2 * branch + 1)
    branches = np.concatenate([stroke.branches[:at], two, stroke.branches[at + 1 :]])
    return replace(stroke, branches=branches.astype(np.int32))
