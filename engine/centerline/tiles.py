"""Tiles: the inked part of a page, cut into rectangles that a network can look at one by one.

White paper is never looked at; memory is bounded by the tile. Windows overlap: a network sees
CONTEXT px beyond its tile, as far as its answer depends on, so there are no seams to hide.

A network that halves its maps answers a little differently when a drawing moves by a pixel. So
blocks are counted from the middle of the ink, not from the corner of the page: the same drawing
gets the same answer wherever it lies on its sheet.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np

from ..values import Array

BLOCK = 32  # px; tiles begin and end at multiples of it (and of the network's stride)
BEYOND = 16  # px of paper around the page: a network answers differently at the rim of what it sees
CONTEXT = 96  # px that a network sees beyond a tile, so that the tile's size makes no difference
# px of a window at most, which bounds the memory (540 MB, or 240 MB on pages that are large
# themselves). Windows of 1536 x 1536 px look at 14 to 56 % less than those of 1024 x 1024 px on A4
# pages, and a page of 1024 px is one window. They may be long: strips overlap less than squares.
LARGEST, LARGEST_OF_LARGE = 1536**2, 1024**2
_LARGE = 24_000_000  # px of a page
_PAPER_CONTEXT = 64  # px, where it is blank
_CELL = 16  # px; ink is looked for in cells of this size
_INK = 0.04  # mean of 3x3 px above which paper counts as inked
_SURE_INK = 0.3  # what is fainter does not say where the middle of the ink is
_BAND = 512  # px; rows looked at together when there is no window, which bounds the memory
_OVERHEAD = 1.0  # blocks; what the call of a network costs beside its pixels
_AROUND = 2 * CONTEXT // BLOCK  # blocks that a window has more than its tile, either way
# Cuts that are tried where no more than so many windows are left to be found. On pages of 2048 px
# and A4 two save up to a quarter of what one does, four no more, in up to six times the time.
_TRIED, _FORESEEN = 2, 8

_Box = tuple[int, int, int, int]  # top, left, bottom, right in blocks


@dataclass(frozen=True)
class Tile:
    """Half-open ranges in px; may reach beyond the page."""

    top: int
    left: int
    bottom: int
    right: int

    @property
    def area(self) -> int:
        return (self.bottom - self.top) * (self.right - self.left)

    def window(self, active: Array, height: int, width: int) -> tuple[slice, slice]:
        """Rows and columns of the tile and its context, on a page of the given size and a rim of
        BEYOND px of paper around it.

        Where all that is white paper, less of it will do.
        """
        top, left, bottom, right = (
            edge // BLOCK for edge in (self.top, self.left, self.bottom, self.right)
        )
        reach = CONTEXT // BLOCK
        rows = slice(max(0, top - reach), bottom + reach)
        columns = slice(max(0, left - reach), right + reach)
        above = CONTEXT if active[rows.start : top, columns].any() else _PAPER_CONTEXT
        below = CONTEXT if active[bottom : rows.stop, columns].any() else _PAPER_CONTEXT
        before = CONTEXT if active[rows, columns.start : left].any() else _PAPER_CONTEXT
        after = CONTEXT if active[rows, right : columns.stop].any() else _PAPER_CONTEXT
        return (
            slice(max(-BEYOND, self.top - above), min(height + BEYOND, self.bottom + below)),
            slice(max(-BEYOND, self.left - before), min(width + BEYOND, self.right + after)),
        )


def plan(active: Array) -> list[Tile]:
    """Tiles that cover all active blocks (2-D bool) and as few others as possible."""
    largest = LARGEST if active.size * BLOCK**2 <= _LARGE else LARGEST_OF_LARGE
    height, width = active.shape
    _, boxes = _Cover(active, largest).of((0, 0, height, width))
    return [Tile(*(BLOCK * edge for edge in box)) for box in sorted(boxes)]


def shift_of(ink: Array) -> tuple[int, int]:
    """Rows and columns of paper, 0 to BLOCK - 1, that put the middle of the ink (H, W) on a corner
    of blocks when they are added above and to the left of it."""
    rows, columns = np.zeros(ink.shape[0]), np.zeros(ink.shape[1])
    for top in range(0, len(ink), _BAND):
        band = np.maximum(ink[top : top + _BAND] - np.float32(_SURE_INK), 0)
        rows[top : top + _BAND] = band.sum(1, dtype=np.float64)
        columns += band.sum(0, dtype=np.float64)
    mass = rows.sum()
    if mass == 0:
        return 0, 0
    middle = ((sums * np.arange(len(sums))).sum() / mass for sums in (rows, columns))
    down, right = (-int(np.floor(place + 0.5)) % BLOCK for place in middle)
    return down, right


def moved(ink: Array, rows: slice, columns: slice, shift: tuple[int, int]) -> Array:
    """A part of the page as it lies when `shift` rows and columns of paper are put before it;
    beyond the page there is paper."""
    spans, around = [], []
    for span, before, side in zip((rows, columns), shift, ink.shape, strict=True):
        start, stop = span.start - before, span.stop - before
        spans.append(slice(max(0, start), max(0, stop)))
        around.append((max(0, -start), max(0, stop - side)))
    part = ink[spans[0], spans[1]]
    return np.ascontiguousarray(np.pad(part, around) if np.any(around) else part)


def active_blocks(ink: Array, shift: tuple[int, int] = (0, 0)) -> Array:
    """Which blocks of BLOCK px hold ink, or have some within _CELL px.

    Args:
        ink: (H, W) float32.
        shift: rows and columns of paper that come before it.

    Returns:
        (ceil((H + down) / BLOCK), ceil((W + right) / BLOCK)) bool.
    """
    height, width = (side + more for side, more in zip(ink.shape, shift, strict=True))
    rows, columns = -(-height // _CELL), -(-width // _CELL)
    cells: Array = np.zeros((rows, columns), np.uint8)
    for top in range(0, height, _BAND):
        band = moved(ink, slice(top, min(top + _BAND, height)), slice(0, width), shift)
        seen = cv2.blur(band, (3, 3)) > _INK
        seen = np.pad(seen, ((0, -len(seen) % _CELL), (0, -width % _CELL)))
        shape = (len(seen) // _CELL, _CELL, columns, _CELL)
        cells[top // _CELL :][: shape[0]] = seen.reshape(shape).any((1, 3))
    cells = cv2.dilate(cells, np.ones((3, 3), np.uint8))
    per = BLOCK // _CELL
    cells = np.pad(cells, ((0, -rows % per), (0, -columns % per)))
    return cells.reshape(cells.shape[0] // per, per, -1, per).any((1, 3))


class _Cover:
    """The rectangles over all active blocks that cost the least to look at.

    A rectangle is cut in two, again and again, as long as its window is too large or cutting is
    cheaper than not. What seem the best cuts are tried where few windows are left to be found.
    """

    def __init__(self, active: Array, largest: int) -> None:
        self._active, self._largest = active, largest
        self._known: dict[_Box, tuple[float, list[_Box]]] = {}

    def of(self, box: _Box) -> tuple[float, list[_Box]]:
        """What the active blocks in a rectangle cost, and disjoint rectangles that hold them."""
        trimmed = _trim(self._active, box)
        if trimmed is None:
            return 0.0, []
        if trimmed not in self._known:
            self._known[trimmed] = self._cut(trimmed)
        return self._known[trimmed]

    def _cut(self, box: _Box) -> tuple[float, list[_Box]]:
        top, left, bottom, right = box
        inside = self._active[top:bottom, left:right]
        height, width = self._active.shape
        fits = _window(top, bottom, height) * _window(left, right, width) <= self._largest
        whole = _window_cost(*inside.shape) if fits else float("inf")
        best = whole, [box]
        tried = _TRIED if inside.size * BLOCK**2 <= _FORESEEN * self._largest else 1
        cuts = [(*cut, True) for cut in _cuts(inside, self._largest)]
        cuts += [(*cut, False) for cut in _cuts(inside.T, self._largest)]
        for cost, _, place, across in sorted(cuts)[:tried]:
            if cost >= whole:
                break
            middle = (top + place, right) if across else (bottom, left + place)
            rest = (top + place, left) if across else (top, left + place)
            parts = self.of((top, left, *middle)), self.of((*rest, bottom, right))
            total = parts[0][0] + parts[1][0]
            if total < best[0]:
                best = total, parts[0][1] + parts[1][1]
        return best


def _window(start: int, stop: int, length: int) -> int:
    """The extent in px of a tile with its context, as far as the page and the paper around it
    reach; given in blocks."""
    end = min(length * BLOCK + BEYOND, stop * BLOCK + CONTEXT)
    return end - max(-BEYOND, start * BLOCK - CONTEXT)


def _trim(active: Array, box: _Box) -> _Box | None:
    top, left, bottom, right = box
    rows = np.flatnonzero(active[top:bottom, left:right].any(1))
    columns = np.flatnonzero(active[top:bottom, left:right].any(0))
    if not len(rows):
        return None
    return (
        top + int(rows[0]),
        left + int(columns[0]),
        top + int(rows[-1]) + 1,
        left + int(columns[-1]) + 1,
    )


def _window_cost(height: Array | float, width: Array | float) -> Any:
    """What looking at a tile costs, in blocks, its context included."""
    return (height + _AROUND) * (width + _AROUND) + _OVERHEAD


def _cost(height: Array, width: Array, largest: int) -> Array:
    """(N,) what looking at rectangles costs, in blocks, each cut evenly into tiles that fit."""
    most = largest / BLOCK**2
    cost: Array = np.full(len(height), np.inf)
    for columns in range(1, 2 + int(width.max() / (most**0.5 - _AROUND))):
        high = most / (width / columns + _AROUND) - _AROUND  # of a tile
        rows = np.ceil(height / np.maximum(high, 1))
        cost = np.minimum(cost, rows * columns * _window_cost(height / rows, width / columns))
    return cost


def _cuts(active: Array, largest: int) -> list[tuple[float, float, int]]:
    """For each row of a block mask but the first the cost of both parts when it is cut above it, as
    far as can be told, how uneven they are, and the row."""
    if len(active) < 2:
        return []
    row = np.arange(1, len(active))
    cost = _upper_cost(active, largest)[:-1] + _upper_cost(active[::-1], largest)[::-1][1:]
    uneven = np.abs(row - len(active) / 2)
    return list(zip(np.round(cost, 3).tolist(), uneven.tolist(), row.tolist(), strict=True))


def _upper_cost(active: Array, largest: int) -> Array:
    """(rows,) what the rows 0 to k of a block mask cost; the first one has active blocks."""
    rows, columns = active.shape
    used = active.any(1)
    left = np.minimum.accumulate(np.where(used, active.argmax(1), columns))
    right = np.maximum.accumulate(np.where(used, columns - active[:, ::-1].argmax(1), 0))
    bottom = np.maximum.accumulate(np.where(used, np.arange(1, rows + 1), 0))
    return _cost(bottom, right - left, largest)


def look(
    ink: Array,
    infer: Callable[[Array], Iterable[Array]],
    maps: Sequence[Array | None],
    tick: Callable[[float], None],
    shift: tuple[int, int] | None = None,
    wanted: Array | None = None,
) -> None:
    """Run a network over all inked blocks of a page and write its answers into the maps.

    Args:
        ink: (H, W) float32.
        infer: (h, w) float32 window of any size -> its maps, (h, w) float32; those at half the
            resolution are (h / 2, w / 2), rounded up.
        maps: as many arrays (H, W) or (H / 2, W / 2), float32, zero, and left so on white paper;
            None = not wanted.
        tick: called with the fraction that is done; what it raises passes through.
        shift: rows and columns of paper before the page; None = those of `shift_of`.
        wanted: which blocks are to be answered, of the page so shifted; None = all with ink.
    """
    shift = shift_of(ink) if shift is None else shift
    active = active_blocks(ink, shift)
    asked = active if wanted is None else active & wanted
    height, width = ink.shape[0] + shift[0], ink.shape[1] + shift[1]
    tiles = plan(asked)
    total = sum(tile.area for tile in tiles)
    done = 0
    for tile in tiles:
        tick(done / total)
        rows, columns = tile.window(active, height, width)
        answers = infer(moved(ink, rows, columns, shift))
        # The tile without the paper that was put before the page, and what lies beyond it.
        top, left = max(tile.top, shift[0]), max(tile.left, shift[1])
        bottom, right = min(tile.bottom, height), min(tile.right, width)
        inked = asked[np.arange(top, bottom)[:, None] // BLOCK, np.arange(left, right) // BLOCK]
        corner = top - rows.start, left - columns.start
        place = top - shift[0], left - shift[1]
        for answer, target in zip(answers, maps, strict=True):
            if target is not None:
                _put(target, answer, inked, place, corner, 1 if target.shape == ink.shape else 2)
        done += tile.area
    tick(1.0)


def _put(
    target: Array,
    answer: Array,
    inked: Array,
    place: tuple[int, int],
    corner: tuple[int, int],
    step: int,
) -> None:
    """Write a tile's part of an answer into a map of the page, white paper left at zero.

    Args:
        inked: (h, w) bool, which pixels of the tile lie in blocks with ink.
        place: where the tile begins on the page, px. corner: where it begins in the window.
        step: px of the page per cell of the map; a map of half the resolution lies up to half a
            cell beside the page where that does not begin at an even pixel of the grid.
    """
    seen = inked[::step, ::step]
    (y, x), (row, column) = (v // step for v in place), (v // step for v in corner)
    found = answer[row : row + seen.shape[0], column : column + seen.shape[1]]
    part = target[y : y + found.shape[0], x : x + found.shape[1]]
    part[:] = (found * seen[: found.shape[0], : found.shape[1]])[: part.shape[0], : part.shape[1]]
