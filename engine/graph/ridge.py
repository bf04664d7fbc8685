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

Array = np.ndarray

SIGMA = 0.8  # px; 0.7 to 0.9 separates parallels 2.5 px apart and still averages pixel noise
FAINT = 0.1  # a line may fade to this probability ...
CLEAR = 0.33  # ... when it reaches this one somewhere (25 and 85 of 255 in the paper)
PEAK = 0.6  # what smoothing leaves of the crest of a line


@dataclass(frozen=True, eq=False)
class Ridge:
    """The centerline map, smoothed, with its derivatives; all (H, W) float32.

    dx, dy: gradient; dxx, dxy, dyy: second derivatives, per pixel.
    """

    value: Array
    dx: Array
    dy: Array
    dxx: Array
    dxy: Array
    dyy: Array

    @staticmethod
    def of(centerline: Array, sigma: float | None = None) -> Ridge:
        """Derivatives of a centerline map (H, W) at scale sigma (px)."""
        image = np.ascontiguousarray(centerline, np.float32)
        sigma = SIGMA if sigma is None else sigma
        radius = int(np.ceil(4 * sigma))
        x = np.arange(-radius, radius + 1, dtype=np.float64)
        g0 = np.exp(-0.5 * (x / sigma) ** 2)
        g0 /= g0.sum()
        # Normalised on the pixel grid, so that slopes and parabolas come out exactly.
        g1 = x * g0
        g1 /= (x * g1).sum()
        g2 = (x**2 - (x**2 * g0).sum()) * g0
        g2 *= 2 / (x**2 * g2).sum()

        def along(kernel_x: Array, kernel_y: Array) -> Array:
            return cv2.sepFilter2D(
                image, cv2.CV_32F, kernel_x, kernel_y, borderType=cv2.BORDER_REPLICATE
            )

        return Ridge(
            along(g0, g0), along(g1, g0), along(g0, g1), along(g2, g0), along(g1, g1), along(g0, g2)
        )

    def mask(self) -> Array:
        """(H, W) uint8, 255 where a line may run: bright enough, and not a valley or a skirt."""
        rows, columns = np.nonzero(self.value > FAINT)
        dxx, dxy, dyy = (a[rows, columns] for a in (self.dxx, self.dxy, self.dyy))
        mean, spread = (dxx + dyy) / 2, np.hypot((dxx - dyy) / 2, dxy)
        # Curved upwards more than downwards = beside a line or between two of them.
        inside = ~((mean > 0) & (mean + spread > 0.02))
        rows, columns = rows[inside], columns[inside]
        mask = np.zeros(self.value.shape, np.uint8)
        mask[rows, columns] = 255
        # Drop what is faint all over.
        count, labels = cv2.connectedComponents(mask, connectivity=8, ltype=cv2.CV_32S)
        label = labels[rows, columns]
        keep = np.zeros(count, bool)
        keep[label[self.value[rows, columns] >= CLEAR * PEAK]] = True
        faint = ~keep[label]
        mask[rows[faint], columns[faint]] = 0
        return mask

    def normals(self, rows: Array, columns: Array) -> tuple[Array, Array]:
        """Unit vectors across the line (N, 2) and the curvature along them (N,), at pixels."""
        dxx, dxy, dyy = (
            a[rows, columns].astype(np.float64) for a in (self.dxx, self.dxy, self.dyy)
        )
        mean, spread = (dxx + dyy) / 2, np.hypot((dxx - dyy) / 2, dxy)
        # Angle of the eigenvector that belongs to the most negative eigenvalue.
        angle = 0.5 * np.arctan2(2 * dxy, dxx - dyy) + np.pi / 2
        return np.stack([np.cos(angle), np.sin(angle)], -1), mean - spread

    def crest(self, rows: Array, columns: Array) -> Array:
        """Sub-pixel points (N, 2) of the line that runs through or beside the given pixels."""
        # A pixel on the flank of its line says little; its brighter neighbour knows the crest.
        dx, dy = self.dx[rows, columns], self.dy[rows, columns]
        steep = np.abs(dx) >= np.abs(dy)
        step_x, step_y = np.where(steep, np.sign(dx), 0), np.where(steep, 0, np.sign(dy))
        height, width = self.value.shape
        up_rows = np.clip(rows + step_y, 0, height - 1).astype(np.intp)
        up_columns = np.clip(columns + step_x, 0, width - 1).astype(np.intp)
        better = self.value[up_rows, up_columns] > self.value[rows, columns]
        rows, columns = np.where(better, up_rows, rows), np.where(better, up_columns, columns)
        centers = np.stack([columns, rows], -1) + 0.5
        normal, curvature = self.normals(rows, columns)
        slope = self.dx[rows, columns] * normal[:, 0] + self.dy[rows, columns] * normal[:, 1]
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.where(curvature < -1e-6, -slope / curvature, 0.0)
        return centers + np.clip(step, -0.75, 0.75)[:, None] * normal
