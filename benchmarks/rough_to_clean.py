"""How many lines of rough drawings are found, on held-out pages drawn for it.

    python -m benchmarks run rough --data DRAWINGS [--pages 24] [--side 704] [--jobs 2]

Keyframes and sketches in turn, their lines by `synthesis.rough_drawings` from drawings that no
network has seen, traced as *Rough*. Within 6 px of 1024, 85 % of a line covered and less than 15 %
off it; strokes a line; length off; and how many pages *Automatic* takes for rough.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path

import cv2
import numpy as np
from involute.engine import Settings, vectorize
from involute.synthesis.composed_pages import Library
from involute.synthesis.line_art import pieces, resample
from involute.synthesis.rough_drawings import rough_drawing
from involute.training.rough.rough_pages import on_sheet

from .metrics import Strokes, recovered, scaled
from .run_record import Figures

Array = np.ndarray

KINDS = ("keyframe", "sketch")
_WITHIN, _COVER, _OFF = 6.0, 0.85, 0.15  # px at 1024, and shares of a line


def main(argv: Sequence[str] | None = None) -> Figures:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks run rough",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--data", type=Path, required=True, help="folder of SOURCE.npz drawings")
    parser.add_argument("--pages", type=int, default=24)
    parser.add_argument("--side", type=int, default=704, help="of a page, px")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2, help="parallel processes")
    options = parser.parse_args(argv)
    work = partial(judged, options.data, options.side, options.seed)
    with ProcessPoolExecutor(options.jobs, get_context("spawn")) as pool:
        rows = np.array(list(pool.map(work, range(options.pages))))
    found = {}
    for number, kind in enumerate(KINDS):
        f1, strokes, off, told = rows[number :: len(KINDS)].T
        found[kind] = {
            "f1": float(f1.mean()),
            "strokes_a_line": float(np.median(strokes)),
            "length_off": float(np.median(off)),
            "told_rough": float(told.mean()),
        }
        print(f"{kind:10s}", "  ".join(f"{k} {v:.3f}" for k, v in found[kind].items()))
    return found


def judged(data: Path, side: int, seed: int, number: int) -> tuple[float, float, float, bool]:
    """F1, strokes a line, share of the length off, and whether it is told to be rough."""
    cv2.setNumThreads(1)
    page, lines = drawn(Library.load(data, held_out=True), side, seed, number)
    traced = vectorize(page, Settings(drawing="rough"))
    if not traced.strokes:
        return 0.0, 0.0, 1.0, False
    pred, true = (
        Strokes(scaled(some, (side, side)))
        for some in ([stroke.points for stroke in traced.strokes], lines)
    )
    whole = true.length.sum()
    told = vectorize(page, Settings(drawing="auto")).pencil is not None
    return (
        2 * recovered(pred, true, _WITHIN, _COVER, _OFF) / (len(pred) + len(true)),
        len(pred) / len(true),
        float(abs(pred.length.sum() - whole) / whole),
        told,
    )


def drawn(library: Library, side: int, seed: int, number: int) -> tuple[Array, list[Array]]:
    """A page, (side, side) uint8, and the lines that it means, as far as they lie on it."""
    rng = np.random.default_rng((seed, number))
    drawing = rough_drawing(rng, library, KINDS[number % len(KINDS)], side)
    return on_sheet(rng, drawing.ink), [
        piece for line in drawing.lines for piece in _on_page(line, side)
    ]


def _on_page(line: Array, side: int) -> list[Array]:
    """What of a line lies on the page."""
    dense = resample(line.astype(np.float32), 2.0)
    inside = ((dense > 0) & (dense < side)).all(1)
    return [piece for piece in pieces(dense, inside) if len(piece) > 3]


if __name__ == "__main__":
    main()
