"""The lines that bundles of pencil strokes mean, as a planar graph of their own.

The strokes, moved together, are drawn thin into a centerline map, and the passes of every page make
a graph of it: what lies on each other is one line then, and lines meet where they met.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import cv2
import numpy as np

from ..arrays.ragged import owners
from ..graph import Evidence, run_passes
from ..graph.passes import MEASURED
from ..settings import Settings
from ..values import Array, LineMaps, PlanarGraph
from .sampled import Sampled

_LINE_BLUR = 1.1  # px; two lines nearer than about twice that are one ridge
_BRIGHT = 2.2  # times as bright, so that a thin line is full at its crest
_PRESSED = (0.6, 1.5)  # times the pen's width, for the lightest and the hardest pressure
SAID = 2.5  # px from a line at most, where a moved stroke says it ...
_SAID_FOR = 3  # ... for as many samples at least
_AROUND = 7  # px; side of the square in which strokes are counted


@dataclass(frozen=True, eq=False)
class Bundles:
    """Pencil strokes moved to the lines that they mean, and what is to be known of these.

    moved: (N, 2) the samples, px. count: (H, W) how many strokes lie at a place, about.
    nearest: (H, W) int32 number of the nearest sample, and away: (H, W) px to it.
    """

    strokes: Sampled
    moved: Array
    count: Array
    nearest: Array
    away: Array

    @classmethod
    def of(cls, strokes: Sampled, moved: Array, shape: tuple[int, int]) -> Bundles:
        row, column = pixels_of(moved, shape)
        step = np.zeros(shape, np.float32)
        ahead = np.hypot(*(moved[strokes.ahead] - moved).T)
        back = np.hypot(*(moved[strokes.back] - moved).T)
        np.add.at(step, (row, column), ((ahead + back) / 2).astype(np.float32))
        count = cv2.boxFilter(step, -1, (_AROUND, _AROUND), normalize=False) / _AROUND
        nearest, away = nearest_of(moved, shape)
        return cls(strokes, moved, count, nearest, away)

    @property
    def shape(self) -> tuple[int, int]:
        """(height, width) of the page, px."""
        return self.count.shape[0], self.count.shape[1]

    def at(self, points: Array) -> Array:
        """The sample nearest to each of (P, 2) points."""
        return self.nearest[pixels_of(points, self.nearest.shape)]

    def ridge(self) -> Array:
        """(H, W) float32 the centerline map of the moved strokes."""
        image = np.zeros(self.count.shape, np.uint8)
        fixed = np.round((self.moved - 0.5) * 256).astype(np.int32)  # OpenCV's centres are whole
        bounds = self.strokes.offsets
        lines = [fixed[a:b, None] for a, b in pairwise(bounds)]
        cv2.polylines(image, lines, False, 255, 1, cv2.LINE_AA, 8)
        blurred = cv2.GaussianBlur(image.astype(np.float32) / 255, (0, 0), _LINE_BLUR)
        return np.minimum(1.0, _BRIGHT * blurred)

    def graph(self, pen: float, settings: Settings) -> PlanarGraph:
        """The planar graph of the lines; they have the width of the pen, and the pencil's ink."""
        evidence = Evidence(LineMaps(self.ridge()), pen)
        graph = run_passes(evidence, settings, until=MEASURED)
        return self._measured(graph, pen) if graph.branch_count else graph

    def _measured(self, graph: PlanarGraph, pen: float) -> PlanarGraph:
        """The graph with the pen's own width, by pressure, and the ink of its pencil strokes."""
        strength = self._darkest(graph.points)
        press = np.sqrt(strength / max(float(np.median(strength)), 1e-3))
        colors = self.strokes.colors
        return replace(
            graph,
            widths=(pen * np.clip(press, *_PRESSED)).astype(np.float32),
            strength=strength.astype(np.float32),
            colors=None if colors is None else colors[self.at(graph.points)],
        )

    def _darkest(self, points: Array) -> Array:
        """(P,) strength of the darkest pencil stroke of the bundle at some points."""
        image: Array = np.zeros(self.count.shape, np.float32)
        np.maximum.at(image, pixels_of(self.moved, image.shape), self.strokes.strength)
        image = cv2.dilate(image, np.ones((5, 5), np.uint8))
        return image[pixels_of(points, image.shape)]

    def said(self, graph: PlanarGraph) -> Array:
        """(K, 2) int32: which pencil strokes say which branches of a graph, both ascending."""
        branch = owners(graph.offsets)
        nearest, away = nearest_of(graph.points, self.shape)
        place = pixels_of(self.moved, self.count.shape)
        near = away[place] <= SAID
        pairs = np.stack([self.strokes.stroke[near], branch[nearest[place][near]]], 1)
        found, count = np.unique(pairs, axis=0, return_counts=True)
        return found[count >= _SAID_FOR].astype(np.int32)


def nearest_of(points: Array, shape: tuple[int, int]) -> tuple[Array, Array]:
    """(H, W) int32 number of the nearest of (N, 2) points, N >= 1, and (H, W) px to its pixel."""
    far = np.full(shape, 255, np.uint8)
    place = pixels_of(points, shape)
    far[place] = 0
    away, label = cv2.distanceTransformWithLabels(
        far, cv2.DIST_L2, cv2.DIST_MASK_5, labelType=cv2.DIST_LABEL_PIXEL
    )
    number = np.zeros(int(label.max()) + 1, np.int32)
    number[label[place]] = np.arange(len(points))
    return number[label], away


def pixels_of(points: Array, shape: tuple[int, ...]) -> tuple[Array, Array]:
    """Rows and columns of the pixels that points lie in."""
    column = np.clip(points[:, 0], 0, shape[1] - 1).astype(int)
    return np.clip(points[:, 1], 0, shape[0] - 1).astype(int), column
