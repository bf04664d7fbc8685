"""Paper, shading, rules and grain taken out of a page: what is left is ink.

`flatten_paper` is the one normalisation that every later stage relies on, and that the network is
trained with: simple, deterministic, and it looks only at what lies near.
"""

from __future__ import annotations

import cv2
import numpy as np

from ..values import Array
from .ruling import without_rules

_BLOCK = 8  # px; paper is estimated on a grid of such blocks
_FRAME = _BLOCK * 8  # px; the grid, and the coarser one over it, begin here beside the middle
_CLEARLY = 0.15  # darker than the paper by this much is no shading
_LARGE = 24_000_000  # px; a larger page is not copied to move its grid
_USUAL = 0.25  # quantile of the grain of a page's blocks: that of paper without lines
_MOST_GRAIN = 0.06  # of full black; more is hatching
# Where lines lie so close that no paper is seen, it is as light as around them: the grain is so
# many times the usual one, at least so much of full black; less than a share of the spots is nearly
# as light as the lightest; and these are darker than the paper around. On 60 held-out pages
# (synthesis.hard_pages.hatched, seed 77) 0.006 of such hatching is lost and 0.0009 of bare paper
# inked; with 1.2 times 0.005 and 0.0010, with 2 times 0.015 and 0.0008, with a share of 0.35 0.010,
# when darker by 0.02 0.011, without all of it 0.20 and 0.0008. On 40 others (seed 5) 0.029 is lost,
# with at least 0.01 0.028, with 0.03 0.068, without all of it 0.23.
_HATCHED, _LIGHT, _LITTLE, _DARKER = (1.5, 0.02), 0.04, 0.45, 0.01


def flatten_paper(gray: Array) -> Array:
    """The ink of a page of dark lines: see `flattened`."""
    return flattened(gray)[0]


def flattened(gray: Array, rules: bool = True) -> tuple[Array, bool]:
    """Take paper, shading, rules and grain out of a page of dark lines.

    Two passes: the lightest spots give a first guess of the paper, but where hatching hides it;
    what that guess calls bare paper then gives its true mean and its grain, so that grain ends up
    around 0 and can be gated. Rules and grids go as well. The grid on which paper is estimated is
    counted from the middle of what is dark, so that a drawing gets the same ink wherever it lies on
    its sheet.

    Args:
        gray: (H, W) float32 luminance in [0, 1]; 0 = black.
        rules: whether printed rules and grids go.

    Returns:
        ink, (H, W) float32 in [0, 1]: 0 on paper, about 1 on a full pen stroke, anti-aliased; and
        whether the page was ruled.
    """
    gray = np.ascontiguousarray(gray, np.float32)
    if gray.size > _LARGE:
        return _flattened(gray, rules)
    above, before = (-place % _FRAME for place in _middle(gray))
    height, width = gray.shape
    below, after = -(height + above) % _FRAME, -(width + before) % _FRAME
    framed = cv2.copyMakeBorder(gray, above, below, before, after, cv2.BORDER_REPLICATE)
    ink, ruled = _flattened(framed, rules)
    return np.ascontiguousarray(ink[above : above + height, before : before + width]), ruled


def _middle(gray: Array) -> tuple[int, int]:
    """Row and column of the middle of all that is clearly darker than the paper, px."""
    dark = np.maximum(np.float32(np.median(gray[::4, ::4]) - _CLEARLY) - gray, 0)
    sums = dark.sum(1, dtype=np.float64), dark.sum(0, dtype=np.float64)
    mass = max(sums[0].sum(), 1e-9)
    row, column = (int(np.floor((s * np.arange(len(s))).sum() / mass + 0.5)) for s in sums)
    return row, column


def _flattened(gray: Array, rules: bool) -> tuple[Array, bool]:
    """The same for a page whose blocks begin at its corner."""
    # In place wherever it can be: a page of 8192 px has 256 MiB in every such array.
    rough, seen, grain = _light_paper(gray)
    np.subtract(1.0, np.divide(gray, rough, out=rough), out=rough)
    limit = _from_grid(grain, gray.shape)
    limit *= 3.0
    limit += 0.04
    bare = (rough < limit).view(np.uint8)
    del limit
    share = _to_grid(bare.astype(np.float32))
    known = (share > 0.1) & seen
    mean = _smooth_fill(_to_grid(rough * bare) / np.maximum(share, 1e-3), known)
    darkness = np.subtract(rough, _from_grid(mean, gray.shape), out=rough)
    bare_page = without_rules(darkness) if rules else darkness
    ruled = bare_page is not darkness
    darkness = bare_page
    del bare_page
    pen = _pen_level(darkness)
    _gate(darkness, bare, pen)
    del bare
    np.divide(darkness, _full_ink(darkness, pen), out=darkness)
    return np.minimum(darkness, 1.0, out=darkness), ruled


def _light_paper(gray: Array) -> tuple[Array, Array, Array]:
    """A first guess of the paper's luminance at each pixel: the lightest spots around it.

    Returns:
        The guess; in which blocks paper is seen, bool; and the paper's grain in each block
        (standard deviation), kept below that of hatching.
    """
    smooth = cv2.blur(gray, (3, 3), borderType=cv2.BORDER_REPLICATE)
    grid = cv2.medianBlur(_block_max(smooth), 5)
    # What is far darker than the lightest paper in a wide circle is solid ink, not shadow.
    size = [max(1, side // 8) for side in grid.shape[::-1]]
    coarse = cv2.resize(grid, size, interpolation=cv2.INTER_AREA)
    reach = np.ones((max(3, coarse.shape[0] // 2), max(3, coarse.shape[1] // 2)), np.uint8)
    bright = cv2.morphologyEx(coarse, cv2.MORPH_CLOSE, reach)
    bright = cv2.resize(bright, grid.shape[::-1], interpolation=cv2.INTER_LINEAR)
    light = _from_grid(grid, gray.shape)
    np.maximum(light, 0.05, out=light)
    share = cv2.blur(_to_grid((smooth > (1 - _LIGHT) * light).astype(np.float32)), (5, 5))
    grain = _grain(np.divide(gray, light, out=smooth))
    times, least = _HATCHED
    seen = (share >= _LITTLE) | (grain <= max(times * np.quantile(grain, _USUAL), least))
    solid = grid <= 0.5 * bright
    if not seen.all():  # where it is no darker than around, nothing is hidden
        seen |= grid >= (1 - _DARKER) * _smooth_fill(grid, seen & ~solid)
    paper = _from_grid(_smooth_fill(grid, seen & ~solid), gray.shape)
    grain = np.minimum(grain, _MOST_GRAIN)
    grain = grain if seen.all() else _smooth_fill(grain, seen)
    return np.maximum(paper, 0.05, out=paper), seen, grain


def _grain(level: Array) -> Array:
    """How uneven a picture is in each block, as a standard deviation."""
    high = cv2.GaussianBlur(level, (0, 0), 1.5)
    np.abs(np.subtract(level, high, out=high), out=high)
    grid: Array = 1.25 * cv2.medianBlur(_to_grid(high), 5)
    return grid


def _pen_level(darkness: Array) -> float:
    """How dark the pen of a page is, however much grain there is beside it: dark spots weigh most.

    1 on a blank page.
    """
    peak = _block_max(cv2.GaussianBlur(darkness, (0, 0), 0.6))
    inked = np.sort(peak[peak > 0.06])
    if not inked.size:
        return 1.0
    weight = np.cumsum(np.square(inked, dtype=np.float64))
    return float(inked[np.searchsorted(weight, 0.65 * weight[-1])])


def _gate(darkness: Array, bare: Array, pen: float) -> None:
    """Shut out, in place, what is as weak as the grain, or as a stain beside the pen; what is
    clearly darker stays as it is.

    Judged on smoothed ink, where grain is weaker and the gaps in a pencil line are closed.
    """
    smooth: Array = cv2.GaussianBlur(darkness, (0, 0), 1.2)
    calm = cv2.erode(bare, np.ones((5, 5), np.uint8))  # not the foot of a line
    share = _to_grid(calm.astype(np.float32))
    square = np.square(smooth)
    square *= calm
    variance = _to_grid(square) / np.maximum(share, 1e-3)
    del square, calm
    grain = np.sqrt(_smooth_fill(variance, share > 0.1))
    low = _from_grid(np.maximum(3.5 * grain + 0.005, 0.08 * pen), darkness.shape)
    smooth -= low
    low *= 0.6
    smooth /= low
    darkness *= np.clip(smooth, 0.0, 1.0, out=smooth)
    np.maximum(darkness, 0.0, out=darkness)


def _full_ink(darkness: Array, pen: float) -> Array:
    """The darkness of a full stroke around each pixel: between the page's and the local one."""
    peak = _block_max(cv2.GaussianBlur(darkness, (0, 0), 0.6))
    local = cv2.GaussianBlur(cv2.dilate(peak, np.ones((7, 7), np.uint8)), (0, 0), 3)
    return _from_grid(np.sqrt(np.clip(local, 0.15 * pen, pen) * pen), darkness.shape)


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


def _from_grid(grid: Array, shape: tuple[int, ...]) -> Array:
    return cv2.resize(grid, shape[1::-1], interpolation=cv2.INTER_LINEAR)


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
