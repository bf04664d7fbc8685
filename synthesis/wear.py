"""What age and handling do to a sheet: stains, foxing, dark edges, dust. None of it is a line."""

from __future__ import annotations

import cv2
import numpy as np

from .line_art import Array, Rng
from .media import noise


def wear(rng: Rng, size: int) -> Array:
    """A (size, size) factor on the reflectance of a sheet, about 0.4..1."""
    left = np.ones((size, size), np.float32)
    if rng.random() < 0.5:
        for _ in range(rng.integers(1, 4)):
            left *= 1 - _stain(rng, size)
    if rng.random() < 0.5:
        left *= 1 - _foxing(rng, size)
    if rng.random() < 0.4:
        left *= 1 - _dark_edge(rng, size)
    return left


def dust(rng: Rng, ink: Array) -> Array:
    """Loose charcoal or dirt as an amount of ink in [0, 1]: specks all over the page or around
    what is drawn; ink: (H, W)."""
    size = len(ink)
    where = np.clip(noise(rng, "cloud", size) + rng.uniform(-0.5, 1), 0, 2)
    if rng.random() < 0.5:
        where = where * cv2.GaussianBlur(ink, (0, 0), rng.uniform(4, 15))
    specks = rng.random(ink.shape, np.float32) < rng.uniform(0.002, 0.03) * where
    spots = specks.astype(np.float32) * rng.uniform(0.2, 1, ink.shape).astype(np.float32)
    soft = cv2.GaussianBlur(spots, (0, 0), rng.uniform(0.4, 1.1))
    return np.clip(soft * rng.uniform(0.5, 3), 0, rng.uniform(0.2, 0.8))


def _stain(rng: Rng, size: int) -> Array:
    """A dried drop: a little darker inside, often with a dark rim."""
    y, x = np.mgrid[:size, :size].astype(np.float32)
    radius = np.exp(rng.uniform(np.log(0.04), np.log(0.7))) * size
    away = np.hypot(x - rng.uniform(0, size), (y - rng.uniform(0, size)) * rng.uniform(0.6, 1.6))
    away += 0.12 * radius * noise(rng, "cloud", size) + rng.uniform(0, 3) * noise(
        rng, "rough", size
    )
    inside = radius - away
    soft = rng.uniform(1, 12)
    fill = 1 / (1 + np.exp(np.clip(-inside / soft, -30, 30)))
    rim = np.exp(-((inside / rng.uniform(1.5, 8)) ** 2)) * (rng.random() < 0.6)
    return rng.uniform(0.01, 0.15) * fill + rng.uniform(0.02, 0.15) * rim


def _foxing(rng: Rng, size: int) -> Array:
    """Brown spots of all sizes, more of them in some places."""
    spots = np.zeros((size, size), np.float32)
    likely = np.clip(noise(rng, "cloud", size) + 0.7, 0.05, None)
    for sigma in rng.uniform(0.8, 7, 3):
        count = rng.uniform(2, 40) / sigma
        at = rng.random((size, size)) < count * likely / size**2
        height = rng.uniform(0.03, 0.3) * 2 * np.pi * sigma**2
        spots += cv2.GaussianBlur(at.astype(np.float32) * height, (0, 0), sigma)
    return np.minimum(spots * np.clip(1 + 0.4 * noise(rng, "tooth", size), 0, 2), 0.5)


def _dark_edge(rng: Rng, size: int) -> Array:
    """A border browned by the air, or in the shadow of the binding; it may end within the page."""
    y, x = np.mgrid[:size, :size].astype(np.float32)
    turn = rng.choice([0, 0.5, 1, 1.5]) * np.pi + rng.normal(0, 0.05)
    inward = (x - size / 2) * np.cos(turn) + (y - size / 2) * np.sin(turn) + size / 2
    inward += 3 * noise(rng, "rough", size) * rng.uniform(0, 1) + 6 * noise(rng, "cloud", size)
    return rng.uniform(0.05, 0.5) * np.exp(-np.maximum(inward, 0) / rng.uniform(5, 60))
