"""The network's answer compared with the ink, and mended by the ridge filter.

# Strategy: every clear pixel of ink must lie within half a line's width of a crest of the
# centerline map. Where a piece of ink as long as a stroke does not, the network has left out a
# line; there, and only there, the ridge filter's crests are taken, if they cover the piece. Crests
# that run over clear paper for longer than a pen may break off go.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np

from ..arrays.distance import depth
from ..values import Array, LineMaps, Scan
from .classical import classical

_CREST = 0.25  # of the centerline map; the graph follows a ridge from a third on
_CLEAR, _SOME = 0.5, 0.12  # ink: what is surely drawn, and what may be
_BESIDE = 2.0  # px that ink may reach beyond the line that was seen in it
_SHORTEST = 3.0  # pen widths; a shorter piece of uncovered ink is an edge, a blot or grain
_BROKEN = (3.0, 8.0)  # pen widths, px: a longer crest over bare paper is no gap of the pen
_COVERED = 0.6  # of a piece that the ridge filter must cover to be believed
_HALF_BLIND = (0.3, 0.5)  # end and junction maps where nobody looked: neither yes nor no
_CONTEXT = 12  # pen widths that the ridge filter sees around a piece


@dataclass(frozen=True, eq=False)
class _Pieces:
    """Connected pieces: (H, W) their labels, 0 = none; (K,) sizes and boxes of those chosen."""

    label: Array
    chosen: Array
    stats: Array


def mended(maps: LineMaps, scan: Scan) -> LineMaps:
    """The maps with the lines that the network left out, and without those it made up.

    Args:
        maps: of the network; where the ridge filter was asked, half_width is NaN.
        scan: what it looked at.
    """
    crest = maps.centerline > _CREST
    maps = _without_made_up(maps, crest, scan)
    clear = scan.ink > _CLEAR
    if not clear.any():
        return maps
    lost = _long(clear & ~_covered(crest, clear), _SHORTEST * scan.pen_width)
    if not len(lost.chosen):
        return maps
    found = _ridges_near(lost, scan)
    good = _believed(lost, found > _CREST, clear)
    if not good.any():
        return maps
    reach = int(np.ceil(scan.pen_width)) + 4
    near = cv2.dilate(good.view(np.uint8), np.ones((2 * reach + 1, 2 * reach + 1), np.uint8)) > 0
    # Beside a crest of its own the network knows better.
    near &= cv2.dilate(crest.view(np.uint8), np.ones((3, 3), np.uint8)) == 0
    return _merged(maps, found, near)


def _covered(crest: Array, clear: Array) -> Array:
    """(H, W) bool: the pixels within the half width of the line at the nearest crest, or a little
    beyond."""
    if not crest.any():
        return crest
    away, nearest = cv2.distanceTransformWithLabels(
        (~crest).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5, labelType=cv2.DIST_LABEL_PIXEL
    )
    half = np.zeros(int(nearest.max()) + 1, np.float32)
    half[nearest[crest]] = depth(clear.view(np.uint8))[crest]
    return away <= half[nearest] + _BESIDE


def _long(place: Array, shortest: float) -> _Pieces:
    """The connected pieces at least as long as that, px."""
    _, label, stats, _ = cv2.connectedComponentsWithStats(place.view(np.uint8))
    extent = np.hypot(stats[:, cv2.CC_STAT_WIDTH], stats[:, cv2.CC_STAT_HEIGHT])
    extent[0] = 0
    return _Pieces(label, np.flatnonzero(extent >= shortest), stats)


def _ridges_near(lost: _Pieces, scan: Scan) -> Array:
    """(H, W) the ridge filter's centerline around the pieces; 0 elsewhere."""
    height, width = scan.ink.shape
    margin = int(_CONTEXT * scan.pen_width) + 16
    # One look at boxes that overlap; the whole page where they are many.
    cells = np.zeros((-(-height // margin), -(-width // margin)), np.uint8)
    for x, y, w, h in lost.stats[lost.chosen, :4]:
        cells[y // margin : (y + h) // margin + 1, x // margin : (x + w) // margin + 1] = 1
    cells = cv2.dilate(cells, np.ones((3, 3), np.uint8))
    found = np.zeros_like(scan.ink)
    count, _, boxes, _ = cv2.connectedComponentsWithStats(cells, connectivity=4)
    for x, y, w, h in boxes[1:count, :4] * margin:
        window = (slice(y, min(y + h, height)), slice(x, min(x + w, width)))
        seen = classical(replace(scan, ink=np.ascontiguousarray(scan.ink[window])), _no_tick)
        found[window] = np.maximum(found[window], seen.centerline)
    return found


def _no_tick(_: float) -> None:
    """The ridge filter looks at small windows: nothing to tell."""


def _believed(lost: _Pieces, crest: Array, clear: Array) -> Array:
    """(H, W) bool: the lost pieces whose ink the new crests cover."""
    place = np.isin(lost.label, lost.chosen) if len(lost.chosen) else np.zeros_like(crest)
    covered = np.bincount(
        lost.label[place & _covered(crest & place, clear)], minlength=len(lost.stats)
    )
    good = covered >= _COVERED * lost.stats[:, cv2.CC_STAT_AREA]
    good[0] = False
    return place & good[lost.label]


def _without_made_up(maps: LineMaps, crest: Array, scan: Scan) -> LineMaps:
    """The maps without crests that run over bare paper."""
    if not crest.any():
        return maps
    ink = (scan.ink > _SOME).view(np.uint8)
    bare = crest & (cv2.dilate(ink, np.ones((5, 5), np.uint8)) == 0)
    if not bare.any():
        return maps
    pens, least = _BROKEN
    made_up = _long(bare, max(pens * scan.pen_width, least))
    if not len(made_up.chosen):
        return maps
    gone = np.isin(made_up.label, made_up.chosen).astype(np.uint8)
    gone = cv2.dilate(gone, np.ones((5, 5), np.uint8)) > 0
    return replace(maps, centerline=np.where(gone, np.float32(0), maps.centerline))


def _merged(maps: LineMaps, found: Array, near: Array) -> LineMaps:
    """The maps, with the centerline `found` where it is `near`; what else is seen there is
    unknown."""
    end, junction = _HALF_BLIND

    def unknown(seen: Array | None, value: float) -> Array | None:
        return None if seen is None else np.where(near, np.float32(value), seen)

    return replace(
        maps,
        centerline=np.where(near, found, maps.centerline),
        endpoints=unknown(maps.endpoints, end),
        junctions=unknown(maps.junctions, junction),
        half_width=unknown(maps.half_width, np.nan),
    )
