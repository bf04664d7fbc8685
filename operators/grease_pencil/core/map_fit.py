"""Where the pixels of a drawing lie, looked up from its strokes.

Applying an object's transform, joining objects and separating strokes move all points and tell
nobody. Strokes that still have as many points as they were traced with say where their pixels
went; most of them have to agree.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass
from hashlib import blake2b
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np

from .pixel_map import PixelMap

if TYPE_CHECKING:
    from ....engine import Drawing

Array = np.ndarray

_MAX_KEPT = 64
_SAMPLED = 120  # strokes; three points of each say enough
_AGREE = 0.5  # px; a point that is this near lies where the map says
_ROUNDS = 4  # of fitting and leaving out what the artist moved
_kept: OrderedDict[bytes, PixelMap] = OrderedDict()
_strokes: WeakKeyDictionary[Drawing, dict[int, Array]] = WeakKeyDictionary()


@dataclass(frozen=True, eq=False)
class Places:
    """The strokes of one cel as far as the map needs them.

    offsets: (n + 1,) int32. points: (P, 3) in object space. keys, halves: (n,) as in
    `stroke_arrays`.
    """

    offsets: Array
    points: Array
    keys: Array
    halves: Array


@dataclass(frozen=True, eq=False)
class Shapes(Places):
    """The strokes of one cel with their shapes.

    cyclic, curved: (n,) bool. handles: (P, 2, 3) left and right, or None where nothing is curved.
    """

    cyclic: Array
    curved: Array
    handles: Array | None


def fitted(drawing: Drawing, cels: Sequence[Places], key: int, stored: PixelMap) -> PixelMap:
    """The map that most strokes agree on; the stored one where they agree with it, or on none.

    Args:
        cels: what the layers show.
        key: of the trace whose drawing it is.
    """
    pixels, places = _pairs(drawing, cels, key)
    if len(pixels) < 3:
        return stored
    content = blake2b(digest_size=16)
    for values in (pixels, places, np.array(stored.as_list())):
        content.update(np.ascontiguousarray(values).tobytes())
    name = content.digest()
    if name not in _kept:
        _kept[name] = _fit(pixels, places, stored)
        while len(_kept) > _MAX_KEPT:
            _kept.popitem(last=False)
    return _kept[name]


def _pairs(drawing: Drawing, cels: Sequence[Places], key: int) -> tuple[Array, Array]:
    """(N, 2) pixels and (N, 3) places of the first, middle and last points of some strokes."""
    strokes = _by_first_half(drawing)
    pixels, places = [], []
    for cel in cels:
        mine = np.flatnonzero((cel.keys == key) & (cel.halves > 0))
        chosen = mine[:: max(1, len(mine) // _SAMPLED)]
        for curve in chosen.tolist():
            points = strokes.get(int(cel.halves[curve]))
            start, end = cel.offsets[curve : curve + 2].tolist()
            if points is None or end - start != len(points):
                continue
            for at in {0, len(points) // 2, len(points) - 1}:
                pixels.append(points[at])
                places.append(cel.points[start + at])
    if not pixels:
        return np.zeros((0, 2)), np.zeros((0, 3))
    return np.array(pixels, np.float64), np.array(places, np.float64)


def _by_first_half(drawing: Drawing) -> dict[int, Array]:
    """The points of each stroke, by its first half-branch counted from 1; made once a drawing."""
    if drawing not in _strokes:
        strokes = (s for s in drawing.strokes if len(s.branches))
        _strokes[drawing] = {int(s.branches[0]) + 1: s.points for s in strokes}
    return _strokes[drawing]


def _fit(pixels: Array, places: Array, stored: PixelMap) -> PixelMap:
    if _agreeing(stored, pixels, places).mean() >= 0.5:
        return stored
    used = np.isfinite(places).all(axis=1)
    rows = np.column_stack([np.ones(len(pixels)), pixels])
    for _ in range(_ROUNDS):
        solved, _, rank, _ = np.linalg.lstsq(rows[used], places[used], rcond=None)
        if rank < 3:
            return stored
        away = np.linalg.norm(rows @ solved - places, axis=1)
        used = away <= np.nanmedian(away)
    found = PixelMap(*solved)
    flat = np.linalg.norm(np.cross(found.right, found.down)) <= 1e-12 * found.unit**2
    enough = _agreeing(found, pixels, places).mean() >= 0.5
    return found if enough and not flat else stored


def _agreeing(pixel_map: PixelMap, pixels: Array, places: Array) -> Array:
    away = np.linalg.norm(pixel_map.to_object(pixels) - places, axis=1)
    return away <= _AGREE * pixel_map.unit
