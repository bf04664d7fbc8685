"""Smooth strokes: no wobble of the raster, no kink at junctions, corners stay corners.

A Gaussian runs along each stroke, not across corners and ends. Junctions stay where they are, so
that crossing strokes go on crossing there: the line around them is moved, not the vertex.
"""

from __future__ import annotations

import numpy as np

from ..values import Array
from .corners import MARGIN as CORNER_MARGIN
from .lines import Lines, Pieces
from .shared import SAMPLES_PER_PEN

WIDEST = 2.5  # pen widths; sigma at smoothing 1
_JOINT = 0.75  # pen widths; least sigma where a stroke runs through a junction
_JOINT_REACH = 2.0  # pen widths from the junction over which that holds
_PULL = 4.0  # pen widths around a junction that follow it back to its place


def margin(smoothing: float) -> int:
    """How many samples away a sample can have an influence."""
    return _radius(smoothing * WIDEST) + _radius(_JOINT) + CORNER_MARGIN


def smooth(points: Array, lines: Lines, corner: Array, smoothing: float) -> Array:
    """The smoothed samples, (N, 2).

    Args:
        points: (N, 2) in px; corner: (N,) bool from `find_corners`; smoothing: 0 to 1.
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


def _fade(distance: Array, reach: Array | float) -> Array:
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
