"""Tiles: the inked part of a page, cut into rectangles that a network can look at one by one.

White paper is never looked at; memory is bounded by the tile. Windows overlap: a network sees
CONTEXT px beyond its tile, as far as its answer depends on, so there are no seams to hide.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from ..values import Array

BLOCK = 32  # px; tiles begin and end at multiples of it (and of the network's stride)
CONTEXT = 96  # px that a network sees beyond a tile, so that the tile's size makes no difference
LARGEST = 1024  # px; longest side of a window, which bounds the memory
_PAPER_CONTEXT = 64  # px, where it is blank
_CELL = 16  # px; ink is looked for in cells of this size
_INK = 0.04  # mean of 3x3 px above which paper counts as inked
_OVERHEAD = 1.0  # blocks; what the call of a network costs beside its pixels


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
        """Rows and columns of the tile and its context, on a page of the given size.

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
            slice(max(0, self.top - above), min(height, self.bottom + below)),
            slice(max(0, self.left - before), min(width, self.right + after)),
        )


def plan(active: Array) -> list[Tile]:
    """Tiles that cover all active blocks (2-D bool) and as few others as possible."""
    return [Tile(*(BLOCK * edge for edge in box)) for box in _cover(active)]


def active_blocks(ink: Array) -> Array:
    """Which blocks of BLOCK px hold ink, or have some within _CELL px.

    Args:
        ink: (H, W) float32.

    Returns:
        (ceil(H / BLOCK), ceil(W / BLOCK)) bool.
    """
    height, width = ink.shape
    rows, columns = -(-height // _CELL), -(-width // _CELL)
    cells: Array = np.zeros((rows, columns), np.uint8)
    band = 32 * _CELL  # bands of rows keep the copies small
    for top in range(0, height, band):
        seen = cv2.blur(ink[top : top + band], (3, 3)) > _INK
        seen = np.pad(seen, ((0, -len(seen) % _CELL), (0, -width % _CELL)))
        shape = (len(seen) // _CELL, _CELL, columns, _CELL)
        cells[top // _CELL :][: shape[0]] = seen.reshape(shape).any((1, 3))
    cells = cv2.dilate(cells, np.ones((3, 3), np.uint8))
    per = BLOCK // _CELL
    cells = np.pad(cells, ((0, -rows % per), (0, -columns % per)))
    return cells.reshape(cells.shape[0] // per, per, -1, per).any((1, 3))


def _cover(active: Array) -> list[tuple[int, int, int, int]]:
    """Disjoint rectangles (top, left, bottom, right) in blocks over all active blocks.

    A rectangle is cut in two where that leaves the least to look at, as long as its window is too
    large or cutting is cheaper than not.
    """
    height, width = active.shape
    done: list[tuple[int, int, int, int]] = []
    open_ = [(0, 0, height, width)]
    while open_:
        box = _trim(active, open_.pop())
        if box is None:
            continue
        top, left, bottom, right = box
        inside = active[top:bottom, left:right]
        high = _window(top, bottom, active.shape[0]) > LARGEST
        wide = _window(left, right, active.shape[1]) > LARGEST
        cost_y, y = _best_cut(inside) if high or not wide else (float("inf"), 0)
        cost_x, x = _best_cut(inside.T) if wide or not high else (float("inf"), 0)
        if not (high or wide) and min(cost_x, cost_y) >= _cost(*inside.shape):
            done.append(box)
        elif cost_y <= cost_x:
            open_ += [(top, left, top + y, right), (top + y, left, bottom, right)]
        else:
            open_ += [(top, left, bottom, left + x), (top, left + x, bottom, right)]
    return sorted(done)


def _window(start: int, stop: int, length: int) -> int:
    """The extent in px of a tile with its context, as far as the page reaches; given in blocks."""
    return min(length * BLOCK, stop * BLOCK + CONTEXT) - max(0, start * BLOCK - CONTEXT)


def _trim(active: Array, box: tuple[int, int, int, int]) -> tuple[int, int, int, int] | None:
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


def _cost(height: Array | int, width: Array | int) -> Array | float:
    """What looking at a tile costs, in blocks, its context included."""
    around = 2 * CONTEXT / BLOCK
    return (height + around) * (width + around) + _OVERHEAD


def _best_cut(active: Array) -> tuple[float, int]:
    """The cost of both parts of a block mask, cut at the best row, and that row (below the cut)."""
    rows, columns = active.shape
    if rows < 2:
        return float("inf"), 0
    used = active.any(1)
    first = np.where(used, active.argmax(1), columns)
    last = np.where(used, columns - active[:, ::-1].argmax(1), 0)
    row = np.arange(rows)

    def upper(first: Array, last: Array, used: Array) -> Array:
        # Width and height of the part that holds rows 0..k, without its empty rows.
        wide = np.maximum.accumulate(last) - np.minimum.accumulate(first)
        begin = used.argmax()
        end = np.maximum.accumulate(np.where(used, row + 1, 0))
        return np.where(end > 0, _cost(end - begin, wide), 0)

    above = upper(first, last, used)[:-1]
    below = upper(first[::-1], last[::-1], used[::-1])[::-1][1:]
    total = above + below
    # Of equal costs the cut wins that leaves the fewest parts of almost full size.
    parts = -(-rows // ((LARGEST - 2 * CONTEXT) // BLOCK))
    even = np.abs(np.arange(1, rows) - rows * max(1, parts // 2) / max(2, parts))
    best = np.lexsort((even, np.round(total, 3)))[0]
    return float(total[best]), int(best) + 1


def look(
    ink: Array,
    infer: Callable[[Array], Iterable[Array]],
    maps: Sequence[Array | None],
    tick: Callable[[float], None],
) -> None:
    """Run a network over all inked blocks of a page and write its answers into the maps.

    Args:
        ink: (H, W) float32.
        infer: (h, w) float32 window of any size -> its maps, (h, w) float32; those at half the
            resolution are (h / 2, w / 2), rounded up.
        maps: as many arrays (H, W) or (H / 2, W / 2), float32, zero, and left so on white paper;
            None = not wanted.
        tick: called with the fraction that is done; what it raises passes through.
    """
    active = active_blocks(ink)
    tiles = plan(active)
    total = sum(tile.area for tile in tiles)
    done = 0
    for tile in tiles:
        tick(done / total)
        rows, columns = tile.window(active, *ink.shape)
        answers = infer(np.ascontiguousarray(ink[rows, columns]))
        inside = ink[tile.top : tile.bottom, tile.left : tile.right].shape
        row = np.arange(tile.top, tile.top + inside[0]) // BLOCK
        column = np.arange(tile.left, tile.left + inside[1]) // BLOCK
        inked = active[row[:, None], column]
        for answer, target in zip(answers, maps, strict=True):
            if target is not None:
                step = 1 if target.shape == ink.shape else 2  # tiles and windows begin at even px
                y, x = (tile.top - rows.start) // step, (tile.left - columns.start) // step
                place = target[
                    tile.top // step : -(-tile.bottom // step),
                    tile.left // step : -(-tile.right // step),
                ]
                seen = answer[y : y + place.shape[0], x : x + place.shape[1]]
                place[:] = seen * inked[::step, ::step]
        done += tile.area
    tick(1.0)
