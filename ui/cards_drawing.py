"""Letters at the lines of the current junction; its alternatives as cards with small sketches."""

from __future__ import annotations

from typing import TYPE_CHECKING

import blf
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader

from ..operators.cards import Card
from ..operators.choose import cards_of
from ..operators.junction_words import letters, percent, sentence
from ..operators.under_mouse import places_on_screen
from .colors import LOOSE
from .overlay_geometry import labels, routes

if TYPE_CHECKING:
    import bpy

    from ..operators.view_state import Shown

_BACK = (0.11, 0.11, 0.12, 0.92)
_POINTED = (0.20, 0.27, 0.38, 0.96)
_EDGE = (0.35, 0.35, 0.36, 1.0)
_IN_FORCE = (0.35, 0.62, 1.0, 1.0)
_TEXT = (0.92, 0.92, 0.92, 1.0)
_FONT = 0


def draw(context: bpy.types.Context, shown: Shown) -> None:
    """Letters always; cards while the user is choosing."""
    junction, drawing = shown.junction, shown.trace.drawing
    scale = context.preferences.system.ui_scale
    named = labels(drawing, junction)
    places = places_on_screen(context, shown, np.array([place for _, place in named]))
    gpu.state.blend_set("ALPHA")
    for (letter, _), place in zip(named, places, strict=True):
        if np.isfinite(place).all():
            _badge(letter, place, scale)
    if shown.view.choosing:
        names = letters(drawing, junction)
        for number, card in enumerate(cards_of(context, shown)):
            way = junction.alternatives[number]
            _card(card, number == shown.view.preview, way.pairs == junction.pairs, scale)
            _sketch(shown, way.pairs, card, scale)
            _write(
                percent(way.probability),
                card.x + 8 * scale,
                card.y + card.height - 18 * scale,
                13 * scale,
            )
            _write(
                sentence(names, way.pairs),
                card.x + 8 * scale,
                card.y + 8 * scale,
                10 * scale,
                card.width - 16 * scale,
            )
    gpu.state.blend_set("NONE")


def draw_drag(context: bpy.types.Context, drag: tuple[float, float, float, float]) -> None:
    """The line from where a drag began to the mouse."""
    gpu.state.blend_set("ALPHA")
    _lines([np.reshape(drag, (2, 2))], (*LOOSE, 1.0), 2.0)
    gpu.state.blend_set("NONE")


def _sketch(shown: Shown, pairs: object, card: Card, scale: float) -> None:
    """The junction as it would be, as seen on the page; every line starts a bit off the middle."""
    middle = np.array([card.x + card.width / 2, card.y + card.height / 2 + 2 * scale])
    size = 30 * scale
    centre = np.array(shown.junction.position)
    for route in routes(shown.trace.drawing, shown.junction, pairs):
        line = (route.points - centre) * (1, -1)
        length = np.abs(line).max() or 1.0
        line = line * (size / max(length, 1e-6))
        if not route.joined:  # an end shows a gap
            line = line[np.linalg.norm(line, axis=1) > 7 * scale]
        if len(line) > 1:
            _lines([line + middle], (*route.color, 1.0), 3.0 * scale)


def _card(card: Card, pointed: bool, current: bool, scale: float) -> None:
    corners = np.array(
        [
            (card.x, card.y),
            (card.x + card.width, card.y),
            (card.x + card.width, card.y + card.height),
            (card.x, card.y + card.height),
        ],
        np.float32,
    )
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    shader.uniform_float("color", _POINTED if pointed else _BACK)
    batch_for_shader(shader, "TRI_FAN", {"pos": corners}).draw(shader)
    outline = np.concatenate([corners, corners[:1]])
    _lines([outline], _IN_FORCE if current else _EDGE, (2.0 if current else 1.0) * scale)


def _badge(letter: str, place: np.ndarray, scale: float) -> None:
    shader = gpu.shader.from_builtin("UNIFORM_COLOR")
    turn = np.linspace(0, 2 * np.pi, 24)
    disc = place + 9 * scale * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    shader.uniform_float("color", _BACK)
    batch_for_shader(shader, "TRI_FAN", {"pos": disc.astype(np.float32)}).draw(shader)
    blf.size(_FONT, 12 * scale)
    width, height = blf.dimensions(_FONT, letter)
    _write(letter, place[0] - width / 2, place[1] - height / 2, 12 * scale)


def _lines(lines: list[np.ndarray], color: tuple[float, ...], width: float) -> None:
    shader = gpu.shader.from_builtin("POLYLINE_UNIFORM_COLOR")
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", width)
    shader.uniform_float("color", color)
    for line in lines:
        flat = np.concatenate([line, np.zeros((len(line), 1))], axis=1).astype(np.float32)
        batch_for_shader(shader, "LINE_STRIP", {"pos": flat}).draw(shader)


def _write(text: str, x: float, y: float, size: float, room: float = 0.0) -> None:
    """Text at a place; made smaller when it would not fit in `room` pixels."""
    blf.size(_FONT, size)
    if room:
        size *= min(1.0, room / max(blf.dimensions(_FONT, text)[0], 1.0))
        blf.size(_FONT, size)
    blf.color(_FONT, *_TEXT)
    blf.position(_FONT, x, y, 0)
    blf.draw(_FONT, text)
