"""From any picture of a drawing to a `Scan`: find its polarity and its pen, flatten its paper.

Files are decoded in `image_file`, paper is taken out in `paper`.
"""

from __future__ import annotations

from os import PathLike
from pathlib import Path

import cv2
import numpy as np

from ..arrays.distance import depth
from ..errors import InvoluteError
from ..settings import Settings
from ..values import Array, Scan
from .image_file import page_count, read_image
from .paper import flatten_paper

Source = str | PathLike[str] | np.ndarray

MIN_SIDE, MAX_SIDE = 16, 20_000  # px
_PEN_RANGE = (1.5, 8.0)  # working px; pens within stay as they are
_PEN_TARGET = (2.5, 6.0)  # what thinner and thicker ones are brought to
_PLENTY, _ENOUGH = 4e6, 4.0  # px of a page above which pens as wide as this will do
_MOST_PIXELS = 64e6  # of a working page: bounds memory and time at 20,000 px
_LEAST_SIDE = 256  # px; no page is worked smaller than this because of a fat pen
_DEFAULT_PEN = 3.0  # px; of a page without a line
_WINDOW, _WINDOWS = 512, 16  # px and number of the places where the pen is measured
_FLAT_WHOLE = 4e6  # px; up to here the pen is measured on the page that is worked on


def read_scan(source: Source, settings: Settings, page: int = 0) -> Scan:
    """Read a picture and prepare it for tracing.

    Args:
        source: path of an image, or an (H, W), (H, W, 3) or (H, W, 4) array in RGB(A) order: bool,
            uint8, uint16 or float in [0, 1].
        settings: polarity, pen_width and provider are used. With provider "given" the picture is
            taken as it is: ink = its luminance, scale 1.
        page: which page of a TIFF with several.

    Returns:
        The page at the scale where its pen is 1.5 to 8 px wide; a blank page has no ink at all.

    Raises:
        InvoluteError: the picture can't be read, or is black all over.
    """
    picture = _checked(source, page)
    height, width = picture.shape[:2]
    if settings.provider == "given":
        luma = cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY) if picture.ndim == 3 else picture
        return Scan(_unit(luma), None, 1.0, (width, height), settings.pen_width or 2.0)
    if _is_light_on_dark(picture, settings):
        picture = _with_lightness_inverted(picture)
    gray = _gray(picture)
    ink = flatten_paper(_unit(gray)) if gray.size <= _FLAT_WHOLE else None
    pen = settings.pen_width or _measured_pen(gray, ink) or _DEFAULT_PEN
    scale = _working_scale(pen, width, height)
    if ink is None or scale != 1.0:
        ink = flatten_paper(_unit(_resized(gray, scale)))
    color = _bytes(_resized(picture, scale)) if picture.ndim == 3 else None
    return Scan(ink, color, scale, (width, height), pen / scale)


# --- the picture -----------------------------------------------------------------------------


def _checked(source: Source, page: int) -> Array:
    """An (H, W) or (H, W, 3) RGB array over white, uint8, uint16 or float32 in [0, 1]."""
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
        picture = _over_white(picture)
    step = max(1, max(height, width) // 2048)
    if picture.ndim == 3 and not np.ptp(picture[::step, ::step], axis=2).any():
        picture = picture[..., 1]  # a grey page saved as colour
    return np.ascontiguousarray(picture)


def _over_white(picture: Array) -> Array:
    top = _top(picture)
    out = np.empty((*picture.shape[:2], 3), picture.dtype)
    for rows in _strips(picture):
        alpha = picture[rows, :, 3:].astype(np.float32) / top
        out[rows] = picture[rows, :, :3] * alpha + top * (1 - alpha) + (0.5 if top > 1 else 0)
    return out


def _is_light_on_dark(picture: Array, settings: Settings) -> bool:
    """Whether the lines are lighter than what is around them."""
    if settings.polarity != "auto":
        return settings.polarity == "light"
    # Thin lines would fade in a reduced picture: take every n-th pixel instead.
    step = max(1, max(picture.shape[:2]) // 1024)
    small = _bytes(_gray(np.ascontiguousarray(picture[::step, ::step])))
    if small.max() < 26:
        raise InvoluteError(
            "The picture is black all over; scan the page again, or choose polarity 'light' if "
            "it is an empty blackboard."
        )
    # The median is the paper wherever lines cover less than half of the surroundings.
    reach = min(255, min(small.shape) // 2 | 1)
    away = small.astype(np.int16) - cv2.medianBlur(small, reach)
    grain = 3 * float(np.median(np.abs(away))) + 8
    return bool(np.maximum(away - grain, 0).sum() > np.maximum(-away - grain, 0).sum())


def _with_lightness_inverted(picture: Array) -> Array:
    """White becomes black and black white; red stays red."""
    top = picture.dtype.type(_top(picture))
    if picture.ndim == 2:
        return top - picture
    out = np.empty_like(picture)
    for rows in _strips(picture):
        part = picture[rows]
        # Unsigned arithmetic wraps around, and back again: the result always fits.
        out[rows] = part + (top - part.max(axis=2, keepdims=True) - part.min(axis=2, keepdims=True))
    return out


def _gray(picture: Array) -> Array:
    """How light each pixel is, (H, W) in the picture's type; a coloured ink is dark in its darkest
    channel, so that yellow pencil counts too."""
    if picture.ndim == 2:
        return picture
    gray = cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY)
    red, green, blue = cv2.split(picture)
    return cv2.addWeighted(gray, 0.5, cv2.min(red, cv2.min(green, blue)), 0.5, 0)


def _strips(picture: Array) -> list[slice]:
    """Slices of rows of about a million pixels, to work on large pictures in little memory."""
    rows = max(1, int(1e6) // picture.shape[1])
    return [slice(start, start + rows) for start in range(0, picture.shape[0], rows)]


def _top(picture: Array) -> float:
    """The value of white."""
    return 1.0 if picture.dtype.kind == "f" else float(np.iinfo(picture.dtype).max)


def _unit(picture: Array) -> Array:
    """As float32 in [0, 1]."""
    return np.multiply(picture, np.float32(1 / _top(picture)), dtype=np.float32)


def _bytes(picture: Array) -> Array:
    return picture if picture.dtype == np.uint8 else np.round(_unit(picture) * 255).astype(np.uint8)


# --- the pen and the scale -------------------------------------------------------------------


def measure_pen(ink: Array) -> float:
    """Typical full width of the lines in an ink map, px; 0 when it has none."""
    return _typical([_line_widths(ink)])


def _measured_pen(gray: Array, ink: Array | None) -> float:
    """The pen where the page has most ink; `ink` is the flattened page when it is small enough."""
    if ink is not None:
        return _typical([_line_widths(ink[window]) for window in _inkiest_windows(-ink)])
    windows = _inkiest_windows(gray)
    return _typical([_line_widths(flatten_paper(_unit(gray[window]))) for window in windows])


def _typical(widths: list[Array]) -> float:
    """The mean of the middle half: as robust as a median, but not confined to whole pixels."""
    every = np.sort(np.concatenate([np.zeros(0), *widths]))
    middle = every[len(every) // 4 : -(-3 * len(every) // 4)]
    return float(middle.mean()) if middle.size else 0.0


def _inkiest_windows(gray: Array) -> list[tuple[slice, slice]]:
    """The windows that are darkest against their own lightest part."""
    found = []
    for top in range(0, gray.shape[0], _WINDOW):
        for left in range(0, gray.shape[1], _WINDOW):
            window = (slice(top, top + _WINDOW), slice(left, left + _WINDOW))
            sample = gray[window][::3, ::3]
            if min(sample.shape) >= 4:
                found.append((float(sample.max()) - float(sample.mean()), window))
    found.sort(key=lambda entry: -entry[0])
    return [window for _, window in found[:_WINDOWS]]


def _line_widths(ink: Array) -> Array:
    """The full width at every pixel along the middle of the lines; dots and blobs do not count.

    Measured at twice the resolution, since half a pixel matters for a thin pen.
    """
    soft = cv2.GaussianBlur(ink, (0, 0), 0.7)
    large = cv2.resize(soft, None, fx=2, fy=2, interpolation=cv2.INTER_LINEAR)
    peak = cv2.dilate(large, np.ones((13, 13), np.uint8))
    dark = (large > np.maximum(0.5 * peak, 0.2)).astype(np.uint8)
    distance = depth(dark)
    middle = (dark > 0) & (distance >= cv2.dilate(distance, np.ones((3, 3), np.uint8)))
    _, label, stats, _ = cv2.connectedComponentsWithStats(dark)
    extent = np.hypot(stats[:, cv2.CC_STAT_WIDTH], stats[:, cv2.CC_STAT_HEIGHT])
    widths, owner = distance[middle], label[middle]
    widths = widths[extent[owner] > np.maximum(12.0, 6.0 * widths)]
    return np.sqrt(np.maximum(widths**2 - 3.0, 1.0))  # less what blur and pixels have added


def _working_scale(pen: float, width: int, height: int) -> float:
    """Input pixels per working pixel."""
    scale = 1.0
    if pen > _PEN_RANGE[1]:
        scale = max(1.0, min(pen / _PEN_TARGET[1], max(width, height) / _LEAST_SIDE))
    elif pen < _PEN_RANGE[0]:
        scale = max(0.5, pen / _PEN_TARGET[0])
    pixels = width * height / scale**2
    if pixels > _PLENTY and pen / scale > _ENOUGH:
        scale *= min(pen / scale / _ENOUGH, (pixels / _PLENTY) ** 0.5)
    return max(scale, (width * height / _MOST_PIXELS) ** 0.5)


def _resized(picture: Array, scale: float) -> Array:
    if scale == 1.0:
        return picture
    how = cv2.INTER_AREA if scale > 1 else cv2.INTER_CUBIC
    # Only fx and fy (without a size) make OpenCV use exactly this scale in both directions.
    out = cv2.resize(picture, None, fx=1 / scale, fy=1 / scale, interpolation=how)
    return np.clip(out, 0, 1, out=out) if out.dtype.kind == "f" else out


__all__ = ["MAX_SIDE", "MIN_SIDE", "flatten_paper", "measure_pen", "page_count", "read_scan"]
