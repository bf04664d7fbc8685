"""Held-out pages in the benchmark's form, to tune and choose on: the benchmark only judges.

`python -m synthesis.held_out_pages --data DIR --out DIR` draws validation drawings (no network
has seen them) with the media and papers of the centerline training and writes NAME.jpg, NAME.svg
and manifest.json, so that `python -m benchmarks.quality --data DIR` and the others run on them.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np

from .composed_pages import SOURCES, Library
from .media import MEDIA, draw, line_spacing, sample
from .sheet_of_paper import paper, scan, shadow
from .true_graph import single_lines

Array = np.ndarray

_SIDE, _MARGIN = 1000, 24  # px; the noise of media and papers is a little larger
# The benchmark has hand-drawn pictures, and few diagrams.
_SOURCES = {"openclipart": 5, "streamline": 3, "quickdraw_raw": 1, "openmoji": 2, "excalidraw": 1}
_COMPOSED = 0.4  # share of the pages that are laid over each other as those of the routing training
_FEWEST, _MOST = 8, 250  # strokes
_PENS = {"technical pen": (2, 4), "ink": (2, 5), "pencil": (2, 5), "soft pencil": (3, 6)} | {
    "brushpen": (2.5, 6),
    "marker": (4, 7),
    "charcoal": (3, 7),
    "ballpoint": (1.8, 3.5),
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True, help="folder of SOURCE.npz drawings")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--pages", type=int, default=48)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="+", choices=list(SOURCES), help="these sets alone")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    rng = np.random.default_rng(args.seed)
    library = Library.load(args.data, held_out=True)
    media = [name for name in _PENS if name in MEDIA]
    manifest = []
    for number in range(args.pages):
        name, medium = f"page_{number:03d}", media[number % len(media)]
        strokes = _drawing(rng, library, args.only)
        image, sheet = _drawn(rng, strokes, medium)
        cv2.imwrite(str(args.out / f"{name}.jpg"), image, [cv2.IMWRITE_JPEG_QUALITY, 88])
        (args.out / f"{name}.svg").write_text(_svg(strokes, image.shape), "utf-8")
        style = f"{medium}, {sheet}"
        manifest.append({"name": name, "source": "", "style": style, "strokes": len(strokes)})
    (args.out / "manifest.json").write_text(json.dumps(manifest, indent=1), "utf-8")


def _drawing(
    rng: np.random.Generator, library: Library, only: Sequence[str] | None = None
) -> list[Array]:
    """True strokes that fill a page: one drawing, or several over each other."""
    names = [name for name in only or _SOURCES if name in library.sources]
    weight = np.array([_SOURCES.get(name, 1) for name in names], float)
    while True:
        if not only and rng.random() < _COMPOSED:
            strokes = library.page(rng)
        else:
            strokes = library.pick(rng, str(rng.choice(names, p=weight / weight.sum())))
        low = np.min([line.min(0) for line in strokes], 0)
        size = float((np.max([line.max(0) for line in strokes], 0) - low).max())
        scale = (_SIDE - 2 * _MARGIN) / max(size, 1e-6)
        strokes = single_lines([(line - low) * scale + _MARGIN for line in strokes])
        if _FEWEST <= len(strokes) <= _MOST:
            return strokes


def _drawn(rng: np.random.Generator, strokes: list[Array], medium: str) -> tuple[Array, str]:
    """The page as a scanner sees it, (H, W) uint8, and what its paper is."""
    width, height = np.ceil(np.max([line.max(0) for line in strokes], 0) + _MARGIN).astype(int)
    samples = sample([line.astype(np.float32) for line in strokes], _SIDE)
    pen = min(float(rng.uniform(*_PENS[medium])), 0.8 * line_spacing(samples, _SIDE))
    ink, _ = draw(rng, samples, MEDIA[medium], pen, _SIDE)
    sheet = str(rng.choice(["white", "paper", "shadow"], p=[0.4, 0.35, 0.25]))
    page = np.ones_like(ink)
    if sheet != "white":
        page = paper(rng, _SIDE, float(np.median(ink[ink > 0.1])))
    gray = page * (1 - ink) + rng.uniform(0, 0.1) * ink
    if sheet == "shadow":
        gray = gray * shadow(rng, _SIDE)
    gray = scan(rng, gray) if sheet != "white" else gray
    return np.round(np.clip(gray[:height, :width], 0, 1) * 255).astype(np.uint8), sheet


def _svg(strokes: list[Array], shape: tuple[int, ...]) -> str:
    lines = [
        "<path d='M" + " L".join(f"{x:.2f} {y:.2f}" for x, y in line) + "'/>" for line in strokes
    ]
    box = f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {shape[1]} {shape[0]}'>"
    return box + "<g fill='none' stroke='#000'>" + "".join(lines) + "</g></svg>\n"


if __name__ == "__main__":
    main()
