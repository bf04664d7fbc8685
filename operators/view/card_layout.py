"""Where the cards of the alternatives lie in the viewport: arithmetic that ui and tools share."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

Array = np.ndarray

_WIDTH, _HEIGHT, _GAP, _MARGIN, _AWAY = 92.0, 104.0, 8.0, 12.0, 46.0  # px at scale 1
_SMALLEST = 0.4  # of the interface's scale; smaller cards can't be read


class Card(NamedTuple):
    """A rectangle in pixels of the region, from its lower left corner."""

    x: float
    y: float
    width: float
    height: float

    def holds(self, x: float, y: float) -> bool:
        """Does this place of the region lie on the card?"""
        return 0 <= x - self.x <= self.width and 0 <= y - self.y <= self.height


def free_part(size: tuple[float, float], covers: Iterable[Card]) -> Card:
    """What sidebar, toolbar and headers leave of a region that they lie over.

    Args:
        size: of the region.
        covers: what lies over it, each along one of its borders.
    """
    left, bottom, right, top = 0.0, 0.0, float(size[0]), float(size[1])
    for x, y, width, height in covers:
        if width >= height:  # along the lower or the upper border
            if y + height / 2 < size[1] / 2:
                bottom = max(bottom, y + height)
            else:
                top = min(top, y)
        elif x + width / 2 < size[0] / 2:
            left = max(left, x + width)
        else:
            right = min(right, x)
    if right - left < _WIDTH or top - bottom < _HEIGHT:  # nothing is left: better covered than gone
        return Card(0.0, 0.0, float(size[0]), float(size[1]))
    return Card(left, bottom, right - left, top - bottom)


def layout(
    count: int,
    anchor: tuple[float, float],
    free: Card,
    scale: float = 1.0,
    lines: Array | None = None,
) -> tuple[list[Card], float]:
    """Rows of cards beside a junction, where they cover least of its lines; inside the free part.

    Above, where that is as good as anywhere else.

    Args:
        anchor: where the junction appears.
        free: the part of the region that nothing covers.
        scale: of the interface.
        lines: (N, 2) places of the region that are better seen.

    Returns:
        The cards, and the scale that they have: smaller where they would not fit.
    """
    smallest = _SMALLEST * scale
    while scale > smallest and not _fits(count, free, scale):
        scale *= 0.9
    width, height, gap, margin = (scale * v for v in (_WIDTH, _HEIGHT, _GAP, _MARGIN))
    columns = _columns(count, free, scale)
    rows = -(-count // columns)
    size = columns * (width + gap) - gap, rows * (height + gap) - gap
    shown = np.vstack([np.zeros((0, 2)) if lines is None else lines, anchor])
    blocks = [Card(x, y, *size) for x, y in _places(anchor, size, free, scale * _AWAY, margin)]
    left, bottom, *_ = min(blocks, key=lambda block: _covered(block, shown, margin))
    cards = []
    for k in range(count):
        row, column = divmod(k, columns)
        y = bottom + (rows - 1 - row) * (height + gap)
        cards.append(Card(left + column * (width + gap), y, width, height))
    return cards, scale


def _places(
    anchor: tuple[float, float], size: tuple[float, float], free: Card, away: float, margin: float
) -> list[tuple[float, float]]:
    """Lower left corners of a block of cards around a junction: above, below, left, right; near
    and farther away."""
    (x, y), (across, tall) = anchor, size
    found = []
    for far in (away, 2 * away, 3 * away):
        found += [(x - across / 2, y + far), (x - across / 2, y - far - tall)]
        found += [(x - far - across, y - tall / 2), (x + far, y - tall / 2)]
    return [
        (
            _kept_in(left, free.x + margin, free.x + free.width - across - margin),
            _kept_in(bottom, free.y + margin, free.y + free.height - tall - margin),
        )
        for left, bottom in found
    ]


def _covered(block: Card, places: Array, margin: float) -> int:
    """How many places lie under a block of cards or close to it."""
    x, y = places.T
    across = (x >= block.x - margin) & (x <= block.x + block.width + margin)
    return int((across & (y >= block.y - margin) & (y <= block.y + block.height + margin)).sum())


def card_at(cards: list[Card], x: float, y: float) -> int:
    """The card under the mouse; -1 when there is none."""
    return next((k for k, card in enumerate(cards) if card.holds(x, y)), -1)


def _columns(count: int, free: Card, scale: float) -> int:
    room = free.width - 2 * scale * _MARGIN + scale * _GAP
    each = max(scale * (_WIDTH + _GAP), 1.0)  # px; without a window Blender knows no scale
    return max(1, min(count, int(room // each)))


def _fits(count: int, free: Card, scale: float) -> bool:
    rows = -(-count // _columns(count, free, scale))
    tall = scale * (rows * (_HEIGHT + _GAP) - _GAP + 2 * _MARGIN)
    return tall <= free.height and scale * (_WIDTH + 2 * _MARGIN) <= free.width


def _kept_in(value: float, low: float, high: float) -> float:
    return min(max(value, low), max(high, low))
