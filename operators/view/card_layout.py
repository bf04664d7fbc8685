"""Where the cards of the alternatives lie in the viewport: arithmetic that ui and tools share."""

from __future__ import annotations

from typing import NamedTuple

_WIDTH, _HEIGHT, _GAP, _MARGIN, _AWAY = 92.0, 104.0, 8.0, 12.0, 46.0


class Card(NamedTuple):
    """A rectangle in pixels of the region, from its lower left corner."""

    x: float
    y: float
    width: float
    height: float

    def holds(self, x: float, y: float) -> bool:
        """Does this place of the region lie on the card?"""
        return 0 <= x - self.x <= self.width and 0 <= y - self.y <= self.height


def layout(
    count: int, anchor: tuple[float, float], size: tuple[float, float], scale: float = 1.0
) -> list[Card]:
    """A row of cards above a junction, or below it where there is no room; inside the region.

    Args:
        anchor: where the junction appears.
        size: of the region.
        scale: of the interface.
    """
    width, height, gap, margin = (scale * v for v in (_WIDTH, _HEIGHT, _GAP, _MARGIN))
    total = count * width + (count - 1) * gap
    left = min(max(anchor[0] - total / 2, margin), max(size[0] - total - margin, margin))
    bottom = anchor[1] + scale * _AWAY
    if bottom + height + margin > size[1]:
        bottom = anchor[1] - scale * _AWAY - height
    bottom = min(max(bottom, margin), max(size[1] - height - margin, margin))
    return [Card(left + k * (width + gap), bottom, width, height) for k in range(count)]


def card_at(cards: list[Card], x: float, y: float) -> int:
    """The card under the mouse; -1 when there is none."""
    return next((k for k, card in enumerate(cards) if card.holds(x, y)), -1)
