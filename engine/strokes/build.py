"""Walks -> strokes: gather, smooth, weigh the ink, and keep few points."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..values import Stroke
from .bezier import fit
from .lines import Lines, Pieces
from .page import SAMPLES_PER_PEN, Page
from .simplify import simplify
from .smooth import corners, margin, smooth
from .walk import Walk

Array = np.ndarray

_WIDTH_BLUR = 1.0  # pen widths; sigma of the smoothing of widths and opacity along a stroke
_WIDTH_STEP = 0.12  # change of width, in pen widths, that is worth a point of its own
_OPACITY_STEP = 0.12
_SPECK = 0.25  # pen widths of ink that a lonely line needs beyond Settings.min_length


def build(page: Page, walks: Sequence[Walk]) -> list[Stroke]:
    """The strokes of walks, in their order; specks are left out.

    Every stroke depends on its own walk alone, so that the same walk always gives the same stroke.
    """
    walks = [w for w in walks if not _is_speck(page, w)]
    if not walks:
        return []
    settings = page.settings
    lines = Lines.of(page, walks, margin(settings.smoothing))
    raw = page.points[lines.sample]
    corner = corners(raw, lines)
    points = smooth(raw, lines, corner, settings.smoothing)
    widths, opacity = _ink(page, lines)

    place = np.arange(len(points))
    ends = np.zeros(len(points), bool)
    ends[lines.start] = ends[lines.stop - 1] = True
    # What continues a closed stroke round its seam has done its work.
    own = _between(place, lines.start, lines.stop)
    index = place[own]
    points, widths, opacity = points[own], widths[own], opacity[own]
    keep = (corner | lines.joint | ends)[own]
    handles = None
    if settings.curve == "bezier":
        kept, handles = fit(points, keep, (corner | ends)[own], settings.tolerance)
    else:
        also = np.column_stack([widths / (_WIDTH_STEP * page.pen), opacity / _OPACITY_STEP])
        kept = simplify(
            np.column_stack([points, also * max(settings.tolerance, 1e-6)]),
            keep,
            settings.tolerance,
        )
    strokes = []
    begin = np.searchsorted(index, lines.start)
    stop = np.searchsorted(index, lines.stop)
    for walk, low, high in zip(walks, begin, stop, strict=True):
        chosen = low + np.flatnonzero(kept[low:high])
        branches = np.array(walk.halves, np.int32)
        own_handles = None if handles is None else handles[chosen].astype(np.float32)
        if walk.closed:
            if own_handles is not None:
                own_handles[0, 0] = own_handles[-1, 0]
                own_handles = own_handles[:-1]
            chosen = chosen[:-1]
        strokes.append(
            Stroke(
                points=points[chosen].astype(np.float32),
                widths=widths[chosen].astype(np.float32),
                opacity=opacity[chosen].astype(np.float32),
                closed=walk.closed,
                color=page.inks.color_of(branches >> 1, page.length[branches >> 1]),
                branches=branches,
                handles=own_handles,
            )
        )
    return strokes


def _is_speck(page: Page, walk: Walk) -> bool:
    """Dust: a line that hangs on nothing and whose ink, caps included, is shorter than allowed."""
    branch = walk.halves[0] >> 1
    if not page.lonely[branch]:
        return False
    samples = slice(page.offsets[branch], page.offsets[branch + 1])
    ink = page.length[branch] + float(np.mean(page.widths[samples]))
    return ink < (page.settings.min_length + _SPECK) * page.pen


def _between(place: Array, start: Array, stop: Array) -> Array:
    edge = np.zeros(len(place) + 1, np.int64)
    np.add.at(edge, start, 1)
    np.add.at(edge, stop, -1)
    return np.cumsum(edge[:-1]) > 0


def _ink(page: Page, lines: Lines) -> tuple[Array, Array]:
    """Widths and opacity along the strokes, smoothed, and carried across junctions."""
    trust = page.trust[lines.sample] + 1e-6
    values = np.column_stack([page.widths[lines.sample], page.opacity[lines.sample]])
    weighted = np.column_stack([values * trust[:, None], trust])
    sigma = _WIDTH_BLUR * SAMPLES_PER_PEN
    runs = np.unique(lines.first)
    pieces = Pieces(runs, lines.last[runs], round(3 * sigma))
    pieces.put(pieces.blur(pieces.alone(weighted), sigma), weighted)
    values = weighted[:, :2] / weighted[:, 2:]
    return values[:, 0], np.clip(values[:, 1], 0.0, 1.0)
