"""Junctions that look like one another: the same lines in the same directions, turned or mirrored.

Pure NumPy.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from .picking import is_bundle, near_part

if TYPE_CHECKING:
    from ...engine import Drawing, Junction
    from ...engine.values import Pair

Array = np.ndarray

_TURN = np.radians(15.0)  # directions that differ by less are the same to the eye
_WIDER = 1.5  # times as wide; lines of one pen vary less
_UNTURNED = 0.1  # of the angle by which a junction is turned, so that an unturned one comes first
_REACH = 15.0  # px; over which a direction is measured


def decided_alike(drawing: Drawing, index: int, pairs: Sequence[Pair]) -> Drawing:
    """The drawing with one junction decided, and all that are open and look like it likewise."""
    if is_bundle(drawing, drawing.asked(index)):
        return drawing.reroute(index, pairs)
    for number, ways in alike(drawing, index, pairs):
        drawing = drawing.reroute(number, ways)
    return drawing.reroute(index, pairs)


def alike(
    drawing: Drawing, index: int, pairs: Sequence[Pair]
) -> list[tuple[int, tuple[Pair, ...]]]:
    """The open junctions that look like one, and what its routing is there.

    Args:
        pairs: how the lines of junction `index` are to run on.
    """
    degrees = drawing.graph.degrees[drawing.graph.junctions]
    model = drawing.place(index)
    angles, widths = _look(drawing, model)
    partner = _local(model.half_branches, pairs)
    open_ones = (degrees == model.degree) & ~drawing.routing.locked[: len(degrees)]
    open_ones[index] = False
    found = []
    for number in np.flatnonzero(open_ones).tolist():
        other = drawing.place(number)
        order = _matched(angles, widths, *_look(drawing, other))
        if order is None:
            continue
        halves = [other.half_branches[k] for k in order]
        ways = tuple(
            sorted(
                (min(halves[a], halves[b]), max(halves[a], halves[b]))
                for a, b in enumerate(partner.tolist())
                if a < b
            )
        )
        if any(way.pairs == ways for way in other.alternatives):
            found.append((number, ways))
    return found


def _look(drawing: Drawing, junction: Junction) -> tuple[Array, Array]:
    """(d,) direction and (d,) width of each line of a junction."""
    graph = drawing.graph
    ends = [near_part(drawing, half, _REACH)[-1] for half in junction.half_branches]
    out = np.array(ends) - junction.position
    widths = np.ones(len(out))
    if graph.widths is not None:
        widths = np.array([_width(graph.widths, graph.offsets, h) for h in junction.half_branches])
    return np.arctan2(out[:, 1], out[:, 0]), widths


def _width(widths: Array, offsets: Array, half: int) -> float:
    return float(np.median(widths[offsets[half >> 1] : offsets[(half >> 1) + 1]]))


def _matched(angles: Array, widths: Array, others: Array, their_widths: Array) -> list[int] | None:
    """Which line of the other junction stands for each of this one; None = it looks otherwise."""
    count = len(angles)
    mine = np.argsort(angles)
    best, chosen = np.inf, None
    for mirrored in (1, -1):
        theirs = np.argsort(mirrored * others)
        for shift in range(count):
            turned = np.roll(theirs, shift)
            away = np.angle(np.exp(1j * (mirrored * others[turned] - angles[mine])))
            turn = float(np.angle(np.exp(1j * away).mean()))
            away = np.angle(np.exp(1j * (away - turn)))
            ratio = their_widths[turned] / np.maximum(widths[mine], 1e-6)
            wide = (np.maximum(ratio, 1 / np.maximum(ratio, 1e-6)) <= _WIDER).all()
            worst = float(np.abs(away).max())
            cost = worst + _UNTURNED * abs(turn) + _UNTURNED * (mirrored < 0)
            if wide and worst <= _TURN and cost < best:
                best = cost
                chosen = np.empty(count, int)
                chosen[mine] = turned
    return None if chosen is None else chosen.tolist()


def _local(halves: Sequence[int], pairs: Iterable[Pair]) -> Array:
    """(d,) partners by place among the half-branches; itself where it ends."""
    partner = np.arange(len(halves))
    for a, b in pairs:
        i, j = halves.index(a), halves.index(b)
        partner[i], partner[j] = j, i
    return partner
