"""Held-out pages in the benchmark's form, to tune and choose on: the benchmark only judges.

`python -m synthesis.held_out_pages --data DIR --out DIR` draws validation drawings (no network
has seen them) with the media and papers of the centerline training and writes NAME.jpg, NAME.svg
and manifest.json, so that `python -m benchmarks.quality --data DIR` and the others run on them.
Other kinds: lines of one bit (NAME.png), and rough sketches of which the clean lines are the truth.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np

from .composed_pages import SOURCES, Library
from .media import DIGITAL, MEDIA, NUDGE, draw, line_spacing, sample
from .pen_lifts import KINDS, Habit, lifted
from .pencilling import Hand, pencilled
from .shared_runs import with_shared_runs
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
_ROUGH_PENS = {"pencil": (1.5, 3), "soft pencil": (2, 4), "ballpoint": (1.2, 2.2)}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True, help="folder of SOURCE.npz drawings")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--pages", type=int, default=48)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="+", choices=list(SOURCES), help="these sets alone")
    parser.add_argument("--look", default="paper", choices=list(_LOOKS), help="how it is drawn")
    parser.add_argument(
        "--habit", default="as drawn", choices=KINDS, help="where the pen is lifted"
    )
    parser.add_argument("--overlaps", type=int, default=0, help="pairs of lines that share a run")
    parser.add_argument("--each", action="store_true", help="every drawing once, the richest first")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    rng = np.random.default_rng(args.seed)
    library = Library.load(args.data, held_out=True)
    names = args.only or [name for name in _SOURCES if name in library.sources]
    drawings = _richest(library, names) if args.each else endless(rng, library, args.only)
    manifest = []
    for number, strokes in zip(range(args.pages), drawings, strict=False):
        name = f"page_{number:03d}"
        pen = float(rng.uniform(*list(_PENS.values())[number % len(_PENS)]))
        strokes = lifted(rng, strokes, Habit.drawn(rng, pen, args.habit))
        if args.overlaps:
            strokes = with_shared_runs(rng, strokes, _SIDE, pen, args.overlaps)[0]
        image, style = _LOOKS[args.look](rng, strokes, number, pen)
        if args.look == "one bit":  # JPEG would bring grey in
            cv2.imwrite(str(args.out / f"{name}.png"), image)
        else:
            cv2.imwrite(str(args.out / f"{name}.jpg"), image, [cv2.IMWRITE_JPEG_QUALITY, 88])
        (args.out / f"{name}.svg").write_text(_svg(strokes, image.shape), "utf-8")
        manifest.append({"name": name, "source": "", "style": style, "strokes": len(strokes)})
    (args.out / "manifest.json").write_text(json.dumps(manifest, indent=1), "utf-8")


def endless(
    rng: np.random.Generator,
    library: Library,
    only: Sequence[str] | None = None,
    once: bool = True,
) -> Iterator[list[Array]]:
    """True strokes that fill a page: one drawing, or several over each other.

    Args:
        only: these sets alone. once: without what is drawn twice.
    """
    names = [name for name in only or _SOURCES if name in library.sources]
    weight = np.array([_SOURCES.get(name, 1) for name in names], float)
    while True:
        if not only and rng.random() < _COMPOSED:
            strokes = library.page(rng)
        else:
            strokes = library.pick(rng, str(rng.choice(names, p=weight / weight.sum())))
        strokes = _filling(strokes, once)
        if _FEWEST <= len(strokes) <= _MOST:
            yield strokes


def _richest(library: Library, names: Sequence[str]) -> Iterator[list[Array]]:
    """Every held-out drawing of some sets, those with the longest lines first."""
    sets = [library.sources[name] for name in names]
    drawings = [drawn.strokes(int(k)) for drawn in sets for k in drawn.part(library.held_out)]
    filling = [_filling([line for line in strokes if len(line) > 1]) for strokes in drawings]
    yield from sorted(filling, key=_length, reverse=True)


def _filling(strokes: list[Array], once: bool = True) -> list[Array]:
    """A drawing at the size of a page, each of its lines once, or as it is."""
    low = np.min([line.min(0) for line in strokes], 0)
    size = float((np.max([line.max(0) for line in strokes], 0) - low).max())
    scale = (_SIDE - 2 * _MARGIN) / max(size, 1e-6)
    placed = [(line - low) * scale + _MARGIN for line in strokes]
    return single_lines(placed) if once else placed


def _length(strokes: list[Array]) -> float:
    return float(sum(np.hypot(*np.diff(line, axis=0).T).sum() for line in strokes))


def _on_paper(
    rng: np.random.Generator, strokes: list[Array], number: int, pen: float
) -> tuple[Array, str]:
    """The page as a scanner sees it, (H, W) uint8, and its medium and paper; pen: its width, px."""
    medium = list(_PENS)[number % len(_PENS)]
    samples = sample([line.astype(np.float32) for line in strokes], _SIDE)
    pen = min(pen, 0.8 * line_spacing(samples, _SIDE))
    ink, _ = draw(rng, samples, MEDIA[medium], pen, _SIDE)
    page, sheet = _scanned(rng, ink)
    return _cropped(page, strokes), f"{medium}, {sheet}"


def _one_bit(
    rng: np.random.Generator, strokes: list[Array], number: int, pen: float
) -> tuple[Array, str]:
    """Lines of 1, 2, 3 or 4 px in turn without any grey, as a drawing program makes them."""
    pen = 1.0 + number % 4
    samples = sample([line.astype(np.float32) + NUDGE for line in strokes], _SIDE)
    ink, _ = draw(rng, samples, DIGITAL["one bit"], pen, _SIDE)
    return _cropped(1 - ink, strokes), f"one bit {pen:.0f} px, white"


def _sketched(
    rng: np.random.Generator, strokes: list[Array], number: int, pen: float
) -> tuple[Array, str]:
    """Every line said by about 2, 4 or 7 pencil strokes in turn; the truth is the line."""
    medium = list(_ROUGH_PENS)[number % len(_ROUGH_PENS)]
    each = (2, 4, 7)[number % 3]
    lines = [line.astype(np.float32) for line in strokes]
    pen = float(rng.uniform(*_ROUGH_PENS[medium]))
    spacing = line_spacing(sample(lines, _SIDE), _SIDE)
    hand = replace(Hand.any(rng, pen, spacing), strokes=float(each))
    pencil, press = pencilled(rng, lines, hand)
    ink: Array = np.zeros((_SIDE, _SIDE), np.float32)
    for low, high in ((0, 0.5), (0.5, 0.75), (0.75, 2)):  # from light to dark
        chosen = [s for s, p in zip(pencil, press, strict=True) if low <= p < high]
        if chosen:
            layer, _ = draw(rng, sample(chosen, _SIDE), MEDIA[medium], pen, _SIDE)
            ink = 1 - (1 - ink) * (1 - layer * min(high, 1.0))
    page, sheet = _scanned(rng, ink)
    return _cropped(page, strokes), f"{medium}, {each} strokes a line, {sheet}"


_LOOKS = {"paper": _on_paper, "one bit": _one_bit, "rough": _sketched}


def _scanned(rng: np.random.Generator, ink: Array) -> tuple[Array, str]:
    """Ink on a sheet, scanned, as luminance, and what its paper is."""
    sheet = str(rng.choice(["white", "paper", "shadow"], p=[0.4, 0.35, 0.25]))
    page = np.ones_like(ink)
    if sheet != "white":
        page = paper(rng, _SIDE, float(np.median(ink[ink > 0.1])))
    gray = page * (1 - ink) + rng.uniform(0, 0.1) * ink
    if sheet == "shadow":
        gray = gray * shadow(rng, _SIDE)
    return (scan(rng, gray) if sheet != "white" else gray), sheet


def _cropped(gray: Array, strokes: list[Array]) -> Array:
    """(H, W) uint8: the part of the page on which there is something."""
    width, height = np.ceil(np.max([line.max(0) for line in strokes], 0) + _MARGIN).astype(int)
    return np.round(np.clip(gray[:height, :width], 0, 1) * 255).astype(np.uint8)


def _svg(strokes: list[Array], shape: tuple[int, ...]) -> str:
    lines = [
        "<path d='M" + " L".join(f"{x:.2f} {y:.2f}" for x, y in line) + "'/>" for line in strokes
    ]
    box = f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {shape[1]} {shape[0]}'>"
    return box + "<g fill='none' stroke='#000'>" + "".join(lines) + "</g></svg>\n"


if __name__ == "__main__":
    main()
