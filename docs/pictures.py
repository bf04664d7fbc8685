"""Makes pictures of the README and the manual: `python docs/pictures.py [NAME ...]`.

before_after    a real scan, and its strokes
inks            an animator's page, and its layers
stages          a part of a scan at every stage of the method

From the root of the project.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
from involute.engine import Settings, Stroke, vectorize
from involute.engine.centerline import provider_for
from involute.engine.fills.solids import split_solids
from involute.engine.formats import png
from involute.engine.graph import Evidence, run_passes
from involute.engine.scan import read_scan

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from benchmarks.metrics import read_svg  # noqa: E402

Array = np.ndarray
SQUIRREL = ROOT / "benchmarks" / "data" / "openclipart_cartoon_squirr.svg"


def before_after() -> None:
    """A part of a scan, and below it its strokes, each in a colour of its own."""
    scan, part = ROOT / "examples" / "hippopotamus.jpg", (slice(160, 730), slice(60, 1300))
    before = cv2.imread(str(scan))
    after = png.render(vectorize(scan), rings=False)[..., ::-1]
    rule = np.full((2, before[part].shape[1], 3), 200, np.uint8)
    both = np.vstack([before[part], rule, after[part]])
    cv2.imwrite(str(ROOT / "docs" / "before_after.png"), both, [cv2.IMWRITE_PNG_COMPRESSION, 9])


def inks() -> None:
    """Black ink over blue pencil on punched paper; the layer of the ink; that of the pencil."""
    page = animators_page(read_svg(SQUIRREL), np.random.default_rng(4))
    strokes = vectorize(page[..., ::-1]).strokes
    black = [stroke for stroke in strokes if max(stroke.color) < 60]
    blue = [stroke for stroke in strokes if max(stroke.color) >= 60]
    layers = [layer(found, page.shape) for found in (black, blue)]
    rule = np.full((page.shape[0], 3, 3), 150, np.uint8)
    three = np.hstack([page, rule, layers[0], rule, layers[1]])
    small = cv2.resize(three, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA)
    path = ROOT / "docs" / "manual" / "inks.jpg"
    cv2.imwrite(str(path), small, [cv2.IMWRITE_JPEG_QUALITY, 85])


def animators_page(drawing: Iterable[Array], rng: np.random.Generator) -> Array:
    """A cleaned-up drawing over its construction, a little askew on the scanner, (H, W, 3) BGR."""
    height, width = 1240, 1040
    ink = [0.92 * line + (150, 60) for line in drawing]
    size = [float(np.hypot(*np.ptp(line, axis=0))) for line in ink]
    sketch = [_roughly(line, rng) for line, long in zip(ink, size, strict=True) if long > 60]
    turn = np.linspace(0, 2 * np.pi, 90)
    round_ = np.stack([np.cos(turn), np.sin(turn)], 1)
    sketch += [(420, 290) + round_ * (170, 190), (400, 720) + round_ * (190, 270)]
    sketch += [
        np.array(line, float) for line in ([(425, 60), (395, 1010)], [(220, 300), (640, 280)])
    ]
    page = np.full((height, width, 3), (226, 238, 243), np.float64)
    page *= 1 - 0.1 * np.linspace(0, 1, width)[None, :, None]
    for lines, color, pen in ((sketch, (225, 160, 120), 3), (ink, (40, 36, 34), 4)):
        share = np.zeros((height, width), np.uint8)
        for line in lines:
            cv2.polylines(share, [np.int32(line * 16)], False, 255, pen, cv2.LINE_AA, 4)
        share = cv2.GaussianBlur(share, (0, 0), 0.7)[..., None] / 255
        page *= 1 - share + share * np.array(color) / 255
    for x, long in ((180, True), (520, False), (860, True)):  # a peg bar's holes, black behind
        if long:
            cv2.line(page, (x - 22, 1150), (x + 22, 1150), (30, 28, 28), 15, cv2.LINE_AA)
        else:
            cv2.circle(page, (x, 1150), 13, (30, 28, 28), cv2.FILLED, cv2.LINE_AA)
    askew = cv2.getRotationMatrix2D((width / 2, height / 2), 0.9, 0.975)
    page = cv2.warpAffine(page, askew, (width, height), borderValue=(30, 28, 28))
    return np.clip(page + rng.normal(0, 2, page.shape), 0, 255).astype(np.uint8)


def _roughly(line: Array, rng: np.random.Generator) -> Array:
    """The same line as a first sketch: fewer bends, a little beside itself."""
    few = cv2.approxPolyDP(np.float32(line)[:, None], 6.0, False)[:, 0] + rng.normal(0, 5, 2)
    for _ in range(3):  # corners cut off (Chaikin)
        cut = np.stack([0.75 * few[:-1] + 0.25 * few[1:], 0.25 * few[:-1] + 0.75 * few[1:]], 1)
        few = np.vstack([few[:1], cut.reshape(-1, 2), few[-1:]])
    return few


def layer(strokes: Iterable[Stroke], shape: tuple[int, ...]) -> Array:
    """Strokes on white, as wide and in the colour that they have, (H, W, 3) BGR."""
    page = np.full(shape, 255, np.uint8)
    for stroke in strokes:
        points = np.int32(np.round(stroke.points * 16))
        width = max(1, round(float(stroke.widths.mean())))
        cv2.polylines(page, [points], stroke.closed, stroke.color[::-1], width, cv2.LINE_AA, 4)
    return page


def stages() -> None:
    """A part of the elephant: scan, ink, center lines, graph with its junctions, strokes."""
    path, settings = ROOT / "examples" / "elephant.jpg", Settings()
    scan = read_scan(path, settings)
    lines, _ = split_solids(scan, settings)
    maps = provider_for(settings)(lines, lambda _: None)
    graph = run_passes(Evidence.of(lines, maps), settings)
    drawing = vectorize(path)
    wide, scale = 260, 2  # px of the scan; enlarged so much
    x, y = _busiest(np.array([j.position for j in drawing.junctions]), scan.size, wide)

    def panel(image: Array, size: float) -> Array:
        """The part of a picture that has `size` px for each of the scan's."""
        a, b, c, d = (round(v * size) for v in (y, y + wide, x, x + wide))
        part = image[a:b, c:d]
        part = cv2.cvtColor(part, cv2.COLOR_GRAY2BGR) if part.ndim == 2 else part
        return cv2.resize(part, (wide * scale,) * 2, interpolation=cv2.INTER_CUBIC)

    def gray(values: Array) -> Array:
        return np.uint8(255 * (1 - np.clip(values, 0, 1)))

    branches = np.full((scan.size[1] * scale, scan.size[0] * scale, 3), 255, np.uint8)
    turned = np.random.default_rng(1).permutation(180)
    for number, (first, last) in enumerate(pairwise(graph.offsets)):
        hue = np.array([[[turned[number % 180], 200, 190]]], np.uint8)
        color = cv2.cvtColor(hue, cv2.COLOR_HSV2BGR)[0, 0].tolist()
        line = np.int32(np.round(graph.points[first:last] * scan.scale * scale * 16))
        cv2.polylines(branches, [line], False, color, 2, cv2.LINE_AA, 4)
    for junction in drawing.junctions:
        at = tuple(int(v) for v in np.round(np.array(junction.position) * scale))
        cv2.circle(branches, at, 6, (40, 40, 220), 2, cv2.LINE_AA)
    shown = [
        panel(cv2.imread(str(path)), 1),
        panel(gray(scan.ink), 1 / scan.scale),
        panel(gray(maps.centerline), 1 / scan.scale),
        panel(branches, scale),
        panel(png.render(drawing, rings=False)[..., ::-1], 1),
    ]
    rule = np.full((wide * scale, 6, 3), 150, np.uint8)
    row = np.hstack([part for one in shown for part in (one, rule)][:-1])
    small = cv2.resize(row, None, fx=0.65, fy=0.65, interpolation=cv2.INTER_AREA)
    cv2.imwrite(str(ROOT / "docs" / "stages.png"), small, [cv2.IMWRITE_PNG_COMPRESSION, 9])


def _busiest(places: Array, size: tuple[int, int], wide: int) -> tuple[int, int]:
    """The corner (x, y) of the square with most of the places, (N, 2), in it."""
    corners = [
        (x, y)
        for y in range(0, size[1] - wide, wide // 4)
        for x in range(0, size[0] - wide, wide // 4)
    ]
    inside = [np.all((places >= c) & (places < np.array(c) + wide), axis=1).sum() for c in corners]
    return corners[int(np.argmax(inside))]


PICTURES = {"before_after": before_after, "inks": inks, "stages": stages}

if __name__ == "__main__":
    for name in sys.argv[1:] or PICTURES:
        PICTURES[name]()
