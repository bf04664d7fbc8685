"""One synthetic page: ink as the network gets it, and its targets.

A page is a list of layers, each drawn with one pen; what kind of page it is decides the pens, the
sheet and what lies on it beside the drawing. All that is ink has a target, printed rules too;
screentone, folds, stains, smudges and what shows through from the back have none.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import cv2
import numpy as np
from involute.engine.scan.paper import flatten_paper

from ...synthesis import pencilling
from ...synthesis.composed_pages import with_ends
from ...synthesis.extra_marks import mark, printed
from ...synthesis.line_art import Array, Library, Rng, Strokes, broken, invented, true_drawing
from ...synthesis.media import (
    DIGITAL,
    MEDIA,
    NUDGE,
    Medium,
    Samples,
    draw,
    line_spacing,
    noise,
    sample,
)
from ...synthesis.pen_lifts import Habit, lifted
from ...synthesis.sheet_of_paper import clean, paper, scan, shadow
from ...synthesis.tone_dots import screentone
from ...synthesis.wear import dust
from .pen_ends import lit_ends
from .targets import MAX_HALF_WIDTH, Targets, ridge, targets

_MIN_SPACING = 2.7  # px; denser hatching is a tone, not lines
_SEEN_OVER = 49  # samples of half a px
_HIDDEN_OVER = 121  # samples; what lies under a wide pen for longer can't be followed
_GONE = 0.3  # share of a stroke that must be seen for any of it to count
# Channels of a page, uint8: 255 * map; half-width and apart are 255 * px / MAX_HALF_WIDTH.
CHANNELS = ("ink", "centerline", "junctions", "endpoints", "half_width", "solid")
CHANNELS += ("doubled", "apart", "clean", "lifted")
# Kinds of pages and how often they are drawn.
KINDS = {"paper": 0.65, "digital": 0.2, "rough": 0.05, "many pens": 0.08, "brush": 0.02}
_LIFTING = 0.4  # share of the pages on paper or screen whose artist lifts the pen at corners
_STEADY = (1.5, 6.0)  # px of pen by which ends move; a hand with a broad pen is no clumsier
_WEAK = ("charcoal", "soft pencil", "charcoal", "pencil")  # media that need more practice


@dataclass(frozen=True, eq=False)
class Layer:
    """What one pen drew. ink: (size, size); half: (N,) px for each sample; means: the lines that
    the strokes stand for, when they are not these themselves (none: nothing); strays: px that the
    ink may lie off the samples."""

    samples: Samples
    half: Array
    ink: Array
    means: Samples | None = None
    is_rough: bool = False
    strays: float = 0.0


def page(
    rng: Rng,
    library: Library,
    size: int,
    held_out: bool = False,
    only: str | None = None,
    kind: str | None = None,
) -> Array:
    """A page as (10, size, size) uint8, channels as in CHANNELS.

    The same generator state gives the same page; held_out picks from the validation drawings,
    only names the one medium to draw with, kind one of KINDS.
    """
    if kind is None:
        kind = "paper" if only else str(rng.choice(list(KINDS), p=list(KINDS.values())))
    layers = _LAYERS[kind](rng, library, size, held_out, only)
    return looked_at(rng, layers, library, size, held_out, kind == "digital")


def looked_at(
    rng: Rng, layers: list[Layer], library: Library, size: int, held_out: bool, digital: bool
) -> Array:
    """The page of some layers as (10, size, size) uint8: on a sheet, scanned and cleaned, or as a
    drawing program hands it on."""
    solid = _solids(rng, size) if rng.random() < 0.15 else np.zeros((size, size), np.float32)
    ink = _together([layer.ink for layer in layers], size)
    ink = 1 - (1 - ink) * (1 - solid * (1.0 if digital else rng.uniform(0.85, 1.0)))
    if rng.random() < 0.1:
        ink = np.maximum(ink, screentone(rng, size, digital))
    if digital:
        cleaned = _digital(rng, ink)
    else:
        gray = _photograph(rng, ink, library, size, held_out)
        cleaned = flatten_paper(gray) if rng.random() < 0.6 else clean(rng, gray)
    maps, means, ends = _targets(layers, cleaned)
    return _pack(cleaned, maps, means, ends, (solid < 0.5).astype(np.float32), solid)


def _on_paper(
    rng: Rng, library: Library, size: int, held_out: bool, only: str | None
) -> list[Layer]:
    """Drawings in one medium or a few, some of them on ruled sheets."""
    layers = [_printed(rng, size)] if rng.random() < 0.16 else []
    hand = _habit(rng)
    medium = _medium(rng, only)
    pen = _pen(rng, medium)
    faint = rng.uniform(0.12, 0.5) if rng.random() < 0.12 else 1.0
    for strokes, widest in _compose(rng, library, size, held_out):
        if rng.random() < 0.25:
            medium = _medium(rng, only)
            pen = _pen(rng, medium)
        own = faint if rng.random() < 0.85 else rng.uniform(0.2, 0.9)
        layers.append(_drawn(rng, strokes, medium, pen, widest, size, own, hand))
    return [layer for layer in layers if layer]


def _digital_lines(
    rng: Rng, library: Library, size: int, held_out: bool, only: str | None
) -> list[Layer]:
    """Clean lines of a drawing program: one bit or crisp, pens of 1 px and more."""
    medium = DIGITAL[str(rng.choice(list(DIGITAL)))]
    pen = _pen(rng, medium)
    if rng.random() < 0.5:
        pen = max(1.0, round(pen))
    hand, layers = _habit(rng), []
    for strokes, widest in _compose(rng, library, size, held_out, marks=0.4):
        if rng.random() < 0.2:
            pen = _pen(rng, medium)
        layers.append(_drawn(rng, strokes, medium, pen, widest, size, hand=hand))
    return [layer for layer in layers if layer]


def _rough_lines(
    rng: Rng, library: Library, size: int, held_out: bool, only: str | None
) -> list[Layer]:
    """A sketch: every line said by several strokes, over construction lines."""
    medium = MEDIA[only or str(rng.choice(pencilling.MEDIA))]
    pen = float(np.clip(_pen(rng, medium), 1.0, 5.0))
    layers = []
    lines = _sane(pencilling.construction(rng, size), size)
    if rng.random() < 0.5:
        light = _drawn(rng, lines, medium, pen, 4.0, size, rng.uniform(0.2, 0.6))
        layers += [Layer(light.samples, light.half, light.ink, None, True)] if light else []
    for _ in range(rng.choice([1, 2, 3])):
        lines, _ = true_drawing(rng, library, size, held_out, (0.6, 3.0))
        lines = _sane(lines, size) if lines else []
        true = sample(lines, size) if lines else ()
        spacing = line_spacing(true, size) if len(true) > 1 else 0.0
        if spacing < 9:
            continue
        hand = pencilling.Hand.any(rng, pen, spacing)
        strokes, press = pencilling.pencilled(rng, lines, hand)
        layers += _pressed(rng, strokes, press, medium, pen, true, size)
    return layers


def _pressed(
    rng: Rng,
    strokes: Strokes,
    press: Array,
    medium: Medium,
    pen: float,
    true: Samples,
    size: int,
) -> list[Layer]:
    """Pencil strokes in three layers, from light to dark; the first stands for the true lines."""
    layers = []
    for low, high in ((0, 0.5), (0.5, 0.75), (0.75, 2)):
        chosen = [s for s, p in zip(strokes, press, strict=True) if low <= p < high]
        samples = sample(chosen, size) if chosen else ()
        if len(samples) < 2:
            continue
        ink, half = draw(rng, samples, medium, pen * rng.uniform(0.8, 1.1), size)
        strength = min(high, 1.0) * rng.uniform(0.8, 1.0)
        layers.append(Layer(samples, half, ink * strength, None if layers else true, True))
    return layers


def _many_pens(
    rng: Rng, library: Library, size: int, held_out: bool, only: str | None
) -> list[Layer]:
    """Every drawing with a pen of its own, 1.5 to 34 px wide."""
    hand, layers = _habit(rng), []
    drawings = _compose(rng, library, size, held_out)
    for strokes, widest in drawings + _compose(rng, library, size, held_out)[:1]:
        pen = float(np.exp(rng.uniform(np.log(1.5), np.log(34))))
        wide = ("marker", "technical pen", "brush", "soft pencil", "crisp")
        medium = (MEDIA | DIGITAL)[str(rng.choice(wide))] if pen > 8 else _medium(rng, only)
        layers.append(_drawn(rng, strokes, medium, pen, 2 * widest, size, hand=hand))
    return [layer for layer in layers if layer]


def _brush(rng: Rng, library: Library, size: int, held_out: bool, only: str | None) -> list[Layer]:
    """One or two lines of a brush 20 to 60 px wide."""
    layers = []
    for _ in range(rng.integers(1, 3)):
        strokes, _ = invented(rng, size) if rng.random() < 0.4 else mark(rng, size)
        if len(strokes) > 6:
            strokes = strokes[:1]
        medium = MEDIA[str(rng.choice(("marker", "brush", "technical pen", "soft pencil")))]
        layers.append(_drawn(rng, strokes, medium, rng.uniform(20, 60), 60.0, size))
    return [layer for layer in layers if layer]


_LAYERS = {
    "paper": _on_paper,
    "digital": _digital_lines,
    "rough": _rough_lines,
    "many pens": _many_pens,
    "brush": _brush,
}


def _printed(rng: Rng, size: int) -> Layer | None:
    """Rules or a grid, thin and paler than most drawings."""
    strokes, widest = printed(rng, size)
    pen, strength = rng.uniform(0.8, 2.2), rng.uniform(0.1, 0.7)
    return _drawn(rng, strokes, DIGITAL["crisp"], pen, widest, size, strength)


def _drawn(
    rng: Rng,
    strokes: Strokes,
    medium: Medium,
    pen: float,
    widest: float,
    size: int,
    strength: float = 1.0,
    hand: Habit | None = None,
) -> Layer | None:
    """Strokes with a pen that suits them, some of them dashed; None where nothing can be seen.

    hand: how their artist lifts the pen, in pen widths.
    """
    strokes = [stroke + NUDGE for stroke in _sane(strokes, size)]
    samples = sample(strokes, size)
    spacing = line_spacing(samples, size)
    if len(samples) < 2 or spacing < _MIN_SPACING:
        return None
    if rng.random() < 0.9:
        widest = min(widest, 0.8 * spacing)
    width = max(0.9, min(pen * rng.uniform(0.9, 1.1), widest))
    if hand:
        strokes = _by_hand(rng, strokes, hand, width)
        samples = sample(strokes, size)
    if medium.grain[1] <= 0.3 and rng.random() < 0.15:
        samples = sample(broken(rng, strokes, width + 1.5) or strokes, size)
        if len(samples) < 2:
            return None
    ink, half = draw(rng, samples, medium, width, size)
    return Layer(samples, half, ink * strength)


def _habit(rng: Rng) -> Habit | None:
    """How the artist of a page lifts the pen, lengths in pen widths; None = as the drawings do."""
    if rng.random() >= _LIFTING:
        return None
    return Habit.drawn(rng, 1.0, str(rng.choice(["lifting", "mixed"], p=[0.6, 0.4])))


def _by_hand(rng: Rng, strokes: Strokes, hand: Habit, width: float) -> Strokes:
    """Strokes cut where a hand lifts its pen of `width` px, ends moved; half of all such hands
    miss the lines that other strokes end on, too."""
    pen = float(np.clip(width, *_STEADY))
    hand = replace(hand, along=pen * hand.along, across=pen * hand.across, over=pen * hand.over)
    if hand.exact < 0.5:
        strokes = [
            with_ends(line, *rng.normal(0.5 * hand.over, 0.5 * hand.along, 2)) for line in strokes
        ]
    return [line.astype(np.float32) for line in lifted(rng, strokes, hand)]


def _compose(
    rng: Rng, library: Library, size: int, held_out: bool, marks: float = 0.1
) -> list[tuple[Strokes, float]]:
    """Up to four drawings, true ones and invented ones, over each other; marks: how likely
    those of `extra_marks` are among the invented."""
    kind = rng.random()
    if kind < 0.06:
        return []
    if kind < 0.12:  # a nearly blank sheet
        strokes, widest = true_drawing(rng, library, size, held_out, (0.1, 0.5))
        return [(strokes, widest)] if strokes else []
    drawings = []
    for _ in range(rng.choice([1, 2, 2, 3, 4])):
        if rng.random() < marks:
            drawings.append(mark(rng, size))
        elif rng.random() < 0.7:
            drawings.append(true_drawing(rng, library, size, held_out))
        else:
            drawings.append(invented(rng, size))
    return [(strokes, widest) for strokes, widest in drawings if strokes]


def _sane(strokes: Strokes, size: int) -> Strokes:
    """Strokes that come near the page at all; at most 3000 of them."""
    near = [
        s for s in strokes if len(s) > 1 and (s.max(0) > -40).all() and (s.min(0) < size + 40).all()
    ]
    return near[:3000] or [np.full((2, 2), -1e4, np.float32)]


def _medium(rng: Rng, only: str | None) -> Medium:
    weak = not only and rng.random() < 0.25
    return MEDIA[only or str(rng.choice(_WEAK if weak else list(MEDIA)))]


def _pen(rng: Rng, medium: Medium) -> float:
    """Full width, px: the medium's own range; fine pens are often 1 to 2 px."""
    low, high = medium.width
    if low < 1.6 and rng.random() < 0.55:
        low, high = 0.9, 2.0
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def _together(inks: list[Array], size: int) -> Array:
    """Layers of ink over each other."""
    paper_left = np.ones((size, size), np.float32)
    for ink in inks:
        paper_left *= 1 - ink
    return 1 - paper_left


def _targets(layers: list[Layer], ink: Array) -> tuple[Targets, Array, Array]:
    """The maps of all strokes that can be seen in the ink, the ridge of what they mean, and the
    ends of that; a sketch has those of its true lines."""
    size = len(ink)
    seen = [_seen(layer, layers, ink) for layer in layers]
    kept = [(la, s) for la, s in zip(layers, seen, strict=True) if np.count_nonzero(s) > 1]
    if not kept:
        return Targets.blank(size), *np.zeros((2, size, size), np.float32)
    merged = Samples.merge([layer.samples.take(s) for layer, s in kept])
    half = np.concatenate([layer.half[s] for layer, s in kept])
    maps = targets(merged, half, size)
    if not any(layer.is_rough for layer in layers):
        strays = max(layer.strays for layer in layers)
        return maps, maps.centerline, lit_ends(merged, half, size, _inked(ink, strays))
    meant = [la.means for la in layers if la.is_rough and la.means is not None]
    meant += [layer.samples.take(s) for layer, s in kept if not layer.is_rough]
    if not meant:
        return maps, *np.zeros((2, size, size), np.float32)
    true = Samples.merge(meant)
    return maps, ridge(true, size), lit_ends(true, np.zeros(len(true)), size)


def _seen(layer: Layer, layers: list[Layer], ink: Array) -> Array:
    """Which samples of a layer can be seen, (N,); of strokes that are gone, none: rules taken out
    of the page would still show where they cross the drawing."""
    seen = _visible(layer.samples.position, ink, layer.strays) & ~_hidden(layer, layers)
    position, stroke = layer.samples.position, layer.samples.stroke
    on_page = ((position >= 0) & (position < len(ink))).all(1)
    shown = np.bincount(stroke, seen & on_page)
    gone = shown < _GONE * np.bincount(stroke, on_page)
    return seen & ~gone[stroke]


def _visible(points: Array, ink: Array, strays: float = 0.0) -> Array:
    """Which of (N, 2) samples along strokes show: most of the 24 px along them is inked, or lies so
    many px off what is.

    Nobody can trace what the paper's grain has swallowed. Points off the page count as well.
    """
    inked = _inked(ink, strays)
    near = _over(_at(inked, points), _SEEN_OVER)
    # On grainy paper a stroke must do better than the grain.
    return near > max(0.42, min(0.9, 0.3 + inked.mean()))


def _inked(ink: Array, strays: float = 0.0) -> Array:
    """Where a line's ink can be seen, a px from its centre at most, or so much more."""
    return cv2.dilate(ink, np.ones((3 + 2 * round(strays),) * 2, np.uint8)) > 0.035


def _hidden(layer: Layer, layers: list[Layer]) -> Array:
    """Which samples of a layer lie for 60 px and more inside the ink of a much wider pen, (N,)."""
    hidden = np.zeros(len(layer.samples), bool)
    own = float(np.median(layer.half))
    for other in layers:
        if other is not layer and float(np.median(other.half)) > max(4.0, 1.5 * own):
            inside = cv2.erode(other.ink, np.ones((3, 3), np.uint8)) > 0.7
            hidden |= _over(_at(inside, layer.samples.position), _HIDDEN_OVER) > 0.5
    return hidden


def _at(mask: Array, points: Array) -> Array:
    """The values of a map at (N, 2) px; points off the page get those at its edge."""
    cell = np.clip(points.astype(int), 0, len(mask) - 1)
    return mask[cell[:, 1], cell[:, 0]]


def _over(values: Array, count: int) -> Array:
    """The running mean of (N,) values over `count` neighbours."""
    around = np.pad(values.astype(np.float64), count // 2, mode="edge")
    return np.convolve(around, np.full(count, 1 / count), "valid")


def _solids(rng: Rng, size: int) -> Array:
    """Solid black areas: smooth or angular closed shapes at least 20 px across; (size, size)."""
    mask = np.zeros((size, size), np.uint8)
    for _ in range(rng.integers(1, 4)):
        count = int(rng.choice([3, 4, 5, 7, 40, 60]))
        turn = (
            np.sort(rng.uniform(0, 2 * np.pi, count))
            if count < 10
            else np.linspace(0, 2 * np.pi, count)
        )
        wave = 1.0
        if count >= 10:
            harmonics = np.arange(1, 5)[:, None]
            wave += (
                rng.normal(0, 0.22, (4, 1))
                / harmonics
                * np.sin(harmonics * turn + rng.uniform(0, 7, (4, 1)))
            ).sum(0)
        radius = rng.uniform(14, 0.28 * size) * wave
        shape = np.stack([np.cos(turn), np.sin(turn) * rng.uniform(0.4, 1)], 1) * np.reshape(
            radius, (-1, 1)
        )
        shape += rng.uniform(0, 1, 2) * size
        cv2.fillPoly(mask, [np.round(shape * 16).astype(np.int32)], 255, cv2.LINE_AA, 4)
    # Thin parts would be lines.
    core = cv2.morphologyEx(
        mask, cv2.MORPH_OPEN, cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (19, 19))
    )
    return core.astype(np.float32) / 255


def _digital(rng: Rng, ink: Array) -> Array:
    """A picture that never was on paper, as the scan stage hands it on."""
    gray = 1 - ink
    if rng.random() < 0.1:  # saved once as JPEG, or made smaller
        gray = scan(rng, gray)
    if rng.random() < 0.12:  # the same on a tinted ground
        gray = np.minimum(gray, 1.0) * rng.uniform(0.6, 1.0)
    return flatten_paper(gray) if rng.random() < 0.7 else (1 - gray / gray.max()).clip(0, 1)


def _photograph(rng: Rng, ink: Array, library: Library, size: int, held_out: bool) -> Array:
    """Ink on paper under a lamp, scanned: (size, size) float32 luminance."""
    drawn = ink[ink > 0.1]
    level = float(np.median(drawn)) if drawn.size > 50 else 0.5
    sheet = paper(rng, size, level, printed=0.0, worn=0.3)
    if ink.mean() > 0.004 and rng.random() < 0.06:  # on a blank sheet it would be the drawing
        sheet *= 1 - _show_through(rng, library, size, held_out) * level
    if rng.random() < 0.08:  # a smudge: ink rubbed along one direction
        length = int(rng.choice([9, 15, 25]))
        rubbed = cv2.blur(ink, (length, 3)) * np.clip(noise(rng, "cloud", size), 0, 1)
        sheet *= 1 - rng.uniform(0.05, 0.3) * rubbed
    if rng.random() < 0.06:  # eraser: a band in which a ghost of older lines stays
        ghost = np.roll(ink, rng.integers(20, size - 20, 2), (0, 1))
        sheet *= 1 - rng.uniform(0.01, 0.07) * cv2.GaussianBlur(ghost, (0, 0), 1.2)
    if rng.random() < 0.12:
        sheet *= 1 - dust(rng, ink)
    black = rng.uniform(0.0, 0.12)
    gray = sheet * (1 - ink) + black * ink
    if rng.random() < 0.5:
        gray *= shadow(rng, size)
    return scan(rng, gray)


def _show_through(rng: Rng, library: Library, size: int, held_out: bool) -> Array:
    """The drawing on the back of the sheet, blurred and faint."""
    strokes, widest = true_drawing(rng, library, size, held_out)
    samples = sample(_sane(strokes, size), size)
    if len(samples) < 2:
        return np.zeros((size, size), np.float32)
    back, _ = draw(rng, samples, MEDIA["marker"], min(5.0, widest), size)
    return cv2.GaussianBlur(back, (0, 0), rng.uniform(1.2, 3)) * rng.uniform(0.03, 0.16)


def _pack(ink: Array, maps: Targets, means: Array, ends: Array, keep: Array, solid: Array) -> Array:
    layers = [
        ink,
        maps.centerline * keep,
        maps.junctions * keep,
        maps.endpoints * keep,
        maps.half_width * keep / MAX_HALF_WIDTH,
        solid,
        maps.doubled * keep,
        maps.apart * keep / MAX_HALF_WIDTH,
        means * keep,
        ends * keep,
    ]
    return np.round(np.clip(np.stack(layers), 0, 1) * 255).astype(np.uint8)
