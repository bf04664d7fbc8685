"""Names for the colours of inks: the layers that an animator knows, the same on every frame."""

from __future__ import annotations

import colorsys
from collections.abc import Sequence
from dataclasses import dataclass

from ..values import Stroke

# Where each hue ends, in degrees.
_HUES = (
    (18, "Red"),
    (45, "Orange"),
    (70, "Yellow"),
    (165, "Green"),
    (200, "Cyan"),
    (262, "Blue"),
    (300, "Purple"),
    (340, "Pink"),
    (360, "Red"),
)


def ink_name(color: Sequence[int]) -> str:
    """The plain name of an sRGB colour (0..255 each): Black, Gray, Red, Blue and so on."""
    hue, lightness, _ = colorsys.rgb_to_hls(*(float(c) / 255 for c in color))
    chroma = (max(color) - min(color)) / 255
    if chroma < 0.16 or (lightness < 0.2 and chroma < 0.22):
        return "Black" if lightness < 0.4 else "Gray" if lightness < 0.9 else "White"
    degrees = hue * 360
    if degrees < 45 and lightness < 0.4 and chroma < 0.5:
        return "Brown"
    return next(name for end, name in _HUES if degrees <= end)


@dataclass(frozen=True)
class InkLayer:
    """The strokes of one ink, or what is small of them.

    name: of its own on the page: Black, Red, Red 2, Small Red.
    color: sRGB 0..255.
    numbers: of the strokes, ascending.
    """

    name: str
    color: tuple[int, int, int]
    numbers: tuple[int, ...]


def ink_layers(strokes: Sequence[Stroke], small: Sequence[bool] = ()) -> list[InkLayer]:
    """A layer per ink, that with the most strokes first; then those of what is small.

    Args:
        small: of each stroke, whether it comes to the small ones.
    """
    inks: dict[tuple[bool, tuple[int, int, int]], list[int]] = {}
    for number, stroke in enumerate(strokes):
        is_small = len(small) > 0 and bool(small[number])
        inks.setdefault((is_small, stroke.color), []).append(number)
    times: dict[str, int] = {}
    found = []
    for (is_small, color), numbers in sorted(inks.items(), key=lambda i: (i[0][0], -len(i[1]))):
        name = f"Small {ink_name(color)}" if is_small else ink_name(color)
        times[name] = times.get(name, 0) + 1
        unique = name if times[name] == 1 else f"{name} {times[name]}"
        found.append(InkLayer(unique, color, tuple(numbers)))
    return found
