"""Rough pages whose clean lines are known, traced as pencil strokes with our own stages.

Four kinds: sketches, every line of which is said by several strokes; keyframes as animators draw
them, dark and nearly single, with the pencil lifted at corners and lines that run on beyond them;
and clean pages, of which nothing is to be bundled, hatching and fur above all.
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
from involute.synthesis import pencilling
from involute.synthesis.composed_pages import Library
from involute.synthesis.figures import figure
from involute.synthesis.held_out_pages import endless
from involute.synthesis.media import MEDIA, draw, line_spacing, sample
from involute.synthesis.pencilling import Hand, angular, construction, in_pieces, keyed, pencilled
from involute.synthesis.sheet_of_paper import paper, scan, shadow

Array = np.ndarray

KINDS = (  # by number, in turn
    "sketch",
    "keyframe",
    "hatched",
    "keyframe",
    "sketch",
    "keyframe",
    "clean",
    "sketch",
)
EACH = (2, 4, 7)  # strokes a line of held-out sketches, in turn
_SIZE = (0.35, 0.8)  # of a page of the benchmark's size: smaller ones are traced sooner
_MARGIN, _LEAST = 24, 300  # px
_DENSEST = {"sketch": 8.0, "keyframe": 5.0, "clean": 0.0}  # px between the lines of a page
# Share of the pages whose lines hide each other, as in cartoons: most of what animators draw.
_FIGURES = {"sketch": 0.4, "keyframe": 0.75, "clean": 0.4}
_ANGULAR = 0.6  # share of the keyframes whose lines are straight from corner to corner
_LIFTED = 22.0  # degrees; corners of keyframes at which the pencil may be lifted
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
    lines = _lines(rng, library, kind)
    size = max(int(np.ceil(np.max([line.max(0) for line in lines]) + _MARGIN)), _LEAST)
    spacing = line_spacing(sample(lines, size), size)
    if spacing < _DENSEST[kind]:
        return None
    if kind == "keyframe" and rng.random() < _ANGULAR:
        lines = angular(lines, rng.uniform(1.0, 3.5))
    hand = None
    if kind != "clean":
        pen = float(np.exp(rng.uniform(np.log(1.2), np.log(3.3))))
        hand = _keyframing(rng, pen) if kind == "keyframe" else Hand.any(rng, pen, spacing)
        if each and kind == "sketch":
            hand = replace(hand, strokes=float(EACH[number % len(EACH)]))
        ink = _sketched(rng, lines, hand, pen, size, kind == "keyframe")
    else:
        ink = _drawn_once(rng, lines, spacing, size)
    spread, strokes = (hand.spread, hand.strokes) if hand else (0.0, 1.0)
    return _traced(_scanned(rng, ink), lines, spread, strokes)


def _lines(rng: np.random.Generator, library: Library, kind: str) -> list[Array]:
    """True lines of a kind of page, all of them at one scale: they meet where they met."""
    if rng.random() < _FIGURES[kind]:
        whole = [line + _MARGIN for line in figure(rng, library)]
    else:
        whole = next(endless(rng, library))
    scale = rng.uniform(*_SIZE)
    return [line.astype(np.float32) * np.float32(scale) for line in whole]


def hatched(rng: np.random.Generator) -> RoughPage:
    """Patches of parallel strokes beside single lines, as if they had been traced exactly."""
    pen = float(np.exp(rng.uniform(np.log(1.3), np.log(4.0))))
    lines: list[Array] = []
    for _ in range(rng.integers(1, 6)):
        lines += _patch(rng, pen) if rng.random() < 0.7 else _contours(rng, pen)
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


def _patch(rng: np.random.Generator, pen: float) -> list[Array]:
    """Hatching, or fur: strokes of about one length at about even distances."""
    apart = pen * rng.uniform(1.7, 5.0)
    count, length = int(rng.integers(4, 30)), float(np.exp(rng.uniform(np.log(15), np.log(220))))
    loose, turn = rng.uniform(0.02, 0.25), rng.uniform(0, np.pi)
    bend = rng.normal(0, 0.3)
    along = np.array([np.cos(turn), np.sin(turn)])
    across = np.array([-along[1], along[0]])
    middle = rng.uniform(0.2, 0.8, 2) * _HATCHED
    slant, fan = rng.normal(0, 0.3) * along, rng.normal(0, 0.02) * rng.random()
    strokes = []
    for k in range(count):
        half = 0.5 * length * (1 + loose * rng.normal())
        t = np.linspace(-1, 1, max(3, int(abs(half)) + 2))[:, None]
        tilt = fan * (k - count / 2) + 0.15 * loose * rng.normal()
        start = middle + apart * (k - count / 2 + loose * rng.normal()) * (across + slant)
        start = start + loose * length * 0.3 * rng.normal() * along
        strokes.append(start + half * (t * (along + tilt * across) + bend * t * t * across))
    return strokes


def _contours(rng: np.random.Generator, pen: float) -> list[Array]:
    """Two or three lines that run beside each other for long: a belt, a seam, a rope."""
    turn, radius = rng.uniform(0, 2 * np.pi), rng.uniform(60, 400)
    span = min(rng.uniform(60, 350) / radius, 4.0)
    center = rng.uniform(0.2, 0.8, 2) * _HATCHED - radius * np.array([np.cos(turn), np.sin(turn)])
    angle = np.linspace(turn - span / 2, turn + span / 2, max(4, int(span * radius / 2)))
    way = np.stack([np.cos(angle), np.sin(angle)], 1)
    apart = pen * rng.uniform(2.2, 6)
    return [
        center + (radius + apart * (k + rng.normal(0, 0.03))) * way
        for k in range(int(rng.integers(2, 4)))
    ]


def _keyframing(rng: np.random.Generator, pen: float) -> Hand:
    """The hand of an animator: sure, nearly single strokes that run on beyond their ends."""
    spread = pen * rng.uniform(0.15, 1.2)
    length = float(np.exp(rng.uniform(np.log(50), np.log(300))))
    return Hand(
        rng.uniform(1, 2.2), spread, spread * rng.uniform(0.2, 1), length, pen * rng.uniform(1, 5)
    )


def _sketched(
    rng: np.random.Generator, lines: list[Array], hand: Hand, pen: float, size: int, sure: bool
) -> Array:
    medium = MEDIA[str(rng.choice(pencilling.MEDIA))]
    if sure:
        pencil, press = keyed(rng, in_pieces(rng, lines, rng.uniform(0.3, 1), _LIFTED), hand)
    else:
        pencil, press = pencilled(rng, lines, hand)
    ink: Array = np.zeros((size, size), np.float32)
    light = construction(rng, size) if rng.random() < (0.3 if sure else 0.6) else []
    if light:
        ink = draw(rng, sample(light, size), medium, pen, size)[0] * rng.uniform(0.2, 0.6)
    dark = rng.random() < (0.7 if sure else 0.3)  # lines of a drawing program: all as dark
    for low, high in ((0, 0.5), (0.5, 0.75), (0.75, 2)):
        chosen = [s for s, p in zip(pencil, press, strict=True) if low <= p < high]
        if chosen:
            layer = draw(rng, sample(chosen, size), medium, pen, size)[0]
            ink = 1 - (1 - ink) * (1 - layer * (rng.uniform(0.8, 1) if dark else min(high, 1.0)))
    return ink


def _drawn_once(rng: np.random.Generator, lines: list[Array], spacing: float, size: int) -> Array:
    medium = MEDIA[str(rng.choice(_CLEAN))]
    pen = max(1.2, min(float(rng.uniform(1.6, 4.5)), 0.8 * spacing))
    return draw(rng, sample(lines, size), medium, pen, size)[0]


def _scanned(rng: np.random.Generator, ink: Array) -> Array:
    """(H, W) uint8: the ink on a sheet, scanned."""
    gray = 1 - ink * rng.uniform(0.9, 1)
    if rng.random() < 0.6:
        dark = ink[ink > 0.1]
        gray = gray * paper(rng, len(ink), float(np.median(dark)) if len(dark) else 0.5)
        if rng.random() < 0.4:
            gray = gray * shadow(rng, len(ink))
        gray = scan(rng, gray)
    return np.round(np.clip(gray, 0, 1) * 255).astype(np.uint8)


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
