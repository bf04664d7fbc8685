"""A second look, at a smaller scale, at lines too wide for the first.

The network knows pens of 1.5 to 8 px. Where a page has a broad one too, what the first look made
of its lines (rims, shreds, nothing) gives way to the centerline seen where they are 5 px wide,
drawn anew at the scale of the page.
"""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np

from .centerline import CenterlineProvider
from .centerline.mending import covered
from .graph import Evidence, build_graph
from .scan.wide_lines import WideLines
from .settings import Settings
from .values import Array, LineMaps, PlanarGraph, Scan

_PEN = 5.0  # px that a broad line is wide in the second look
_SEEN, _DOUBLE = 0.9, 1.6  # share of a line that one crest must cover; crests for its length
_CREST = 0.25  # of the centerline map
_AROUND = 2  # px; the soft edge of a line
_BITS = 4  # of a pixel, as OpenCV draws


def look_again(
    maps: LineMaps, scan: Scan, wide: WideLines, look: CenterlineProvider, settings: Settings
) -> LineMaps:
    """The maps, with those wide lines that the first look did not get seen anew.

    Args:
        maps: of the scan, in working pixels; wide: what is wide in it.
        look: the provider that made the maps.
    """
    missed = _missed(maps, wide)
    octave = np.round(np.log2(np.maximum(wide.widths, 1e-3)))
    for one in np.unique(octave[missed]):
        lines = missed[octave[missed] == one]
        maps = _seen_anew(maps, scan, wide, lines, look, settings)
    return maps


def _missed(maps: LineMaps, wide: WideLines) -> Array:
    """(K,) numbers of the wide lines that have not one crest along their middle."""
    place = wide.label > 0
    crest = (maps.centerline > _CREST) & place
    count = len(wide.widths)
    size = np.bincount(wide.label[place], minlength=count)
    seen = np.bincount(wide.label[place & covered(crest, place)], minlength=count)
    # A crest is about 2 px wide.
    crests = np.bincount(wide.label[crest], minlength=count) / 2
    bad = (seen < _SEEN * size) | (crests > _DOUBLE * wide.lengths)
    bad[0] = False
    return np.flatnonzero(bad)


def _seen_anew(
    maps: LineMaps,
    scan: Scan,
    wide: WideLines,
    lines: Array,
    look: CenterlineProvider,
    settings: Settings,
) -> LineMaps:
    """The maps with these lines, of about one width, seen where they are `_PEN` px wide."""
    scale = max(1.0, float(np.median(wide.widths[lines])) / _PEN)
    side = 2 * _AROUND + 1
    own = np.isin(wide.label, lines).view(np.uint8)
    near = cv2.dilate(own, np.ones((side, side), np.uint8)) > 0
    ink = np.where(near, scan.ink, np.float32(0))
    small = cv2.resize(ink, None, fx=1 / scale, fy=1 / scale, interpolation=cv2.INTER_AREA)
    # The grain of a pencil, averaged, is grey: full ink again.
    small = np.clip(small / max(float(np.quantile(small[small > 0.3], 0.7)), 0.3), 0, 1)
    seen = look(replace(scan, ink=small, color=None, pen_width=_PEN), lambda _: None)
    graph = build_graph(Evidence(seen, _PEN), settings)
    centerline = np.where(near, np.float32(0), maps.centerline)
    np.maximum(centerline, _drawn(graph, scale, near), out=centerline)

    def put(fine: Array | None, coarse: Array | None) -> Array | None:
        if fine is None or coarse is None:
            return fine
        return np.where(near, cv2.resize(coarse, fine.shape[::-1]), fine)

    half = maps.half_width
    return replace(
        maps,
        centerline=centerline,
        junctions=put(maps.junctions, seen.junctions),
        endpoints=put(maps.endpoints, seen.endpoints),
        half_width=None if half is None else np.where(near, wide.half_width, half),
        solid=put(maps.solid, seen.solid),
    )


def _drawn(graph: PlanarGraph, scale: float, near: Array) -> Array:
    """(H, W) float32 the branches of a coarse graph as crests of the fine map."""
    drawn = np.zeros(near.shape, np.uint8)
    for branch in range(graph.branch_count):
        points = np.round((graph.branch(branch) * scale - 0.5) * (1 << _BITS)).astype(np.int32)
        cv2.polylines(drawn, [points], False, 255, 2, cv2.LINE_AA, _BITS)
    return drawn.astype(np.float32) / 255
