"""Graphs as our own centerline and graph stages really make them, matched back to the true strokes.

`python -m training run traced --data DIR --out FILE --pages N` draws pages of true strokes,
traces them and writes the graphs with their routing: after the rasterised set of "Stroke
Vectorization via Involution Prediction" (routing data), but from real drawings as well. Started
again with the same FILE, it goes on where it stopped.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
from involute.engine.centerline import provider_for
from involute.engine.fills.solids import split_solids
from involute.engine.graph import Evidence, run_passes
from involute.engine.graph.passes import MEASURED, ROUTED
from involute.engine.scan.picture import MIN_SIDE
from involute.engine.scan.preparing import read_scan
from involute.engine.settings import Settings
from involute.engine.values import LineMaps, PlanarGraph, Scan
from involute.synthesis.composed_pages import Library, loosened
from involute.synthesis.media import MEDIA, draw, line_spacing, sample
from involute.synthesis.sheet_of_paper import paper, scan, shadow

from ..page_bank import PageBank
from .augment import Page
from .labels import labelled, unowned

Array = np.ndarray

_MARGIN = 12.0  # px around the drawing
_LARGEST = 1000.0  # px; a page is cut to this, so that tracing stays quick
_WIDEST = 9.0  # px; wider pens are scanned at a lower resolution
_args: argparse.Namespace  # of a process that makes pages, and its
_library: Library
_SAVED = 500  # tries between two writings of the file
_KINDS = (0.15, 0.25, 0.6)  # shares of ideal, inked and scanned pages
MOST_FALSE = 0.3  # of the length of all branches: more than this that nobody drew is no drawing


def main(argv: Sequence[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True, help="folder of SOURCE.npz drawings")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--pages", type=int, default=1500, help="one in ten comes to nothing")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1, help="parallel processes")
    parser.add_argument("--provider", default="auto", help="centerline: network or classical")
    parser.add_argument("--held-out", action="store_true", help="from the validation drawings")
    args = parser.parse_args(argv)
    PageBank(args.out, _with_tries, save, _SAVED).filled(
        args.pages, _numbered_page, args.jobs, _prepare, (args,)
    )


def _prepare(args: argparse.Namespace) -> None:
    """What every page needs, once in each process."""
    global _args, _library
    cv2.setNumThreads(1)
    _args, _library = args, Library.load(args.data, args.held_out)


def _numbered_page(number: int) -> Page | None:
    rng = np.random.default_rng((_args.seed, number))
    return traced_page(rng, _library, Settings(provider=_args.provider))


def traced_page(rng: np.random.Generator, library: Library, settings: Settings) -> Page | None:
    """One random page, traced from an ideal centerline, from clean ink or from a scanned page.

    None when nothing fits on the page, when there is no junction, or when the tracer saw so much
    that nobody drew that it is no example of routing.
    """
    strokes = on_canvas(loosened(rng, library.page(rng)))
    if not strokes:
        return None
    look = (look_ideal, look_ink, look_scan)[int(rng.choice(3, p=_KINDS))]
    maps, scan = look(rng, strokes, settings)
    strokes = [line / scan.scale for line in strokes]
    page = labelled(graph_of(maps, scan, settings), strokes)
    # Stubs go as the true strokes tell them: what is left is what the last routing will see.
    known = Evidence.of(scan, maps).routed(page.partner)
    left = run_passes(known, settings, page.graph, start=ROUTED) if scan.ink.any() else page.graph
    page = page if left is page.graph else labelled(left, strokes)
    good = len(page.graph.junctions) and unowned(page) < MOST_FALSE
    return page if good else None


def graph_of(maps: LineMaps, scan: Scan, settings: Settings) -> PlanarGraph:
    """The graph as the engine first routes it; an ideal page has no ink to measure, nor dust."""
    cut = ROUTED if scan.ink.any() else MEASURED
    return run_passes(Evidence.of(scan, maps), settings, until=cut)


def on_canvas(strokes: list[Array]) -> list[Array]:
    """Strokes moved to positive coordinates; those that leave the largest page are dropped."""
    low = np.min([line.min(0) for line in strokes], 0) if strokes else np.zeros(2)
    moved = [line - low + _MARGIN for line in strokes]
    return [line for line in moved if line.max() < _LARGEST]


def _size(strokes: list[Array]) -> tuple[int, int]:
    """Height and width, px, of a page that holds the strokes."""
    size = np.max([line.max(0) for line in strokes], 0) if strokes else np.zeros(2)
    width, height = np.ceil(size + _MARGIN).astype(int)
    return max(int(height), MIN_SIDE), max(int(width), MIN_SIDE)


def _draw(image: Array, line: Array, thickness: int, level: int, scale: int = 1) -> None:
    # OpenCV's pixel centres are whole numbers, ours lie at one half.
    fixed = np.round((line * scale - 0.5) * 256).astype(np.int32)
    cv2.polylines(image, [fixed], False, level, thickness, cv2.LINE_AA, 8)


def look_ideal(
    rng: np.random.Generator, strokes: list[Array], settings: Settings
) -> tuple[LineMaps, Scan]:
    """A perfect centerline, a thin white line, sometimes softened; the scan has no ink."""
    image = np.zeros(_size(strokes), np.uint8)
    for line in strokes:
        _draw(image, line, 1, 255)
    maps = image.astype(np.float32) / 255
    if rng.random() < 0.7:
        maps = np.minimum(1, 2.2 * cv2.GaussianBlur(maps, (0, 0), rng.uniform(0.6, 1.0)))
    height, width = maps.shape
    return LineMaps(maps), Scan(np.zeros_like(maps), None, 1.0, (width, height), 2.0)


def look_ink(
    rng: np.random.Generator, strokes: list[Array], settings: Settings
) -> tuple[LineMaps, Scan]:
    """Even pen strokes on white paper, through the centerline provider that ships."""
    size = _size(strokes)
    pen = rng.uniform(2.0, 5.5)
    ink: Array = np.zeros((2 * size[0], 2 * size[1]), np.uint8)
    for line in strokes:
        wide = max(1, round(2 * pen * np.exp(rng.normal(0, 0.12))))
        _draw(ink, line, wide, int(rng.integers(190, 256)), 2)
    ink = cv2.resize(ink, size[::-1], interpolation=cv2.INTER_AREA).astype(np.float32) / 255
    ink = cv2.GaussianBlur(ink, (0, 0), rng.uniform(0.4, 1.0))
    grain = cv2.GaussianBlur(rng.normal(0, 1, ink.shape).astype(np.float32), (0, 0), 0.8)
    ink = ink * (1 + rng.uniform(0, 0.5) * grain) + rng.uniform(0, 0.06) * grain
    ink = np.clip(ink, 0, 1).astype(np.float32)
    return _centerline(Scan(ink, None, 1.0, size[::-1], pen), settings)


def look_scan(
    rng: np.random.Generator, strokes: list[Array], settings: Settings
) -> tuple[LineMaps, Scan]:
    """A page as hands draw and scanners see it, read and traced as any user's page."""
    height, width = _size(strokes)
    side = max(height, width)
    medium = MEDIA[str(rng.choice(list(MEDIA)))]
    stamps = sample(strokes, side)
    pen = float(np.exp(rng.uniform(*np.log(medium.width))))
    pen = max(1.3, min(pen, _WIDEST, 0.7 * line_spacing(stamps, side)))
    ink = draw(rng, stamps, medium, pen, side)[0]
    gray = paper(rng, side, float(np.median(ink[ink > 0.1])) if (ink > 0.1).any() else 0.5)
    gray = gray * (1 - ink) + rng.uniform(0, 0.12) * ink
    if rng.random() < 0.5:
        gray = gray * shadow(rng, side)
    scanned = read_scan(scan(rng, gray)[:height, :width].clip(0, 1), settings)
    return _centerline(split_solids(scanned, settings)[0], settings)


def _centerline(scan: Scan, settings: Settings) -> tuple[LineMaps, Scan]:
    return provider_for(settings)(scan, lambda fraction: None), scan


def save(path: Path, pages: list[Page], tried: int = 0) -> None:
    """Write traced pages as one compressed file, and how many tries they took."""
    arrays: dict[str, Array] = {}
    for name in ("vertices", "points", "offsets", "ends"):
        arrays[name] = np.concatenate([getattr(page.graph, name) for page in pages])
    for name in ("widths", "strength"):
        arrays[name] = np.concatenate([_or_nan(page, name) for page in pages])
    for name in ("partner", "stroke"):
        arrays[name] = np.concatenate([getattr(page, name) for page in pages])
    sizes = [(len(p.graph.vertices), len(p.graph.points), p.graph.branch_count) for p in pages]
    np.savez_compressed(path, sizes=np.array(sizes), tried=np.array(tried), **arrays)


def _or_nan(page: Page, name: str) -> Array:
    values = getattr(page.graph, name)
    return np.full(len(page.graph.points), np.nan if values is None else values, np.float16)


def _with_tries(path: Path) -> tuple[list[Page], int]:
    with np.load(path) as data:
        return load(path), int(data["tried"])


def load(path: Path) -> list[Page]:
    """Read what `save` wrote."""
    data = dict(np.load(path))
    pages = []
    bounds = np.concatenate([np.zeros((1, 3), int), np.cumsum(data["sizes"], axis=0)])
    for number, ((v0, p0, b0), (v1, p1, b1)) in enumerate(pairwise(bounds)):
        given = {name: data[name][p0:p1].astype(np.float32) for name in ("widths", "strength")}
        graph = PlanarGraph(
            data["vertices"][v0:v1],
            data["points"][p0:p1],
            data["offsets"][b0 + number : b1 + number + 1],
            data["ends"][b0:b1],
            **{name: None if np.isnan(v).any() else v for name, v in given.items()},
        )
        partner, stroke = data["partner"][2 * b0 : 2 * b1], data["stroke"][p0:p1]
        pages.append(Page(graph, partner, stroke, traced=True))
    return pages


if __name__ == "__main__":
    main()
