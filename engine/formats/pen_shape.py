"""The shape that a pen of changing width leaves: each stroke as the outline of its ink.

Along either side the outline runs at half the width from the line. Where the line bends by more
than a step of the arc, it goes round the outer side as the pen does; on the inner side the two
sides meet, or, in bends tighter than the pen, run through the point of the bend itself. So the
outline may overlap itself, always in the same sense, and is filled by the nonzero rule.
"""

from __future__ import annotations

import numpy as np

from ..arrays.ragged import count_up, offsets_of, owners
from ..strokes.simplify import simplify
from ..values import Array, Stroke
from .flatten import outline, widths_along

_FLAT = 0.05  # px; an arc of the outline strays no farther from the true one: not to be seen
_STEP = (0.1, 0.6)  # radians from point to point of an arc, at least and at most
_FOLD = 1.2  # radians; in sharper bends the sides would meet where the pen has another width
_NEAR = 1e-3  # px; points closer than this are one: the resolution of the files


def pen_shape(stroke: Stroke) -> list[Array]:
    """The rings (N, 2) float64 px around the ink of a stroke, to be filled by the nonzero rule.

    An open stroke has one ring, with round ends; a closed one an outer and an inner one.
    """
    line, radius = _line(stroke)
    if len(line) == 1:
        return [_ring(line, radius, np.zeros(1), np.full(1, -2 * np.pi), radius)]
    if not stroke.closed:
        return [_around(line, radius)]
    line, radius = line[:-1], radius[:-1]
    if len(line) < 3:
        return [_around(line, radius)]
    angle = _angles(np.concatenate([line, line[:1]]))
    turn = _wrapped(angle - np.roll(angle, 1))
    length = np.hypot(*(np.roll(line, -1, 0) - line).T)
    room = np.minimum(length, np.roll(length, 1))
    left = _ring(line, radius, np.roll(angle, 1) + np.pi / 2, turn, room)
    back = slice(None, None, -1)
    right = _ring(line[back], radius[back], angle[back] - np.pi / 2, -turn[back], room[back])
    return [left, right]


def _line(stroke: Stroke) -> tuple[Array, Array]:
    """The polyline of a stroke and the radius at its points; no point twice in a row."""
    line = outline(stroke).astype(np.float64)
    radius = widths_along(stroke).astype(np.float64) / 2
    if stroke.handles is not None:
        keep = np.zeros(len(line), bool)
        keep[[0, -1]] = True
        keep = simplify(np.column_stack([line, radius]), keep, _FLAT / 2)
        line, radius = line[keep], radius[keep]
    moved = np.hypot(*np.diff(line, axis=0).T) > _NEAR
    first = np.flatnonzero(np.concatenate([[True], moved]))
    line, radius = line[first], np.maximum.reduceat(radius, first)
    if stroke.closed and len(line) > 1 and np.hypot(*(line[-1] - line[0])) > _NEAR:
        line, radius = np.append(line, line[:1], 0), np.append(radius, radius[0])
    return line, radius


def _around(line: Array, radius: Array) -> Array:
    """The ring around an open line: its left side, the end, the right side back, the beginning."""
    angle = _angles(line)
    turn = _wrapped(np.diff(angle))
    length = np.hypot(*np.diff(line, axis=0).T)
    room = np.minimum(length[:-1], length[1:])
    half, inner, back = np.pi / 2, slice(1, -1), slice(-2, 0, -1)
    ends = np.array([-np.pi])
    never = np.array([np.inf])
    return _ring(
        np.concatenate([line[inner], line[-1:], line[back], line[:1]]),
        np.concatenate([radius[inner], radius[-1:], radius[back], radius[:1]]),
        np.concatenate(
            [angle[:-1] + half, angle[-1:] + half, angle[:0:-1] - half, angle[:1] - half]
        ),
        np.concatenate([turn, ends, -turn[::-1], ends]),
        np.concatenate([room, never, room[::-1], never]),
    )


def _ring(center: Array, radius: Array, start: Array, turn: Array, room: Array) -> Array:
    """The points of a ring that goes round one centre after the other.

    Args:
        center: (J, 2); radius: (J,).
        start: (J,) angle at which the ring comes to each; turn: (J,) by how much it turns there.
            Below zero = the outer side of the bend, as the ring runs with the ink at its right.
        room: (J,) length of the shorter segment at each; a bend on the inner side with less room
            than twice what the pen needs is passed through its centre.
    """
    step = np.clip(2 * np.arccos(np.clip(1 - _FLAT / np.maximum(radius, _FLAT), 0, 1)), *_STEP)
    sharp, inner = np.abs(turn) > step, turn > 0
    inset = np.where(inner, np.tan(np.minimum(np.abs(turn), 3.0) / 2), 0)
    tight = sharp & inner & ((radius * inset > room / 2) | (turn > _FOLD))
    arc = sharp & (~inner | ~np.isfinite(room))
    count = np.where(arc, np.ceil(np.abs(turn) / step).astype(np.int64) + 1, 1)
    count[tight] = 3
    of = owners(offsets_of(count))
    part = count_up(count) / np.maximum(count - 1, 1)[of]
    part[(count == 1)[of]] = 0.5
    angle = start[of] + turn[of] * part
    miter = np.where(count == 1, 1 / np.cos(np.minimum(np.abs(turn), 2.9) / 2), 1.0)
    far = (radius * miter)[of]
    far[tight[of] & (part == 0.5)] = 0.0
    return center[of] + far[:, None] * np.stack([np.cos(angle), np.sin(angle)], 1)


def _angles(line: Array) -> Array:
    step = np.diff(line, axis=0)
    return np.arctan2(step[:, 1], step[:, 0])


def _wrapped(angle: Array) -> Array:
    return (angle + np.pi) % (2 * np.pi) - np.pi
