"""Whether traced and true lines lie beside each other on the whole, and what that costs.

    python -m benchmarks.offset [--data DIR] [--methods NAME ...]

Whoever draws a page from a truth may place it a fraction of a pixel off. Such a shift is the same
for every drawing; a method that has none on exactly drawn pages has found it in the pages. (Plain
thinning leans to one side itself.) It is estimated from all drawings together, and the Chamfer
distance is given with it and without.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from .judged_pages import DATA, JudgedPage, pages
from .methods import METHODS
from .metrics import Strokes, chamfer
from .quality import one_thread
from .run_record import Figures
from .tables import markdown

Array = np.ndarray

_NEAR = 2.0  # px; what is farther from every true line is another error than a shift


def shift(pairs: Sequence[tuple[Strokes, Strokes]]) -> Array:
    """(2,) px: how far the first strokes of all pairs lie from the second, to the right and down.

    A line only tells the part of a shift that goes across it: least squares over all of them.
    """
    matrix, vector = np.zeros((2, 2)), np.zeros(2)
    for pred, true in pairs:
        if pred.tree is None or true.tree is None:
            continue
        dense = _dense(true)
        distance, hit = cKDTree(dense).query(pred.samples)
        near = distance < _NEAR
        tangent = pred.tangent(pred.stroke[near], pred.arc[near])
        normal = np.stack([-tangent[:, 1], tangent[:, 0]], 1)
        across = ((pred.samples[near] - dense[hit[near]]) * normal).sum(1)
        matrix += normal.T @ normal
        vector += normal.T @ across
    return np.linalg.solve(matrix + 1e-9 * np.eye(2), vector)


def _dense(strokes: Strokes) -> Array:
    """Points of the strokes a tenth of a pixel apart."""
    tenths = np.arange(0, 1, 0.1)
    arc = np.minimum(
        strokes.arc[:, None] + tenths, strokes.length[strokes.stroke][:, None]
    ).reshape(-1)
    return strokes.at(np.repeat(strokes.stroke, len(tenths)), arc)


def _traced(work: tuple[str, JudgedPage]) -> list[Array]:
    method, page = work
    return METHODS[method](page.image)


def main(argv: Sequence[str] | None = None) -> Figures:
    """The command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.offset", description=__doc__)
    parser.add_argument("--data", type=Path, default=DATA)
    default = ["involute", "involute, no network", "skeleton + greedy"]
    parser.add_argument("--methods", nargs="+", choices=METHODS, default=default, metavar="NAME")
    parser.add_argument("--jobs", type=int, default=2, help="parallel processes")
    arguments = parser.parse_args(argv)
    drawings = pages(arguments.data)
    true = [Strokes(page.true_strokes()) for page in drawings]
    figures = {}
    with ProcessPoolExecutor(arguments.jobs, get_context("spawn"), one_thread) as pool:
        for method in arguments.methods:
            lines = list(pool.map(_traced, [(method, page) for page in drawings]))
            pairs = [(Strokes(own), t) for own, t in zip(lines, true, strict=True)]
            x, y = shift(pairs)
            before = np.median([chamfer(*pair) for pair in pairs])
            moved = [Strokes([line - (x, y) for line in own]) for own in lines]
            after = np.median([chamfer(p, t) for p, t in zip(moved, true, strict=True)])
            figures[method] = {"x_px": x, "y_px": y, "chamfer": before, "chamfer_moved": after}
    forms = "{:+.2f}", "{:+.2f}", "{:.3f}", "{:.3f}"
    rows = [
        [name, *(form.format(v) for form, v in zip(forms, own.values(), strict=True))]
        for name, own in figures.items()
    ]
    print(markdown(["method", "shift x px", "shift y px", "Chamfer px", "without the shift"], rows))
    return figures


if __name__ == "__main__":
    main()
