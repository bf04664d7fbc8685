"""Centerlines by the trained network: see training/centerline for its making."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import TypeVar

import numpy as np

from .. import weights
from ..settings import Settings
from ..values import Array, LineMaps
from . import CenterlineProvider, Tick
from .backends import Infer, InferBoth, load, load_both
from .tiles import look

WEIGHTS = weights.FOLDER / "centerline.onnx"
LEAN = weights.FOLDER / "centerline_lean.onnx"  # two fifths of the work; see its model card
STRIDE = 16  # px; the network wants both sides of its input to be multiples of this
HALF_WIDTH_UNIT = 10.5  # px of half-width, or apart, that an output of 1 stands for
_ALL_MAPS = 24_000_000  # px; larger pages go without the maps that only help
# Heads of the network are the first maps of LineMaps, in that order.
_NEEDED = (0, 3)  # centerline, half_width
_LENGTHS = (3, 6)  # half_width, apart

Answer = TypeVar("Answer")


def available() -> bool:
    """Whether the weights are there."""
    return WEIGHTS.exists()


def provider(settings: Settings, features: bool = False) -> CenterlineProvider:
    """A provider that runs the network on the device that the settings ask for.

    features: whether its maps come with the features.

    Raises:
        InvoluteError: the weights are missing, or there is no GPU though one is asked for.
    """
    if features:
        both = load_both(_chosen(settings), settings.device)
        return lambda scan, tick: trace_both(scan.ink, both, tick)
    look = at(settings)
    return lambda scan, tick: look(scan.ink, tick, None, None)


def _chosen(settings: Settings) -> Path:
    return LEAN if settings.provider == "lean" else WEIGHTS


def at(
    settings: Settings,
) -> Callable[[Array, Tick, tuple[int, int] | None, Array | None], LineMaps]:
    """`trace_maps` with the network that the settings ask for; raises as `provider` does."""
    infer = load(_chosen(settings), settings.device)
    return lambda ink, tick, shift, wanted: trace_maps(ink, infer, tick, shift, wanted)


def trace_maps(
    ink: Array,
    infer: Infer,
    tick: Tick,
    shift: tuple[int, int] | None = None,
    wanted: Array | None = None,
) -> LineMaps:
    """The maps of a page, (H, W) float32 ink in [0, 1], without features.

    `shift` and `wanted` are those of `tiles.look`. On pages of more than 24 megapixels, all but
    centerline and half_width are None: memory. Older weights have no doubled, apart and clean,
    or no lifted.
    """
    maps = _room(ink, _paper(infer).shape[0])

    def answers(window: Array) -> Array:
        return _cut(infer(_padded(window)), window.shape)

    look(ink, answers, maps, tick, shift, wanted)
    return _named(maps)


def trace_both(ink: Array, infer: InferBoth, tick: Tick) -> LineMaps:
    """The same with features; without those, too, on pages of more than 24 megapixels."""
    seen, deep = _paper(infer)
    maps = _room(ink, seen.shape[0])
    half = -(-ink.shape[0] // 2), -(-ink.shape[1] // 2)
    features = np.zeros((len(deep), *half), np.float32) if ink.size <= _ALL_MAPS else None

    def answers(window: Array) -> list[Array]:
        seen, deep = infer(_padded(window))
        return [*_cut(seen, window.shape), *deep]

    rest = [None] * len(deep) if features is None else list(features)
    look(ink, answers, [*maps, *rest], tick)
    return replace(_named(maps), features=features)


@cache
def _paper(infer: Callable[[Array], Answer]) -> Answer:
    """The answer to a piece of blank paper: how many maps there are."""
    return infer(np.zeros((STRIDE, STRIDE), np.float32))


def _room(ink: Array, heads: int) -> list[Array | None]:
    """A map for each head; large pages go without those that only help."""
    wanted = (ink.size <= _ALL_MAPS or head in _NEEDED for head in range(heads))
    return [np.zeros_like(ink) if want else None for want in wanted]


def _named(maps: list[Array | None]) -> LineMaps:
    """The maps in the order of the heads; lengths in px."""
    for head in _LENGTHS:
        length = maps[head] if head < len(maps) else None
        if length is not None:
            np.multiply(length, HALF_WIDTH_UNIT, out=length)
    centerline, *others = maps
    assert centerline is not None  # it is needed on every page
    return LineMaps(centerline, *others)


def _padded(window: Array) -> Array:
    """A window of any size with paper at its right and lower side, up to a multiple of STRIDE."""
    height, width = window.shape
    padding = ((0, -height % STRIDE), (0, -width % STRIDE))
    return np.pad(window, padding) if any(p for _, p in padding) else window


def _cut(seen: Array, shape: tuple[int, ...]) -> Array:
    return seen[:, : shape[0], : shape[1]]
