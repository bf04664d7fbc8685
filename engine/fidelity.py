"""The drawing checks itself: how much of the ink is in it, and how much of it is not on ink.

lost: the share of the page's clear ink that no stroke and no fill covers.
invented: the share of the length of all strokes that runs over clear paper.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import cv2
import numpy as np

from .arrays.components import components
from .values import Array, Stroke

_CLEAR, _SOME = 0.5, 0.12  # ink: surely drawn; perhaps drawn
_BESIDE = 2.0  # px of the input that ink may reach beyond a stroke, or a stroke beyond ink
_SPECK = 5  # px; smaller pieces of ink are none
_GAP = 1.5  # gaps of a dashed line; a longer stretch over paper is no gap
_PLACES = 8  # as many are told, the largest first
_BITS = 4  # of a pixel, as OpenCV draws
_MUCH_LOST, _MUCH_INVENTED = 0.02, 0.02  # shares that are worth a warning

Box = tuple[float, float, float, float]
"""Left, top, width and height in px of the input."""


@dataclass(frozen=True)
class Fidelity:
    """How faithful a drawing is to the ink that was to be traced.

    lost, invented: shares, see above; lost_at, invented_at: where, the largest places first.
    """

    lost: float
    invented: float
    lost_at: tuple[Box, ...] = ()
    invented_at: tuple[Box, ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """As plain values, for files."""
        return asdict(self)

    @staticmethod
    def from_dict(values: dict[str, Any]) -> Fidelity:
        """What `as_dict` gave, or a file made of it."""

        def places(name: str) -> tuple[Box, ...]:
            return tuple((float(x), float(y), float(w), float(h)) for x, y, w, h in values[name])

        lost, invented = float(values["lost"]), float(values["invented"])
        return Fidelity(lost, invented, places("lost_at"), places("invented_at"))


def fidelity(
    strokes: Sequence[Stroke],
    fills: Iterable[Sequence[Array]],
    ink: Array,
    scale: float,
    width_scale: float = 1.0,
    overlooked: Array | None = None,
) -> Fidelity:
    """Compare a drawing with its page.

    Args:
        strokes, fills: in px of the input.
        ink: (H, W) float32 in [0, 1], all that was to be traced; working pixels.
        scale: input pixels per working pixel.
        width_scale: how many times too wide the strokes are on purpose.
        overlooked: (H, W) bool, ink of the page that is not in `ink` though it should be.
    """
    if overlooked is not None:
        ink = np.where(overlooked, np.float32(1), ink)
    clear = _without_specks(ink > _CLEAR)
    some = _without_specks(ink > _SOME)
    beside = max(1.0, _BESIDE / scale)
    lines = [_around(stroke) / scale - 0.5 for stroke in strokes]
    thick = [float(stroke.widths.mean()) / width_scale / scale + 2 * beside for stroke in strokes]
    lost = clear & ~_drawn(ink.shape, lines, thick, fills, scale, beside)
    paper = cv2.distanceTransform((~some).view(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5) > beside
    along = [_every_pixel(line) for line in lines]
    every = np.concatenate([np.zeros((0, 2)), *along])
    column, row = np.clip(np.rint(every).astype(int), 0, np.array(ink.shape[::-1]) - 1).T
    over = paper[row, column]
    stop = np.cumsum([len(line) for line in along])
    for stroke, line, end in zip(strokes, along, stop, strict=True):
        if stroke.dash:
            own = slice(end - len(line), end)
            over[own] = _longer(over[own], _GAP * stroke.dash[1] / scale)
    invented = np.zeros(ink.shape, bool)
    invented[row[over], column[over]] = True
    return Fidelity(
        lost=float(lost.sum() / max(1, clear.sum())),
        invented=float(over.sum() / max(1, len(over))),
        lost_at=_places(lost, scale),
        invented_at=_places(invented, scale),
    )


def warnings(found: Fidelity, light: bool) -> tuple[str, ...]:
    """What a user should know, each with what to do about it; empty for a good drawing.

    Args:
        light: whether the page was taken, by itself, for light lines on a dark ground.
    """
    bad = found.lost > _MUCH_LOST or found.invented > _MUCH_INVENTED
    if not bad:
        return ()
    if light and max(found.lost, found.invented) > 5 * _MUCH_LOST:
        return ("Traced as light lines on dark; if the ink is dark, try --polarity dark.",)
    said = []
    if found.lost > _MUCH_LOST:
        said.append(
            f"{found.lost:.0%} of the ink is not in the drawing; try --provider classical, or a "
            "smaller --min-length where dots and specks are missing."
        )
    if found.invented > _MUCH_INVENTED:
        said.append(
            f"{found.invented:.0%} of the length of the strokes runs over bare paper; raise "
            "--min-length, or set --pen-width."
        )
    return tuple(said)


def _without_specks(place: Array) -> Array:
    _, label, stats, _ = components(place.view(np.uint8))
    kept = np.zeros_like(place)
    kept[place] = (stats[:, cv2.CC_STAT_AREA] >= _SPECK)[label[place]]
    return kept


def _around(stroke: Stroke) -> Array:
    """(N, 2) points of a stroke; of a closed one with the first again at its end."""
    if stroke.handles is not None:
        return _curve(stroke)
    return np.vstack([stroke.points, stroke.points[:1]]) if stroke.closed else stroke.points


def _curve(stroke: Stroke) -> Array:
    """Points along a Bezier stroke, eight to a segment."""
    points, handles = stroke.points, stroke.handles
    assert handles is not None, "only a Bezier stroke is a curve"
    if stroke.closed:
        points = np.vstack([points, points[:1]])
        handles = np.concatenate([handles, handles[:1]])
    t = np.linspace(0, 1, 9)[:-1, None, None]
    a, b, c, d = points[:-1], handles[:-1, 1], handles[1:, 0], points[1:]
    along = (1 - t) ** 3 * a + 3 * t * (1 - t) ** 2 * b + 3 * t**2 * (1 - t) * c + t**3 * d
    return np.vstack([along.transpose(1, 0, 2).reshape(-1, 2), points[-1:]])


def _drawn(
    shape: tuple[int, ...],
    lines: Sequence[Array],
    thick: Sequence[float],
    fills: Iterable[Sequence[Array]],
    scale: float,
    beside: float,
) -> Array:
    """(H, W) bool: what strokes and fills cover, and a little beyond."""
    drawn = np.zeros(shape, np.uint8)
    for line, width in zip(lines, thick, strict=True):
        cv2.polylines(drawn, [_fixed(line)], False, 1, max(1, int(np.ceil(width))), shift=_BITS)
    for fill in fills:
        rings = [_fixed(ring / scale - 0.5) for ring in fill]
        cv2.fillPoly(drawn, rings, 1, shift=_BITS)
        cv2.polylines(drawn, rings, True, 1, 1 + 2 * int(np.ceil(beside)), shift=_BITS)
    return drawn > 0


def _fixed(points: Array) -> Array:
    """Pixels in OpenCV's fixed numbers, its pixel centres whole."""
    return np.round(points * (1 << _BITS)).astype(np.int32)


def _every_pixel(line: Array) -> Array:
    """(N, 2) points along a line, 1 px apart."""
    step = np.hypot(*np.diff(line, axis=0).T)
    arc = np.concatenate([[0.0], np.cumsum(step)])
    at = np.arange(0.0, arc[-1] + 1e-9, 1.0)
    return np.stack([np.interp(at, arc, line[:, k]) for k in (0, 1)], 1)


def _longer(over: Array, least: float) -> Array:
    """(N,) bool: what lies in a run of at least so many."""
    run = np.concatenate([[0], np.cumsum(over[1:] != over[:-1])])
    found: Array = over & (np.bincount(run)[run] >= least)
    return found


def _places(wrong: Array, scale: float) -> tuple[Box, ...]:
    """The boxes round the largest places, px of the input."""
    if not wrong.any():
        return ()
    near = cv2.dilate(wrong.view(np.uint8), np.ones((9, 9), np.uint8))
    count, label, stats, _ = components(near)
    much = np.bincount(label[wrong], minlength=count)
    order = np.argsort(-much, kind="stable")[:_PLACES]
    boxes = []
    for piece in order[much[order] > 0].tolist():
        x, y, width, height = (round(float(v) * scale, 1) for v in stats[piece, :4])
        boxes.append((x, y, width, height))
    return tuple(boxes)
