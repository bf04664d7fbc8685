"""From any picture of a drawing to a `Scan`: read it, find its polarity, flatten its paper.

`flatten_paper` is the one normalisation that every later stage (and the training of the
centerline network) relies on: it turns a grey page into even, anti-aliased ink.
"""

from __future__ import annotations

import os
from os import PathLike
from pathlib import Path

import cv2
import numpy as np

from .errors import InvoluteError
from .settings import Settings
from .values import Array, Scan

Source = str | PathLike[str] | np.ndarray

MIN_SIDE, MAX_SIDE = 16, 20_000
_PEN_RANGE = (1.5, 8.0)  # working pixels
_PEN_TARGET = (2.5, 6.0)  # what a pen outside that range is brought to
_MAX_WORKING = 100e6  # working pixels of one page: bounds memory and time at 20,000 px
_DEFAULT_PEN = 3.0  # of a page without a line
_BLOCK = 8  # px; paper is estimated on a grid of such blocks


def read_scan(source: Source, settings: Settings, page: int = 0) -> Scan:
    """Read a picture and prepare it for tracing.

    Args:
        source: path of an image, or an (H, W), (H, W, 3) or (H, W, 4) array (RGB order), uint8,
            uint16 or float in [0, 1].
        settings: polarity, pen_width and provider are used.
        page: which page of a file with several.

    Raises:
        InvoluteError: the picture can't be read, or has nothing that could be traced.
    """
    picture = _load(source, page)
    height, width = picture.shape[:2]
    gray = _gray(picture)
    if settings.provider == "given":
        return Scan(gray, None, 1.0, (width, height), settings.pen_width or 2.0)
    if _wants_invert(gray, settings):
        gray = 1.0 - gray
    elif settings.polarity == "auto" and gray.max() < 0.1:
        raise InvoluteError(
            "The picture is black all over; scan the page again, or choose polarity 'light' "
            "for white lines on black."
        )
    pen = settings.pen_width or measure_pen(flatten_paper(gray))
    scale = _working_scale(pen or _DEFAULT_PEN, width * height)
    color = None
    if picture.ndim == 3:
        color = _resize(picture, scale)
        if color.dtype != np.uint8:
            color = np.round(color * (255 / _full_scale(color))).astype(np.uint8)
    ink = flatten_paper(_resize(gray, scale))
    return Scan(ink, color, scale, (width, height), (pen or _DEFAULT_PEN) / scale)


def page_count(path: str | PathLike[str]) -> int:
    """The number of pages in an image file; 1 for all but TIFFs with several."""
    return max(1, cv2.imcount(os.fspath(path), cv2.IMREAD_UNCHANGED))


def flatten_paper(gray: Array) -> Array:
    """Take paper, shading and grain out of a page of dark lines.

    Two passes: the lightest spots give a first guess of the paper; what that guess calls bare
    paper then gives its true mean and its grain, so that grain ends up around 0 and can be gated.

    Args:
        gray: (H, W) float32 luminance in [0, 1]; 0 = black.

    Returns:
        ink, (H, W) float32 in [0, 1]: 0 on paper, about 1 on a full pen stroke, anti-aliased.
    """
    gray = np.ascontiguousarray(gray, np.float32)
    rough = 1.0 - gray / _light_paper(gray)
    bare = (rough < 0.04 + 3.0 * _texture(rough)).astype(np.float32)
    share = _to_grid(bare)
    known = share > 0.1
    mean = _smooth_fill(_to_grid(rough * bare) / np.maximum(share, 1e-3), known)
    darkness = rough - _from_grid(mean, gray.shape)
    _gate(darkness, bare)
    return np.minimum(darkness / _pen_level(darkness), 1.0)


def _light_paper(gray: Array) -> Array:
    """A first guess of the paper's luminance at each pixel: the lightest spots around it."""
    smooth = cv2.blur(gray, (3, 3), borderType=cv2.BORDER_REPLICATE)
    grid = cv2.medianBlur(_block_max(smooth), 5)
    # What is far darker than the lightest paper in a wide circle is solid ink, not shadow.
    coarse = cv2.resize(grid, None, fx=0.125, fy=0.125, interpolation=cv2.INTER_AREA)
    reach = np.ones((max(3, coarse.shape[0] // 2), max(3, coarse.shape[1] // 2)), np.uint8)
    bright = cv2.morphologyEx(coarse, cv2.MORPH_CLOSE, reach)
    bright = cv2.resize(bright, grid.shape[::-1], interpolation=cv2.INTER_LINEAR)
    return np.maximum(_from_grid(_smooth_fill(grid, grid > 0.5 * bright), gray.shape), 0.05)


def _texture(rough: Array) -> Array:
    """A first guess of the grain (standard deviation) at each pixel, kept below hatching's."""
    high = np.abs(rough - cv2.GaussianBlur(rough, (0, 0), 1.5))
    return _from_grid(np.minimum(1.25 * cv2.medianBlur(_to_grid(high), 5), 0.06), rough.shape)


def _gate(darkness: Array, bare: Array) -> None:
    """Shut out, in place, what is as weak as the grain; what is clearly darker stays as it is.

    Judged on smoothed ink, where grain is weaker and the gaps in a pencil line are closed.
    """
    smooth = cv2.GaussianBlur(darkness, (0, 0), 1.2)
    calm = cv2.erode(bare, np.ones((5, 5), np.uint8))  # not the foot of a line
    share = _to_grid(calm)
    variance = _to_grid(np.square(smooth) * calm) / np.maximum(share, 1e-3)
    grain = np.sqrt(_smooth_fill(variance, share > 0.1))
    low = _from_grid(3.0 * grain + 0.005, darkness.shape)
    darkness *= np.clip((smooth - low) / (0.6 * low), 0.0, 1.0)
    np.maximum(darkness, 0.0, out=darkness)


def _pen_level(darkness: Array) -> Array:
    """The darkness of a full stroke around each pixel: between the page's and the local one."""
    peak = _block_max(cv2.GaussianBlur(darkness, (0, 0), 0.6))
    inked = peak[peak > 0.06]
    page = float(np.percentile(inked, 80)) if inked.size else 1.0
    local = cv2.GaussianBlur(cv2.dilate(peak, np.ones((7, 7), np.uint8)), (0, 0), 3)
    return _from_grid(np.sqrt(np.clip(local, 0.15 * page, page) * page), darkness.shape)


def _block_max(image: Array) -> Array:
    """The largest value around the centre of each block of the grid."""
    peak = cv2.dilate(image, np.ones((_BLOCK, _BLOCK), np.uint8))
    return np.ascontiguousarray(peak[_BLOCK // 2 :: _BLOCK, _BLOCK // 2 :: _BLOCK])


def _to_grid(image: Array) -> Array:
    """The mean of each block."""
    height, width = image.shape
    blocks = (
        max(1, (width + _BLOCK // 2 - 1) // _BLOCK),
        max(1, (height + _BLOCK // 2 - 1) // _BLOCK),
    )
    return cv2.resize(image, blocks, interpolation=cv2.INTER_AREA)


def _from_grid(grid: Array, shape: tuple[int, int]) -> Array:
    return cv2.resize(grid, shape[::-1], interpolation=cv2.INTER_LINEAR)


def _smooth_fill(grid: Array, known: Array) -> Array:
    """Smooth the known values and carry them into the unknown blocks (push-pull pyramid)."""
    weight = known.astype(np.float32)
    mass = cv2.GaussianBlur(weight, (0, 0), 1.5)
    near = cv2.GaussianBlur(grid * weight, (0, 0), 1.5) / np.maximum(mass, 1e-6)
    if mass.min() > 0.05 or min(grid.shape) < 3:
        return near if mass.any() else grid
    far = _smooth_fill(
        cv2.pyrDown(near * mass) / np.maximum(cv2.pyrDown(mass), 1e-6), cv2.pyrDown(mass) > 0.02
    )
    return np.where(mass > 0.05, near, cv2.pyrUp(far, dstsize=grid.shape[::-1]))


def measure_pen(ink: Array) -> float:
    """Typical full width of the lines in an ink map, px; 0 when there are none.

    Looks at the windows with the most ink, at twice their resolution: half a pixel counts.
    """
    crests = [_crest_widths(window) for window in _inkiest_windows(ink)]
    widths = np.concatenate(crests) if crests else np.zeros(0)
    return float(np.median(widths)) if widths.size else 0.0


def _inkiest_windows(ink: Array, side: int = 512, most: int = 16) -> list[Array]:
    rows, columns = (-(-n // side) for n in ink.shape)
    tiles = [
        ink[r * side : (r + 1) * side, c * side : (c + 1) * side]
        for r in range(rows)
        for c in range(columns)
    ]
    tiles.sort(key=lambda tile: -float(tile[::3, ::3].sum()))
    return tiles[:most]


def _crest_widths(ink: Array) -> Array:
    """The width at every pixel of the lines' crests; wide areas count no more than lines."""
    big = cv2.resize(
        cv2.GaussianBlur(ink, (0, 0), 0.7), None, fx=2, fy=2, interpolation=cv2.INTER_LINEAR
    )
    peak = cv2.dilate(big, np.ones((13, 13), np.uint8))
    dark = (big > np.maximum(0.5 * peak, 0.2)).astype(np.uint8)
    distance = cv2.distanceTransform(dark, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    crest = (distance > 0) & (distance >= cv2.dilate(distance, np.ones((3, 3), np.uint8)))
    widths = distance[crest] - 0.5
    return np.sqrt(np.maximum(widths**2 - 2.7, 1.0))  # less what the blur above has added


def _working_scale(pen: float, pixels: int) -> float:
    low, high = _PEN_RANGE
    scale = 1.0
    if pen > high:
        scale = pen / _PEN_TARGET[1]
    elif pen < low:
        scale = max(0.5, pen / _PEN_TARGET[0])
    return max(scale, (pixels / _MAX_WORKING) ** 0.5)


def _resize(image: Array, scale: float) -> Array:
    if scale == 1.0:
        return image
    how = cv2.INTER_AREA if scale > 1 else cv2.INTER_CUBIC
    # Only with fx and fy (and no size) does OpenCV use exactly this scale in both directions.
    out = cv2.resize(image, None, fx=1 / scale, fy=1 / scale, interpolation=how)
    return np.clip(out, 0, 1) if out.dtype == np.float32 else out


def _wants_invert(gray: Array, settings: Settings) -> bool:
    if settings.polarity != "auto":
        return settings.polarity == "light"
    step = max(1, max(gray.shape) // 1024)
    small = (gray[::step, ::step] * 255).astype(np.uint8)
    window = min(255, (min(small.shape) // 2) | 1)
    deviation = small.astype(np.int16) - cv2.medianBlur(small, window)
    dark, light = np.maximum(-deviation - 8, 0).sum(), np.maximum(deviation - 8, 0).sum()
    return bool(light > dark)


def _gray(picture: Array) -> Array:
    """Luminance in [0, 1], (H, W) float32; a coloured ink counts as dark in its darkest channel."""
    top = _full_scale(picture)
    if picture.ndim == 2:
        return (picture / np.float32(top)).astype(np.float32)
    luma = cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY).astype(np.float32)
    return (0.5 / top) * (luma + picture.min(axis=2))


def _full_scale(picture: Array) -> float:
    return 1.0 if picture.dtype.kind == "f" else float(np.iinfo(picture.dtype).max)


def _load(source: Source, page: int) -> Array:
    """An (H, W) or (H, W, 3) RGB array over white, uint8, uint16 or float32."""
    if isinstance(source, np.ndarray):
        picture, name = source, "the array"
    else:
        picture, name = _decode(Path(source), page), Path(source).name
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
            f"{name} is {width} x {height} px; scale it down to at most {MAX_SIDE} px a side."
        )
    if picture.dtype == bool:
        picture = picture.astype(np.uint8) * 255
    if picture.dtype.kind == "f":
        if not np.isfinite(picture).all():
            raise InvoluteError(f"{name} holds values that aren't numbers; replace NaN first.")
        picture = np.clip(picture, 0, 1).astype(np.float32)
    elif picture.dtype not in (np.uint8, np.uint16):
        raise InvoluteError(
            f"Can't trace values of type {picture.dtype}; give uint8, uint16 or float in [0, 1]."
        )
    if picture.ndim == 3 and picture.shape[2] == 4:
        top = _full_scale(picture)
        alpha = picture[..., 3:] / np.float32(top)
        over = picture[..., :3] * alpha + top * (1 - alpha)
        picture = over.astype(picture.dtype)
    if picture.ndim == 3 and (np.ptp(picture[::7, ::7], axis=2) == 0).all():
        picture = np.ascontiguousarray(picture[..., 1])
    return picture


def _decode(path: Path, page: int) -> Array:
    try:
        data = np.fromfile(path, np.uint8)
    except FileNotFoundError:
        raise InvoluteError(f"There is no file {path}; check the path.") from None
    except OSError as error:
        raise InvoluteError(f"Can't read {path}: {error.strerror or error}.") from None
    flags = cv2.IMREAD_UNCHANGED
    try:
        ok, pages = cv2.imdecodemulti(data, flags, range=(page, page + 1))
    except cv2.error:
        ok, pages = False, ()
    if not ok or not pages:
        raise InvoluteError(
            f"{path.name} isn't a picture that can be read; give a whole PNG, JPEG, TIFF, WebP "
            "or BMP file."
        )
    picture = pages[0]
    if picture.ndim == 3:
        code = cv2.COLOR_BGRA2RGBA if picture.shape[2] == 4 else cv2.COLOR_BGR2RGB
        picture = cv2.cvtColor(picture, code)
    return picture
