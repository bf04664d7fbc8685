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

from ..arrays.components import components
from ..arrays.distance import depth
from ..values import Array, LineMaps, Scan
from .classical import classical

_CREST = 0.25  # of the centerline map; the graph follows a ridge from a third on
_SURE = 0.5  # of the map; 0.25 broke 7 of 343 crisp, even held-out lines, 0.35 to 0.65 break 3
_CLEAR, _SOME = 0.5, 0.12  # ink: what is surely drawn, and what may be
_BESIDE = 2.0  # px that ink may reach beyond the line that was seen in it
_SHORTEST = 3.0  # pen widths; a shorter piece of uncovered ink is an edge, a blot or grain
_BROKEN = (3.0, 8.0)  # pen widths, px: a longer crest over bare paper is no gap of the pen
_COVERED = 0.6  # of a piece that the ridge filter must cover to be believed
_DOT = 0.4  # squared pen widths of ink that a dot has at least
_MOST_DOTS = 2000  # more uncovered pieces are no dots but grain
_HALF_BLIND = (0.3, 0.5)  # end and junction maps where nobody looked: neither yes nor no
_CONTEXT = 12  # pen widths that the ridge filter sees around a piece


@dataclass(frozen=True, eq=False)
class _Pieces:
    """Connected pieces: (H, W) their labels, 0 = none; (K,) sizes and boxes of those chosen."""

    label: Array
    chosen: Array
    stats: Array


def mended(maps: LineMaps, scan: Scan, done: Array | None = None) -> LineMaps:
    """The maps with the lines that the network left out, and without those it made up.

    Args:
        maps: of the network; where the ridge filter was asked, half_width is NaN.
        scan: what it looked at.
        done: (H, W) bool, where lines have been looked at twice already.
    """
    crest = maps.centerline > _CREST
    maps = _without_made_up(maps, crest, scan)
    clear = scan.ink > _CLEAR
    if done is not None:
        clear &= ~done
    if not clear.any():
        return maps
    uncovered = clear & ~covered(crest, clear)
    found, good = np.zeros_like(scan.ink), np.zeros_like(clear)
    lost = _long(uncovered, _SHORTEST * scan.pen_width)
    if len(lost.chosen):
        found = _ridges_near(lost, scan)
        good = _believed(lost, found > _CREST, clear)
    good |= _with_dots(found, clear, uncovered & ~good, scan.pen_width)
    if not good.any():
        return maps
    reach = int(np.ceil(scan.pen_width)) + 4
    near = cv2.dilate(good.view(np.uint8), np.ones((2 * reach + 1, 2 * reach + 1), np.uint8)) > 0
    # Beside a crest that it is sure of the network knows better.
    sure = (maps.centerline > _SURE).view(np.uint8)
    near &= cv2.dilate(sure, np.ones((3, 3), np.uint8)) == 0
    return _merged(maps, found, near)


def covered(crest: Array, clear: Array) -> Array:
    """(H, W) bool: the pixels no farther from a crest than the ink there is deep, or a little more.

    Args:
        crest, clear: (H, W) bool, where lines run and where ink is.
    """
    if not crest.any():
        return crest
    deep = depth(clear.view(np.uint8))[crest]  # before the two large arrays that follow
    away, nearest = cv2.distanceTransformWithLabels(
        (~crest).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5, labelType=cv2.DIST_LABEL_PIXEL
    )
    half = np.zeros(int(nearest.max()) + 1, np.float32)
    half[nearest[crest]] = deep
    reach = half[nearest]
    reach += _BESIDE
    return away <= reach


def _long(place: Array, shortest: float) -> _Pieces:
    """The connected pieces at least as long as that, px."""
    _, label, stats, _ = components(place.view(np.uint8))
    extent = np.hypot(stats[:, cv2.CC_STAT_WIDTH], stats[:, cv2.CC_STAT_HEIGHT])
    extent[0] = 0
    return _Pieces(label, np.flatnonzero(extent >= shortest), stats)


def _ridges_near(lost: _Pieces, scan: Scan) -> Array:
    """(H, W) the ridge filter's centerline around the pieces; 0 elsewhere."""
    height, width = scan.ink.shape
    margin = int(_CONTEXT * scan.pen_width) + 16
    # One look at boxes that overlap; the whole page where they are many.
    cells: Array = np.zeros((-(-height // margin), -(-width // margin)), np.uint8)
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
    size = np.bincount(lost.label[place & covered(crest & place, clear)], minlength=len(lost.stats))
    good = size >= _COVERED * lost.stats[:, cv2.CC_STAT_AREA]
    good[0] = False
    return place & good[lost.label]


def _with_dots(found: Array, clear: Array, uncovered: Array, pen: float) -> Array:
    """Draw a crest into each small piece of ink that has none at all; (H, W) bool, these pieces.

    A dot gets a crest just long enough to have a direction, a dash one through its middle.
    """
    count, label, stats, middle = components(clear.view(np.uint8))
    size = stats[:, cv2.CC_STAT_AREA]
    whole = np.bincount(label[uncovered], minlength=count) >= size
    extent = stats[:, [cv2.CC_STAT_WIDTH, cv2.CC_STAT_HEIGHT]].max(1)
    whole &= (size >= _DOT * pen**2) & (extent <= (_SHORTEST + 1) * pen)
    whole[0] = False
    if not 0 < np.count_nonzero(whole) <= _MOST_DOTS:
        return np.zeros_like(clear)
    rows, columns = np.nonzero(whole[label])
    piece = label[rows, columns]
    x, y = columns - middle[piece, 0], rows - middle[piece, 1]
    xx, xy, yy = (np.bincount(piece, v, count) / size for v in (x * x, x * y, y * y))
    # A rod's variance is a twelfth of its length squared.
    mean, spread = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
    long, wide = np.sqrt(12 * (mean + spread)), np.sqrt(12 * np.maximum(mean - spread, 0))
    angle = 0.5 * np.arctan2(2 * xy, xx - yy)
    arm = np.maximum(long - wide, 1.0)[:, None] / 2 * np.stack([np.cos(angle), np.sin(angle)], 1)
    for k in np.flatnonzero(whole):
        ends = np.round((middle[k] + np.outer((-1, 1), arm[k])) * 16).astype(np.int32)
        cv2.line(found, tuple(ends[0].tolist()), tuple(ends[1].tolist()), 1.0, 2, shift=4)
    return whole[label]


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
    lines = np.isin(made_up.label, made_up.chosen).astype(np.uint8)
    gone = cv2.dilate(lines, np.ones((5, 5), np.uint8)) > 0
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
