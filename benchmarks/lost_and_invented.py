"""How faithful drawings are to the ink of their pages; no truth is needed.

    python -m benchmarks run fidelity [--scans DIR] [--data DIR] [--every N]

    lost      share of the clear ink that no stroke and no fill covers
    invented  share of the length of all strokes that runs over clear paper

Clear ink is at least half as dark as the page's full ink and no speck; clear paper is lighter than
an eighth of it and 2.5 px away from anything darker. Ink that a setting leaves out (rules, marks)
counts as lost.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import TypeVar

import cv2
import numpy as np
from involute.engine import Drawing, vectorize
from involute.engine.formats.flatten import outline

from .judged_pages import DATA, pages, picture
from .quality import one_thread
from .run_record import Figures
from .tables import markdown

Array = np.ndarray
Work = TypeVar("Work")

_INK, _TRACE = 0.5, 0.12  # of full ink: what is clear ink, and what may be some
_SPECK = 5  # px of area; less is dust
_PAPER = 2.5  # px that clear paper keeps away from ink
_SLACK = 2.0  # px that a stroke may be too thin on each side
_SUB = 4  # binary digits of sub-pixel positions


@dataclass(frozen=True)
class Fidelity:
    """Pixels of clear ink and of those lost; px of line and of that over clear paper."""

    ink: int
    lost: int
    length: int
    invented: int

    @staticmethod
    def pooled(parts: Iterable[Fidelity]) -> dict[str, float]:
        """The shares of many pages together, and of the worst of them."""
        parts = list(parts)
        lost, invented = (sum(getattr(p, name) for p in parts) for name in ("lost", "invented"))
        return {
            "pages": len(parts),
            "lost": lost / max(1, sum(p.ink for p in parts)),
            "invented": invented / max(1, sum(p.length for p in parts)),
            "worst lost": max((p.lost / max(1, p.ink) for p in parts), default=0.0),
            "worst invented": max((p.invented / max(1, p.length) for p in parts), default=0.0),
        }


def fidelity(ink: Array, drawing: Drawing) -> Fidelity:
    """Compare a drawing with the (H, W) ink in [0, 1] of its page, 1 = the page's full ink."""
    clear, near = _without_specks(ink > _INK), _without_specks(ink > _TRACE)
    paper = cv2.distanceTransform((~near).astype(np.uint8), cv2.DIST_L2, 5) > _PAPER
    covered = _covered(drawing, ink.shape)
    length = invented = 0
    for stroke in drawing.strokes:
        row, column = _pixels(outline(stroke), ink.shape)
        length += len(row)
        invented += int(np.count_nonzero(paper[row, column]))
    lost = int(np.count_nonzero(clear & ~covered))
    return Fidelity(int(np.count_nonzero(clear)), lost, length, invented)


def ink_of(gray: Array) -> Array:
    """(H, W) float32 in [0, 1]: how dark a page (uint8) is beside its paper; 1 = its full ink.

    Paper is what a closing wider than any line leaves, so shade and stains count as paper.
    """
    dark_page = float(np.median(gray)) < 100
    page = (255.0 - gray if dark_page else gray).astype(np.float32)
    side = max(5, min(page.shape) // 48 | 1)  # of a quarter of the page: a twelfth of its side
    small = cv2.resize(page, None, fx=0.25, fy=0.25, interpolation=cv2.INTER_AREA)
    small = cv2.copyMakeBorder(small, side, side, side, side, cv2.BORDER_REFLECT)
    paper = cv2.morphologyEx(small, cv2.MORPH_CLOSE, np.ones((side, side), np.uint8))
    paper = cv2.GaussianBlur(paper, (0, 0), side / 2)[side:-side, side:-side]
    paper = cv2.resize(paper, page.shape[::-1], interpolation=cv2.INTER_LINEAR)
    dark = np.clip(1 - page / np.maximum(paper, 1), 0, 1)
    strong = dark[dark > 0.25]
    full = float(np.quantile(strong, 0.8)) if len(strong) > 50 else 1.0
    return np.clip(dark / max(full, 0.15), 0, 1).astype(np.float32)


def _without_specks(mask: Array) -> Array:
    _, label, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=8)
    return mask & (stats[:, cv2.CC_STAT_AREA] >= _SPECK)[label]


def _covered(drawing: Drawing, shape: tuple[int, ...]) -> Array:
    """(H, W) bool: under a fill, or a stroke made a little wider."""
    drawn = np.zeros(shape[:2], np.uint8)
    for fill in drawing.fills:
        rings = [_fixed(ring) for ring in fill]
        cv2.fillPoly(drawn, rings, 1, cv2.LINE_8, _SUB)
        cv2.polylines(drawn, rings, True, 1, round(2 * _SLACK) + 1, cv2.LINE_8, _SUB)
    for stroke in drawing.strokes:
        wide = int(np.ceil(stroke.widths.mean() + 2 * _SLACK))
        cv2.polylines(drawn, [_fixed(outline(stroke))], False, 1, wide, cv2.LINE_8, _SUB)
    return drawn > 0


def _fixed(points: Array) -> Array:
    # OpenCV's pixel centres are whole numbers, ours lie at one half.
    return np.round((np.asarray(points) - 0.5) * 2**_SUB).astype(np.int32)


def _pixels(line: Array, shape: tuple[int, ...]) -> tuple[Array, Array]:
    """The pixels under a polyline, one for each px of its length."""
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    along = np.arange(0, arc[-1], 1.0)
    x, y = (np.interp(along, arc, line[:, k]).astype(int) for k in (0, 1))
    return np.clip(y, 0, shape[0] - 1), np.clip(x, 0, shape[1] - 1)


def judged(path: Path) -> Fidelity:
    """Trace a page as a user does and compare it with its own ink."""
    return fidelity(ink_of(picture(path)), vectorize(path))


def side_by_side(
    work: Mapping[str, Sequence[Work]], judge: Callable[[Work], Fidelity], jobs: int
) -> Figures:
    """Judge all that a row holds, in parallel; print the rows as a table."""
    with ProcessPoolExecutor(jobs, get_context("spawn"), one_thread) as pool:
        figures = {
            name: Fidelity.pooled(pool.map(judge, members)) for name, members in work.items()
        }
    rows = [
        [name, f"{own['pages']:.0f}", *(f"{100 * v:.3f}" for v in list(own.values())[1:])]
        for name, own in figures.items()
    ]
    print(markdown(["", "pages", "lost %", "invented %", "worst lost", "worst invented"], rows))
    return figures


def main(argv: Sequence[str] | None = None) -> Figures:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks run fidelity",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--data", type=Path, default=DATA, help="folder with a manifest.json")
    parser.add_argument("--scans", type=Path, help="a folder of scans, a row each")
    parser.add_argument("--every", type=int, default=1, help="only every n-th page")
    parser.add_argument("--jobs", type=int, default=2, help="parallel processes")
    options = parser.parse_args(argv)
    if options.scans:
        paths = sorted(p for p in options.scans.iterdir() if p.suffix in (".jpg", ".png"))
        work = {path.stem: [path] for path in paths[:: options.every]} | {"all": paths}
    else:
        work = {"all": [page.image for page in pages(options.data)[:: options.every]]}
    return side_by_side(work, judged, options.jobs)


if __name__ == "__main__":
    main()
