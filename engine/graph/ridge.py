"""Where the lines are: ridges of the centerline map, to the sub-pixel.

The paper thresholds the map twice (globally, then against a local mean), repairs holes and spikes
of the result and takes pixel centres as points. We take the Gaussian derivatives once instead:
their sign keeps close parallels apart (the valley between them curves the other way), and their
zero crossing gives the crest of the line to a few hundredths of a pixel (Steger, "An unbiased
detector of curvilinear structures", 1998).
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from ..values import Array
from .limits import LIMITS

BAND = 512  # rows whose derivatives are held at a time, so that large pages need little memory


@dataclass(frozen=True, eq=False)
class Ridge:
    """The centerline map and its smoothed value; both (H, W) float32.

    The derivatives are made where they are asked for, band by band.
    """

    value: Array
    _image: Array
    _kernels: tuple[Array, Array, Array]

    @staticmethod
    def of(centerline: Array) -> Ridge:
        """The ridges of a centerline map (H, W)."""
        sigma = LIMITS.ridge_sigma
        image = np.ascontiguousarray(centerline, np.float32)
        radius = int(np.ceil(4 * sigma))
        x = np.arange(-radius, radius + 1, dtype=np.float64)
        g0 = np.exp(-0.5 * (x / sigma) ** 2)
        g0 /= g0.sum()
        # Normalised on the pixel grid, so that slopes and parabolas come out exactly.
        g1 = x * g0
        g1 /= (x * g1).sum()
        g2 = (x**2 - (x**2 * g0).sum()) * g0
        g2 *= 2 / (x**2 * g2).sum()
        value = cv2.sepFilter2D(image, cv2.CV_32F, g0, g0, borderType=cv2.BORDER_REPLICATE)
        return Ridge(value, image, (g0, g1, g2))

    def _derivative(self, top: int, bottom: int, order_x: int, order_y: int) -> Array:
        """A derivative of the smoothed map, per pixel, in the rows from top to bottom."""
        radius = len(self._kernels[0]) // 2
        low, high = max(0, top - radius), min(len(self._image), bottom + radius)
        found = cv2.sepFilter2D(
            self._image[low:high],
            cv2.CV_32F,
            self._kernels[order_x],
            self._kernels[order_y],
            borderType=cv2.BORDER_REPLICATE,
        )
        return found[top - low : bottom - low]

    def _curvatures(self, top: int, bottom: int) -> tuple[Array, Array, Array]:
        xx, xy, yy = (self._derivative(top, bottom, *way) for way in ((2, 0), (1, 1), (0, 2)))
        return xx, xy, yy

    def mask(self) -> Array:
        """(H, W) uint8, 255 where a line may run: bright enough, and not a valley or a skirt."""
        mask = np.zeros(self.value.shape, np.uint8)
        for top in range(0, len(mask), BAND):
            bright = self.value[top : top + BAND] > LIMITS.ridge_faint
            if bright.any():
                dxx, dxy, dyy = self._curvatures(top, top + len(bright))
                mean = (dxx + dyy) / 2
                rows, columns = np.nonzero(bright & (mean > 0))
                across = (dxx[rows, columns] - dyy[rows, columns]) / 2
                spread = np.hypot(across, dxy[rows, columns])
                # Curved upwards more than downwards = beside a line or between two of them.
                aside = mean[rows, columns] + spread > LIMITS.ridge_valley
                mask[top : top + BAND] = bright * np.uint8(255)
                mask[top + rows[aside], columns[aside]] = 0
        # Drop what is faint all over.
        rows, columns = np.nonzero(mask)
        count, labels = cv2.connectedComponents(mask, connectivity=8, ltype=cv2.CV_32S)
        label = labels[rows, columns]
        keep = np.zeros(count, bool)
        keep[label[self.value[rows, columns] >= LIMITS.ridge_clear * LIMITS.ridge_peak]] = True
        faint = ~keep[label]
        mask[rows[faint], columns[faint]] = 0
        return mask

    def crest(self, rows: Array, columns: Array) -> Array:
        """Sub-pixel points (N, 2) of the line that runs through or beside the given pixels."""
        points = np.zeros((len(rows), 2))
        order = np.argsort(rows, kind="stable")
        by_row = rows[order]
        for top in range(0, len(self.value), BAND):
            first, last = np.searchsorted(by_row, [top, top + BAND])
            if first < last:
                some = order[first:last]
                points[some] = self._crest(rows[some], columns[some], top)
        return points

    def _crest(self, rows: Array, columns: Array, top: int) -> Array:
        """The same for pixels in the band that begins at the row `top`."""
        height, width = self.value.shape
        top, bottom = max(0, top - 1), min(height, top + BAND + 1)
        gradient = [self._derivative(top, bottom, *way) for way in ((1, 0), (0, 1))]
        # A pixel on the flank of its line says little; its brighter neighbour knows the crest.
        dx, dy = (a[rows - top, columns] for a in gradient)
        steep = np.abs(dx) >= np.abs(dy)
        step_x, step_y = np.where(steep, np.sign(dx), 0), np.where(steep, 0, np.sign(dy))
        up_rows = np.clip(rows + step_y, 0, height - 1).astype(np.intp)
        up_columns = np.clip(columns + step_x, 0, width - 1).astype(np.intp)
        better = self.value[up_rows, up_columns] > self.value[rows, columns]
        rows, columns = np.where(better, up_rows, rows), np.where(better, up_columns, columns)
        centers = np.stack([columns, rows], -1) + 0.5
        second = self._curvatures(top, bottom)
        normal, curvature = _across(*(a[rows - top, columns].astype(np.float64) for a in second))
        dx, dy = (a[rows - top, columns] for a in gradient)
        slope = dx * normal[:, 0] + dy * normal[:, 1]
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.where(curvature < -1e-6, -slope / curvature, 0.0)
        return centers + np.clip(step, -0.75, 0.75)[:, None] * normal


def _across(dxx: Array, dxy: Array, dyy: Array) -> tuple[Array, Array]:
    """Unit vectors across the line (N, 2) and the curvature along them (N,)."""
    mean, spread = (dxx + dyy) / 2, np.hypot((dxx - dyy) / 2, dxy)
    # Angle of the eigenvector that belongs to the most negative eigenvalue.
    angle = 0.5 * np.arctan2(2 * dxy, dxx - dyy) + np.pi / 2
    return np.stack([np.cos(angle), np.sin(angle)], -1), mean - spread
