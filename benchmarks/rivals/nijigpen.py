"""What nijiGPen's "Import Line Art from Image" does, the best centre-line tracer in Blender so far.

Written from a description of the method, not from its code: threshold and median filter, medial
axis, segments by following 8-neighbours; then tips near each other are paired, those that face
each other best first, each tip once, unless their colours differ; at last the points are thinned
out and smoothed. A user sets the threshold by eye; here it is Otsu's.
"""

from __future__ import annotations

from os import PathLike

import cv2
import numpy as np
from scipy.ndimage import uniform_filter1d
from scipy.spatial import cKDTree
from skimage.morphology import medial_axis

from .plain_skeleton import pieces, strokes

Array = np.ndarray

_JOIN = 5.0  # px
_LOOK = 8  # points of a segment that make the direction of its tip, 25 % of it at most
_COLOR = 0.25  # of the whole range; tips that differ more never join
_STEP = 3  # a point every so many px
_SMOOTH = 3  # points


def trace(path: str | PathLike[str]) -> list[Array]:
    """The strokes of a scan, in px."""
    color = np.asarray(cv2.imread(str(path), cv2.IMREAD_COLOR))
    grey = cv2.medianBlur(cv2.cvtColor(color, cv2.COLOR_BGR2GRAY), 3)
    _, ink = cv2.threshold(grey, 0, 255, cv2.THRESH_BINARY_INV | cv2.THRESH_OTSU)
    if not ink.any():
        return []
    thin, distance = medial_axis(ink > 0, return_distance=True)
    # The segments end beside the junction, not on it; a tip of the line is its own end.
    segments = [line[1:-1] for line in pieces(thin).paths if len(line) > 3]
    if not segments:
        return []
    partner = _face_to_face(segments, color / 255.0, distance)
    return [_smooth(line) for line in strokes(segments, partner)]


def _face_to_face(segments: list[Array], color: Array, distance: Array) -> Array:
    """Partners of the tips (2 * k: first point of segment k; 2 * k + 1: last)."""
    tips = np.array([line[[0, -1]] for line in segments]).reshape(-1, 2)
    inward = []
    for line in segments:
        look = max(1, min(_LOOK, len(line) // 4))
        inward += [line[look] - line[0], line[-1 - look] - line[-1]]
    outward = -np.array(inward)
    outward /= np.maximum(np.hypot(*outward.T), 1e-9)[:, None]

    column, row = tips.astype(int).T
    reach = np.maximum(distance[row, column], _JOIN)
    tree = cKDTree(tips)
    pairs = tree.query_pairs(reach.max(), output_type="ndarray")
    a, b = pairs.T
    near = np.hypot(*(tips[a] - tips[b]).T) <= np.maximum(reach[a], reach[b])
    alike = np.abs(color[row[a], column[a]] - color[row[b], column[b]]).max(1) < _COLOR
    a, b = a[near & alike], b[near & alike]
    facing = (outward[a] * outward[b]).sum(1)
    partner = np.arange(len(tips))
    for k in np.argsort(facing, kind="stable"):
        if facing[k] < 0 and partner[a[k]] == a[k] and partner[b[k]] == b[k]:
            partner[a[k]], partner[b[k]] = b[k], a[k]
    return partner


def _smooth(line: Array) -> Array:
    thinned = np.vstack([line[:-1:_STEP], line[-1:]])
    if len(thinned) <= _SMOOTH:
        return thinned
    inner = uniform_filter1d(thinned, _SMOOTH, axis=0, mode="nearest")[1:-1]
    return np.vstack([thinned[:1], inner, thinned[-1:]])
