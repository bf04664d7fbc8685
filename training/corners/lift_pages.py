"""Pages with the lifts of many hands, traced, and at every corner whether a stroke goes on.

`python -m training.corners.lift_pages --data DIR --out FILE --pages N` draws pages of true strokes
with random habits (`synthesis.pen_lifts`) as hands draw and scanners see them, traces them with
our own stages and keeps the evidence at every place where the pen may have been lifted. Started
again with the same FILE, it goes on where it stopped.
"""

from __future__ import annotations

import argparse
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
_SIZE = (0.6, 1.0)  # of a page of the benchmark's size: smaller ones are traced sooner
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


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True, help="folder of SOURCE.npz drawings")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--pages", type=int, default=800)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1, help="parallel processes")
    parser.add_argument("--held-out", action="store_true", help="from the validation drawings")
    args = parser.parse_args()
    found: list[tuple[Array, Array, float]] = []
    done = 0
    if args.out.exists():
        saved = Corners.load(args.out)
        done = len(saved.habit)
        rows = [saved.page == number for number in range(done)]
        found = [
            (saved.evidence[own], saved.truth[own], habit)
            for own, habit in zip(rows, saved.habit, strict=True)
        ]
    work = args.data, args.held_out, args.seed
    with ProcessPoolExecutor(args.jobs, get_context("spawn"), _prepare, work) as pool:
        while done < args.pages:
            numbers = range(done, min(done + _PIECE, args.pages))
            found += pool.map(_corners, numbers)
            done = numbers.stop
            _save(args.out, found)
            print(f"{done} pages, {sum(len(f[1]) for f in found)} corners", flush=True)


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
    strokes = next(endless(rng, _library))
    size = rng.uniform(*_SIZE)
    strokes = loosened(rng, [line * size for line in strokes])
    habit = Habit.drawn(rng, _PEN)
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


if __name__ == "__main__":
    main()
