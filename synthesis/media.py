"""Drawing media: how much ink a stroke leaves on each pixel of a page.

Every stroke becomes dense samples along its arc; each sample stamps its exact distance to the
pixels around it, the nearest one wins. So one pass gives, per pixel, the signed distance to the
edge of the ink AND the sample it belongs to, with its pen width and pressure.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise

import cv2
import numpy as np
from involute.engine.arrays.ragged import count_up

from .line_art import Array, Rng, Strokes

STEP = 0.5  # px between samples along a stroke
MARGIN = 30  # px around the page in which ink still matters
_FAR = 99.0
WIDEST = 32.0  # px of half-width
NUDGE = 0.013  # px; where a line of one bit would end just on the centres of pixels


@dataclass(frozen=True)
class Samples:
    """Dense samples of all strokes. position, tangent: (N, 2) px; stroke: (N,) its number;
    arc: (N,) px from its start; length: (N,) px of the whole stroke."""

    position: Array
    tangent: Array
    stroke: Array
    arc: Array
    length: Array

    def __len__(self) -> int:
        return len(self.stroke)

    @staticmethod
    def merge(parts: list[Samples]) -> Samples:
        """The samples of several drawings; strokes are numbered on."""
        offsets = np.cumsum([0] + [int(p.stroke.max()) + 1 for p in parts])
        return Samples(
            np.concatenate([p.position for p in parts]),
            np.concatenate([p.tangent for p in parts]),
            np.concatenate([p.stroke + o for p, o in zip(parts, offsets, strict=False)]),
            np.concatenate([p.arc for p in parts]),
            np.concatenate([p.length for p in parts]),
        )

    def take(self, keep: Array) -> Samples:
        """The samples that a mask or an index selects."""
        return Samples(
            self.position[keep],
            self.tangent[keep],
            self.stroke[keep],
            self.arc[keep],
            self.length[keep],
        )


def sample(strokes: Strokes, size: int) -> Samples:
    """Samples every STEP px of what lies on the page or MARGIN around it."""
    sizes = np.array([len(s) for s in strokes])
    packed = np.concatenate(strokes).astype(np.float64)
    hop = np.hypot(*np.diff(packed, axis=0).T)
    last = np.cumsum(sizes) - 1
    hop[last[:-1]] = 1.0  # a gap in the common arc length keeps strokes apart
    arc = np.concatenate([[0.0], np.cumsum(hop)])
    start, length = arc[last - sizes + 1], arc[last] - arc[last - sizes + 1]
    count = np.maximum(2, np.ceil(length / STEP).astype(int) + 1)
    stroke = np.repeat(np.arange(len(strokes)), count)
    k = count_up(count)
    local = k / (count[stroke] - 1) * length[stroke]
    at = start[stroke] + local
    position = np.stack([np.interp(at, arc, packed[:, 0]), np.interp(at, arc, packed[:, 1])], 1)
    before = np.where(k > 0, np.arange(len(k)) - 1, np.arange(len(k)))
    after = np.where(k < count[stroke] - 1, np.arange(len(k)) + 1, np.arange(len(k)))
    tangent = position[after] - position[before]
    norm = np.hypot(*tangent.T)
    tangent = np.where(norm[:, None] > 1e-9, tangent / np.maximum(norm, 1e-9)[:, None], (1.0, 0.0))
    all_samples = Samples(position, tangent, stroke, local, length[stroke])
    near = ((position > -MARGIN) & (position < size + MARGIN)).all(1)
    return all_samples.take(near)


def line_spacing(samples: Samples, size: int) -> float:
    """Distance between lines where a drawing is dense, px: area over length in cells of 16 px."""
    on_page = ((samples.position >= 0) & (samples.position < size)).all(1)
    cell = (samples.position[on_page] // 16).astype(int)
    if not len(cell):
        return float(size)
    count = np.bincount(cell[:, 1] * size + cell[:, 0])
    return 256 / (STEP * float(np.percentile(count[count > 0], 90)))


def nearest(
    samples: Samples, half_width: Array, size: int, reach: float, step: float = STEP
) -> tuple[Array, Array]:
    """Distance to the edge of the ink, negative inside, and the sample that decides it.

    Args:
        half_width: (N,) px; zeros give the plain distance to the line.
        reach: how far outside the edge the distance is known; beyond it is 99.

    Returns:
        (size, size) float32 distance in px, and (size, size) int32 sample numbers (-1 = none).
    """
    best = np.full(size * size, np.int64(2) ** 62)
    radius = half_width + reach
    limits = [0.0, 2.5, 3.5, 5.0, 7.0, 10.0, 14.0, 40.0]
    for low, high in pairwise(limits):
        ids = np.flatnonzero((radius > low) & (radius <= high))
        if not len(ids):
            continue
        # Wide pens need fewer stamps: thin out, but keep both ends of every stroke.
        stride = max(1, int(0.3 * low / step))
        arc, length = samples.arc[ids], samples.length[ids]
        kept = (
            (np.round(arc / step).astype(int) % stride == 0) | (arc < step) | (arc > length - step)
        )
        kept[0] = True  # of a short piece away from both ends, too
        ids = ids[kept]
        half = 0.6 * stride * step
        r = int(np.ceil(high if high < 40 else radius[ids].max()))
        dy, dx = (o.ravel() for o in np.mgrid[-r : r + 1, -r : r + 1])
        disc = np.hypot(dx, dy) <= r + 0.8
        dx, dy = dx[disc], dy[disc]
        for part in np.array_split(ids, max(1, len(ids) * len(dx) // 400_000)):
            p, t = samples.position[part], samples.tangent[part]
            cell = np.floor(p).astype(np.int64)
            x, y = cell[:, :1] + dx, cell[:, 1:] + dy
            u, v = x + (0.5 - p[:, :1]), y + (0.5 - p[:, 1:])
            along = np.maximum(np.abs(u * t[:, :1] + v * t[:, 1:]) - half, 0)
            across = v * t[:, :1] - u * t[:, 1:]
            edge = np.sqrt(along * along + across * across) - half_width[part][:, None]
            good = (edge < reach) & (x >= 0) & (y >= 0) & (x < size) & (y < size)
            key = ((edge[good] + 64) * 4096).astype(np.int64) << 24
            key |= np.broadcast_to(part[:, None], good.shape)[good]
            np.minimum.at(best, (y * size + x)[good], key)
    none = best == np.int64(2) ** 62
    distance = np.where(none, _FAR, (best >> 24) / 4096 - 64).astype(np.float32)
    owner = np.where(none, -1, best & 0xFFFFFF).astype(np.int32)
    return distance.reshape(size, size), owner.reshape(size, size)


@cache
def _bank() -> dict[str, Array]:
    """Noise fields of unit spread, made once; pages cut random windows out of them."""
    rng = np.random.default_rng(5)
    bank = {}
    for name, sigma in {
        "fine": 0.5,
        "grain": 0.9,
        "tooth": 1.6,
        "rough": 3,
        "blotch": 9,
        "cloud": 30,
    }.items():
        field = cv2.GaussianBlur(rng.normal(size=(1024, 1024)).astype(np.float32), (0, 0), sigma)
        bank[name] = field / field.std()
    fibre = cv2.GaussianBlur(
        rng.normal(size=(1024, 1024)).astype(np.float32), (0, 0), 0.7, sigmaY=5
    )
    bank["fibre"] = fibre / fibre.std()
    return bank


def noise(rng: Rng, name: str, size: int) -> Array:
    """A (size, size) window of a noise field, mean 0, spread 1: fine, grain, tooth, rough, blotch,
    cloud (correlation 0.5 to 30 px) or fibre (streaks)."""
    field = _bank()[name]
    x, y = rng.integers(0, 1024 - size, 2)
    window = field[y : y + size, x : x + size]
    if rng.random() < 0.5:
        window = window.T
    return window[:: rng.choice([-1, 1]), :: rng.choice([-1, 1])]


def _pressure(rng: Rng, samples: Samples, length: float) -> Array:
    """Smooth noise along each stroke in about [-1, 1], (N,)."""
    knots = rng.normal(0, 0.45, 4096)
    where = samples.arc / length + (samples.stroke * 37.7 + rng.uniform(0, 4096)) % 4000
    low = np.floor(where).astype(int)
    t = where - low
    t = t * t * (3 - 2 * t)
    return np.clip(knots[low % 4096] * (1 - t) + knots[(low + 1) % 4096] * t, -1, 1)


def _skips(rng: Rng, samples: Samples) -> tuple[Array, Array]:
    """Where a pen skips: gaps of about 2 to 8 px, many in a row where it runs dry.

    Returns:
        The share of ink that is left and of the width that is left, (N,) each.
    """
    dry = _pressure(rng, samples, rng.uniform(30, 120)) > rng.uniform(0.1, 1.0)
    fine = _pressure(rng, samples, rng.uniform(4, 14))
    over = fine - np.where(dry, rng.uniform(0.3, 0.6), rng.uniform(0.75, 0.98))
    ink = np.where(over > 0, rng.choice([0.0, 0.05, 0.2]), 1.0)
    return ink, 1 - rng.uniform(0, 0.6) * np.clip(1 + over / 0.3, 0, 1)


def _taper(samples: Samples, length: float, thin: float) -> Array:
    """1 inside a stroke, falling to `thin` at both ends over `length` px (or a third of it)."""
    reach = np.maximum(np.minimum(length, samples.length / 3), 1e-3)
    end = np.minimum(samples.arc, samples.length - samples.arc)
    return thin + (1 - thin) * np.sqrt(np.clip(end / reach, 0, 1))


@dataclass(frozen=True)
class Medium:
    """A pen. Ranges are drawn anew for every drawing; lengths in px, the rest relative.

    width: typical full width. swell: width change with pressure. taper: how thin ends become
    (1 = blunt). nib: flatness of a broad nib. density: ink of a full stroke. fade: change of the
    density with pressure. grain: how much the paper's tooth shows; tooth: which noise. ragged:
    roughness of the edge in px. soft: softness of the edge in px, 0 = without any grey. rim: darker
    edges of wet ink. overlap: strokes of one drawing darken each other. skip: how likely there are
    gaps.
    """

    width: tuple[float, float]
    swell: tuple[float, float] = (0.0, 0.1)
    taper: tuple[float, float] = (1.0, 1.0)
    nib: float = 0.0
    density: tuple[float, float] = (0.85, 1.0)
    fade: tuple[float, float] = (0.0, 0.1)
    grain: tuple[float, float] = (0.0, 0.0)
    tooth: tuple[str, ...] = ("grain",)
    ragged: tuple[float, float] = (0.0, 0.1)
    soft: tuple[float, float] = (0.5, 0.8)
    rim: tuple[float, float] = (0.0, 0.0)
    overlap: float = 0.0
    skip: float = 0.25


MEDIA: dict[str, Medium] = {
    "technical pen": Medium((1.4, 6.0)),
    "ink": Medium((1.5, 6.0), (0.2, 0.5), (0.3, 1.0), ragged=(0.05, 0.35)),
    "wet ink": Medium(
        (2.5, 10.0),
        (0.2, 0.5),
        (0.6, 1.3),
        density=(0.55, 0.95),
        fade=(0.1, 0.3),
        ragged=(0.2, 0.7),
        soft=(0.7, 1.8),
        rim=(0.1, 0.4),
        overlap=0.5,
    ),
    "brush": Medium(
        (3.0, 14.0),
        (0.4, 0.8),
        (0.05, 0.5),
        density=(0.8, 1.0),
        grain=(0.0, 0.25),
        tooth=("fibre", "rough"),
        ragged=(0.1, 0.5),
    ),
    "calligraphy": Medium((3.0, 12.0), (0.0, 0.2), nib=0.8, ragged=(0.05, 0.4), grain=(0.0, 0.15)),
    "pencil": Medium(
        (1.3, 3.5),
        (0.1, 0.3),
        (0.4, 1.0),
        density=(0.45, 0.85),
        fade=(0.2, 0.5),
        grain=(0.2, 0.6),
        tooth=("fine", "grain"),
        ragged=(0.1, 0.5),
        soft=(0.6, 1.2),
        overlap=0.5,
    ),
    "soft pencil": Medium(
        (2.5, 8.0),
        (0.1, 0.4),
        (0.5, 1.1),
        density=(0.4, 0.85),
        fade=(0.2, 0.5),
        grain=(0.3, 0.75),
        tooth=("grain", "tooth"),
        ragged=(0.3, 1.0),
        soft=(0.8, 2.0),
        overlap=0.6,
    ),
    "charcoal": Medium(
        (4.0, 14.0),
        (0.2, 0.4),
        (0.6, 1.2),
        density=(0.5, 0.95),
        fade=(0.2, 0.5),
        grain=(0.45, 0.9),
        tooth=("grain", "tooth", "rough"),
        ragged=(0.5, 1.6),
        soft=(0.8, 2.0),
        overlap=0.5,
    ),
    "marker": Medium(
        (4.0, 20.0),
        (0.0, 0.12),
        density=(0.5, 0.98),
        fade=(0.0, 0.15),
        ragged=(0.05, 0.4),
        soft=(0.5, 1.2),
        grain=(0.0, 0.15),
        tooth=("fibre",),
        overlap=0.7,
    ),
    "ballpoint": Medium(
        (1.1, 2.8),
        (0.0, 0.2),
        (0.6, 1.0),
        density=(0.5, 0.95),
        fade=(0.2, 0.5),
        grain=(0.1, 0.5),
        tooth=("fine", "grain"),
        ragged=(0.05, 0.3),
        overlap=0.4,
        skip=0.5,
    ),
    "fineliner": Medium((1.5, 5.0), (0.0, 0.15), (0.8, 1.15), ragged=(0.05, 0.3), soft=(0.5, 1.0)),
    "coloured pencil": Medium(
        (2.0, 7.0),
        (0.1, 0.3),
        (0.5, 1.0),
        density=(0.25, 0.6),
        fade=(0.2, 0.5),
        grain=(0.3, 0.8),
        tooth=("grain", "tooth"),
        ragged=(0.3, 0.9),
        soft=(0.7, 1.5),
        overlap=0.6,
    ),
    "brushpen": Medium((2.0, 9.0), (0.3, 0.7), (0.1, 0.7), ragged=(0.05, 0.3)),
}
# Lines that no pen drew on paper: one bit without any grey, and crisp ones with smooth edges.
_EVEN = Medium(
    (0.9, 4.3), swell=(0.0, 0.0), density=(1.0, 1.0), fade=(0.0, 0.0), ragged=(0.0, 0.0), skip=0.0
)
DIGITAL: dict[str, Medium] = {
    "one bit": replace(_EVEN, soft=(0.0, 0.0)),
    "crisp": replace(_EVEN, width=(0.9, 6.0), soft=(0.5, 0.5)),
}


def draw(
    rng: Rng, samples: Samples, medium: Medium, width: float, size: int
) -> tuple[Array, Array]:
    """Ink of a drawing made with one pen.

    Returns:
        (size, size) float32 ink in [0, 1], and (N,) the half-width of each sample in px.
    """
    length = rng.uniform(25, 160)
    press = _pressure(rng, samples, length)
    half = 0.5 * width * np.exp(rng.uniform(*medium.swell) * press)
    half *= _taper(samples, width * rng.uniform(2, 10), rng.uniform(*medium.taper))
    if medium.nib:
        turn = rng.uniform(0, np.pi)
        across = np.abs(samples.tangent @ (-np.sin(turn), np.cos(turn)))
        half *= np.hypot(across, 1 - medium.nib) * rng.uniform(0.9, 1.2)
    left: Array | float = 1.0
    if rng.random() < medium.skip:
        left, thinner = _skips(rng, samples)
        half = half * thinner
    layers = [np.ones(len(samples), bool)]
    if rng.random() < medium.overlap:
        second = rng.integers(0, 2, samples.stroke.max() + 1).astype(bool)[samples.stroke]
        layers = [second, ~second]
    soft = rng.uniform(*medium.soft)
    # Without any grey, a line thinner than a pixel would vanish between the rows.
    half = np.clip(half, 0.45 if soft else 0.505, WIDEST)
    density, fade = rng.uniform(*medium.density), rng.uniform(*medium.fade)
    ragged, rim = rng.uniform(*medium.ragged), rng.uniform(*medium.rim)
    grain = rng.uniform(*medium.grain)
    tooth = noise(rng, str(rng.choice(medium.tooth)), size)
    edge_noise = noise(rng, str(rng.choice(["grain", "tooth", "rough"])), size)
    flow = density * (1 + fade * press) * left
    ink: Array = np.zeros((size, size), np.float32)
    for layer in layers:
        ids = np.flatnonzero(layer)
        if not len(ids):
            continue
        edge, owner = nearest(samples.take(ids), half[ids], size, soft + 1.5 * ragged + 0.6)
        mine = np.clip(flow[ids][owner], 0.0, 1).astype(np.float32)
        edge = edge + ragged * edge_noise
        cover = np.clip(0.5 - edge / (2 * soft), 0, 1) if soft else edge <= 0
        if rim:
            mine = mine * (1 - rim + rim * np.exp(-np.abs(edge + 1.0)))
        if grain:
            # The tooth of the paper takes ink where it is high; more pressure fills the valleys.
            fill = np.clip(0.8 + 0.9 * (mine - 0.5) + tooth * 0.5, 0, 1)
            mine = mine * (1 - grain + grain * fill)
        ink = 1 - (1 - ink) * (1 - np.where(owner >= 0, cover * mine, 0))
    return ink.astype(np.float32), half
