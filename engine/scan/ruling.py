"""Printed rules and grids, taken out of a page before its ink is scaled.

Rules are what a hand does not draw: thin lines across the whole page, straight, at equal distances,
and fainter than the pen. All of that must hold, so that the long straight lines of a drawing stay.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np

from ..values import Array

_STRIP, _MOST_STRIPS = 64, 24  # px; rules are looked for in strips across them
_TILT = 0.06  # rad; how far a page may be turned
_LEAST = 0.012  # mean darkness of a row of a strip from which on it may belong to a rule
_THROUGH, _MARGIN = 0.7, 0.9  # share of the strips in which a rule, or a margin line, shows
_FEWEST, _FEWEST_ALONE = 5, 8  # rules; the latter where nothing on the page is darker
_EVEN, _MOST_EVEN = 0.12, 0.7  # of the pitch that a gap may be off; share of the gaps that are not
_SAME_PITCH, _NEXT = 0.03, 4  # front and back are ruled alike; lines looked at from one on
# Share of the rules of the back that show at least; 0.3 to 0.8 leave the same on 40 ruled sheets
# (`python -m benchmarks run scan_limits`: 0.004 of the rules left, 0.008 of the drawings gone).
_MOST_HIDDEN = 0.5
_SPAN = 0.5  # of the page that rules cover
_PEN, _PEN_PIXELS = 1.7, 60  # so many pixels so many times as dark as the rules: a pen
_PALE = 0.5  # how dark the rules of an otherwise blank page may be
_ALIKE = 2.5  # times that one rule may be darker or paler than the others
_REACH, _STRAY = 4, 2  # px that a rule's tone reaches from its middle; that it may stray
_HIDDEN = 0.4  # share of a rule between or beyond others that shows at least
_NOISE = 1.6  # times as dark as the rule: that is ink
_EDGE = 0.08  # of a rule's tone that still counts as rule


@dataclass(frozen=True)
class _Lines:
    """Lines across a page: at[i] + slope * (x - middle) + stray[i] px; shown: share of strips."""

    at: Array
    stray: Array
    shown: Array
    slope: float

    def take(self, chosen: Array) -> _Lines:
        return _Lines(self.at[chosen], self.stray[chosen], self.shown[chosen], self.slope)

    def places(self, width: int) -> Array:
        """The row nearest to each line in each column, (N, width) int."""
        if not len(self.at):
            return np.zeros((0, width), np.int32)
        stray = cv2.resize(self.stray, (width, len(self.at)), interpolation=cv2.INTER_LINEAR)
        along = self.slope * (np.arange(width, dtype=np.float32) + 0.5 - width / 2)
        return np.round(self.at[:, None] + along + stray).astype(np.int32)


def without_rules(darkness: Array) -> Array:
    """A page without its rules; the page itself when it has none.

    Args:
        darkness: (H, W) float32, 0 = paper, 1 = black.
    """
    if min(darkness.shape) < 4 * _STRIP:
        return darkness
    strips = [_strips(darkness, axis) for axis in (0, 1)]
    if not any(_may_be_ruled(strip) for strip in strips):
        return darkness
    lines = [_lines_across(strip, darkness.shape[1 - axis]) for axis, strip in enumerate(strips)]
    rules = [_families(found, side) for found, side in zip(lines, darkness.shape, strict=True)]
    if not any(rules):
        return darkness
    left, tones = darkness.copy(), []
    for page, found, rule in zip((left, left.T), lines, rules, strict=True):
        # A sheet that is ruled one way may have a line at its margin the other way.
        for chosen in map(found.take, rule or [found.shown >= _MARGIN]):
            if len(chosen.at):
                tones.append(_take_out(page, chosen))
    tone = np.concatenate(tones)
    typical = float(np.median(tone))
    drawn = np.count_nonzero(left > _PEN * typical) >= _PEN_PIXELS
    return left if drawn or (len(tone) >= _FEWEST_ALONE and typical < _PALE) else darkness


def _strips(page: Array, axis: int) -> Array:
    """How much darker each row (axis 0) or column (1) is than those around it, in strips across
    them: (rows, strips)."""
    rows, width = page.shape if axis == 0 else page.shape[::-1]
    strips = min(max(width // _STRIP, 4), _MOST_STRIPS)
    size = (strips, rows) if axis == 0 else (rows, strips)
    mean = cv2.resize(page, size, interpolation=cv2.INTER_AREA)
    mean = np.ascontiguousarray(mean if axis == 0 else mean.T)
    return mean - cv2.blur(mean, (1, 15))


def _dark(strips: Array) -> Array:
    noise = float(np.median(np.abs(strips - np.median(strips))))
    return strips > max(_LEAST, 4.0 * noise)


def _may_be_ruled(strips: Array) -> bool:
    """Whether enough strips have as many dark rows as rules: most pages are done with here."""
    share = np.mean(_dark(strips).sum(0) >= _FEWEST)
    return bool(share >= _THROUGH)


def _lines_across(strips: Array, width: int) -> _Lines:
    """Thin lines across most of the strips of a page, ordered."""
    rows, count = strips.shape
    wide = cv2.dilate(_dark(strips).astype(np.uint8), np.ones((3, 1), np.uint8))
    middle = ((np.arange(count) + 0.5) / count - 0.5) * width
    most = int(_TILT * width / 4)  # the ends of a line move by 2 px from one slope to the next
    slopes = np.arange(-most, most + 1) * (4.0 / width)
    margin = 2 * most + 2
    padded = np.pad(wide.T, ((0, 0), (margin, margin)))

    def shown(slope: float) -> Array:
        """The share of strips that each row crosses where they are dark."""
        start = margin + np.round(slope * middle).astype(int)
        return sum(s[k : k + rows] for s, k in zip(padded, start, strict=True)) / count

    slope = max(slopes, key=lambda s: float(np.maximum(shown(s) - 0.5, 0).sum()))
    share = shown(slope)
    through = np.flatnonzero(share >= _THROUGH)
    if not len(through):
        return _Lines(np.zeros(0), np.zeros((0, count), np.float32), np.zeros(0), slope)
    starts = np.flatnonzero(np.diff(through, prepend=-9) > 1)
    thick = np.diff(starts, append=len(through))
    thin = thick <= 2 * _REACH
    at = (through[starts] + (thick - 1) / 2)[thin]
    share = np.maximum.reduceat(share[through], starts)[thin]
    return _Lines(at, _stray(strips, at[:, None] + slope * middle), share, slope)


def _stray(mean: Array, at: Array) -> Array:
    """How far (N, strips) places along lines are from the darkest row beside them, px."""
    offset = np.arange(-_STRAY, _STRAY + 1)
    near = np.round(at).astype(int)
    cell = np.clip(near[..., None] + offset, 0, len(mean) - 1)
    weight = np.maximum(mean[cell, np.arange(at.shape[1])[:, None]], 0) ** 2
    total = weight.sum(-1)
    off = (weight * offset).sum(-1) / np.maximum(total, 1e-12) + near - at
    # Where the line is hidden or crossed it goes on as elsewhere.
    if not len(off):
        return off.astype(np.float32)
    off = np.clip(off - np.median(off, 1, keepdims=True), -_STRAY, _STRAY) + np.median(
        off, 1, keepdims=True
    )
    padded = np.pad(off, ((0, 0), (1, 1)), mode="edge")
    return np.median([padded[:, :-2], off, padded[:, 2:]], 0).astype(np.float32)


def _families(lines: _Lines, side: int) -> list[Array]:
    """Which lines are rules, (N,) bool for each side of the sheet that shows; [] for none."""
    one = _evenly_spaced(lines, side)
    if one.any():
        return [one]
    # The rules of the back, seen through the paper, lie between those of the front.
    front, pitch = _comb(lines, np.ones(len(lines.at), bool), side)
    back, _ = _comb(lines, ~front, side, pitch)
    return [front, back] if front.any() and back.any() else []


def _comb(lines: _Lines, free: Array, side: int, known: float = 0.0) -> tuple[Array, float]:
    """The largest set of free lines at equal distances, (N,) bool, and that distance, px.

    Args:
        known: the distance, where it is known; then more of the lines may be hidden.
    """
    most = _MOST_HIDDEN if known else _MOST_EVEN
    best, best_pitch = np.zeros(len(lines.at), bool), 0.0
    if free.sum() < _FEWEST:
        return best, best_pitch
    place = lines.at + np.median(lines.stray, 1)
    numbers = np.flatnonzero(free)
    for ahead in range(1, _NEXT + 1):
        for a, b in zip(numbers, numbers[ahead:], strict=False):
            pitch = place[b] - place[a]
            crossing = pitch <= 0  # two lines that cross have one place
            if crossing or (known and abs(pitch - known) > _SAME_PITCH * known):
                continue
            steps = (place - place[a]) / pitch
            tooth = free & (np.abs(steps - np.round(steps)) < _EVEN)
            teeth = np.round(steps[tooth])
            full = len(np.unique(teeth)) >= most * (np.ptp(teeth) + 1)
            spans = np.ptp(place[tooth]) >= _SPAN * side
            if full and spans and tooth.sum() >= max(_FEWEST, best.sum() + 1):
                best, best_pitch = tooth, float(pitch)
    return best, best_pitch


def _evenly_spaced(lines: _Lines, side: int) -> Array:
    """Which lines are rules: (N,) bool; all False when there are too few."""
    none = np.zeros(len(lines.at), bool)
    if len(lines.at) < _FEWEST:
        return none
    gaps = np.diff(lines.at + np.median(lines.stray, 1))
    steps = gaps / max(float(np.median(gaps)), 1e-6)
    even = (np.abs(steps - np.round(steps)) < _EVEN) & (np.round(steps) >= 1)
    rule = np.append(even, False) | np.insert(even, 0, False)
    enough = rule.sum() >= _FEWEST and even.mean() >= _MOST_EVEN
    spans = enough and np.ptp(lines.at[rule]) >= _SPAN * side
    return rule if spans else none


def _take_out(page: Array, lines: _Lines) -> Array:
    """Lighten a page in place by the tone of its rules; returns how dark each rule is."""
    height, width = page.shape
    place, column = lines.places(width), np.arange(width)
    offsets = range(-_REACH, _REACH + 1)
    profile = np.stack(
        [np.median(page[np.clip(place + o, 0, height - 1), column], 1) for o in offsets]
    )
    tone = profile.max(0)
    typical = float(np.median(tone))
    alike = (tone < _ALIKE * typical) & (_ALIKE * tone > typical)
    shape = np.median(profile / np.maximum(tone, 1e-6), 1)
    more = _between_and_beyond(lines, height, width).places(width)
    on_page = (more >= 0) & (more < height)
    shows = on_page & (page[np.clip(more, 0, height - 1), column] > 0.4 * typical)
    more = more[shows.sum(1) > _HIDDEN * np.maximum(on_page.sum(1), 1)]
    place = np.concatenate([place[alike], more])
    level = np.append(tone[alike], np.full(len(more), typical))
    for offset, part in zip(offsets, shape, strict=True):
        if part > _EDGE:
            line, x = np.nonzero((place + offset >= 0) & (place + offset < height))
            y = place[line, x] + offset
            seen = page[y, x]
            tone_here = part * level[line]
            # Ink and print darken each other as two layers of colour do.
            ink = (seen - tone_here) / np.maximum(1 - tone_here, 0.1)
            page[y, x] = np.where(seen < _NOISE * level[line], 0, ink)
    return tone[alike]


def _between_and_beyond(lines: _Lines, height: int, width: int) -> _Lines:
    """Where a rule may be that too few strips show: hidden by the drawing, or cut off by the side
    of a turned page."""
    if len(lines.at) < _FEWEST:
        return lines.take(np.zeros(0, int))
    gaps = np.diff(lines.at)
    pitch, rise = float(np.median(gaps)), abs(lines.slope) * width / 2
    parts = np.maximum(np.round(gaps / pitch), 1).astype(int)
    at = [a + gap / n * np.arange(1, n) for a, gap, n in zip(lines.at, gaps, parts, strict=False)]
    at.append(np.arange(lines.at[0] - pitch, -rise, -pitch))
    at.append(np.arange(lines.at[-1] + pitch, height + rise, pitch))
    every = np.concatenate(at)
    nearest = np.abs(lines.at[:, None] - every).argmin(0)
    return replace(lines.take(nearest), at=every)
