"""Pages on which lines run together, traced, and of every run whether it carries two strokes.

Four pages in ten are drawings, with what is drawn twice in them, a fourth are tangles, and on the
others pairs of lines share a run (`synthesis.shared_runs`). A run carries two when one true stroke
goes all along it and out by one line at each end, and another one by the other two.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from involute.engine.arrays.ragged import along, arc
from involute.engine.graph import Evidence, traced
from involute.engine.routing import route
from involute.engine.routing.double_runs import Runs, find_runs
from involute.engine.routing.run_features import FEATURES, features
from involute.engine.settings import Settings
from involute.engine.values import PlanarGraph, Routing
from scipy.spatial import cKDTree

from ...synthesis.composed_pages import Library, loosened
from ...synthesis.held_out_pages import endless
from ...synthesis.pen_lifts import Habit, lifted
from ...synthesis.shared_runs import with_shared_runs
from ..page_bank import Labelled, labelled_rows
from ..routing.hand_drawn import MARGIN, in_window
from ..routing.traced import look_ink, look_scan, on_canvas

Array = np.ndarray

ONE, TOUCH, CROSS = 0, 1, 2  # what a run carries: one stroke, two that touch, two that cross
_KINDS = (0.4, 0.25)  # shares of drawings and of tangles
_SIZE, _WINDOW = (0.55, 0.9), (500.0, 800.0)  # of a page of the benchmark's size; px
_PEN, _PENS = 4.0, (2.0, 6.0)  # px; of a habit, and of lines side by side
_OVER, _MOST = 0.6, 60  # share of these pages that lie over a drawing, of so many strokes at most
_SCANNED = 0.8  # share of the pages; the others are even ink
_BEYOND = 60.0  # px beyond a run that its lines are followed
_COVERED = 0.93  # share of a line along which one stroke must run
_NEAR, _HALF = 3.0, 0.75  # px, or px more than half of _NEAR in pen widths, beside a stroke
_ALONG = 0.8  # cosine between a line and a stroke that runs along it
_DRIFT = 12.0, 0.06  # px, and share of a line's length, that it may be longer than its stroke
_PIECE = 40  # pages between two writings of the file
_library: Library  # of a process that makes pages, and its
_seed: int


def gathered(path: Path, pages: int, jobs: int, work: tuple) -> Labelled:
    """Features (N, F) and labels (N,) of the runs of so many pages, from a file or made.

    work: folder of the drawings, whether they are held out, seed.
    """
    return labelled_rows(path, pages, jobs, _runs, _prepare, work, _PIECE)


def _prepare(data: Path, held_out: bool, seed: int) -> None:
    """What every page needs, once in each process."""
    global _library, _seed
    cv2.setNumThreads(1)
    _library, _seed = Library.load(data, held_out), seed


def _runs(number: int) -> Labelled:
    """The runs of one page."""
    rng, settings = np.random.default_rng((_seed, number)), Settings()
    strokes = drawn(rng, _library)
    if strokes:
        look = look_scan if rng.random() < _SCANNED else look_ink
        maps, scan = look(rng, strokes, settings)
        graph, routing = traced(Evidence.of(scan, maps), settings, route)
        if graph.branch_count:
            return labelled(graph, routing, [line / scan.scale for line in strokes], scan.pen_width)
    return np.zeros((0, FEATURES), np.float32), np.zeros(0, np.int8)


def drawn(rng: np.random.Generator, library: Library) -> list[Array]:
    """The strokes of a random page, (N, 2) px each."""
    kind = np.searchsorted(np.cumsum(_KINDS), rng.random(), "right")
    if kind == 0:
        size = rng.uniform(*_SIZE)
        strokes = [line * size for line in next(endless(rng, library, once=False))]
        habit = Habit.drawn(rng, _PEN)
        strokes = loosened(rng, strokes) if habit.corners else strokes
        return on_canvas(lifted(rng, strokes, habit))
    if kind == 1 and "tangles" in library.sources:
        tangle = next(endless(rng, library, ["tangles"]))
        return on_canvas(in_window(rng, tangle, rng.uniform(*_WINDOW)))
    size = rng.uniform(*_WINDOW)
    under = []
    if rng.random() < _OVER:
        under = [line * size / 1000 for line in next(endless(rng, library))]
        under = [under[k] for k in rng.permutation(len(under))[:_MOST]]
    pairs = int(rng.integers(2, 7))
    return [m + MARGIN for m in with_shared_runs(rng, under, size, rng.uniform(*_PENS), pairs)[0]]


def labelled(graph: PlanarGraph, routing: Routing, strokes: list[Array], pen: float) -> Labelled:
    """Features and labels of all runs of a traced page whose true strokes are known."""
    runs = find_runs(graph, routing.partner)
    if not len(runs):
        return np.zeros((0, FEATURES), np.float32), np.zeros(0, np.int8)
    truth = _Strokes.of(strokes)
    near = max(_NEAR, _NEAR / 2 + _HALF * pen)
    rows = features(graph, routing, runs).astype(np.float32)
    labels = np.array([_carried(graph, truth, runs, k, near) for k in range(len(runs))], np.int8)
    # The network says whether lines keep their sides, whichever of them the router let through.
    other = (rows[:, -1] < 0) & (labels != ONE)
    return rows, np.where(other, TOUCH + CROSS - labels, labels)


def _carried(graph: PlanarGraph, truth: _Strokes, runs: Runs, run: int, near: float) -> int:
    """What one run carries."""
    middle = np.concatenate([graph.half_branch(half) for half in runs.path[run]]).astype(float)
    first, last = (
        [_beyond(graph, half) for half in ends[run, 1:]] for ends in (runs.first, runs.last)
    )
    # Which share of each way through is covered by each stroke, in at b and out at a.
    covered = [
        [truth.covered(np.concatenate([b[::-1], middle, a]), near) for a in last] for b in first
    ]
    touch, cross = (
        max(
            (min(p, q) for i, p in one.items() for j, q in other.items() if i != j),
            default=0.0,
        )
        for one, other in ((covered[0][0], covered[1][1]), (covered[0][1], covered[1][0]))
    )
    if max(touch, cross) < _COVERED:
        return ONE
    return TOUCH if touch >= cross else CROSS


def _beyond(graph: PlanarGraph, half: int) -> Array:
    """The first px of a half-branch, (8, 2)."""
    line = graph.half_branch(half).astype(float)
    return along(line, np.linspace(0, min(arc(line)[-1], _BEYOND), 8))


@dataclass(frozen=True, eq=False)
class _Strokes:
    """True strokes, sampled every pixel: a tree of them, tangent (N, 2), stroke and arc (N,)."""

    tree: cKDTree
    tangent: Array
    stroke: Array
    arc: Array

    @staticmethod
    def of(strokes: list[Array]) -> _Strokes:
        lines = [line for line in strokes if len(line) > 1 and arc(line)[-1] >= 1]
        at = [np.linspace(0, arc(line)[-1], max(2, round(arc(line)[-1]) + 1)) for line in lines]
        place = [along(line, where) for line, where in zip(lines, at, strict=True)]
        return _Strokes(
            cKDTree(np.concatenate(place)),
            np.concatenate([_unit(np.gradient(line, axis=0)) for line in place]),
            np.repeat(np.arange(len(place)), [len(line) for line in place]),
            np.concatenate(at),
        )

    def covered(self, line: Array, near: float) -> dict[int, float]:
        """Which share of a line each stroke runs along in one go."""
        length = arc(line)[-1]
        count = max(4, int(length / 3) + 1)
        places = along(line, np.linspace(0, length, count))
        way = _unit(np.gradient(places, axis=0))
        hits = self.tree.query_ball_point(places, near)
        row = np.repeat(np.arange(count), [len(hit) for hit in hits])
        if not len(row):
            return {}
        hit = np.concatenate([np.asarray(some, int) for some in hits])
        turn = (way[row] * self.tangent[hit]).sum(1)
        found: dict[int, float] = {}
        for sign in (1, -1):
            for stroke in np.unique(self.stroke[hit[sign * turn > _ALONG]]).tolist():
                own = (sign * turn > _ALONG) & (self.stroke[hit] == stroke)
                start = self.arc[hit[own]] - sign * length / (count - 1) * row[own]
                steady = np.abs(start - np.median(start)) < _DRIFT[0] + _DRIFT[1] * length
                share = len(np.unique(row[own][steady])) / count
                found[stroke] = max(found.get(stroke, 0.0), share)
        return found


def _unit(vectors: Array) -> Array:
    return vectors / np.maximum(np.hypot(*vectors.T), 1e-9)[:, None]
