"""Screentone: even dots that stand for grey. It is ink, but nobody drew a line there."""

from __future__ import annotations

import cv2
import numpy as np

from .line_art import Array, Rng

FINEST, WIDEST = 3.5, 9.0  # px between dots; wider apart they are dots that a pen made


def screentone(rng: Rng, size: int, hard: bool) -> Array:
    """A (size, size) amount of ink: a patch of the page covered with even dots, some with a run
    from light to dark; hard: without any grey, as in pictures of one bit."""
    pitch = rng.uniform(FINEST, WIDEST)
    turn = rng.choice([0.0, 45.0, 45.0, 30.0, 15.0, 60.0]) * np.pi / 180
    y, x = np.mgrid[:size, :size].astype(np.float32) + 0.5
    u = (x * np.cos(turn) + y * np.sin(turn) + rng.uniform(0, pitch)) % pitch - pitch / 2
    v = (y * np.cos(turn) - x * np.sin(turn) + rng.uniform(0, pitch)) % pitch - pitch / 2
    radius = pitch * rng.uniform(0.15, 0.42)
    if rng.random() < 0.4:
        way = rng.uniform(0, 2 * np.pi)
        run = ((x * np.cos(way) + y * np.sin(way)) / size * rng.uniform(0.5, 2)) % 2
        radius = radius * (0.5 + 0.8 * np.abs(run - 1))
    edge = radius - np.hypot(u, v)
    dots = (edge > 0).astype(np.float32) if hard else np.clip(edge + 0.5, 0, 1)
    return dots * _patch(rng, size) * (1.0 if hard else rng.uniform(0.5, 1.0))


def _patch(rng: Rng, size: int) -> Array:
    """Where the tone was laid: a box, an angular or a round shape, or the whole page."""
    mask = np.zeros((size, size), np.uint8)
    count = int(rng.choice([3, 4, 5, 24]))
    turn = np.sort(rng.uniform(0, 2 * np.pi, count)) if count < 10 else np.linspace(0, 6.28, count)
    reach = rng.uniform(0.15, 0.7) * size * rng.uniform(0.7, 1.3, count if count < 10 else 1)
    shape = np.stack([np.cos(turn), np.sin(turn)], 1) * reach[:, None]
    cv2.fillPoly(mask, [np.round(shape + rng.uniform(0.1, 0.9, 2) * size).astype(np.int32)], 1)
    return mask.astype(np.float32)
