"""How sure a rough drawing is of its bundles: `python -m benchmarks run bundles --data DRAWINGS`.

Keyframes and sketches as in `rough_to_clean`, traced as *Rough*. A bundle is truly one line where
the samples of its two strokes lie on the same true line beside each other. How many are decided
wrongly; how many are flagged, and which share of the length that is wrong these hold; and how far
the probabilities are off, on average over tenths.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np
from involute.engine import Drawing, Settings, vectorize
from involute.engine.rough.answered import between
from involute.engine.rough.remembered import recalled
from involute.synthesis.composed_pages import Library
from involute.synthesis.rough_drawings import rough_drawing
from involute.training.rough.rough_pages import on_sheet
from involute.training.rough.true_lines import TrueLines
from involute.training.routing.judge import calibration_error

from .rough_to_clean import KINDS
from .run_record import Figures

Array = np.ndarray

_LEAST, _STRAYS = 3.5, 2.5  # px, and spreads, that a pencil stroke lies off its line at most
_ALONG = 60.0  # px along a line between samples that lie beside each other, at most
_LINE = 0.6  # share of a stroke on true lines; one with less is a construction line


def main(argv: Sequence[str] | None = None) -> Figures:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True, help="folder of SOURCE.npz drawings")
    parser.add_argument("--pages", type=int, default=16)
    parser.add_argument("--side", type=int, default=704, help="of a page, px")
    parser.add_argument("--seed", type=int, default=7)
    args = parser.parse_args(argv)
    cv2.setNumThreads(1)
    library = Library.load(args.data, held_out=True)
    found = [_asked(library, args.side, args.seed, number) for number in range(args.pages)]
    chance, flagged, length, one, true = np.concatenate(found).T
    known, flagged = true >= 0, flagged > 0
    wrong = np.where(known, length * (one != true), 0.0)
    figures = {
        "bundles": float(len(chance)),
        "wrong": float((wrong[known] > 0).mean()),
        "flagged": float(flagged.mean()),
        "wrong length flagged": float(wrong[flagged].sum() / max(wrong.sum(), 1e-9)),
        "calibration error": calibration_error(chance[known], true[known] > 0),
    }
    print(*(f"{what:22} {value:8.3f}" for what, value in figures.items()), sep="\n")
    return {f"{args.pages} pages": figures}


def _asked(library: Library, side: int, seed: int, number: int) -> Array:
    """(M, 5) for each bundle of a page: how probably it is one line, whether it is flagged, its
    length, px; whether it is one line, and whether it truly is, or -1."""
    rng = np.random.default_rng((seed, number))
    page = rough_drawing(rng, library, KINDS[number % len(KINDS)], side)
    drawing = vectorize(on_sheet(rng, page.ink), Settings(drawing="rough"))
    if not drawing.bundles:
        return np.zeros((0, 5))
    lines = TrueLines.of([line / drawing.scale for line in page.lines])
    true = truly_one(drawing, lines, max(_LEAST, _STRAYS * page.spread + 1.0))
    rows = [
        (
            next(way.probability for way in bundle.alternatives if way.pairs),
            bundle.index in drawing.doubtful,
            bundle.span[1] - bundle.span[0],
            bool(bundle.pairs),
            answer,
        )
        for bundle, answer in zip(drawing.bundles, true, strict=True)
    ]
    return np.array(rows, float)


def truly_one(drawing: Drawing, lines: TrueLines, reach: float) -> list[int]:
    """For each bundle 1 = one line, 0 = two, -1 = a stroke of it is none.

    Args:
        lines: the true ones, and reach: how far strokes stray from them; working pixels.
    """
    assert drawing.pencil is not None
    assert drawing.pencil.beside is not None
    found = recalled(drawing.pencil.beside, drawing.scale, drawing.size)
    strokes, rungs = found.strokes, found.rungs
    line, place, _ = lines.owner(strokes.points, strokes.tangent, reach)
    on_lines = np.bincount(strokes.stroke, line >= 0) / np.bincount(strokes.stroke)
    answers = []
    for bundle in drawing.bundles:
        own = between(found, bundle.strokes, np.array(bundle.span) / drawing.scale)
        a, b = rungs.a[own], rungs.b[own]
        nothing = ((line[a] < 0) & (line[b] < 0)).mean() > 0.5
        if nothing or on_lines[list(bundle.strokes)].min() < _LINE:
            answers.append(-1)
            continue
        same = (line[a] == line[b]) & (line[a] >= 0) & (np.abs(place[a] - place[b]) < _ALONG)
        answers.append(int(same.mean() > 0.5))
    return answers


if __name__ == "__main__":
    main()
