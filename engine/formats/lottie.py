"""Lottie: a drawing that draws itself, stroke after stroke, or the frames of a sequence.

Lottie's lines have one width. A stroke whose width varies is therefore cut into pieces that stay
within 5 % of one, with round ends that hide the cuts. Each piece is a path of its own whose trim
path shows it in its turn. A layer per ink, and per frame of a sequence.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ..arrays.ragged import arc, count_up, offsets_of, owners
from ..drawing import Drawing
from ..ink.ink_names import InkLayer
from ..strokes.small_parts import layers_of
from ..values import Array, Stroke
from .areas import area_layers
from .flatten import outline, widths_along
from .plot_paths import short_order
from .whole_file import write_text

FRAME_RATE = 24  # frames per second: film's, and Blender's own
_DRAWN, _HELD = 96, 24  # frames in which a drawing draws itself, and for which it then stays
# Greatest width of a piece over its least: 3.5 % from their middle, and 5 % with the round end of
# the wider neighbour, as rlottie shows it (tests/engine/test_exchange.py).
_SPREAD = 1.07
_ROUND, _EVEN_ODD = 2, 2  # Lottie's numbers for round caps and joins, and for a fill rule
_VERSION = 10_001  # of the specification, as its schema asks: 1.0.1

Json = dict[str, Any]


def write(drawing: Drawing, path: Path) -> None:
    """Write a drawing that draws itself in four seconds, in a short order of its strokes."""
    inks = layers_of(drawing)
    total = sum(float(arc(outline(stroke))[-1]) for stroke in drawing.strokes)
    clock = _Clock(_DRAWN / max(total, 1e-6))
    layers = [_ink_layer(drawing, ink, (0, _DRAWN + _HELD), clock) for ink in inks]
    layers += _areas(drawing, (_DRAWN, _DRAWN + _HELD))
    _write(layers, drawing.size, _DRAWN + _HELD, path)


def write_sequence(name: str, frames: Iterable[tuple[int, Drawing]], path: Path) -> None:
    """Write the drawings of a sequence, each shown from its frame to the next one's."""
    layers: list[Json] = []
    width = height = end = first = 0
    waiting: tuple[int, Drawing] | None = None

    def show(until: int) -> None:
        if waiting is not None:
            time, drawing = waiting
            span = (time - first, until - first)
            inks = layers_of(drawing)
            layers.extend(_ink_layer(drawing, ink, span) for ink in inks)
            layers.extend(_areas(drawing, span))

    for frame, drawing in frames:
        if waiting is None:
            first = frame
        show(frame)
        waiting = frame, drawing
        width, height = max(width, drawing.size[0]), max(height, drawing.size[1])
    if waiting is not None:
        end = waiting[0] + 1
        show(end)
        end -= first
    _write(layers, (width, height), max(end, 1), path)


def _write(layers: list[Json], size: tuple[int, int], frames: int, path: Path) -> None:
    for number, layer in enumerate(layers):
        layer["ind"] = number + 1
    document = {
        "v": "5.7.0",  # the version of the player that all players ask for
        "ver": _VERSION,
        "fr": FRAME_RATE,
        "ip": 0,
        "op": frames,
        "w": size[0],
        "h": size[1],
        "nm": path.stem if not path.name.startswith(".") else "Drawing",
        "ddd": 0,
        "assets": [],
        "layers": layers,
    }
    write_text(json.dumps(document, separators=(",", ":")), path)


class _Clock:
    """Gives every piece of line the time that its length takes."""

    def __init__(self, frames_per_px: float) -> None:
        self._speed, self._now = frames_per_px, 0.0

    def __call__(self, line: Array) -> tuple[float, float]:
        start, self._now = self._now, self._now + float(arc(line)[-1]) * self._speed
        return round(start, 3), round(self._now, 3)


def _ink_layer(
    drawing: Drawing, ink: InkLayer, span: tuple[int, int], clock: _Clock | None = None
) -> Json:
    """The strokes of an ink; in the order of the pen when there is a clock."""
    strokes = [drawing.strokes[number] for number in ink.numbers]
    ends = [2 * k for k in range(len(strokes))]
    if clock:
        ends = short_order([outline(stroke) for stroke in strokes])
    groups: list[Json] = []
    for end in ends:
        stroke, back = strokes[end >> 1], bool(end & 1)
        name = f"Stroke {ink.numbers[end >> 1] + 1}"
        pieces = _pieces(stroke)
        pieces = [(line[::-1], width) for line, width in reversed(pieces)] if back else pieces
        groups += [_group(name, *piece, stroke, clock) for piece in pieces]
    # What is listed first lies on top.
    return _layer(ink.name, groups[::-1], span)


def _pieces(stroke: Stroke) -> list[tuple[Array, float]]:
    """Lines (N, 2), each with its width, that make up a stroke one after the other."""
    line, widths = outline(stroke).astype(np.float64), widths_along(stroke).astype(np.float64)
    ratio = widths[1:] / widths[:-1]
    steps = np.maximum(np.ceil(np.abs(np.log(ratio)) / np.log(_SPREAD)), 1).astype(np.int64)
    of, part = owners(offsets_of(steps)), count_up(steps) / np.repeat(steps, steps)
    # Cut where the width has changed by equal factors, however far along that is.
    ratio = np.where(np.abs(ratio - 1) < 1e-6, 1 + 1e-6, ratio)[of]
    places = np.append(of + (ratio**part - 1) / (ratio - 1), len(line) - 1.0)
    at = np.arange(len(line))
    logs = np.log(np.interp(places, at, widths))
    line = np.stack([np.interp(places, at, line[:, k]) for k in (0, 1)], 1)
    found, start, low, high = [], 0, logs[0], logs[0]
    for k in range(1, len(logs)):
        least, most = min(low, logs[k]), max(high, logs[k])
        if most - least > np.log(_SPREAD) + 1e-6 and k - start > 1:
            found.append((line[start:k], float(np.exp((low + high) / 2))))
            start, least, most = k - 1, min(logs[k - 1], logs[k]), max(logs[k - 1], logs[k])
        low, high = least, most
    found.append((line[start:], float(np.exp((low + high) / 2))))
    return found


def _group(name: str, line: Array, width: float, stroke: Stroke, clock: _Clock | None) -> Json:
    whole = stroke.closed and np.array_equal(line[0], line[-1])
    items = [_path(line[:-1] if whole else line, whole)]
    if clock:
        start, end = clock(line)
        keys = [
            {"t": start, "s": [0], "o": {"x": [0], "y": [0]}, "i": {"x": [1], "y": [1]}},
            {"t": max(end, start + 1e-3), "s": [100]},
        ]
        trim = {"s": _still(0), "e": {"a": 1, "k": keys}, "o": _still(0), "m": 1}
        items.append({"ty": "tm", "nm": "Trim", **trim})
    color = [round(value / 255, 4) for value in stroke.color]
    pen = {"c": _still([*color, 1]), "o": _still(round(float(stroke.opacity.mean()) * 100, 1))}
    ends = {"w": _still(round(width, 3)), "lc": _ROUND, "lj": _ROUND}
    items.append({"ty": "st", "nm": "Pen", **pen, **ends})
    return {"ty": "gr", "nm": name, "it": [*items, {"ty": "tr", **_transform()}]}


def _areas(drawing: Drawing, span: tuple[int, int]) -> list[Json]:
    """The layers below the strokes: solid areas, and below them the coloured regions."""
    return [
        _layer(name, [_area(rings, color) for rings, color in areas], span)
        for name, areas in reversed(area_layers(drawing).items())
    ]


def _area(rings: Sequence[Array], color: Sequence[int]) -> Json:
    paths = [_path(ring, True) for ring in rings]
    channels = [*(round(value / 255, 4) for value in color), 1]
    fill = {"ty": "fl", "c": _still(channels), "o": _still(100), "r": _EVEN_ODD}
    return {"ty": "gr", "nm": "Area", "it": [*paths, fill, {"ty": "tr", **_transform()}]}


def _path(points: Array, closed: bool) -> Json:
    rows = np.round(points.astype(np.float64), 2).tolist()
    flat = [[0, 0]] * len(rows)
    return {"ty": "sh", "ks": _still({"c": closed, "v": rows, "i": flat, "o": flat})}


def _layer(name: str, shapes: list[Json], span: tuple[int, int]) -> Json:
    time = {"ip": span[0], "op": span[1], "st": 0}
    return {"ty": 4, "nm": name, "ddd": 0, "ks": _transform(), **time, "shapes": shapes}


def _transform() -> Json:
    return {
        "a": _still([0, 0]),
        "p": _still([0, 0]),
        "s": _still([100, 100]),
        "r": _still(0),
        "o": _still(100),
    }


def _still(value: Any) -> Json:
    """A property that does not change."""
    return {"a": 0, "k": value}
