"""Corners: where a line turns suddenly. They stay sharp, and become sharp again.

A centerline rounds corners off, and sharp ones the most, by up to a pen width: where both sides
are straight, the corner belongs where they meet.
"""

from __future__ import annotations

import numpy as np

from ..values import Array
from .lines import Lines
from .shared import SAMPLES_PER_PEN

_ARM = 1.5  # pen widths of line on both sides of a corner that are looked at
_CORNER = np.radians(38.0)  # least turn of a corner over the whole arm
_SUDDEN = 0.7  # share of that turn that must be there over half of the arm: 0.5 on a circle
_ROUNDED = 4  # samples on either side of a corner that are rounded off
_STRAIGHT = 7  # samples beyond these that show where the side comes from
_BENT = 0.06  # pen widths, root mean square, that a straight side may be bent
_RADIUS = 0.45  # pen widths; the greatest rounding that counts as the centerline's doing
_SLACK = 0.1  # pen widths that a corner may move beyond what such a rounding takes off

MARGIN = 4 * round(_ARM * SAMPLES_PER_PEN) + _ROUNDED + _STRAIGHT  # samples that can matter


def find_corners(points: Array, lines: Lines) -> Array:
    """(N,) bool: where the line turns suddenly, and the first and last sample of each run.

    A corner turns as much over a short stretch as over a long one; a tight curve doesn't.
    """
    place = np.arange(len(points))
    arm = round(_ARM * SAMPLES_PER_PEN)
    wide, near = (_turn(points, lines, a) for a in (arm, arm // 2))
    sharp = (wide > _CORNER) & (near > _SUDDEN * wide)
    strength = np.where(sharp, wide + near, 0.0)
    best = strength > 0
    for k in range(1, arm + 1):
        best &= strength >= strength[np.minimum(place + k, lines.last)]
        best &= strength > strength[np.maximum(place - k, lines.first)] * (place - k >= lines.first)
    # A corner right beside a junction is the junction: the raster has moved one of them.
    for k in range(arm // 2, 0, -1):
        for other in (np.minimum(place + k, lines.last), np.maximum(place - k, lines.first)):
            moved = best & lines.joint[other] & ~lines.joint
            best[other[moved]], best[moved] = True, False
    return best | (place == lines.first) | (place == lines.last)


def _turn(points: Array, lines: Lines, arm: int) -> Array:
    """(N,) the angle between the chords over `arm` samples before and after; 0 near the ends."""
    place = np.arange(len(points))
    before, after = np.maximum(place - arm, lines.first), np.minimum(place + arm, lines.last)
    a, b = points - points[before], points[after] - points
    turn = np.abs(np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], (a * b).sum(1)))
    short = np.minimum(place - before, after - place) < arm // 2
    return np.where(short, 0.0, turn)


def sharpen(
    points: Array, lines: Lines, corner: Array, pen: float, size: tuple[float, float]
) -> Array:
    """The samples with each corner moved to where its two straight sides meet, (N, 2).

    Corners at junctions stay, and so do those with a curved or short side, and those that the edge
    of the page, of width and height `size`, px, cuts off.
    """
    place = np.arange(len(points))
    reach = _ROUNDED + _STRAIGHT
    stops = np.flatnonzero(corner | lines.joint)
    at = np.flatnonzero(corner & ~lines.joint & (place > lines.first) & (place < lines.last))
    if len(at) == 0:
        return points
    number = np.searchsorted(stops, at)
    room = np.minimum(at - stops[number - 1], stops[number + 1] - at)
    at = at[room >= reach]
    k = np.arange(_ROUNDED, reach + 1)
    sides = [points[at[:, None] - k], points[at[:, None] + k]]
    middle = [side.mean(1) for side in sides]
    heading, bent = zip(*(_direction(side) for side in sides), strict=True)

    # middle[0] + t heading[0] == middle[1] + u heading[1]
    det = heading[0][:, 0] * heading[1][:, 1] - heading[0][:, 1] * heading[1][:, 0]
    gap = middle[1] - middle[0]
    t = gap[:, 0] * heading[1][:, 1] - gap[:, 1] * heading[1][:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        tip = middle[0] + (t / det)[:, None] * heading[0]
        moved = np.hypot(*(tip - points[at]).T)
    # A corner of turn a, rounded with radius r, loses r (1 / cos(a / 2) - 1) of its tip.
    along = -(heading[0] * heading[1]).sum(1)
    lost = _RADIUS * (1 / np.sqrt(np.maximum((1 + along) / 2, 0.03)) - 1)
    good = (np.maximum(*bent) < _BENT * pen) & (moved < (lost + _SLACK) * pen)
    good &= (np.abs(det) > 0.2) & (tip >= 0).all(1) & (tip <= size).all(1)
    at, tip = at[good], tip[good]
    result = points.copy()
    for step in range(_ROUNDED):
        for side in (-1, 1):
            base = points[at + side * _ROUNDED]
            result[at + side * step] = tip + (base - tip) * (step / _ROUNDED)
    return result


def _direction(side: Array) -> tuple[Array, Array]:
    """The direction of the line fitted to (n, K, 2) samples, (n, 2), and its error, (n,)."""
    u = np.linspace(-1, 1, side.shape[1])
    slope = np.einsum("k,nkc->nc", u / (u * u).sum(), side)
    rest = side - side.mean(1, keepdims=True) - u[:, None] * slope[:, None]
    slope = slope / np.maximum(np.hypot(*slope.T), 1e-12)[:, None]
    return slope, np.sqrt((rest * rest).sum(-1).mean(1))
