"""A picture of hard pages and the centerlines that the network finds on them, for the manual.

python -m involute.training.centerline.stress --data DIR --out docs/centerline.png
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import cv2
import numpy as np
from involute.engine.centerline.backends import load
from involute.engine.centerline.learned import WEIGHTS, trace_maps
from involute.engine.scan.paper import flatten_paper

from ...synthesis.line_art import Array, Library, Rng, Strokes, parallels, scribble, true_drawing
from ...synthesis.media import MEDIA, Medium, draw, sample
from ...synthesis.sheet_of_paper import paper, print_on, scan, shadow

SIZE = 360
GAP = 10


@dataclass(frozen=True)
class Page:
    """A hard page: its strokes, the pen, and the sheet under them."""

    name: str
    strokes: Callable[[Rng, Library], list[Strokes]]
    medium: Medium
    width: float
    sheet: Callable[[Rng], Array]


def main(arguments: list[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(prog="stress", description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--weights", type=Path, default=WEIGHTS)
    parser.add_argument("--seed", type=int, default=5)
    options = parser.parse_args(arguments)
    library = Library.load(options.data)
    infer = load(options.weights, "cpu")
    columns: list[Array] = []
    for number, hard in enumerate(pages()):
        gray = drawn(np.random.default_rng((options.seed, number)), hard, library)
        line = trace_maps(flatten_paper(gray), infer, lambda fraction: None).centerline
        shown = _captioned(gray, hard.name), np.ones((GAP, SIZE)), 1 - line
        column = np.vstack(shown)
        columns += [column, np.ones((len(column), GAP))]
    picture = np.hstack(columns[:-1])
    cv2.imwrite(str(options.out), np.round(np.clip(picture, 0, 1) * 255).astype(np.uint8))


def pages() -> Iterator[Page]:
    """The hard pages."""

    def aged(rng: Rng) -> Array:
        return paper(rng, SIZE, 0.1) * shadow(rng, SIZE)

    def white(rng: Rng) -> Array:
        return np.full((SIZE, SIZE), 0.97, np.float32)

    def grid(rng: Rng) -> Array:
        return white(rng) * (1 - print_on(rng, SIZE, 0.4, pitch=24))

    def drawings(count: int) -> Callable[[Rng, Library], list[Strokes]]:
        return lambda rng, library: [
            true_drawing(rng, library, SIZE // 2, True)[0] for _ in range(count)
        ]

    faint = replace(MEDIA["pencil"], density=(0.3, 0.35), grain=(0.3, 0.4))
    yield Page("faint", drawings(3), faint, 2.0, aged)
    yield Page("fat marker", drawings(1), MEDIA["marker"], 15.0, white)
    yield Page(
        "grid paper",
        lambda rng, library: [scribble(rng, SIZE)[0] for _ in range(3)],
        MEDIA["ballpoint"],
        2.2,
        grid,
    )
    yield Page(
        "4 px apart",
        lambda rng, library: [parallels(rng, SIZE, 4.0)[0] for _ in "abcd"],
        MEDIA["technical pen"],
        1.8,
        white,
    )
    yield Page("overlap", drawings(7), MEDIA["ink"], 3.0, white)


def drawn(rng: Rng, hard: Page, library: Library) -> Array:
    """The page as a scanner sees it, (SIZE, SIZE) float32 luminance."""
    ink: Array = np.zeros((SIZE, SIZE), np.float32)
    for strokes in hard.strokes(rng, library):
        samples = sample(strokes, SIZE) if strokes else None
        if samples is not None and len(samples) > 1:
            layer, _ = draw(rng, samples, hard.medium, hard.width, SIZE)
            ink = 1 - (1 - ink) * (1 - layer)
    return scan(rng, hard.sheet(rng) * (1 - 0.95 * ink))


def _captioned(gray: Array, name: str) -> Array:
    strip = np.full((24, gray.shape[1]), 255, np.uint8)
    cv2.putText(strip, name, (4, 17), cv2.FONT_HERSHEY_SIMPLEX, 0.5, 50, 1, cv2.LINE_AA)
    return np.vstack([strip / 255, gray])


if __name__ == "__main__":
    main()
