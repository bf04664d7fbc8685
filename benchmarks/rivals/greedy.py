"""The classical way: threshold, thin, and go on as straight as possible at every junction.

Otsu's threshold, Zhang and Suen's thinning, junctions contracted at the scale of the pen, then the
straightest pair of branches first, as long as a stroke turns by less than 60 degrees. What every
method with a better idea has to beat.
"""

from __future__ import annotations

from os import PathLike
from pathlib import Path

import cv2
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ..judged_pages import picture
from .plain_skeleton import Pieces, pieces, strokes

Array = np.ndarray

_LOOK = 8.0  # px along a branch that make its direction
_STRAIGHT = np.cos(np.radians(60))


def trace(path: str | PathLike[str]) -> list[Array]:
    """The strokes of a scan, in px."""
    _, ink = cv2.threshold(picture(Path(path)), 0, 255, cv2.THRESH_BINARY_INV | cv2.THRESH_OTSU)
    thin = cv2.ximgproc.thinning(ink, thinningType=cv2.ximgproc.THINNING_ZHANGSUEN) > 0
    if not thin.any():
        return []
    pen = 2 * float(np.median(cv2.distanceTransform(ink, cv2.DIST_L2, 5)[thin]))
    found = _contract(pieces(thin), pen)
    return strokes(found.paths, straightest(found))


def straightest(graph: Pieces) -> Array:
    """Partners of the half-branches: at each node the straightest pair first."""
    count = 2 * len(graph.paths)
    away = np.zeros((count, 2))
    for half in range(count):
        line = graph.paths[half >> 1][:: -1 if half & 1 else 1]
        near = np.hypot(*(line - line[0]).T) <= _LOOK
        # The last point before the branch leaves the circle for the first time.
        away[half] = line[max(1, int(np.argmin(near)) - 1) if not near.all() else -1] - line[0]
    away /= np.maximum(np.hypot(*away.T), 1e-9)[:, None]

    node = graph.ends.ravel()
    order = np.argsort(node, kind="stable")
    size = np.bincount(node[order])[node[order]]
    place = np.arange(count) - np.searchsorted(node[order], node[order])
    rest = size - 1 - place
    a = np.repeat(np.arange(count), rest)
    b = a + 1 + np.arange(len(a)) - np.repeat(np.cumsum(rest) - rest, rest)
    degree = size[a]
    a, b = order[a], order[b]
    straight = -(away[a] * away[b]).sum(1)
    fits = (straight > _STRAIGHT) | (degree == 2)
    partner = np.arange(count)
    for k in np.argsort(-straight, kind="stable"):
        if fits[k] and partner[a[k]] == a[k] and partner[b[k]] == b[k] and a[k] != b[k]:
            partner[a[k]], partner[b[k]] = b[k], a[k]
    return partner


def _contract(graph: Pieces, pen: float) -> Pieces:
    """Merge junctions joined by less than a pen's width, and drop spurs shorter than that."""
    length = np.array([np.hypot(*np.diff(line, axis=0).T).sum() for line in graph.paths])
    degree = np.bincount(graph.ends.ravel(), minlength=len(graph.nodes))
    tips = degree[graph.ends] == 1
    short = length < pen
    bridge = short & ~tips.any(1)
    spur = short & (tips.sum(1) == 1)
    links = graph.ends[bridge]
    size = len(graph.nodes)
    links = coo_matrix((np.ones(len(links)), (links[:, 0], links[:, 1])), (size, size))
    count, merged = connected_components(links, directed=False)
    share = np.bincount(merged, minlength=count)
    centre = np.stack([np.bincount(merged, v, count) / share for v in graph.nodes.T], -1)
    kept = np.flatnonzero(~bridge & ~spur)
    ends = merged[graph.ends[kept]]
    paths = [
        np.vstack([centre[a], graph.paths[k][1:-1], centre[b]])
        for k, (a, b) in zip(kept, ends, strict=True)
    ]
    return Pieces(paths, ends, centre)
