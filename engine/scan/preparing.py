"""From any picture of a drawing to a `Scan`, step by step.

image_file   a file is decoded
picture      its values are checked, transparent becomes white
pose         turned to the way in which its drawing is always looked at
polarity     dark lines on light, whichever it was
sheet        what lies beyond the sheet in a photograph goes
straightening  its perspective is taken out, if wanted
pen_width    how wide its pen is, which decides at what scale it is traced
paper        paper, shading, grain and printed rules are taken out: what is left is ink
overlooked   clear ink that went with the paper is remembered for the drawing's check
"""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np

from ..settings import Settings
from ..values import Array, Pose, Scan
from .overlooked import overlooked
from .paper import flattened
from .pen_width import measured_pen
from .picture import MIN_SIDE, Source, as_bytes, checked_picture, darkest_gray, unit
from .polarity import is_light_on_dark, with_lightness_inverted
from .pose import pose_of
from .sheet import Sheet, find_sheet, without_surroundings
from .straightening import askew, corners_of, straightened

# Shares of its size at which a page is read, by `Settings.grain`; see `engine.grain`.
SEEN_AT = {"auto": 1.0, "fine": 1.0, "medium": 0.7, "coarse": 0.55, "coarsest": 0.4}
_PEN_RANGE = (1.5, 8.0)  # working px; pens within stay as they are
_PEN_TARGET = (2.5, 6.0)  # what thinner and thicker ones are brought to
_PLENTY, _ENOUGH = 4e6, 4.0  # px of a page above which pens as wide as this will do
_MOST_PIXELS = 64e6  # of a working page: bounds memory and time at 20,000 px
_LEAST_SIDE = 256  # px; no page is worked smaller than this because of a fat pen
_DEFAULT_PEN = 3.0  # px; of a page without a line
_FLAT_WHOLE = 4e6  # px; up to here the pen is measured on the page that is worked on


def read_scan(source: Source, settings: Settings, page: int = 0, turn: bool = False) -> Scan:
    """Read a picture and prepare it for tracing.

    Args:
        source: path of an image, or an (H, W), (H, W, 3) or (H, W, 4) array in RGB(A) order: bool,
            uint8, uint16 or float in [0, 1].
        settings: polarity, pen_width, grain and provider are used. With provider "given" the
            picture is taken as it is: ink = its luminance, scale 1.
        page: which page of a TIFF with several.
        turn: whether the page is turned to the pose in which its drawing is always looked at.

    Returns:
        The page at the scale where its pen is 1.5 to 8 px wide; a blank page has no ink at all.

    Raises:
        InvoluteError: the picture can't be read, or is black all over.
    """
    picture = checked_picture(source, page, settings.polarity)
    size = picture.shape[1], picture.shape[0]
    pose = pose_of(picture) if turn else Pose()
    picture = pose.turned(picture)
    if settings.provider == "given":
        luma = cv2.cvtColor(picture, cv2.COLOR_RGB2GRAY) if picture.ndim == 3 else picture
        return Scan(unit(luma), None, 1.0, size, settings.pen_width or 2.0, pose=pose)
    share = _seen_at(settings, picture)
    picture = _resized(picture, 1 / share)
    height, width = picture.shape[:2]
    light, sheet = _looked_at(picture, settings)
    if light:
        picture = with_lightness_inverted(picture)
        sheet = find_sheet(picture) if settings.sheet else None
    notes: tuple[str, ...] = ()
    if sheet:
        picture, notes = _sheet_alone(picture, sheet, settings)
    gray = darkest_gray(picture)
    ink, ruled = None, False
    if gray.size <= _FLAT_WHOLE:
        ink, ruled = flattened(unit(gray), settings.rules)
    pen = settings.pen_width * share or measured_pen(gray, ink) or _DEFAULT_PEN
    scale = _working_scale(pen, width, height)
    if ink is None or scale != 1.0:
        gray = _resized(gray, scale)
        ink, ruled = flattened(unit(gray), settings.rules)
    # What is left out of a ruled page was left out on purpose.
    left = None if ruled else overlooked(unit(gray), ink)
    if ruled:
        notes = (*notes, "Printed rules were left out.")
    color = as_bytes(_resized(picture, scale)) if picture.ndim == 3 else None
    guessed = light and settings.polarity == "auto"
    pen /= scale
    found = Scan(ink, color, scale / share, size, pen, light=guessed, notes=notes, pose=pose)
    return replace(found, overlooked=left)


def _seen_at(settings: Settings, picture: Array) -> float:
    """Share of its size at which a page is read; a small one is read as it is."""
    share = SEEN_AT[settings.grain]
    return share if min(picture.shape[:2]) * share >= MIN_SIDE else 1.0


def _looked_at(picture: Array, settings: Settings) -> tuple[bool, Sheet | None]:
    """Whether the lines are light on dark, and else the sheet that they are on."""
    light = is_light_on_dark(picture, settings)
    if not settings.sheet or (light and settings.polarity != "auto"):
        return light, None
    # A dark desk may take up more of a photograph than the sheet on it.
    sheet = find_sheet(picture)
    light = light and (
        sheet is None or is_light_on_dark(without_surroundings(picture, sheet), settings)
    )
    return light, sheet


def _sheet_alone(picture: Array, sheet: Sheet, settings: Settings) -> tuple[Array, tuple[str, ...]]:
    """The picture without what lies beyond its sheet, seen from above if wanted; and notes."""
    corners = corners_of(sheet, picture) if settings.straighten else None
    picture = without_surroundings(picture, sheet)
    notes = (f"What lies beyond the sheet was left out: {sheet.share:.0%} of the picture.",)
    if not settings.straighten:
        return picture, notes
    if corners is None:
        return picture, (*notes, "The sheet was not straightened: its four corners are not sure.")
    off = askew(corners)
    picture, _ = straightened(picture, sheet, corners)
    return picture, (*notes, f"The sheet was straightened: its corners were {off:.0f}° askew.")


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
