"""What a page carries besides the drawing: scan borders, punched holes, registration marks.

They are found by what they are, not by a colour: a border is dark up to the picture's edge and ends
in a straight line; holes stand in line near one edge, in the pattern of a peg bar or a file punch;
registration marks are small crosses that occur alike at distant edges. Nothing of them is traced,
and holes and marks tell how the page lay on the scanner.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations, pairwise
from os import PathLike
from pathlib import Path

import cv2
import numpy as np

from ..arrays.components import components
from ..errors import InvoluteError
from ..settings import Settings
from ..values import Array, Scan

_DARK = 0.35  # ink
_MARGIN = 0.16  # of the page: how far from its edges holes and marks are looked for
_DEEPEST = 0.15  # of the page: a wider black area is a drawn one
_PEN = (0.4, 1.6)  # pen widths: how wide a line along the edge is, which may be cut off by it
_WORKING_SIDE = 3000  # px; larger pages are looked at smaller
_LOOSE = 0.02  # of the distance between the holes: how far they may miss those of the first page
_WHITE, _LIGHTER = 235, 0.4  # of 255: no sheet is tinted; share of what is left up to white
_RIM = 0.15  # of a hole's width: how far its shadow lies around it
_SIZES = (0.007, 0.09)  # of the page's longer side: smallest and largest hole or mark


@dataclass(frozen=True, eq=False)
class Marks:
    """What was found; points in pixels of the picture that was looked at.

    anchors: (K, 2) float32, the middles of the holes, or else of the registration marks, in an
        order that depends only on the page: K = 3 for a peg bar, 2 to 4 for a file punch, 0 when
        there are none.
    mask: (H, W) bool, all that must not be traced.
    names: what it is, for people.
    """

    anchors: Array
    mask: Array
    names: tuple[str, ...] = ()


def set_aside(scan: Scan, settings: Settings) -> Scan:
    """Take borders, holes and marks out of a scan; align it when the settings say where to.

    With `settings.align`, the page is turned and moved so that its holes or marks lie there; a page
    without such ones stays as it lies and says so.
    """
    wanted = np.array(settings.align, np.float32).reshape(-1, 2) / scan.scale
    if not settings.marks or settings.provider == "given":
        return replace(scan, aligned=not len(wanted))
    marks = find_marks(scan.ink, scan.pen_width, scan.color)
    if marks.mask.any():
        note = f"Left out as no part of the drawing: {', '.join(marks.names)}."
        ink = np.where(marks.mask, np.float32(0), scan.ink)
        scan = replace(scan, ink=ink, notes=(*scan.notes, note))
    if not len(wanted):
        return scan
    if len(wanted) != len(marks.anchors):
        return replace(scan, aligned=False)
    motion = rigid(marks.anchors, wanted)
    off = np.hypot(*(cv2.transform(marks.anchors[:, None], motion)[:, 0] - wanted).T).max()
    if off > _LOOSE * np.hypot(*np.ptp(wanted, axis=0)):  # other holes than the first page's
        return replace(scan, aligned=False)
    return _moved(scan, motion)


def anchors_of(scan: Scan) -> tuple[tuple[float, float], ...]:
    """The holes or marks of a page in pixels of the input, as `Settings.align` wants them."""
    marks = find_marks(scan.ink, scan.pen_width, scan.color)
    return tuple((float(x), float(y)) for x, y in marks.anchors * scan.scale)


def first_anchors(
    path: str | PathLike[str], page: int, settings: Settings
) -> tuple[tuple[float, float], ...]:
    """The same for the page that a whole sequence is aligned to.

    Raises:
        InvoluteError: it can't be read, or there is nothing on it to align by.
    """
    from .preparing import read_scan

    anchors = anchors_of(read_scan(path, settings, page))
    if len(anchors) < 2:
        raise InvoluteError(
            f"There are no peg holes or registration marks on {Path(path).name}; "
            "trace it without aligning."
        )
    return anchors


def find_marks(ink: Array, pen_width: float, color: Array | None = None) -> Marks:
    """Find everything on a page that is not drawn.

    Args:
        ink: (H, W) float32, 1 = full ink.
        pen_width: typical width of a line, px.
        color: (H, W, 3) uint8, the page: through holes in a tinted sheet one sees what is lighter.
    """
    height, width = ink.shape
    shrink = max(1.0, max(ink.shape) / _WORKING_SIDE)
    if shrink > 1:
        ink = cv2.resize(ink, None, fx=1 / shrink, fy=1 / shrink, interpolation=cv2.INTER_AREA)
        pen_width = max(1.0, pen_width / shrink)
    dark = (ink > _DARK).astype(np.uint8)
    mask = _borders(dark, pen_width)
    names = ["dark borders of the scan"] if mask.any() else []
    dark[mask] = 0
    blobs = _blobs(dark, pen_width)
    holes = _peg_holes(blobs, ink.shape)
    rim = 0.0
    if not holes and color is not None:
        holes = _peg_holes(_blobs(_lighter(color, dark.shape), pen_width), ink.shape)
        rim = _RIM  # and the shadow that falls on it
    crosses = _crosses(blobs, ink.shape)
    names += [f"{len(holes)} punched holes"] if holes else []
    names += [f"{len(crosses)} registration marks"] if crosses else []
    for blob in crosses:
        _stamp(mask, blob, pen_width)
    for blob in holes:
        _stamp(mask, blob, pen_width + rim * min(blob.size))
    if shrink > 1:
        whole = cv2.resize(mask.view(np.uint8), (width, height), interpolation=cv2.INTER_NEAREST)
        mask = whole.view(bool)
    anchors = np.array([blob.middle for blob in holes or crosses], np.float32).reshape(-1, 2)
    return Marks(anchors * np.float32(shrink), mask, tuple(names))


def rigid(source: Array, target: Array) -> Array:
    """The turn and shift that move one set of points onto another best, (2, 3) float32.

    Least squares without a change of scale (Kabsch 1976).
    """
    a, b = source - source.mean(axis=0), target - target.mean(axis=0)
    angle = np.arctan2((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum(), (a * b).sum())
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    shift = target.mean(axis=0) - turn @ source.mean(axis=0)
    return np.hstack([turn, shift[:, None]]).astype(np.float32)


def _moved(scan: Scan, motion: Array) -> Scan:
    height, width = scan.ink.shape
    # Our pixel centres lie at +0.5, OpenCV's at 0.
    motion = motion.copy()
    motion[:, 2] += motion[:, :2] @ np.array([0.5, 0.5], np.float32) - 0.5
    ink = cv2.warpAffine(scan.ink, motion, (width, height), flags=cv2.INTER_CUBIC)
    color = scan.color
    if color is not None:
        white = (255, 255, 255)
        color = cv2.warpAffine(color, motion, (width, height), borderValue=white)
    return replace(scan, ink=np.clip(ink, 0, 1), color=color, overlooked=None)


def _borders(dark: Array, pen_width: float) -> Array:
    """(H, W) bool: black that reaches in from an edge of the picture up to a straight line."""
    mask = np.zeros(dark.shape, bool)
    # Where the page lies askew, a short wedge at one side goes with a long one at another.
    for shortest in (0.2, 0.03):
        for side in range(4):
            depth = _border_depth(np.rot90(dark, side), pen_width, shortest)
            rows = np.arange(dark.shape[side % 2])[:, None]
            np.rot90(mask, side)[rows < depth] = True  # a view: writes through
        if not mask.any():
            break
    return mask


def _border_depth(dark: Array, pen_width: float, shortest: float) -> Array:
    """How far a border reaches down from the top edge in each column, px; 0 = there is none.

    shortest: the share of the edge that it must take up.
    """
    height, width = dark.shape
    deepest = int(_DEEPEST * height)
    strip = dark[: deepest + 4].astype(bool)
    strip[:3] |= strip[3:4].any(axis=0)  # scanners leave a few odd rows at the very edge
    depth = np.where(strip.all(axis=0), len(strip), strip.argmin(axis=0)).astype(np.float32)
    # Lines that end on the border are narrow; a border is not.
    window = max(3, int(6 * pen_width)) | 1
    depth = cv2.morphologyEx(depth[None], cv2.MORPH_OPEN, np.ones((1, window), np.uint8))[0]
    there = np.flatnonzero((depth > 0) & (depth <= deepest))
    if len(there) < max(shortest * width, window) or not _is_straight(there, depth, pen_width):
        return np.zeros(width, np.int64)
    if _is_line(there, depth, dark, pen_width):
        return np.zeros(width, np.int64)
    edge = np.where(depth > 0, depth + 1.5 * pen_width + 1, 0)
    return cv2.dilate(edge[None], np.ones((1, window), np.uint8))[0].astype(np.int64)


def _is_line(there: Array, depth: Array, dark: Array, pen_width: float) -> bool:
    """Whether a border is a drawn line along the edge: as wide as the pen all along, and at either
    end it stops short of the picture's corner, or turns and leaves the edge.

    A border of the scanner is wider, thins out where the page lies askew, or runs out of the
    picture.
    """
    typical = float(np.median(depth[there]))
    even = np.percentile(np.abs(depth[there] - typical), 80) < 0.25 * pen_width + 1
    if not (_PEN[0] * pen_width < typical < _PEN[1] * pen_width and even):
        return False
    reach = int(4 * pen_width) + 4
    below = slice(int(typical + 1.5 * pen_width) + 1, int(typical + 1.5 * pen_width) + 1 + reach)

    def goes_on(end: int, corner: int) -> bool:
        near = slice(max(0, end - reach), end + reach)
        return abs(end - corner) > reach or dark[below, near].any(axis=1).all()

    return goes_on(int(there[0]), 0) and goes_on(int(there[-1]), dark.shape[1] - 1)


def _is_straight(there: Array, depth: Array, pen_width: float) -> bool:
    """Whether most of a border's inner edge lies on one line."""
    points = np.stack([there, depth[there]], 1).astype(np.float32)
    dx, dy, x, y = cv2.fitLine(points, cv2.DIST_HUBER, 0, 0.01, 0.01).ravel()
    off = np.abs((points[:, 0] - x) * dy - (points[:, 1] - y) * dx)
    return bool(np.mean(off < 2 * pen_width) > 0.7)


@dataclass(frozen=True, eq=False)
class _Blob:
    """A small connected piece of ink near an edge; `mask` (h, w) uint8, x and y of its corner."""

    x: int
    y: int
    mask: Array

    @cached_property
    def filled(self) -> Array:
        """The blob with all that it encloses: a ring becomes a disc."""
        outlines, _ = cv2.findContours(self.mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
        return cv2.drawContours(np.zeros_like(self.mask), outlines, -1, 1, cv2.FILLED)

    @cached_property
    def middle(self) -> tuple[float, float]:
        """Its centre of gravity on the page, px."""
        rows, columns = np.nonzero(self.filled)
        return float(self.x + columns.mean() + 0.5), float(self.y + rows.mean() + 0.5)

    @property
    def size(self) -> tuple[int, int]:
        return self.mask.shape[1], self.mask.shape[0]

    def is_round(self) -> bool:
        width, height = self.size
        return 0.8 < width / height < 1.25 and abs(self.filled.mean() / (np.pi / 4) - 1) < 0.1

    def is_slot(self) -> bool:
        long, short = max(self.size), min(self.size)
        # A slot with round ends lies between an ellipse and a full box.
        return 1.7 < long / short < 6 and self.filled.mean() > 0.8

    def is_cross(self) -> bool:
        """Alike after a quarter turn, inked in its middle and where its axes meet its box."""
        width, height = self.size
        if not 0.85 < width / height < 1.18:
            return False
        small = self.sketch()
        n = len(small)
        middle = slice(n // 2 - 2, n // 2 + 2)
        arms = [small[:2, middle], small[-2:, middle], small[middle, :2], small[middle, -2:]]
        if not all(arm.max() > 0 for arm in (*arms, small[middle, middle])):
            return False
        return likeness(small, np.rot90(small)) > 0.6 and small.mean() < 0.7

    def sketch(self) -> Array:
        """The blob at a size at which all can be compared, (24, 24) float32."""
        return cv2.resize(self.mask.astype(np.float32), (24, 24), interpolation=cv2.INTER_AREA)


def likeness(a: Array, b: Array) -> float:
    """Overlap of two sketches: 1 = equal, 0 = disjoint."""
    return float(np.minimum(a, b).sum() / max(np.maximum(a, b).sum(), 1e-6))


def _blobs(dark: Array, pen_width: float) -> list[_Blob]:
    """The pieces of ink near an edge that have the size of a hole or mark."""
    height, width = dark.shape
    count, labels, stats, _ = components(dark)
    x, y, w, h = stats[:, :4].T
    low, high = (share * max(dark.shape) for share in _SIZES)
    middle_x, middle_y = (x + w / 2) / width, (y + h / 2) / height
    near = np.minimum.reduce([middle_x, middle_y, 1 - middle_x, 1 - middle_y]) < _MARGIN
    long, short = np.maximum(w, h), np.minimum(w, h)
    sized = (long > max(low, 2 * pen_width)) & (short > 0.5 * low) & (long < high)
    chosen = np.flatnonzero(near & sized & (np.arange(count) > 0))
    blobs = []
    for k in chosen:
        piece = labels[y[k] : y[k] + h[k], x[k] : x[k] + w[k]] == k
        blobs.append(_Blob(int(x[k]), int(y[k]), piece.astype(np.uint8)))
    return blobs


def _lighter(color: Array, shape: tuple[int, ...]) -> Array:
    """(H, W) uint8, at a size: 1 where a page is clearly lighter than its sheet."""
    sheet = np.median(color[::8, ::8].reshape(-1, 3), axis=0)
    clear: Array = np.zeros(shape, np.uint8)
    if sheet.min() > _WHITE:  # nothing is lighter than that
        return clear
    small = (
        cv2.resize(color, shape[::-1], interpolation=cv2.INTER_AREA)
        if (color.shape[:2] != shape)
        else color
    )
    above = cv2.blur(small, (3, 3)).min(2).astype(np.int16) - int(sheet.min())
    clear = (above > _LIGHTER * (255 - int(sheet.min()))).astype(np.uint8)
    return cv2.morphologyEx(clear, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))


def _peg_holes(blobs: Sequence[_Blob], shape: tuple[int, ...]) -> list[_Blob]:
    """Slot, round hole, slot in line (a peg bar), or a row of round holes (a file punch), or none.

    From hole to hole it is many times the round hole's width: 16 for ACME and Oxberry bars, 13 for
    two holes after ISO 838, 14 for the three of American paper.
    """
    rounds = [b for b in blobs if b.is_round()]
    slots = [b for b in blobs if b.is_slot()]
    patterns = [
        (abs(_off_middle(left, hole, right)), [left, hole, right])
        for left, right in combinations(_sorted(slots), 2)
        for hole in rounds
        if _in_line(left, right, shape)
        and _alike(left, right)
        and 20 < _distance(left, right) / hole.size[0] < 50
        and abs(_off_middle(left, hole, right)) < 0.5 * hole.size[0]
    ]
    patterns += [(1.0, row) for row in (_row_of(b, rounds, shape) for b in rounds) if row]
    return min(patterns, key=lambda p: p[0], default=(0, []))[1]


def _row_of(hole: _Blob, rounds: Sequence[_Blob], shape: tuple[int, ...]) -> list[_Blob]:
    """The file punch that a round hole belongs to: 2 to 4 alike, evenly, about mid-page; or none.

    A longer row of dots is a drawn one.
    """
    row = _sorted(
        [b for b in rounds if b is hole or (_in_line(hole, b, shape) and _alike(hole, b))]
    )
    if not 2 <= len(row) <= 4 or not _centred(row[0], row[-1], shape):
        return []
    gaps = np.array([_distance(a, b) for a, b in pairwise(row)])
    even = np.ptp(gaps) < 0.05 * gaps.mean()
    return row if even and 10 < gaps.mean() / hole.size[0] < 20 else []


def _crosses(blobs: Sequence[_Blob], shape: tuple[int, ...]) -> list[_Blob]:
    """Registration marks: crosses that occur alike, at least two of them far apart."""
    crosses = _sorted([b for b in blobs if b.is_cross()])
    if len(crosses) > 64:  # a page full of crosses is a drawing
        return []
    marks = [
        one
        for one in crosses
        if any(
            other is not one
            and _distance(one, other) > 0.5 * min(shape)
            and _alike(one, other)
            and likeness(one.sketch(), other.sketch()) > 0.6
            for other in crosses
        )
    ]
    return marks if 2 <= len(marks) <= 8 else []


def _sorted(blobs: Sequence[_Blob]) -> list[_Blob]:
    return sorted(blobs, key=lambda b: b.middle)


def _distance(a: _Blob, b: _Blob) -> float:
    return float(np.hypot(a.middle[0] - b.middle[0], a.middle[1] - b.middle[1]))


def _alike(a: _Blob, b: _Blob) -> bool:
    """About the same size."""
    return all(abs(p - q) <= 0.2 * max(p, q) + 2 for p, q in zip(a.size, b.size, strict=True))


def _in_line(a: _Blob, b: _Blob, shape: tuple[int, ...]) -> bool:
    """Side by side along an edge of the page, which may lie a few degrees askew."""
    dx, dy = abs(a.middle[0] - b.middle[0]), abs(a.middle[1] - b.middle[1])
    height, width = shape
    ys, xs = ([p.middle[k] / side for p in (a, b)] for k, side in ((1, height), (0, width)))
    along_x = dy < 0.08 * dx and (max(ys) < _MARGIN or min(ys) > 1 - _MARGIN)
    along_y = dx < 0.08 * dy and (max(xs) < _MARGIN or min(xs) > 1 - _MARGIN)
    return along_x or along_y


def _centred(a: _Blob, b: _Blob, shape: tuple[int, ...]) -> bool:
    """Their middle lies about half-way along the edge."""
    axis = int(abs(a.middle[1] - b.middle[1]) > abs(a.middle[0] - b.middle[0]))
    half = 0.5 * (a.middle[axis] + b.middle[axis]) / shape[1 - axis]
    return abs(half - 0.5) < 0.1


def _off_middle(left: _Blob, hole: _Blob, right: _Blob) -> float:
    return float(
        np.hypot(*(np.add(left.middle, right.middle) / 2 - np.asarray(hole.middle, float)))
    )


def _stamp(mask: Array, blob: _Blob, pen_width: float) -> None:
    """Mark a blob, all that it encloses, and its soft edge."""
    grow = int(np.ceil(pen_width)) + 2
    filled = np.pad(blob.filled, grow)
    filled = cv2.dilate(filled, np.ones((2 * grow + 1, 2 * grow + 1), np.uint8)) > 0
    x, y = blob.x - grow, blob.y - grow
    height, width = mask.shape
    x0, y0 = max(x, 0), max(y, 0)
    target = mask[y0 : min(y + filled.shape[0], height), x0 : min(x + filled.shape[1], width)]
    target |= filled[y0 - y : y0 - y + target.shape[0], x0 - x : x0 - x + target.shape[1]]
