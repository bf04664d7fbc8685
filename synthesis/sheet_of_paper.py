"""Paper and what happens to a page: tone, folds, print, shadows, the scanner, and its cleaning."""

from __future__ import annotations

import cv2
import numpy as np

from .line_art import Array, Rng
from .media import noise
from .wear import wear


def paper(rng: Rng, size: int, ink_level: float, printed: float = 0.25, worn: float = 0.2) -> Array:
    """A (size, size) sheet of reflectance about 0.3..1, with print that is not to be traced.

    ink_level: how dark the drawing's ink is; ruled lines stay well below it. printed: how likely
    the sheet is to be ruled; worn: how likely it is to be stained.
    """
    sheet = np.full((size, size), rng.uniform(0.72, 1.0), np.float32)
    kind = rng.random()
    if kind > 0.3:
        sheet += rng.uniform(0, 0.03) * noise(
            rng, str(rng.choice(["fine", "grain", "tooth"])), size
        )
        sheet += rng.uniform(0, 0.03) * noise(
            rng, str(rng.choice(["blotch", "cloud", "fibre"])), size
        )
    if kind > 0.75:  # aged: stains and specks
        sheet += rng.uniform(0.01, 0.06) * noise(rng, "cloud", size)
        specks = noise(rng, str(rng.choice(["grain", "tooth", "rough"])), size)
        sheet -= rng.uniform(0.03, 0.2) * np.clip(specks - rng.uniform(2.3, 3.2), 0, 1)
    if rng.random() < worn:
        sheet *= wear(rng, size)
    if rng.random() < printed:
        sheet *= 1 - print_on(rng, size, ink_level)
    for _ in range(rng.choice([0, 0, 0, 0, 1, 2])):
        sheet += _fold(rng, size)
    return np.clip(sheet, 0.3, 1.05)


def _frame(rng: Rng, size: int) -> tuple[Array, Array]:
    """Coordinates of all pixels in a slightly turned frame."""
    y, x = np.mgrid[:size, :size].astype(np.float32)
    turn = rng.normal(0, 0.03)
    return x * np.cos(turn) + y * np.sin(turn), y * np.cos(turn) - x * np.sin(turn)


def print_on(rng: Rng, size: int, ink_level: float, pitch: float | None = None) -> Array:
    """Ruled lines, grid or dots as an amount of ink; regular, thin and lighter than the drawing.

    ink_level: how dark the drawing is; pitch: px between lines (a grid then), or None for any.
    """
    x, y = _frame(rng, size)
    if rng.random() < 0.3:
        x, y = y, x
    kind = rng.random() if pitch is None else 0.5
    pitch = pitch or float(np.exp(rng.uniform(np.log(9), np.log(100))))
    half = rng.uniform(0.4, 1.1)

    def lines(v: Array, pitch: float) -> Array:
        off = np.abs((v + rng.uniform(0, pitch)) % pitch - pitch / 2)
        return np.clip(half + 0.5 - off, 0, 1)

    rows = lines(y, pitch)
    if kind < 0.45:
        marks = rows
        if rng.random() < 0.4:
            marks = np.maximum(marks, lines(x, size * 1.7))
    elif kind < 0.9:
        marks = np.maximum(rows, lines(x, pitch))
        if rng.random() < 0.3:
            marks = np.maximum(marks * 0.6, np.maximum(lines(x, pitch * 5), lines(y, pitch * 5)))
    else:
        marks = rows * lines(x, pitch)
    return marks * rng.uniform(0.08, 0.55) * min(1.0, ink_level)


def _fold(rng: Rng, size: int) -> Array:
    """A crease: light on one side, dark on the other, low in contrast."""
    turn = rng.uniform(0, np.pi)
    y, x = np.mgrid[:size, :size].astype(np.float32)
    d = (x - rng.uniform(0, size)) * np.cos(turn) + (y - rng.uniform(0, size)) * np.sin(turn)
    d += 2 * noise(rng, "cloud", size)
    width = rng.uniform(1.5, 10)
    dark = np.exp(-((d / width) ** 2)) - rng.uniform(0, 1) * np.exp(
        -(((d - 2 * width) / width) ** 2)
    )
    return -rng.uniform(0.02, 0.09) * dark * (1 + 0.3 * noise(rng, "rough", size))


def shadow(rng: Rng, size: int) -> Array:
    """A (size, size) factor: uneven light, sometimes the soft edge of a shadow."""
    y, x = np.mgrid[:size, :size].astype(np.float32) / size - 0.5
    turn = rng.uniform(0, 2 * np.pi)
    ramp = x * np.cos(turn) + y * np.sin(turn)
    light = 1 + rng.uniform(0, 0.3) * ramp
    if rng.random() < 0.4:
        edge = rng.uniform(0.04, 0.5)
        light *= 1 - rng.uniform(0.1, 0.5) / (1 + np.exp(-(ramp - rng.uniform(-0.4, 0.4)) / edge))
    return light


def scan(rng: Rng, page: Array) -> Array:
    """What a scanner or phone makes of the page: blur, resampling, noise, JPEG."""
    size = len(page)
    if rng.random() < 0.15:
        small = int(size * rng.uniform(0.5, 0.95))
        page = cv2.resize(page, (small, small), interpolation=cv2.INTER_AREA)
        page = cv2.resize(
            page, (size, size), interpolation=int(rng.choice([cv2.INTER_LINEAR, cv2.INTER_CUBIC]))
        )
    if rng.random() < 0.45:
        page = cv2.GaussianBlur(page, (0, 0), rng.uniform(0.3, 1.1))
    if rng.random() < 0.1:
        blurred = cv2.GaussianBlur(page, (0, 0), 1.0)
        page = page + rng.uniform(0.3, 1.0) * (page - blurred)
    if rng.random() < 0.6:
        page = page + rng.uniform(0, 0.05) * noise(
            rng, str(rng.choice(["fine", "fine", "grain"])), size
        )
    if rng.random() < 0.05:
        salt = rng.random(page.shape)
        page = np.where(salt < 0.004, 0.0, np.where(salt > 0.996, 1.0, page))
    page = np.clip(page, 0, 1) * 255
    if rng.random() < 0.45:
        quality = int(rng.uniform(30, 95))
        ok, data = cv2.imencode(".jpg", page.astype(np.uint8), [cv2.IMWRITE_JPEG_QUALITY, quality])
        if ok:
            page = np.asarray(cv2.imdecode(data, cv2.IMREAD_GRAYSCALE))
    return np.round(page).astype(np.float32) / 255


def clean(rng: Rng, page: Array) -> Array:
    """The page as the engine's scan stage hands it on: ink in [0, 1] on flattened paper.

    The level that counts as full ink varies on purpose, so that the network does not lean on it.
    """
    small = cv2.resize(page, None, fx=0.25, fy=0.25, interpolation=cv2.INTER_AREA)
    reach = int(rng.choice([9, 13, 17]))
    kernel = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (reach, reach))
    light = cv2.morphologyEx(small, cv2.MORPH_CLOSE, kernel, borderType=cv2.BORDER_REFLECT)
    light = cv2.GaussianBlur(light, (0, 0), reach / 3)
    light = cv2.resize(light, page.shape[::-1], interpolation=cv2.INTER_LINEAR)
    ink = 1 - page / np.maximum(light, 0.05)
    floor = rng.uniform(0, 0.05)
    full = max(0.15, float(np.quantile(ink, 0.995))) ** rng.uniform(0, 1.0)
    return np.clip((ink - floor) / (full * rng.uniform(0.85, 1.1)), 0, 1).astype(np.float32)
