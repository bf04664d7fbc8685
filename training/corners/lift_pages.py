"""Pages with the lifts of many hands, traced, and at every corner whether a stroke goes on.

Pages of true strokes with random habits (`synthesis.pen_lifts`) are drawn as hands draw and
scanners see them and traced with our own stages; what is kept is the evidence at every place where
the pen may have been lifted.
"""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path

import cv2
import numpy as np
from involute.engine.graph import Evidence, traced
from involute.engine.graph.lifts import cut_at_lifts, evidence_size
from involute.engine.routing import route
from involute.engine.settings import Settings
from involute.engine.values import PlanarGraph

from ...synthesis.composed_pages import Library, loosened
from ...synthesis.held_out_pages import endless
from ...synthesis.pen_lifts import Habit, lifted
from ..routing.labels import labelled, unowned
from ..routing.traced import MOST_FALSE, look_ink, look_scan, on_canvas

Array = np.ndarray

_SCANNED = 0.75  # share of the pages; the others are even ink
_SIZE = (0.55, 0.9)  # of a page of the benchmark's size: smaller ones are traced sooner
_PEN = 4.0  # px; a habit moves ends by shares of this
_PIECE = 40  # pages between two writings of the file
JOINED, LIFTED, UNKNOWN = 1, 0, -1


@dataclass(frozen=True, eq=False)
class Corners:
    """Corners of many pages: evidence (N, F) float16, truth (N,) int8, page (N,) int32, and the
    habit (share of the corners that were cut) of every page, (P,)."""

    evidence: Array
    truth: Array
    page: Array
    habit: Array

    @staticmethod
    def load(path: Path) -> Corners:
        with np.load(path) as file:
            return Corners(*(file[name] for name in ("evidence", "truth", "page", "habit")))


def gathered(
    path: Path, pages: int, data: Path, held_out: bool = False, seed: int = 1, jobs: int = 1
) -> Corners:
    """The corners of so many pages, from a file, as far as it goes, and made."""
    found: list[tuple[Array, Array, float]] = []
    if path.exists():
        saved = Corners.load(path)
        for number, habit in enumerate(saved.habit):
            own = saved.page == number
            found.append((saved.evidence[own], saved.truth[own], float(habit)))
    work = data, held_out, seed
    with ProcessPoolExecutor(jobs, get_context("spawn"), _prepare, work) as pool:
        while len(found) < pages:
            found += pool.map(_corners, range(len(found), min(len(found) + _PIECE, pages)))
            _save(path, found)
            print(f"{len(found)} pages, {sum(len(f[1]) for f in found)} corners", flush=True)
    return Corners.load(path)


def _save(path: Path, found: list[tuple[Array, Array, float]]) -> None:
    part = path.with_suffix(".part.npz")
    np.savez(
        part,
        evidence=np.concatenate([f[0] for f in found]),
        truth=np.concatenate([f[1] for f in found]),
        page=np.repeat(np.arange(len(found), dtype=np.int32), [len(f[1]) for f in found]),
        habit=np.array([f[2] for f in found]),
    )
    part.replace(path)


def _prepare(data: Path, held_out: bool, seed: int) -> None:
    """What every page needs, once in each process."""
    global _library, _seed
    cv2.setNumThreads(1)
    _library, _seed = Library.load(data, held_out), seed


def _corners(number: int) -> tuple[Array, Array, float]:
    """Evidence and truth of one page, and its habit; none when it is no example."""
    rng, settings = np.random.default_rng((_seed, number)), Settings()
    size = rng.uniform(*_SIZE)
    strokes = [line * size for line in next(endless(rng, _library))]
    habit = Habit.drawn(rng, _PEN)
    if habit.corners:  # a hand that lifts is looser everywhere
        strokes = loosened(rng, strokes)
    strokes = on_canvas(lifted(rng, strokes, habit))
    if strokes:
        look = look_scan if rng.random() < _SCANNED else look_ink
        maps, scan = look(rng, strokes, settings)
        graph = traced(Evidence.of(scan, maps), settings, route, without=("lifts",))[0]
        graph, seen = cut_at_lifts(graph, scan, maps)
        if len(seen):
            page = labelled(graph, [line / scan.scale for line in strokes])
            if unowned(page) < MOST_FALSE:
                return seen.astype(np.float16), truth_at(graph, page), habit.corners
    return np.zeros((0, evidence_size()), np.float16), np.zeros(0, np.int8), habit.corners


def truth_at(graph: PlanarGraph, page: object) -> Array:
    """(C,) int8: whether one stroke runs through each corner; unknown where nobody drew."""
    order, starts = graph.halves_at
    halves = order[starts[graph.corners][:, None] + np.arange(2)].reshape(-1, 2)
    joined = page.partner[halves[:, 0]] == halves[:, 1]
    owned = (page.stroke[graph.offsets[:-1]] >= 0)[halves >> 1].all(1)
    return np.where(owned, joined, UNKNOWN).astype(np.int8)
