"""A part of a page, traced to see what the settings do: in no file, and no step to undo.

It is shown over the scan until another takes its place, the whole page is traced, or the artist
has seen enough.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...engine import InvoluteError
from ..grease_pencil import cels, state
from ..grease_pencil.core.pixel_map import PixelMap, on_empty
from ..language import message
from ..view.view_state import shown_in
from . import sources
from .sources import Source

if TYPE_CHECKING:
    from ...engine import Drawing

Box = tuple[int, int, int, int]
"""left, top, right, bottom of a part, px of the page."""

_MARGIN = 24  # px around a part that are traced as well: its lines don't end where it does
_LEAST = 8  # px; a side of the smallest part
_PLAYED = {"SEQUENCE", "MOVIE"}
NOTHING = "Select an image Empty, or a drawing that was traced."
BESIDE = "Drag a box over the picture."


@dataclass(frozen=True)
class Page:
    """A picture that can be seen in the viewport.

    name: of the object that it lies on.
    size: (width, height) px, as Blender or the drawing on it says.
    pixel_map: where its pixels lie in the object.
    frame: of an Empty that plays; key: of the trace on a drawing. It shows other pictures, too.
    """

    name: str
    size: tuple[int, int]
    pixel_map: PixelMap
    frame: int | None = None
    key: int | None = None

    @property
    def object(self) -> bpy.types.Object | None:
        """The object, unless it is gone."""
        return bpy.data.objects.get(self.name)

    @property
    def is_seen(self) -> bool:
        """Can the object be seen, and does it show this picture now?"""
        obj, frame = self.object, bpy.context.scene.frame_current
        if obj is None or not obj.visible_get():
            return False
        if self.key is not None:
            return cels.is_grease_pencil(obj) and self.key in state.keys_at(obj.data, frame)
        return self.frame in (None, frame)

    def source(self) -> Source:
        """What there is to trace.

        Raises:
            InvoluteError: the picture is gone.
        """
        obj = self.object
        if sources.is_image_empty(obj):
            return sources.from_image(obj.data, obj)
        shown = shown_in(bpy.context, obj)
        if shown is None:
            raise InvoluteError(NOTHING)
        key = shown.trace.key if self.key is None else self.key
        return sources.noted(state.picture_of(obj.data, key), shown.trace.source)


@dataclass(frozen=True, eq=False)
class Part:
    """A part of a page. crop: the part and its margin, once it was read.

    drawing: in pixels of the crop; None before the first trace, and where that failed: `problem`.
    """

    page: Page
    box: Box
    crop: Source | None = None
    drawing: Drawing | None = None
    problem: str = ""

    @property
    def around(self) -> Box:
        """The part with its margin."""
        left, top, right, bottom = self.box
        grown = left - _MARGIN, top - _MARGIN, right + _MARGIN, bottom + _MARGIN
        return _inside(grown, self.page.size)

    def read(self, source: Source) -> Source:
        """Its pixels, and those of the margin.

        Raises:
            InvoluteError: the picture can't be read, or is not as large as what is seen of it.
        """
        from ...engine.scan.image_file import read_image
        from ...engine.vector_page import is_vector

        picture = source.picture
        if is_vector(picture):
            raise InvoluteError("The lines of an SVG are taken as they are; there is no scan.")
        if isinstance(picture, str):
            picture = read_image(picture, source.page)
        if picture.shape[1::-1] != self.page.size:
            said = "The picture isn't as large as what you see of it; trace it as a new object."
            raise InvoluteError(said)
        left, top, right, bottom = self.around
        pixels = np.ascontiguousarray(picture[top:bottom, left:right])
        return Source(source.name, pixels)


shown: Part | None = None
"""What is tried now."""


def show(part: Part | None) -> None:
    """Put a part in the place of what was shown; None = nothing more."""
    global shown
    shown = part


def current() -> Part | None:
    """The part that can be seen; None where there is none."""
    return shown if shown is not None and shown.page.is_seen else None


def page_of(context: bpy.types.Context) -> Page:
    """The picture that the artist looks at: the active image Empty, or that of the drawing.

    Raises:
        InvoluteError: there is none.
    """
    obj = context.active_object
    if sources.is_image_empty(obj):
        if not all(obj.data.size):
            said = "The image {name!r} has no pixels; reload it or choose another."
            raise InvoluteError(message(said, name=obj.data.name))
        size = tuple(obj.data.size)
        frame = context.scene.frame_current if obj.data.source in _PLAYED else None
        return Page(obj.name, size, on_empty(obj, size), frame=frame)
    seen = shown_in(context)
    if seen is None:
        raise InvoluteError(NOTHING)
    size = tuple(seen.trace.drawing.size)
    return Page(seen.object.name, size, seen.pixel_map, key=seen.trace.key)


def box_around(places: np.ndarray, page: Page) -> Box:
    """The part of a page that some places (N, 2) px enclose.

    Raises:
        InvoluteError: they lie beside the page.
    """
    if not np.isfinite(places).all():
        raise InvoluteError(BESIDE)
    low, high = np.floor(places.min(0)), np.ceil(places.max(0))
    box = _inside((*low.astype(int).tolist(), *high.astype(int).tolist()), page.size)
    if box[2] - box[0] < _LEAST or box[3] - box[1] < _LEAST:
        raise InvoluteError(BESIDE)
    return box


def _inside(box: Box, size: tuple[int, int]) -> Box:
    left, top, right, bottom = box
    return max(left, 0), max(top, 0), min(right, size[0]), min(bottom, size[1])


def _forget(*_: object) -> None:
    show(None)


def register() -> None:
    """Opening a file ends what was tried in the one before."""
    bpy.app.handlers.load_pre.append(bpy.app.handlers.persistent(_forget))


def unregister() -> None:
    """Nothing is tried any more."""
    show(None)
    bpy.app.handlers.load_pre.remove(_forget)
