"""Rough pages whose clean lines are known, traced as pencil strokes with our own stages.

Sketches, every line of which is said by several strokes; keyframes as animators draw them, dark and
nearly single, with the pencil lifted at corners and lines that run on beyond them, whole figures
most of all, and parts of larger pages; and clean pages, of which nothing is to be bundled, hatching
and fur above all.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from pathlib import Path

import cv2
import numpy as np
from involute.engine.centerline import provider_for
from involute.engine.centerline.mending import mended
from involute.engine.fills.solids import split_solids
from involute.engine.graph import Evidence, run_passes
from involute.engine.graph.passes import ROUTED
from involute.engine.routing import route
from involute.engine.scan import read_scan
from involute.engine.settings import Settings
from involute.engine.values import PlanarGraph
from involute.synthesis.composed_pages import Library
from involute.synthesis.line_art import pieces, resample
from involute.synthesis.media import MEDIA, draw, line_spacing, sample
from involute.synthesis.pencilling import Hand
from involute.synthesis.rough_drawings import (
    MARGIN,
    RoughDrawing,
    animated,
    any_pen,
    contours,
    is_too_dense,
    keyframing,
    meant_lines,
    patch,
    rough_drawing,
    sketched,
    straightened,
)
from involute.synthesis.sheet_of_paper import paper, scan, shadow

Array = np.ndarray

KINDS = (  # by number, in turn
    "sketch",
    "animated",
    "hatched",
    "animated",
    "keyframe",
    "animated",
    "clean",
    "part",
)
EACH = (2, 4, 7)  # strokes a line of held-out sketches, in turn
_LEAST = 300  # px
_PART = 576  # px; side of a part of a large page
_BARE = 0.6  # share of the figures that a drawing program made: on no paper
_HATCHED = 420  # px; side of a page of hatching
_CLEAN = ("technical pen", "ink", "pencil", "soft pencil", "marker", "ballpoint", "fineliner")


@dataclass(frozen=True, eq=False)
class RoughPage:
    """One traced page, in working pixels.

    lines: the true lines, (N, 2) each. ink: (H, W) uint8. graph, partner: the pencil strokes.
    spread: how far they stray from the lines, px. each: strokes a line.
    """

    lines: list[Array]
    ink: Array
    graph: PlanarGraph
    partner: Array
    spread: float
    each: float

    def save(self, path: Path) -> None:
        """Write the page as one compressed file."""
        graph = {f.name: getattr(self.graph, f.name) for f in fields(PlanarGraph)}
        np.savez_compressed(
            path,
            lines=np.concatenate(self.lines),
            sizes=np.array([len(line) for line in self.lines]),
            ink=self.ink,
            partner=self.partner,
            about=np.array([self.spread, self.each]),
            **{f"graph_{name}": values for name, values in graph.items() if values is not None},
        )

    @staticmethod
    def load(path: Path) -> RoughPage:
        """Read what `save` wrote."""
        with np.load(path) as file:
            graph = {n[6:]: file[n] for n in file.files if n.startswith("graph_")}
            lines = np.split(file["lines"], np.cumsum(file["sizes"])[:-1])
            spread, each = file["about"].tolist()
            return RoughPage(
                lines, file["ink"], PlanarGraph(**graph), file["partner"], spread, each
            )


def gathered(
    folder: Path,
    pages: int,
    make: Callable[[np.random.Generator, int], RoughPage | None],
    seed: int = 1,
) -> list[RoughPage]:
    """So many pages from a folder, as far as it goes, and made: by their numbers."""
    folder.mkdir(parents=True, exist_ok=True)
    cv2.setNumThreads(1)
    for number in range(pages):
        path = folder / f"{number:05d}.npz"
        if path.exists() or path.with_suffix(".none").exists():
            continue
        page = make(np.random.default_rng((seed, number)), number)
        if page is None:
            path.with_suffix(".none").touch()
        else:
            page.save(path)
            print(f"page {number}: {page.graph.branch_count} branches", flush=True)
    return [RoughPage.load(path) for path in sorted(folder.glob("*.npz"))]


def rough_page(
    rng: np.random.Generator, library: Library, number: int, *, each: bool = False
) -> RoughPage | None:
    """One random page; None when its lines are too dense, or nothing was traced.

    Args:
        each: sketches with 2, 4 and 7 strokes a line in turn, to judge by.
    """
    kind = KINDS[number % len(KINDS)]
    if kind == "hatched":
        return hatched(rng)
    if kind in ("animated", "part"):
        drawing = animated(rng, library) if kind == "animated" else _part(rng, library)
        bare = kind == "animated" and rng.random() < _BARE
        image = _gray(1 - drawing.ink) if bare else on_sheet(rng, drawing.ink)
        return _traced(image, drawing.lines, drawing.spread, 2.0)
    lines = meant_lines(rng, library, kind)
    size = max(int(np.ceil(np.max([line.max(0) for line in lines]) + MARGIN)), _LEAST)
    if is_too_dense(lines, kind, size):
        return None
    spacing = line_spacing(sample(lines, size), size)
    if kind == "keyframe":
        lines = straightened(rng, lines)
    hand = None
    if kind != "clean":
        pen = any_pen(rng)
        hand = keyframing(rng, pen) if kind == "keyframe" else Hand.any(rng, pen, spacing)
        if each and kind == "sketch":
            hand = replace(hand, strokes=float(EACH[number % len(EACH)]))
        ink = sketched(rng, lines, hand, pen, size, kind == "keyframe")
    else:
        ink = _drawn_once(rng, lines, spacing, size)
    spread, strokes = (hand.spread, hand.strokes) if hand else (0.0, 1.0)
    return _traced(on_sheet(rng, ink), lines, spread, strokes)


def _part(rng: np.random.Generator, library: Library) -> RoughDrawing:
    """A part of a large keyframe or sketch, the lines of which end at its rim."""
    kind = ("keyframe", "sketch")[int(rng.integers(2))]
    drawing = rough_drawing(rng, library, kind, _PART)
    dense = [resample(line.astype(np.float32), 2.0) for line in drawing.lines]
    inside = [((line > 0) & (line < _PART)).all(1) for line in dense]
    runs = [run for line, kept in zip(dense, inside, strict=True) for run in pieces(line, kept)]
    return replace(drawing, lines=[run for run in runs if len(run) > 3])


def hatched(rng: np.random.Generator) -> RoughPage:
    """Patches of parallel strokes beside single lines, as if they had been traced exactly."""
    pen = float(np.exp(rng.uniform(np.log(1.3), np.log(4.0))))
    lines: list[Array] = []
    for _ in range(rng.integers(1, 6)):
        near = patch if rng.random() < 0.7 else contours
        lines += near(rng, pen, _HATCHED)
    lines = [line for line in lines if line.min() > 4 and line.max() < _HATCHED - 4] or [
        np.array([[20.0, 20.0], [80.0, 30.0]])
    ]
    offsets = np.cumsum([0] + [len(line) for line in lines])
    strength = [np.full(len(line), rng.uniform(0.5, 1.0)) for line in lines]
    widths = [np.full(len(line), pen * rng.uniform(0.85, 1.2)) for line in lines]
    vertices = np.concatenate([line[[0, -1]] for line in lines])
    graph = PlanarGraph(
        vertices.astype(np.float32),
        np.concatenate(lines).astype(np.float32),
        offsets.astype(np.int32),
        np.arange(2 * len(lines), dtype=np.int32).reshape(-1, 2),
        np.concatenate(widths).astype(np.float32),
        np.concatenate(strength).astype(np.float32),
    )
    ink = np.zeros((_HATCHED, _HATCHED), np.uint8)
    for line, dark in zip(lines, strength, strict=True):
        fixed = np.round((line - 0.5) * 256).astype(np.int32)
        wide = max(1, round(pen))
        cv2.polylines(ink, [fixed], False, int(255 * dark[0]), wide, cv2.LINE_AA, 8)
    ink = cv2.GaussianBlur(ink, (0, 0), rng.uniform(0.4, 1.0))
    partner = np.arange(2 * len(lines), dtype=np.int32)
    return RoughPage(lines, ink, graph, partner, 0.0, 1.0)


def _drawn_once(rng: np.random.Generator, lines: list[Array], spacing: float, size: int) -> Array:
    medium = MEDIA[str(rng.choice(_CLEAN))]
    pen = max(1.2, min(float(rng.uniform(1.6, 4.5)), 0.8 * spacing))
    return draw(rng, sample(lines, size), medium, pen, size)[0]


def on_sheet(rng: np.random.Generator, ink: Array) -> Array:
    """(H, W) uint8: the ink on a sheet, scanned."""
    gray = 1 - ink * rng.uniform(0.9, 1)
    if rng.random() < 0.6:
        dark = ink[ink > 0.1]
        gray = gray * paper(rng, len(ink), float(np.median(dark)) if len(dark) else 0.5)
        if rng.random() < 0.4:
            gray = gray * shadow(rng, len(ink))
        gray = scan(rng, gray)
    return _gray(gray)


def _gray(page: Array) -> Array:
    """(H, W) uint8 of a page in [0, 1]."""
    return np.round(np.clip(page, 0, 1) * 255).astype(np.uint8)


def _traced(image: Array, lines: list[Array], spread: float, each: float) -> RoughPage | None:
    settings = Settings(drawing="clean")
    scanned = read_scan(image, settings)
    inked = split_solids(scanned, settings)[0]
    maps = mended(provider_for(settings)(inked, lambda fraction: None), inked, None)
    graph = run_passes(Evidence.of(inked, maps), settings, until=ROUTED)
    if graph.branch_count == 0:
        return None
    partner = route(graph, settings).partner
    ink = np.round(np.clip(scanned.ink, 0, 1) * 255).astype(np.uint8)
    scale = scanned.scale
    return RoughPage([line / scale for line in lines], ink, graph, partner, spread / scale, each)
