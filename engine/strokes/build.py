"""Walks -> strokes: gather, smooth, weigh the ink, and keep few points."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..values import Array, Stroke
from .bezier import fit
from .corners import find_corners, sharpen
from .dashing import dashes
from .fairing import margin, smooth
from .lines import Lines, Pieces
from .shared import SAMPLES_PER_PEN, Page
from .simplify import simplify
from .walk import Walk

_WIDTH_BLUR = 1.0  # pen widths; sigma of the smoothing of widths along a stroke
_OPACITY_BLUR = 3.0  # pen widths; the same of opacity, which is noisier
_FADES, _FADING = 0.15, 0.2  # a stroke fades when a fifth of it is so far from its typical opacity
_FAINTEST = 0.1  # opacity of a stroke at least, so that nothing is there that can't be seen
_WIDTH_STEP = 0.12  # change of width, in pen widths, that is worth a point of its own
_OPACITY_STEP = 0.12
_COARSER = 2.0  # times these steps for curves, which are to have few points
_POINT = 1e-3  # px; a line that is shorter is a point to whoever draws it
_SHRUNK = 0.1  # share of its reach that smoothing must leave of a line
_APART = 1e3  # between samples; so much more than any change of the ink


def build(page: Page, walks: Sequence[Walk]) -> list[Stroke]:
    """The strokes of walks, in their order.

    Every stroke depends on its own walk alone, so that the same walk always gives the same stroke.
    """
    if not walks:
        return []
    lines = Lines.of(page, walks, margin(page.settings.smoothing))
    raw = page.points[lines.sample]
    corner = find_corners(raw, lines)
    points = sharpen(raw, lines, corner, page.pen, page.size)
    points = _with_length(smooth(points, lines, corner, page.settings.smoothing), raw, lines)
    # Strong smoothing swings beyond the page where a line turns at its edge.
    points = points.clip(np.minimum(raw.min(0), 0.0), np.maximum(raw.max(0), page.size))
    widths, opacity = _ink(page, lines)
    kept, handles = _few(page, lines, corner, points, widths, opacity)
    kept |= _drawn_together(points, lines, kept, handles)

    even = dashes(page.bare[lines.sample], points, lines) if page.bare is not None else None
    strokes = []
    for number, (walk, start, stop) in enumerate(zip(walks, lines.start, lines.stop, strict=True)):
        chosen = start + np.flatnonzero(kept[start:stop])
        curve = None if handles is None else handles[chosen].astype(np.float32)
        if walk.closed:  # the last sample is the first again
            chosen = chosen[:-1]
            if curve is not None:
                curve[0, 0] = curve[-1, 0]
                curve = curve[:-1]
        branches = np.array(walk.halves, np.int32)
        strokes.append(
            Stroke(
                points=points[chosen].astype(np.float32),
                widths=(page.settings.width_scale * widths[chosen]).astype(np.float32),
                opacity=opacity[chosen].astype(np.float32),
                closed=walk.closed,
                color=page.inks.color_of(branches >> 1, page.length[branches >> 1]),
                branches=branches,
                handles=curve,
                dash=even[number] if even else None,
            )
        )
    return strokes


def _few(
    page: Page, lines: Lines, corner: Array, points: Array, widths: Array, opacity: Array
) -> tuple[Array, Array | None]:
    """Which samples become points of the strokes, and their Bezier handles if these are wanted.

    Ends, corners and the junctions that a stroke runs through are always points.
    """
    keep = corner | lines.joint
    keep[lines.start] = keep[lines.stop - 1] = True
    tolerance = page.settings.tolerance
    # A change of the ink is as good a reason for a point as a bend.
    ink = np.column_stack([widths / (_WIDTH_STEP * page.pen), opacity / _OPACITY_STEP])
    if page.settings.curve == "bezier":
        # Over the place along the line, so far apart that a distance is one of the ink alone.
        along = _APART * np.arange(len(points))
        keep = simplify(np.column_stack([along, ink / _COARSER]), keep, 1.0)
        return fit(points, lines.first, keep, corner, tolerance)
    return simplify(np.column_stack([points, ink * tolerance]), keep, tolerance), None


def _with_length(points: Array, raw: Array, lines: Lines) -> Array:
    """The smoothed points; a line that smoothing has drawn together to a point stays as it was."""
    away, run, begin = _away(points, lines)
    before = np.maximum.reduceat(_away(raw, lines)[0], begin)
    gone = np.maximum.reduceat(away, begin) < np.maximum(_POINT, _SHRUNK * before)
    return np.where(gone[run][:, None], raw, points)


def _drawn_together(points: Array, lines: Lines, kept: Array, handles: Array | None) -> Array:
    """(N,) bool: all samples of the lines whose few points would be one, as those of a small loop
    whose curve has no other point than where it begins and ends."""
    away, run, begin = _away(points, lines)
    inside = away >= 0
    reach = np.where(kept & inside, away, 0.0)
    gone = (np.maximum.reduceat(reach, begin) < _POINT)[run] & inside
    if handles is not None:
        handles[gone] = points[gone][:, None]  # straight from one to the next
    return gone


def _away(points: Array, lines: Lines) -> tuple[Array, Array, Array]:
    """(N,) px of each sample from where its line begins, -1 before and after the line itself; (N,)
    the line's number, and (S,) where its run begins."""
    begin = lines.first[lines.start]
    run = np.searchsorted(begin, lines.first)
    number = np.arange(len(points))
    inside = (number >= lines.start[run]) & (number < lines.stop[run])
    away = np.hypot(*(points - points[lines.start][run]).T)
    return np.where(inside, away, -1.0), run, begin


def _ink(page: Page, lines: Lines) -> tuple[Array, Array]:
    """Widths and opacity along the strokes, smoothed, and carried across junctions."""
    trust = page.trust[lines.sample] + 1e-6
    runs = np.unique(lines.first)
    found = []
    for values, blur in ((page.widths, _WIDTH_BLUR), (page.opacity, _OPACITY_BLUR)):
        sigma = blur * SAMPLES_PER_PEN
        pieces = Pieces(runs, lines.last[runs], round(3 * sigma))
        weighted = np.column_stack([values[lines.sample] * trust, trust])
        pieces.put(pieces.blur(pieces.alone(weighted), sigma), weighted)
        found.append(weighted[:, 0] / weighted[:, 1])
    widths, opacity = found
    if page.settings.even_width:
        widths = _typical(widths, trust, lines)
    solid = page.solid[page.inks.ink[lines.branch]]
    opacity = np.where(solid, 1.0, _steady(opacity, trust, lines))
    return widths, np.clip(opacity, _FAINTEST, 1.0)


def _steady(opacity: Array, trust: Array, lines: Lines) -> Array:
    """One opacity a stroke, unless it really changes along it."""
    typical = _typical(opacity, trust, lines)
    far = np.abs(opacity - typical)
    run = np.cumsum(lines.first == np.arange(len(lines.first))) - 1
    share = np.bincount(run, far > _FADES) / np.bincount(run)
    return np.where(share[run] > _FADING, opacity, typical)


def _typical(values: Array, trust: Array, lines: Lines) -> Array:
    """(N,) the mean along each run, weighed by how far the samples can be trusted."""
    run = np.cumsum(lines.first == np.arange(len(lines.first))) - 1
    mean = np.bincount(run, trust * values) / np.bincount(run, trust)
    return mean[run]
