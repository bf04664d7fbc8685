"""Smooth strokes: no wobble of the raster, no kink at junctions, corners stay corners.

A Gaussian runs along each stroke, not across corners and ends. Junctions stay where they are, so
that crossing strokes go on crossing there: the line around them is moved, not the vertex.
"""

from __future__ import annotations

import numpy as np

from .lines import Lines, Pieces
from .page import SAMPLES_PER_PEN

Array = np.ndarray

WIDEST = 2.5  # pen widths; sigma at smoothing 1
_JOINT = 0.75  # pen widths; least sigma where a stroke runs through a junction
_JOINT_REACH = 2.0  # pen widths from the junction over which that holds
_PULL = 4.0  # pen widths around a junction that follow it back to its place
_CORNER_ARM = 1.5  # pen widths of line on both sides of a corner that are looked at
_CORNER = np.radians(38.0)  # least turn of a corner over the whole arm
_SUDDEN = 0.7  # share of that turn that must be there over half of the arm: 0.5 on a circle


def margin(smoothing: float) -> int:
    """How many samples away a sample can have an influence."""
    return _radius(smoothing * WIDEST) + _radius(_JOINT) + round(4 * _CORNER_ARM * SAMPLES_PER_PEN)


def corners(points: Array, lines: Lines) -> Array:
    """(N,) bool: where the line turns suddenly, and the first and last sample of each run.

    A corner turns as much over a short stretch as over a long one; a tight curve doesn't.
    """
    place = np.arange(len(points))
    arm = round(_CORNER_ARM * SAMPLES_PER_PEN)
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


def smooth(points: Array, lines: Lines, corner: Array, smoothing: float) -> Array:
    """The smoothed samples, (N, 2).

    Args:
        points: (N, 2) in px; corner: (N,) bool from `corners`; smoothing: 0 to 1.
    """
    place = np.arange(len(points))
    sigma = smoothing * WIDEST
    wanted = _sharpened_blur(points, lines, corner, sigma)
    stops = np.flatnonzero(corner | lines.joint)
    if sigma < _JOINT and lines.joint.any():
        calm = _sharpened_blur(points, lines, corner, _JOINT)
        share = _hat(place, stops, lines.joint, _JOINT_REACH * SAMPLES_PER_PEN)
        wanted += share[:, None] * (calm - wanted)

    # Bring the junctions back to where they were, and the line around them with them.
    reach = max(_PULL, sigma * 1.5) * SAMPLES_PER_PEN
    return wanted + _pull(place, stops, points[stops] - wanted[stops], reach)


def _radius(sigma: float) -> int:
    return int(np.ceil(3 * sigma * SAMPLES_PER_PEN))


def _sharpened_blur(points: Array, lines: Lines, corner: Array, sigma: float) -> Array:
    """Blur by sigma pen widths, twice over (2 G - G G), so that curves don't shrink.

    Beyond a corner or end the line goes on mirrored at that point, which therefore stays.
    """
    sigma *= SAMPLES_PER_PEN
    if sigma < 0.3:
        return points.copy()
    stops = np.flatnonzero(corner)
    inside = lines.first[stops[:-1]] == lines.first[stops[1:]]
    pieces = Pieces(stops[:-1][inside], stops[1:][inside], _radius(sigma / SAMPLES_PER_PEN))
    once = pieces.blur(pieces.mirrored(points), sigma)
    blurred = np.empty_like(points)
    pieces.put(once, blurred)
    result = points.copy()
    pieces.put(2 * once - pieces.blur(pieces.mirrored(blurred), sigma), result)
    return result


def _neighbours(place: Array, stops: Array) -> tuple[Array, Array]:
    """For each sample the numbers of the stops before (or at) and after (or at) it."""
    after = np.searchsorted(stops, place)
    before = np.searchsorted(stops, place, side="right") - 1
    return np.maximum(before, 0), np.minimum(after, len(stops) - 1)


def _fade(distance: Array, reach: Array) -> Array:
    """1 at 0, smoothly down to 0 at `reach`."""
    t = np.clip(1 - distance / np.maximum(reach, 1e-9), 0.0, 1.0)
    return t * t * (3 - 2 * t)


def _hat(place: Array, stops: Array, joint: Array, reach: float) -> Array:
    """(N,) how near a joint is: 1 at one, 0 further than `reach`."""
    before, after = _neighbours(place, stops)
    here = np.where(joint[stops[before]], _fade(place - stops[before], reach), 0.0)
    there = np.where(joint[stops[after]], _fade(stops[after] - place, reach), 0.0)
    return np.maximum(here, there)


def _pull(place: Array, stops: Array, shift: Array, reach: float) -> Array:
    """(N, 2) a smooth displacement that is `shift` at the stops and fades out within `reach`."""
    before, after = _neighbours(place, stops)
    gap = np.where(before == after, reach, stops[after] - stops[before])
    own = np.minimum(reach, gap)
    left = _fade(place - stops[before], own)[:, None] * shift[before]
    right = _fade(stops[after] - place, own)[:, None] * shift[after]
    return np.where((before == after)[:, None], left, left + right)
