"""The frames of a sequence: where the ink is that of the frame before, its answer is taken over.

A held background, or the body under a moving arm, is looked at once and drawn alike in all frames.
What a pixel's answer depends on lies within `tiles.CONTEXT`, nearly all of it within `_DEPENDS`.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import cv2
import numpy as np

from ..settings import Settings
from ..values import Array, LineMaps, Scan
from . import Tick, learned, provider_for
from .tiles import BLOCK, active_blocks, shift_of

# Ink that counts as the same: on frames of equal pixels but for a part, paper and pen, which are
# measured on the whole page, change the ink of the rest by up to 0.014.
_SAME = 0.02
# px. Farther from a change of the ink, the maps of four pages were other by 0.005 at most, by 0.03
# from 32 px on, and by nothing from 96 on.
_DEPENDS = 64
_MOST = 512e6  # bytes of the maps that are kept, or the frames are too large for that
_WORTH = 0.8  # of the inked blocks that have to be looked at anew, at most: else all of them are


@dataclass(frozen=True, eq=False)
class _Seen:
    """asked: what else the answer depends on. ink: (H, W), of which the maps were made. shift: rows
    and columns of paper before it."""

    asked: tuple[object, ...]
    ink: Array
    shift: tuple[int, int]
    maps: LineMaps


class FrameBefore:
    """The last frame that was looked at; give the same one to every `vectorize` of a sequence.

    For one thread. A frame that is not alike is looked at as if there were none before it.
    """

    def __init__(self) -> None:
        self._seen: _Seen | None = None
        self.looked_at = 1.0  # share of the last frame's inked blocks that was looked at anew

    def look(self, scan: Scan, settings: Settings, tick: Tick) -> LineMaps:
        """What the provider that the settings ask for sees in a frame."""
        if settings.provider in ("given", "classical") or not learned.available():
            return provider_for(settings)(scan, tick)
        asked = (settings.provider, settings.device, scan.ink.shape, scan.scale)
        before = self._seen if self._seen and self._seen.asked == asked else None
        changed = _changed(scan.ink, before) if before else None
        self.looked_at = 1.0
        if before is None or changed is None:
            shift = shift_of(scan.ink)
            maps = learned.at(settings)(scan.ink, tick, shift, None)
            known = sum(isinstance(getattr(maps, f.name), np.ndarray) for f in fields(maps))
            fits = (known + 1) * scan.ink.nbytes <= _MOST
            self._seen = _Seen(asked, scan.ink, shift, maps) if fits else None
            return maps
        active = active_blocks(scan.ink, before.shift)
        self.looked_at = float((active & changed).sum() / max(1, active.sum()))
        maps = learned.at(settings)(scan.ink, tick, before.shift, changed)
        anew = _pixels(changed, before.shift, scan.ink.shape)
        maps = _merged(before.maps, maps, anew)
        ink = np.where(anew, scan.ink, before.ink)  # what the maps are of: differences don't add up
        self._seen = replace(before, ink=ink, maps=maps)
        return maps


def _changed(ink: Array, before: _Seen) -> Array | None:
    """The blocks of the page, shifted, whose answer another ink may change; None for nearly all."""
    other: Array = (cv2.absdiff(ink, before.ink) > _SAME).view(np.uint8)
    down, right = before.shift
    height, width = ink.shape
    frame = down, -(height + down) % BLOCK, right, -(width + right) % BLOCK
    other = cv2.copyMakeBorder(other, *frame, cv2.BORDER_CONSTANT, value=0)
    rows, columns = (side // BLOCK for side in other.shape)
    blocks = other.reshape(rows, BLOCK, columns, BLOCK).any((1, 3)).view(np.uint8)
    reach = 2 * (_DEPENDS // BLOCK) + 1
    blocks = cv2.dilate(blocks, np.ones((reach, reach), np.uint8)) > 0
    active = active_blocks(ink, before.shift)
    return blocks if (active & blocks).sum() <= _WORTH * active.sum() else None


def _pixels(blocks: Array, shift: tuple[int, int], shape: tuple[int, ...]) -> Array:
    """(H, W) bool: the pixels of some blocks."""
    whole = np.kron(blocks, np.ones((BLOCK, BLOCK), bool))
    return whole[shift[0] : shift[0] + shape[0], shift[1] : shift[1] + shape[1]]


def _merged(before: LineMaps, anew: LineMaps, where: Array) -> LineMaps:
    """The maps of before, and where something changed the new ones."""
    named = {field.name: getattr(anew, field.name) for field in fields(anew)}
    merged = {
        name: np.where(where, new, getattr(before, name))
        for name, new in named.items()
        if isinstance(new, np.ndarray) and new.shape == where.shape
    }
    return replace(anew, **merged)
