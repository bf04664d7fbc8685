"""Centerlines by the trained network: see training/centerline for its making."""

from __future__ import annotations

import numpy as np

from .. import weights
from ..settings import Settings
from ..values import Array, LineMaps, Scan
from . import CenterlineProvider, Tick
from .backends import Infer, load
from .tiles import look

WEIGHTS = weights.FOLDER / "centerline.onnx"
STRIDE = 16  # px; the network wants both sides of its input to be multiples of this
HALF_WIDTH_UNIT = 10.5  # px of half-width that an output of 1 stands for
_ALL_MAPS = 24_000_000  # px; larger pages go without the maps that only help


def available() -> bool:
    """Whether the weights are there."""
    return WEIGHTS.exists()


def provider(settings: Settings) -> CenterlineProvider:
    """A provider that runs the network on the device that the settings ask for.

    Raises:
        InvoluteError: the weights are missing or damaged, or there is no GPU though one is asked
            for.
    """
    infer = load(WEIGHTS, settings.device)

    def network(scan: Scan, tick: Tick) -> LineMaps:
        return trace_maps(scan.ink, infer, tick)

    return network


def trace_maps(ink: Array, infer: Infer, tick: Tick) -> LineMaps:
    """The maps of a page, (H, W) float32 ink in [0, 1].

    On pages of more than 24 megapixels, junctions, endpoints and solid are None: memory.
    """
    line, half = np.zeros_like(ink), np.zeros_like(ink)
    junctions = endpoints = solid = None
    if ink.size <= _ALL_MAPS:
        junctions, endpoints, solid = (np.zeros_like(ink) for _ in range(3))
    look(
        ink, lambda window: _padded(window, infer), [line, junctions, endpoints, half, solid], tick
    )
    half *= HALF_WIDTH_UNIT
    return LineMaps(line, junctions, endpoints, half, solid)


def _padded(window: Array, infer: Infer) -> Array:
    """The answer to a window of any size: paper is added at its right and lower side."""
    height, width = window.shape
    padding = ((0, -height % STRIDE), (0, -width % STRIDE))
    if any(p for _, p in padding):
        window = np.pad(window, padding)
    return infer(window)[:, :height, :width]
