"""Graphs as our own centerline and graph stages really make them, matched back to the true strokes.

`python -m training run traced --data DIR --out FILE --pages N` draws pages of true strokes,
traces them and writes the graphs with their routing: after the rasterised set of "Stroke
Vectorization via Involution Prediction" (routing data), but from real drawings as well, by hands
that lift the pen. Started again with the same FILE, it goes on where it stopped.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from involute.engine.centerline import learned, provider_for
from involute.engine.centerline.mending import mended
from involute.engine.fills.solids import split_solids
from involute.engine.graph import Evidence, build_graph, traced
from involute.engine.routing import route
from involute.engine.scan.picture import MIN_SIDE
from involute.engine.scan.preparing import read_scan
from involute.engine.scan.wide_lines import find_wide_lines
from involute.engine.settings import Settings
from involute.engine.values import LineMaps, PlanarGraph, Scan
from involute.engine.wide_pens import look_again
from involute.synthesis.composed_pages import Library
from involute.synthesis.media import DIGITAL, MEDIA, Medium, Samples, draw, line_spacing, sample
from involute.synthesis.sheet_of_paper import paper, scan, shadow

from ..page_bank import PageBank
from .augment import Page
from .hand_drawn import MARGIN, hand_drawn
from .labels import labelled, unowned
from .page_file import save, with_tries

Array = np.ndarray

_LARGEST = 1000.0  # px; strokes that go beyond are left out, so that tracing stays quick
_WIDEST = 9.0  # px; wider pens are scanned at a lower resolution
_args: argparse.Namespace  # of a process that makes pages, and its
_library: Library
_SAVED = 250  # tries between two writings of the file
_KINDS = (0.08, 0.2, 0.72)  # shares of ideal, inked and scanned pages
_MIXED = 0.25  # share of the scanned pages that are drawn with two media
_DIGITAL = 0.1  # share that no pen drew: one bit, or crisp
_LEAN = 0.2  # share that the lean network looks at
MOST_FALSE = 0.3  # of the length of all branches: more than this that nobody drew is no drawing


def main(argv: Sequence[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True, help="folder of SOURCE.npz drawings")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--pages", type=int, default=1500, help="one in ten comes to nothing")
    parser.add_argument("--seconds", type=float, default=np.inf, help="stop after so many")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1, help="parallel processes")
    parser.add_argument("--provider", default="auto", help="centerline: network or classical")
    parser.add_argument("--held-out", action="store_true", help="from the validation drawings")
    args = parser.parse_args(argv)
    PageBank(args.out, with_tries, save, _SAVED).filled(
        args.pages, _numbered_page, args.jobs, _prepare, (args,), seconds=args.seconds
    )


def _prepare(args: argparse.Namespace) -> None:
    """What every page needs, once in each process."""
    global _args, _library
    cv2.setNumThreads(1)
    _args, _library = args, Library.load(args.data, args.held_out)


def _numbered_page(number: int) -> Page | None:
    rng = np.random.default_rng((_args.seed, number))
    # Many processes make pages: none of them asks for a GPU.
    return traced_page(rng, _library, Settings(provider=_args.provider, device="cpu"))


def traced_page(rng: np.random.Generator, library: Library, settings: Settings) -> Page | None:
    """One random page, traced from an ideal centerline, from clean ink or from a scanned page.

    None when nothing fits on the page, when there is no junction, or when the tracer saw so much
    that nobody drew that it is no example of routing.
    """
    strokes = hand_drawn(rng, library)
    if not strokes:
        return None
    if settings.provider == "auto" and rng.random() < _LEAN and learned.LEAN.exists():
        settings = replace(settings, provider="lean")
    look = (look_ideal, look_ink, look_scan)[int(rng.choice(3, p=_KINDS))]
    maps, scan = look(rng, strokes, settings)
    page = labelled(graph_of(maps, scan, settings), [line / scan.scale for line in strokes])
    good = len(page.graph.junctions) and unowned(page) < MOST_FALSE
    return page if good else None


def graph_of(maps: LineMaps, scan: Scan, settings: Settings) -> PlanarGraph:
    """The graph as the engine routes it last, but with its corners whole, as the network sees
    them; an ideal page has no ink to measure, and nothing to take away."""
    evidence = Evidence.of(scan, maps)
    if not scan.ink.any():
        return build_graph(evidence, settings)
    return traced(evidence, settings, route, without=("lifts",))[0]


def on_canvas(strokes: list[Array]) -> list[Array]:
    """Strokes moved to positive coordinates; those that leave the largest page are dropped."""
    low = np.min([line.min(0) for line in strokes], 0) if strokes else np.zeros(2)
    moved = [line - low + MARGIN for line in strokes]
    return [line for line in moved if line.max() < _LARGEST]


def _size(strokes: list[Array]) -> tuple[int, int]:
    """Height and width, px, of a page that holds the strokes."""
    size = np.max([line.max(0) for line in strokes], 0) if strokes else np.zeros(2)
    width, height = np.ceil(size + MARGIN).astype(int)
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
    return _seen(Scan(ink, None, 1.0, size[::-1], pen), settings)


def look_scan(
    rng: np.random.Generator, strokes: list[Array], settings: Settings
) -> tuple[LineMaps, Scan]:
    """A page as hands draw and scanners see it, read and traced as any user's page."""
    height, width = _size(strokes)
    side = max(height, width)
    stamps = sample(strokes, side)
    if rng.random() < _DIGITAL:
        gray = 1 - _inked(rng, stamps, DIGITAL, side)
    else:
        ink = _inked(rng, stamps, MEDIA, side)
        if rng.random() < _MIXED:
            ink = _two_inks(rng, stamps, ink, side)
        gray = paper(rng, side, float(np.median(ink[ink > 0.1])) if (ink > 0.1).any() else 0.5)
        gray = gray * (1 - ink) + rng.uniform(0, 0.12) * ink
        if rng.random() < 0.5:
            gray = gray * shadow(rng, side)
        gray = scan(rng, gray)
    return _seen(read_scan(gray[:height, :width].clip(0, 1), settings), settings)


def _inked(rng: np.random.Generator, stamps: Samples, media: dict[str, Medium], side: int) -> Array:
    """(side, side) ink of strokes that are drawn with any pen of some media."""
    medium = media[str(rng.choice(list(media)))]
    pen = float(np.exp(rng.uniform(*np.log(medium.width))))
    pen = max(1.3, min(pen, _WIDEST, 0.7 * line_spacing(stamps, side)))
    return draw(rng, stamps, medium, pen, side)[0]


def _two_inks(rng: np.random.Generator, stamps: Samples, ink: Array, side: int) -> Array:
    """A page whose strokes are drawn with another pen where a coin says so."""
    other = rng.random(int(stamps.stroke.max()) + 1) < rng.uniform(0.2, 0.6)
    own = other[stamps.stroke]
    if not own.any() or own.all():
        return ink
    parts = [_inked(rng, stamps.take(mask), MEDIA, side) for mask in (own, ~own)]
    return 1 - (1 - parts[0]) * (1 - parts[1])


def _seen(scan: Scan, settings: Settings) -> tuple[LineMaps, Scan]:
    """What the engine sees of a scan before it makes a graph, and the scan of lines alone."""
    wide = find_wide_lines(scan, settings)
    near = wide.near if wide.any else None
    lines = split_solids(scan, settings, near)[0]
    look = provider_for(settings)
    maps = look(lines, lambda fraction: None)
    if wide.any:
        maps = look_again(maps, lines, wide, look, settings)
    if maps.half_width is not None and settings.provider != "classical":
        maps = mended(maps, lines, near)
    return maps, lines


if __name__ == "__main__":
    main()
