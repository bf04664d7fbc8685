"""What is drawn on the back of a sheet and shows through it: paler and softer than the front.

Paper spreads what shines through it, so that its edges are soft however sharp the pen was. Pencil
under ink is as pale, but as sharp as the ink; a page of one strength shows nothing of its back.
"""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np

from ..arrays.two_clusters import Split, best_split
from ..settings import Settings
from ..values import Array, Scan

_INK = 0.06  # of full ink: what is any
_CORE = 0.6  # of the strongest ink nearby, that the middle of a line has
# Pen widths on either side in which that is looked for. With 0.5 pencil of one of these pages goes;
# 1 to 2 leave as much, and take a little more of the drawings.
_AROUND = 0.75
# The largest value at which pencil under ink stays: on 140 held-out pages (synthesis.hard_pages.
# both_sides) 0.8 leaves 0.30 of what shows through, and takes 0.0005 of the
# drawings and none of the pencil of 31; with 0.7 0.54 is left, with 0.85 as much as with 0.8, with
# 0.9 0.10 and 0.22, but pencil of five pages goes.
_SOFTER = 0.8  # of the sharpness of the front, that the back has at most
_FAINTEST = 0.1  # share: fainter lines are grain
_FRONT = 0.75  # share of the front's usual ink that is surely the front
# Of the front's strength, that the back has at most: 0.7 to 0.9 do alike there, 0.6 leaves 0.34.
_PALER = 0.7
# Of the lines: what may be neither (0.1 to 0.5 do alike); what either has (0.1 leaves 0.37).
_BETWEEN, _LEAST = 0.2, 0.05
_EDGE = 2  # px that the soft edge of the front reaches


def without_show_through(scan: Scan, settings: Settings) -> Scan:
    """The scan without what shows through from the back of its sheet; what is drawn over it on the
    front stays."""
    if not settings.show_through or settings.provider == "given":
        return scan
    back = _back(scan.ink, scan.pen_width)
    if back is None:
        return scan
    share = float(scan.ink[back].sum() / max(scan.ink.sum(), 1e-6))
    note = f"What shows through from the back was left out: {share:.0%} of the ink."
    ink = np.where(back, np.float32(0), scan.ink)
    return replace(scan, ink=ink, notes=(*scan.notes, note))


def _back(ink: Array, pen: float) -> Array | None:
    """(H, W) bool, what shows through; None where nothing does."""
    reach = 2 * max(1, round(_AROUND * pen)) + 1
    strength = cv2.dilate(ink, np.ones((reach, reach), np.uint8))
    core = (ink > _INK) & (ink > _CORE * strength)
    count = np.bincount(np.uint8(np.round(strength[core] * 255)), minlength=256)
    count[: round(255 * _FAINTEST)] = 0
    if not count.any():
        return None
    split = best_split(np.flatnonzero(count) / 255, count[count > 0])
    if split is None or not _is_of_two(split):
        return None
    front = strength > split.level
    # How steep the ink falls beside a line, for its strength; a blurred line falls slowly.
    way = [cv2.Sobel(ink, cv2.CV_32F, *axis, scale=1 / 8) for axis in ((1, 0), (0, 1))]
    steep = np.hypot(*way)
    steep = cv2.dilate(steep, np.ones((reach, reach), np.uint8))
    clear = front & (strength > _FRONT * split.high)
    near = cv2.dilate(
        front.view(np.uint8), np.ones((reach + 2 * _EDGE, reach + 2 * _EDGE), np.uint8)
    )
    pale = core & (near == 0) & (strength > _FAINTEST)
    if not pale.any() or not (core & clear).any():
        return None
    sharp, soft = (float(np.median(steep[at] / strength[at])) for at in (core & clear, pale))
    if soft > _SOFTER * sharp:
        return None
    edge = cv2.dilate((ink > split.level).view(np.uint8), np.ones((2 * _EDGE + 1,) * 2, np.uint8))
    back: Array = (ink > 0) & (edge == 0)
    return back


def _is_of_two(split: Split) -> bool:
    """Whether the strengths of a page may be those of a front and a back."""
    paler = split.low < _PALER * split.high
    return paler and split.between < _BETWEEN and split.share > _LEAST
