"""Where the pixels of a drawing lie in the space of its Grease Pencil object."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import bpy

Array = np.ndarray


@dataclass(frozen=True, eq=False)
class PixelMap:
    """An affine map from pixels (x right, y down) to object space (metres).

    origin: (3,) where the image's top left corner lies.
    right, down: (3,) one pixel to the right, one pixel down.
    """

    origin: Array
    right: Array
    down: Array

    @cached_property
    def unit(self) -> float:
        """The length of a pixel, for widths."""
        return float(np.sqrt(np.linalg.norm(self.right) * np.linalg.norm(self.down)))

    def to_object(self, points: Array) -> Array:
        """(..., 2) pixels -> (..., 3) float32 in object space."""
        points = np.asarray(points, np.float64)
        place = self.origin + points[..., :1] * self.right + points[..., 1:2] * self.down
        return place.astype(np.float32)

    def to_pixels(self, places: Array) -> Array:
        """(..., 3) object space -> (..., 2) float64 pixels; off the plane is projected onto it."""
        axes = np.stack([self.right, self.down], 1)
        return (np.asarray(places, np.float64) - self.origin) @ np.linalg.pinv(axes).T

    def moved(self, x: float, y: float) -> PixelMap:
        """The map of a part of the page whose top left corner is the pixel (x, y)."""
        return PixelMap(self.origin + x * self.right + y * self.down, self.right, self.down)

    def as_list(self) -> list[float]:
        """Nine numbers to store."""
        return [float(v) for v in (*self.origin, *self.right, *self.down)]

    @staticmethod
    def from_list(values: list[float]) -> PixelMap:
        """The map of nine numbers that `as_list` gave."""
        return PixelMap(*np.array(list(values), np.float64).reshape(3, 3))


def front_view(size: tuple[int, int], height: float = 2.0) -> PixelMap:
    """Upright in the front view (XZ), centred on the object's origin, `height` metres tall."""
    width_px, height_px = size
    pixel = height / height_px
    return PixelMap(
        np.array([-0.5 * width_px * pixel, 0.0, 0.5 * height]),
        np.array([pixel, 0.0, 0.0]),
        np.array([0.0, 0.0, -pixel]),
    )


def on_empty(empty: bpy.types.Object, size: tuple[int, int]) -> PixelMap:
    """On the picture that an image Empty shows, in the Empty's own space.

    Blender draws the longer side as long as the Empty's display size, after the pixel aspect.
    """
    aspect = empty.data.display_aspect
    across, along = size[0] * aspect[0], size[1] * aspect[1]
    longest = max(across, along)
    width = empty.empty_display_size * across / longest
    height = empty.empty_display_size * along / longest
    left, bottom = empty.empty_image_offset[0] * width, empty.empty_image_offset[1] * height
    return PixelMap(
        np.array([left, bottom + height, 0.0]),
        np.array([width / size[0], 0.0, 0.0]),
        np.array([0.0, -height / size[1], 0.0]),
    )
