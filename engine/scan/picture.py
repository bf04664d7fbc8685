"""A picture as an array of one kind: checked, over white, in RGB order; and what it shows as grey.

Values may be uint8, uint16, or float32 in [0, 1].
"""

from __future__ import annotations

from os import PathLike
from pathlib import Path

import cv2
import numpy as np

from ..errors import InvoluteError
from ..values import Array
from .image_file import read_image
from .largest import MAX_SIDE

Source = str | PathLike[str] | Array

MIN_SIDE = 16  # px
_DARKEST, _LIGHT = 0.02, 0.5  # the darkest 2 % of the opaque pixels are lighter than half of white


def checked_picture(source: Source, page: int, polarity: str = "auto") -> Array:
    """An (H, W) or (H, W, 3) RGB array, uint8, uint16 or float32 in [0, 1].

    What is transparent becomes white; black when the lines are light, by `polarity` or "auto", by
    the picture itself.
    """
    if isinstance(source, np.ndarray):
        picture, name = source, "The array"
    else:
        picture, name = read_image(source, page), Path(source).name
        if picture.dtype.kind in "if" and picture.size:  # a TIFF of measurements: any range
            picture = picture.astype(np.float32) / max(1.0, float(np.nanmax(picture)))
    if picture.ndim == 3 and picture.shape[2] == 1:
        picture = picture[..., 0]
    if picture.ndim not in (2, 3) or (picture.ndim == 3 and picture.shape[2] not in (3, 4)):
        raise InvoluteError(
            f"Can't trace an array of shape {picture.shape}; give (H, W), (H, W, 3) or (H, W, 4)."
        )
    height, width = picture.shape[:2]
    if min(height, width) < MIN_SIDE:
        raise InvoluteError(
            f"{name} is only {width} x {height} px; give a picture of at least "
            f"{MIN_SIDE} x {MIN_SIDE} px."
        )
    if max(height, width) > MAX_SIDE:
        raise InvoluteError(
            f"{name} is {width} x {height} px; scale it down to at most {MAX_SIDE:,} px a side."
        )
    if picture.dtype.kind == "f":
        if not np.isfinite(picture).all():
            raise InvoluteError(f"{name} holds values that aren't numbers; replace the NaN first.")
        if picture.min() < -0.01 or picture.max() > 1.01:
            raise InvoluteError(
                f"{name} holds values outside 0 to 1; divide them by their maximum."
            )
        picture = np.clip(picture, 0, 1, dtype=np.float32)
    elif picture.dtype == bool:
        picture = picture.astype(np.uint8) * np.uint8(255)
    elif picture.dtype not in (np.uint8, np.uint16):
        raise InvoluteError(
            f"Can't trace values of type {picture.dtype}; give uint8, uint16 or float in [0, 1]."
        )
    if picture.ndim == 3 and picture.shape[2] == 4:
        picture = _over_ground(picture, polarity)
    step = max(1, max(height, width) // 2048)
    if picture.ndim == 3 and not np.ptp(picture[::step, ::step], axis=2).any():
        picture = picture[..., 1]  # a grey page saved as colour
    return np.ascontiguousarray(picture)


def _over_ground(picture: Array, polarity: str) -> Array:
    """An RGBA picture over white; over black when nothing on it is dark: white lines show there."""
    top = white_of(picture)
    light = polarity == "light" or (polarity == "auto" and _is_light(picture))
    ground = 0.0 if light else top
    out = np.empty((*picture.shape[:2], 3), picture.dtype)
    for rows in row_strips(picture):
        alpha = picture[rows, :, 3:].astype(np.float32) / top
        out[rows] = picture[rows, :, :3] * alpha + ground * (1 - alpha) + (0.5 if top > 1 else 0)
    return out


def _is_light(picture: Array) -> bool:
    """Whether an RGBA picture has ink, and none of it is dark."""
    step = max(1, max(picture.shape[:2]) // 1024)
    small = np.ascontiguousarray(picture[::step, ::step])
    opaque = small[..., 3] > 0.5 * white_of(picture)
    if opaque.all() or not opaque.any():
        return False
    gray = darkest_gray(np.ascontiguousarray(small[..., :3]))[opaque]
    return float(np.quantile(gray, _DARKEST)) > _LIGHT * white_of(picture)


def darkest_gray(picture: Array) -> Array:
    """How light each pixel is, (H, W) in the picture's type; a coloured ink is dark in its darkest
    channel, so that yellow pencil counts too."""
    if picture.ndim == 2:
        return picture
    gray = cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY)
    red, green, blue = cv2.split(picture)
    return cv2.addWeighted(gray, 0.5, cv2.min(red, cv2.min(green, blue)), 0.5, 0)


def row_strips(picture: Array) -> list[slice]:
    """Slices of rows of about a million pixels, to work on large pictures in little memory."""
    rows = max(1, int(1e6) // picture.shape[1])
    return [slice(start, start + rows) for start in range(0, picture.shape[0], rows)]


def white_of(picture: Array) -> float:
    """The value of white."""
    return 1.0 if picture.dtype.kind == "f" else float(np.iinfo(picture.dtype).max)


def unit(picture: Array) -> Array:
    """As float32 in [0, 1]."""
    return np.multiply(picture, np.float32(1 / white_of(picture)), dtype=np.float32)


def as_bytes(picture: Array) -> Array:
    return picture if picture.dtype == np.uint8 else np.round(unit(picture) * 255).astype(np.uint8)
