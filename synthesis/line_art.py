"""Strokes for synthetic pages: true drawings at random scale and rotation, and invented ones.

A stroke is an (N, 2) float32 polyline in page pixels (x right, y down).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from involute.engine.arrays.ragged import count_up

from .library import DrawingSet, read_sets

Array = np.ndarray
Rng = np.random.Generator
Strokes = list[Array]

# How often each set of true drawings is picked: artistic ones and real pens first.
SET_WEIGHTS = {
    "quickdraw_raw": 3.0,
    "quickdraw_simplified": 0.7,
    "openmoji": 1.5,
    "streamline": 3.0,
    "openclipart": 4.0,
    "excalidraw": 1.5,
    "fishdraw": 0.3,
    "arcticons": 1.0,
    "icons_permissive": 0.7,
    "kanjivg": 1.5,
    "tangles": 1.0,
    "own": 6.0,  # of whoever trains: `own_drawings`
}


@dataclass(frozen=True, eq=False)
class Library:
    """The true drawings, by set."""

    sets: dict[str, DrawingSet]

    @staticmethod
    def load(folder: Path | str) -> Library:
        """Read the sets of SET_WEIGHTS that a folder holds.

        Raises:
            FileNotFoundError: the folder holds none of them.
        """
        return Library(read_sets(folder, SET_WEIGHTS))

    def pick(self, rng: Rng, held_out: bool) -> Strokes:
        """One drawing in a 0..1024 box, from the training or from the held-out part."""
        names = [name for name, drawn in self.sets.items() if len(drawn.part(held_out))]
        weight = np.array([SET_WEIGHTS[name] for name in names])
        drawn = self.sets[str(rng.choice(names, p=weight / weight.sum()))]
        return drawn.strokes(int(rng.choice(drawn.part(held_out))))


def transform(strokes: Strokes, matrix: Array, shift: Array) -> Strokes:
    """Every point p as matrix @ p + shift."""
    return [(s @ matrix.T + shift).astype(np.float32) for s in strokes]


def random_matrix(rng: Rng, scale: float) -> Array:
    """Rotation, flip, scale and a little shear."""
    turn = rng.uniform(0, 2 * np.pi) if rng.random() < 0.7 else rng.normal(0, 0.1)
    c, s = np.cos(turn), np.sin(turn)
    shear = np.array([[rng.uniform(0.8, 1.25), rng.normal(0, 0.15)], [0, 1]])
    flip = np.diag([rng.choice([-1.0, 1.0]), 1.0])
    return scale * np.array([[c, -s], [s, c]]) @ shear @ flip


def wobble(rng: Rng, strokes: Strokes, amount: float, length: float) -> Strokes:
    """Shift points by a smooth random field: a hand instead of a ruler, corners still meet."""
    phase = rng.uniform(0, 2 * np.pi, (2, 3))
    wave = rng.normal(0, 2 * np.pi / length, (2, 3, 2))
    out = []
    for s in strokes:
        field = np.sin(np.einsum("akd,nd->ank", wave, s) + phase[:, None]).sum(-1)
        out.append((s + amount * field.T).astype(np.float32))
    return out


def true_drawing(
    rng: Rng,
    library: Library,
    size: int,
    held_out: bool,
    extent: tuple[float, float] = (0.5, 4.0),
) -> tuple[Strokes, float]:
    """A true drawing placed on the page; also the widest pen that suits its scale, in px.

    extent: how large its box is, in pages.
    """
    box = size * float(np.exp(rng.uniform(*np.log(extent))))
    matrix = random_matrix(rng, box / 1024)
    strokes = [s for s in library.pick(rng, held_out) if len(s) > 1]
    if not strokes:
        return [], 8.0
    # A random point of the drawing comes to a random place of the page.
    anchor = strokes[rng.integers(len(strokes))]
    anchor = anchor[rng.integers(len(anchor))]
    placed = transform(strokes, matrix, rng.uniform(0.1, 0.9, 2) * size - matrix @ anchor)
    if rng.random() < 0.5:
        # Ruled edges become hand-drawn ones: wobble needs points to act on.
        dense = [resample(s, 4.0) if len(s) < 400 else s for s in placed]
        placed = wobble(rng, dense, rng.uniform(0.1, 0.9), rng.uniform(30, 150))
    return placed, 3.0 + 0.03 * box


def resample(stroke: Array, step: float) -> Array:
    """Insert points so that no segment is longer than step; corners stay."""
    length = np.hypot(*np.diff(stroke, axis=0).T)
    pieces = np.maximum(1, np.ceil(length / step)).astype(int)
    start = np.repeat(np.arange(len(length)), pieces)
    within = count_up(pieces)
    t = (within / pieces[start])[:, None]
    inner = stroke[start] * (1 - t) + stroke[start + 1] * t
    return np.concatenate([inner, stroke[-1:]]).astype(np.float32)


# Invented strokes: each returns strokes and the widest pen that keeps them apart.


def pieces(stroke: Array, kept: Array) -> Strokes:
    """The runs of (N, 2) points that are kept, by (N,) bool."""
    runs = np.split(stroke, np.flatnonzero(np.diff(kept)) + 1)
    return runs[0 if kept[0] else 1 :: 2]


def _bezier(p: Array, count: int = 48) -> Array:
    t = np.linspace(0, 1, count)[:, None]
    u = 1 - t
    curve = u**3 * p[0] + 3 * u * u * t * p[1] + 3 * u * t * t * p[2] + t**3 * p[3]
    return curve.astype(np.float32)


def _spline(rng: Rng, size: int, reach: float | None = None) -> Array:
    """A smooth curve through a few random points (Catmull-Rom)."""
    reach = reach or size * rng.uniform(0.15, 0.7)
    knots = np.cumsum(rng.normal(0, reach * 0.5, (rng.integers(4, 8), 2)), axis=0)
    knots += rng.uniform(0, size, 2) - knots[len(knots) // 2]
    pieces = []
    for a, b, c, d in zip(knots, knots[1:], knots[2:], knots[3:], strict=False):
        pieces.append(_bezier(np.array([b, b + (c - a) / 6, c - (d - b) / 6, c]))[:-1])
    return np.concatenate(pieces).astype(np.float32)


def splines(rng: Rng, size: int) -> tuple[Strokes, float]:
    return [_spline(rng, size) for _ in range(rng.integers(1, 7))], 16.0


def star(rng: Rng, size: int) -> tuple[Strokes, float]:
    """Rays and curves through one point: some pass, some end there (paper, "synthetic stars")."""
    count = int(rng.integers(2, 7))
    gaps = rng.dirichlet(np.ones(count)) * (np.pi - count * 0.2) + 0.2
    angles = np.cumsum(gaps) + rng.uniform(0, np.pi)
    center = rng.uniform(0.2, 0.8, 2) * size
    strokes = []
    for angle in angles:
        along = np.array([np.cos(angle), np.sin(angle)])
        across = np.array([-along[1], along[0]])
        t = np.linspace(-1, 1, 81)[:, None]
        bend = rng.normal(0, 0.3, 2) if rng.random() < 0.6 else np.zeros(2)
        reach = size * rng.uniform(0.3, 0.8)
        curve = center + reach * (t * along + (bend[0] * t**2 + bend[1] * t**3) * across)
        half = rng.random()
        keep = slice(None) if half < 0.5 else slice(40, None) if half < 0.75 else slice(None, 41)
        strokes.append(curve[keep].astype(np.float32))
    return strokes, 14.0


def parallels(rng: Rng, size: int, gap: float | None = None) -> tuple[Strokes, float]:
    """Curves side by side, 3 to 12 px apart; ends may flare, meet or stop early."""
    gap = gap or rng.uniform(3, 12)
    spine = resample(_spline(rng, size, size * 0.6), 3.0)
    tangent = np.gradient(spine, axis=0)
    normal = np.stack([-tangent[:, 1], tangent[:, 0]], 1)
    normal /= np.maximum(np.hypot(*tangent.T), 1e-6)[:, None]
    t = np.linspace(0, 1, len(spine))
    count = int(rng.integers(2, 6))
    flare = 1 + rng.choice([0.0, 1.0, -1.0]) * np.clip(t - rng.uniform(0.3, 0.8), 0, 1)
    strokes = []
    for k in range(count):
        cut = slice(int(rng.integers(0, 1 + len(spine) // 4)), None)
        side = (k - (count - 1) / 2) * gap * flare
        strokes.append((spine + normal * side[:, None])[cut].astype(np.float32))
    return [s for s in strokes if len(s) > 2], max(1.0, gap - rng.uniform(1.2, 2.5))


def tees(rng: Rng, size: int) -> tuple[Strokes, float]:
    """Branches that end on a main curve, on one or both sides, sometimes a little short or over."""
    main = resample(_spline(rng, size, size * 0.6), 3.0)
    strokes = [main]
    for _ in range(rng.integers(1, 7)):
        k = rng.integers(1, len(main) - 1)
        angle = np.arctan2(*(main[k + 1] - main[k - 1])[::-1]) + rng.uniform(0.35, np.pi - 0.35)
        angle += np.pi * rng.integers(2)
        reach = size * rng.uniform(0.1, 0.6)
        along = np.array([np.cos(angle), np.sin(angle)])
        across = np.array([-along[1], along[0]])
        start = rng.choice([0.0, 0.0, 0.0, -1.0, 1.0]) * rng.uniform(1, 6) / reach
        t = np.linspace(start, 1, 40)[:, None]
        curve = main[k] + reach * (t * along + rng.normal(0, 0.2) * t * t * across)
        strokes.append(curve.astype(np.float32))
    return strokes, 14.0


def tangents(rng: Rng, size: int) -> tuple[Strokes, float]:
    """Curves that touch: circles with tangent lines, and lines that merge at a small angle."""
    center, radius = rng.uniform(0.2, 0.8, 2) * size, rng.uniform(0.06, 0.35) * size
    turn = np.linspace(0, 2 * np.pi, 90) + rng.uniform(0, 7)
    strokes = [(center + radius * np.stack([np.cos(turn), np.sin(turn)], 1)).astype(np.float32)]
    for _ in range(rng.integers(1, 4)):
        angle = rng.uniform(0, 2 * np.pi)
        out = np.array([np.cos(angle), np.sin(angle)])
        side = np.array([-out[1], out[0]])
        touch = center + radius * out
        t = np.linspace(rng.choice([-1.0, 0.0]), 1, 60)[:, None] * radius * rng.uniform(1, 3)
        bend = rng.choice([0.0, 0.0, 0.5, 1.0]) * rng.uniform(-0.5, 0.8) / radius
        strokes.append((touch + t * side + bend * t * t * out).astype(np.float32))
    if rng.random() < 0.4:
        other = center + rng.normal(0, radius, 2)
        strokes.append((other + rng.uniform(0.3, 1) * (strokes[0] - center)).astype(np.float32))
    return strokes, 12.0


def hatching(rng: Rng, size: int) -> tuple[Strokes, float]:
    """Families of nearly parallel strokes, sometimes crossed."""
    strokes: Strokes = []
    gap = rng.uniform(4, 16)
    center, reach = rng.uniform(0.2, 0.8, 2) * size, size * rng.uniform(0.15, 0.5)
    angle = rng.uniform(0, np.pi)
    for _ in range(rng.choice([1, 1, 2, 2, 3])):
        along = np.array([np.cos(angle), np.sin(angle)])
        across = np.array([-along[1], along[0]])
        bend = rng.normal(0, 0.15)
        for k in range(-int(reach / gap), int(reach / gap) + 1):
            ends = np.array([-1, 1]) + rng.normal(0, 0.08, 2)
            half = np.sqrt(max(reach**2 - (k * gap) ** 2, (0.2 * reach) ** 2))
            t = np.linspace(ends[0], ends[1], 24)[:, None]
            offset = k * gap + rng.normal(0, 0.12 * gap)
            line = center + across * offset + half * (t * along + bend * t * t * across)
            strokes.append(line.astype(np.float32))
        angle += rng.uniform(0.4, 1.6)
    return strokes, max(1.0, 0.55 * gap)


def dots(rng: Rng, size: int) -> tuple[Strokes, float]:
    """Dots and very short dashes: some here and there, or an area full of them."""
    if rng.random() < 0.6:
        gap = rng.uniform(4.5, 18)
        at = np.stack(np.meshgrid(*[np.arange(0, size, gap)] * 2), -1).reshape(-1, 2)
        at = at + rng.uniform(-0.4, 0.4, at.shape) * gap
        center, radius = rng.uniform(0.1, 0.9, 2) * size, rng.uniform(0.1, 0.5) * size
        at = at[np.hypot(*((at - center) * rng.uniform(0.6, 1.4, 2)).T) < radius]
        half = rng.uniform(0.2, 0.2 * gap) * rng.uniform(0.5, 1.2, len(at))
        widest = 0.45 * gap
    else:
        at = rng.uniform(0, size, (rng.integers(3, 30), 2))
        half = rng.choice([0.3, 0.6, 2.0, 5.0], len(at)) * rng.uniform(0.7, 1.5, len(at))
        widest = 9.0
    turn = rng.uniform(0, np.pi) + rng.uniform(0, rng.choice([0.3, 7.0]), len(at))
    way = half[:, None] * np.stack([np.cos(turn), np.sin(turn)], 1)
    return list(np.stack([at - way, at, at + way], 1).astype(np.float32)), widest


def broken(rng: Rng, strokes: Strokes, gap: float) -> Strokes:
    """Strokes cut into dashes and dots with gaps of at least `gap` px: each piece is a stroke."""
    length = float(np.exp(rng.uniform(np.log(1.5), np.log(60))))
    gap = max(gap, 4.0 + 0.1 * length)  # shorter ones are skips of the pen
    pieces: Strokes = []
    for stroke in strokes[:400]:
        dense = resample(stroke, 1.0)
        count = 2 + int(len(dense) / (length + gap))
        on = 1.5 + rng.exponential(length, count)
        off = gap * (1 + rng.exponential(0.6, count))
        edges = np.cumsum(np.stack([on, off], 1).ravel()) - rng.uniform(0, length)
        parts = np.split(dense, np.clip(edges, 0, len(dense)).astype(int))
        pieces += [part for part in parts[::2] if len(part) > 1]
    return pieces


def scribble(rng: Rng, size: int) -> tuple[Strokes, float]:
    """Looping handwriting-like lines."""
    strokes: Strokes = []
    height = rng.uniform(6, 45)
    for row in range(rng.integers(1, 4)):
        length = rng.uniform(0.3, 1.2) * size
        n = int(length / height * 40) + 20
        t = np.linspace(0, length / height * 3.2, n)
        speed = np.repeat(rng.uniform(0.7, 1.4, n // 20 + 1), 20)[:n]
        phase = np.cumsum(speed) * (t[1] - t[0]) * rng.uniform(1.2, 2.4)
        lift = np.interp(
            np.arange(n),
            np.arange(0, n + 30, 30),
            rng.uniform(0.4, 1.3, n // 30 + 1 + (n % 30 > 0)),
        )
        x = t * height / 3.2 + rng.uniform(0.2, 0.7) * height * np.sin(phase) * lift
        y = height * 0.5 * lift * np.cos(phase) + row * height * rng.uniform(1.2, 2)
        word = np.stack([x, y], 1) + rng.uniform(-0.2, 0.7, 2) * size
        for part in np.array_split(word, rng.integers(1, 4)):
            strokes.append(part.astype(np.float32))
    return strokes, max(1.2, 0.14 * height)


def ruler(rng: Rng, size: int) -> tuple[Strokes, float]:
    """Straight lines and boxes: construction, furniture, comic panels."""
    strokes: Strokes = []
    for _ in range(rng.integers(2, 9)):
        a, b = rng.uniform(-0.2, 1.2, (2, 2)) * size
        if rng.random() < 0.4:
            box = np.array([a, (b[0], a[1]), b, (a[0], b[1]), a])
            strokes += [box] if rng.random() < 0.5 else list(np.stack([box[:-1], box[1:]], 1))
        else:
            strokes.append(np.array([a, b]))
    return [resample(s.astype(np.float32), 6.0) for s in strokes], 14.0


INVENTED: dict[Callable[[Rng, int], tuple[Strokes, float]], float] = {
    splines: 2.0,
    star: 2.5,
    parallels: 2.0,
    tees: 2.0,
    tangents: 1.5,
    hatching: 1.5,
    dots: 1.8,
    scribble: 1.5,
    ruler: 1.0,
}


def invented(rng: Rng, size: int) -> tuple[Strokes, float]:
    """Invented strokes of a random kind, turned and stretched."""
    weights = np.fromiter(INVENTED.values(), float)
    strokes, pen = list(INVENTED)[rng.choice(len(weights), p=weights / weights.sum())](rng, size)
    turn = random_matrix(rng, 1.0)
    turn /= max(1.0, np.linalg.norm(turn, 2))
    center = np.full(2, size / 2)
    return transform(strokes, turn, center - turn @ center), pen * float(np.linalg.norm(turn, -2))
