"""Letters at the lines of the current junction; its alternatives as cards with small sketches.

A bundle of pencil strokes has two: one line, two lines.

A redraw without change makes nothing: the cards are batches in pixels from the lower left corner
of the first one, made once for a junction, its routing and the card that is pointed at.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import blf
import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader

from ...operators.view.card_layout import Card
from ...operators.view.junction_words import in_words, percent
from ...operators.view.on_screen import cards_of, places_on_screen
from .colors import STROKES
from .drawn_batches import kept
from .overlay_geometry import labels, sketch

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ...operators.view.view_state import Shown

Array = np.ndarray
Rgba = tuple[float, float, float, float]

_BACK = (0.11, 0.11, 0.12, 0.92)
_POINTED = (0.20, 0.27, 0.38, 0.96)
_EDGE = (0.35, 0.35, 0.36, 1.0)
_IN_FORCE = (0.35, 0.62, 1.0, 1.0)
_TEXT = (0.92, 0.92, 0.92, 1.0)
_FONT = 0
_REACH, _GAP = 30.0, 0.25  # px of a sketch around its junction; share of it that an end leaves out
_BADGE = 9.0  # px; radius of the disc behind a letter


@dataclass(frozen=True, eq=False)
class _Text:
    text: str
    x: float
    y: float
    size: float


@dataclass(frozen=True, eq=False)
class _Cards:
    """areas: the cards. lines: batches with their line widths. texts: what is written on them."""

    areas: gpu.types.GPUBatch
    lines: list[tuple[float, gpu.types.GPUBatch]]
    texts: list[_Text]


def draw(context: bpy.types.Context, shown: Shown) -> None:
    """Letters always; cards while the user is choosing."""
    scale = context.preferences.system.ui_scale
    language = bpy.app.translations.locale
    state = shown.trace.stamp, shown.junction.index, language, scale
    gpu.state.blend_set("ALPHA")
    _draw_letters(context, shown, state)
    if shown.view.choosing:
        placed, scale = cards_of(context, shown)
        rows = tuple((c.x - placed[0].x, c.y - placed[0].y) for c in placed)
        key = ("cards", *state, shown.view.preview, rows, scale)
        _draw_cards(kept(key, lambda: _make(placed, shown, scale)), placed[0])
    gpu.state.blend_set("NONE")


def draw_trail(places: Array) -> None:
    """The path of a drag so far, (N, 2) px of the region."""
    gpu.state.blend_set("ALPHA")
    for width, color in ((5.0, _BACK), (2.5, (*STROKES[0], 1.0))):  # seen on ink and paper
        _draw_lines(_polylines([(places, color)]), width)
    gpu.state.blend_set("NONE")


def _draw_letters(context: bpy.types.Context, shown: Shown, state: tuple) -> None:
    scale = state[-1]
    named = kept(("letters", *state), lambda: _labels(shown, scale))
    if not named:
        return
    places = places_on_screen(context, shown, np.array([place for _, place in named]))
    disc = kept(("disc", scale), lambda: _disc(_BADGE * scale))
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    seen = [(text, p) for (text, _), p in zip(named, places, strict=True) if np.isfinite(p).all()]
    for _, place in seen:
        with gpu.matrix.push_pop():
            gpu.matrix.translate(place)
            shader.uniform_float("color", _BACK)
            disc.draw(shader)
    for text, place in seen:
        _write(text, place)


def _draw_cards(cards: _Cards, first: Card) -> None:
    corner = (first.x, first.y)
    with gpu.matrix.push_pop():
        gpu.matrix.translate(corner)
        cards.areas.draw(gpu.shader.from_builtin("FLAT_COLOR"))
        for width, batch in cards.lines:
            _draw_lines(batch, width)
    for text in cards.texts:
        _write(text, corner)


def _draw_lines(batch: gpu.types.GPUBatch, width: float) -> None:
    shader = gpu.shader.from_builtin("POLYLINE_FLAT_COLOR")
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", width)
    batch.draw(shader)


def _write(text: _Text, at: Sequence[float]) -> None:
    blf.size(_FONT, text.size)
    blf.color(_FONT, *_TEXT)
    blf.position(_FONT, at[0] + text.x, at[1] + text.y, 0)
    blf.draw(_FONT, text.text)


# --- made once for each state --------------------------------------------------------------------


def _labels(shown: Shown, scale: float) -> list[tuple[_Text, tuple[float, float]]]:
    """The letters, centred, and where on the page they stand."""
    blf.size(_FONT, 12 * scale)
    found = []
    for letter, place in labels(shown.trace.drawing, shown.junction):
        width, height = blf.dimensions(_FONT, letter)
        found.append((_Text(letter, -width / 2, -height / 2, 12 * scale), place))
    return found


def _make(row: Sequence[Card], shown: Shown, scale: float) -> _Cards:
    drawing, junction = shown.trace.drawing, shown.junction
    areas, edges, bold, sketches, texts = [], [], [], [], []
    for number, (card, way) in enumerate(zip(row, junction.alternatives, strict=True)):
        card = card._replace(x=card.x - row[0].x, y=card.y - row[0].y)
        corners = np.array([card.x, card.y]) + _CORNERS * (card.width, card.height)
        areas.append((corners, _POINTED if number == shown.view.preview else _BACK))
        in_force = way.pairs == junction.pairs
        outline = np.concatenate([corners, corners[:1]])
        (bold if in_force else edges).append((outline, _IN_FORCE if in_force else _EDGE))
        sketches += _sketch(shown, way.pairs, card, scale)
        left, room = card.x + 8 * scale, card.width - 16 * scale
        top = card.y + card.height - 18 * scale
        texts.append(_Text(percent(way.probability), left, top, 13 * scale))
        words = in_words(drawing, junction, way.pairs)
        size = _fitting(words, 10 * scale, room)
        texts.append(_Text(words, left, card.y + 8 * scale, size))
    lines = (scale, edges), (2 * scale, bold), (3 * scale, sketches)
    return _Cards(
        _rectangles(areas), [(width, _polylines(some)) for width, some in lines if some], texts
    )


_CORNERS = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], np.float32)


def _sketch(shown: Shown, pairs: object, card: Card, scale: float) -> list[tuple[Array, Rgba]]:
    """The junction as it would be, as seen on the page; what ends there shows a gap."""
    middle = np.array([card.x + card.width / 2, card.y + card.height / 2 + 2 * scale])
    found = []
    for route in sketch(shown.trace.drawing, shown.junction, pairs):
        line = route.points
        if not route.joined:
            line = line[np.linalg.norm(line, axis=1) > _GAP]
        if len(line) > 1:
            found.append((middle + _REACH * scale * line, (*route.color, 1.0)))
    return found


def _fitting(text: str, size: float, room: float) -> float:
    """The size of the letters, smaller where the text would need more room."""
    blf.size(_FONT, size)
    return size * min(1.0, room / max(blf.dimensions(_FONT, text)[0], 1.0))


def _disc(radius: float) -> gpu.types.GPUBatch:
    turn = np.arange(24) * (2 * np.pi / 24)
    points = radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    corner = np.arange(1, 23, dtype=np.int32)
    triangles = np.stack([np.zeros_like(corner), corner, corner + 1], axis=1)
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    return batch_for_shader(shader, "TRIS", {"pos": _in_space(points)}, indices=triangles)


def _rectangles(areas: Sequence[tuple[Array, Rgba]]) -> gpu.types.GPUBatch:
    first = 4 * np.arange(len(areas), dtype=np.int32)[:, None, None]
    triangles = (first + np.array([(0, 1, 2), (0, 2, 3)], np.int32)).reshape(-1, 3)
    return batch_for_shader(
        gpu.shader.from_builtin("FLAT_COLOR"), "TRIS", _colored(areas), indices=triangles
    )


def _polylines(lines: Iterable[tuple[Array, Rgba]]) -> gpu.types.GPUBatch:
    """Polylines in one batch, each in its colour."""
    lines = list(lines)
    starts = np.cumsum([0, *(len(line) for line, _ in lines)])
    steps = [
        np.stack([np.arange(a, b - 1), np.arange(a + 1, b)], axis=1) for a, b in pairwise(starts)
    ]
    return batch_for_shader(
        gpu.shader.from_builtin("POLYLINE_FLAT_COLOR"),
        "LINES",
        _colored(lines),
        indices=np.concatenate(steps).astype(np.int32),
    )


def _colored(shapes: Sequence[tuple[Array, Rgba]]) -> dict[str, Array]:
    colors = [np.tile(np.array(color, np.float32), (len(points), 1)) for points, color in shapes]
    return {
        "pos": _in_space(np.concatenate([points for points, _ in shapes])),
        "color": np.concatenate(colors),
    }


def _in_space(points: Array) -> Array:
    """(N, 2) -> (N, 3) float32."""
    return np.pad(points, ((0, 0), (0, 1))).astype(np.float32)
