"""Lines in the order and the pieces that a pen plotter draws best: no line twice, few long paths,
short ways with the pen up.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays.ragged import along, arc, count_up, offsets_of, owners, ranges
from ..values import Array

# In pen widths unless said otherwise; evidence: tests/engine/test_exchange.py.
_SAMPLE = 0.5  # from sample to sample when lines are compared
_SAME = 0.35  # lines this close leave one line of ink
_PARALLEL = np.cos(np.radians(12.0))  # lines that cross at more than that are two
_SHORTEST = 3.0  # a shared stretch; shorter ones are crossings
_JOINED = 0.5  # ends this close are drawn in one go: the pen covers the gap
_END = np.arange(2)


def without_doubles(lines: Sequence[Array], pen: float) -> list[Array]:
    """The lines (N, 2) without the stretches that another, longer one has drawn already."""
    return [line for _, line in undoubled(lines, pen)]


def undoubled(lines: Sequence[Array], pen: float) -> list[tuple[int, Array]]:
    """What `without_doubles` leaves, each piece with the number of its line."""
    if not lines:
        return []
    order = np.argsort([-arc(line)[-1] for line in lines], kind="stable")
    places = [_evenly(lines[k], _SAMPLE * pen) for k in order]
    samples = [along(lines[k], at) for k, at in zip(order, places, strict=True)]
    offsets = offsets_of([len(s) for s in samples])
    covered = _covered(np.concatenate(samples), offsets, _SAME * pen)
    kept = []
    for rank, k in enumerate(order):
        hit = covered[offsets[rank] : offsets[rank + 1]]
        line = lines[k]
        for first, last in _free(hit, round(_SHORTEST / _SAMPLE)):
            if first == 0 and last == len(hit) - 1:
                kept.append((int(k), line))
            elif last > first:
                kept.append((int(k), _part(line, places[rank][first], places[rank][last])))
    return sorted(kept, key=lambda found: found[0])


def joined(lines: Sequence[Array], pen: float) -> list[Array]:
    """Lines whose ends meet as one; where several end in one place, the nearest two go together."""
    if not lines:
        return []
    ends = np.array([line[[0, -1]] for line in lines], np.float64).reshape(-1, 2)
    a, b = _close_pairs(ends, _JOINED * pen)
    partner = np.full(len(ends), -1)
    for k in np.argsort(np.hypot(*(ends[a] - ends[b]).T), kind="stable"):
        if partner[a[k]] < 0 and partner[b[k]] < 0 and a[k] != b[k]:
            partner[a[k]], partner[b[k]] = b[k], a[k]
    done = np.zeros(len(lines), bool)
    found = []
    # Chains are walked from their free ends first; what is left then are rings.
    for end in [*np.flatnonzero(partner < 0), *range(len(ends))]:
        chain = []
        while not done[end >> 1]:
            done[end >> 1] = True
            line = lines[end >> 1]
            chain.append(line[::-1] if end & 1 else line)
            if partner[end ^ 1] < 0:
                break
            end = partner[end ^ 1]
        if chain:
            found.append(np.concatenate(chain))
    return found


def in_short_order(lines: Sequence[Array]) -> list[Array]:
    """The lines, turned where that helps, each near where the one before it ended."""
    return [lines[end >> 1][::-1] if end & 1 else lines[end >> 1] for end in short_order(lines)]


def short_order(lines: Sequence[Array]) -> list[int]:
    """The ends at which to begin the lines, each near where the one before it ended.

    End 2 k is the first point of line k, 2 k + 1 its last. The next one is the nearest on a grid
    that grows coarser as lines go: about n steps in all.
    """
    ends = np.array([line[[0, -1]] for line in lines], np.float64).reshape(-1, 2)
    left, at = set(range(len(lines))), np.zeros(2)
    grid, size = _grid(ends, left)
    grown = len(left)
    found = []
    while left:
        if len(left) * 4 < grown:
            grid, size = _grid(ends, left)
            grown = len(left)
        end = _nearest(grid, size, ends, at)
        for gone in (end, end ^ 1):
            grid[tuple((ends[gone] // size).astype(int))].discard(gone)
        left.discard(end >> 1)
        found.append(end)
        at = ends[end ^ 1]
    return found


def hatched(rings: Sequence[Array], apart: float) -> list[Array]:
    """Level lines, `apart` from each other, that fill an area (even-odd), there and back."""
    edges = np.concatenate(
        [np.stack([ring, np.roll(ring, -1, 0)], 1) for ring in rings if len(ring) > 2]
        or [np.zeros((0, 2, 2))]
    ).astype(np.float64)
    edges = np.where((edges[:, :1, 1:] > edges[:, 1:, 1:]), edges[:, ::-1], edges)
    first = np.ceil(edges[:, 0, 1] / apart).astype(np.int64)
    count = np.maximum(np.ceil(edges[:, 1, 1] / apart).astype(np.int64) - first, 0)
    row, edge = ranges(first, count), owners(offsets_of(count))
    (x0, y0), (x1, y1) = edges[edge, 0].T, edges[edge, 1].T
    x = x0 + (row * apart - y0) / np.where(y1 > y0, y1 - y0, 1) * (x1 - x0)
    order = np.lexsort([x, row])
    x, row = x[order].reshape(-1, 2), row[order][::2]
    long = x[:, 1] - x[:, 0] > apart / 2
    lines = np.stack([x, np.broadcast_to(row[:, None] * apart, x.shape)], -1)[long]
    turned = lines[:, ::-1]
    return list(np.where((row[long] % 2 == 1)[:, None, None], turned, lines))


def _evenly(line: Array, step: float) -> Array:
    length = arc(line)[-1]
    return np.linspace(0, length, max(2, int(np.ceil(length / step)) + 1))


def _part(line: Array, start: float, end: float) -> Array:
    way = arc(line)
    inside = (way > start) & (way < end)
    return along(line, np.concatenate([[start], way[inside], [end]]))


def _free(covered: Array, shortest: int) -> list[tuple[int, int]]:
    """First and last sample of each stretch that no other line covers for long."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], covered, [False]]).astype(np.int8)))
    shortest = min(shortest, len(covered) - 1)  # a short line may be covered whole
    spans = [(a, b) for a, b in edges.reshape(-1, 2).tolist() if b - a > shortest]
    starts = [0, *(b for _, b in spans)]
    stops = [*(a - 1 for a, _ in spans), len(covered) - 1]
    # A stretch begins where the other line still covers it, so that no gap is left.
    pieces = zip(starts, stops, strict=True)
    return [(max(a - 1, 0), min(b + 1, len(covered) - 1)) for a, b in pieces if b >= a]


def _covered(points: Array, offsets: Array, radius: float) -> Array:
    """(M,) bool: near a sample of an earlier line that runs the same way there."""
    of = owners(offsets)
    way = np.roll(points, -1, 0) - points
    last = offsets[1:] - 1
    way[last] = way[last - 1]
    way /= np.maximum(np.hypot(*way.T), 1e-9)[:, None]
    a, b = _close_pairs(points, radius + _SAMPLE * radius)
    earlier = of[b] < of[a]
    a, b = np.where(earlier, a, b), np.where(earlier, b, a)
    apart = points[a] - points[b]
    side = np.abs(apart[:, 0] * way[b, 1] - apart[:, 1] * way[b, 0])
    same = (of[a] != of[b]) & (side <= radius) & (np.abs((way[a] * way[b]).sum(1)) >= _PARALLEL)
    hit = np.zeros(len(points), bool)
    hit[a[same]] = True
    return hit


def _close_pairs(points: Array, radius: float) -> tuple[Array, Array]:
    """Pairs of points no farther apart than that; each pair once."""
    cell = np.floor(points / radius).astype(np.int64)
    cell -= cell.min(0, initial=0) - 1
    wide = int(cell[:, 0].max(initial=0)) + 2
    key = cell[:, 1] * wide + cell[:, 0]
    order = np.argsort(key, kind="stable")
    keys = key[order]
    ones, others = [], []
    for step in (0, 1, wide - 1, wide, wide + 1):  # half of the neighbours: the rest see us
        low = np.searchsorted(keys, keys + step, "left")
        high = np.searchsorted(keys, keys + step, "right")
        if step == 0:
            low = np.arange(len(keys)) + 1
        count = np.maximum(high - low, 0)
        ones.append(np.repeat(order, count))
        others.append(order[np.repeat(low, count) + count_up(count)])
    a, b = np.concatenate(ones), np.concatenate(others)
    near = np.hypot(*(points[a] - points[b]).T) <= radius
    return a[near], b[near]


def _grid(ends: Array, left: set[int]) -> tuple[dict[tuple[int, ...], set[int]], float]:
    """The ends of what is left in cells, about two in each."""
    if not left:
        return {}, 1.0
    numbers = (np.array(sorted(left))[:, None] * 2 + _END).reshape(-1)
    here = ends[numbers]
    span = np.maximum(np.ptp(here, 0), 1.0)
    size = float(np.sqrt(span[0] * span[1] / len(left)))
    size = max(size, float(span.max()) / len(left))
    grid: dict[tuple[int, ...], set[int]] = {}
    for number, (x, y) in zip(numbers.tolist(), (here // size).astype(int).tolist(), strict=True):
        grid.setdefault((x, y), set()).add(number)
    return grid, size


def _nearest(grid: dict[tuple[int, ...], set[int]], size: float, ends: Array, at: Array) -> int:
    """The end nearest to a place: rings of cells around it, until no nearer one can come."""
    x, y = (at // size).astype(int).tolist()
    best, distance, ring = -1, np.inf, 0
    while best < 0 or (ring - 1) * size < distance:
        for cell in _ring_of(x, y, ring):
            for end in grid.get(cell, ()):
                away = float(np.hypot(*(ends[end] - at)))
                if away < distance or (away == distance and end < best):
                    best, distance = end, away
        ring += 1
    return best


def _ring_of(x: int, y: int, ring: int) -> list[tuple[int, int]]:
    if ring == 0:
        return [(x, y)]
    side = range(-ring, ring + 1)
    rows = [(x + k, y + s) for k in side for s in (-ring, ring)]
    return rows + [(x + s, y + k) for k in side[1:-1] for s in (-ring, ring)]
