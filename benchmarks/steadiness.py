"""How steady strokes are from frame to frame: `python -m benchmarks.steadiness --data TRAIN`.

A drawing of known pen strokes is animated (it moves, turns, bends, and is redrawn with a shaking
hand), rendered, traced frame by frame, and followed. Every traced stroke can be told by the pen
strokes under it, so the figures need no eye: of the pen strokes that two neighbouring frames both
show as one traced stroke, how many keep their number, their order among each other, and their
direction.
With --frames DIR a real sequence is traced instead and only what was matched is counted.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
from involute.command import trace_sequence
from involute.engine import Drawing, InvoluteError, Settings
from involute.engine.arrays.ragged import along, arc
from involute.engine.sequence import number_frames
from involute.engine.sequence.stroke_matching import match_strokes, sample_strokes
from scipy.spatial import cKDTree

from .run_record import Figures

Array = np.ndarray
SIZE = 1024


@dataclass
class Tally:
    """Counts over all neighbouring frames; `share` gives them as shares."""

    seen: int = 0
    number: int = 0
    direction: int = 0
    order: int = 0
    orders: int = 0

    def add(self, before: Array, after: Array, same_way: Array) -> None:
        """before, after: numbers of the same lines in two frames; same_way: their directions."""
        self.seen += len(before)
        self.number += int((before == after).sum())
        self.direction += int(same_way.sum())
        upper = np.triu_indices(len(before), 1)
        kept = np.sign(before[:, None] - before) == np.sign(after[:, None] - after)
        self.order += int(kept[upper].sum())
        self.orders += len(upper[0])

    def figures(self) -> dict[str, float]:
        seen, orders = max(self.seen, 1), max(self.orders, 1)
        return {
            "lines": self.seen,
            "number": self.number / seen,
            "order": self.order / orders,
            "direction": self.direction / seen,
        }

    def share(self) -> str:
        lines, number, order, direction = self.figures().values()
        return f"{lines:6.0f} {number:8.3f} {order:8.3f} {direction:10.3f}"


def main(argv: Sequence[str] | None = None) -> Figures:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--data", type=Path, help="folder of the training drawings (.npz)")
    source.add_argument("--frames", type=Path, help="folder of one real sequence")
    parser.add_argument("--set", default="streamline", help="which training drawings")
    parser.add_argument("--drawings", type=int, nargs="+", default=[9, 24])
    parser.add_argument("--count", type=int, default=24, help="frames of each drawing")
    parser.add_argument("--jobs", type=int, default=0)
    parser.add_argument("--keep", type=Path, help="keep the rendered frames in this folder")
    options = parser.parse_args(argv)
    print(f"{'':18} {'lines':>6} {'number':>8} {'order':>8} {'direction':>10}")
    if options.frames:
        return _real(options.frames, options.jobs)
    traced, followed = Tally(), Tally()
    for drawing in options.drawings:
        strokes = read_drawing(options.data / f"{options.set}.npz", drawing)
        with tempfile.TemporaryDirectory() as scratch:
            folder = options.keep or Path(scratch)
            truths = list(animate(strokes, options.count, seed=drawing))
            paths = [folder / f"{options.set}{drawing}_{k + 1:04d}.png" for k in range(len(truths))]
            for path, truth in zip(paths, truths, strict=True):
                cv2.imwrite(str(path), render(truth, np.random.default_rng(len(truth))))
            for follow, tally in ((False, traced), (True, followed)):
                parts = Path(scratch, "parts")
                frames = trace_sequence(
                    number_frames(paths), jobs=options.jobs, parts=parts, follow=follow
                )
                drawings = map(_whole, frames)
                labels = [label(d, t) for d, t in zip(drawings, truths, strict=True)]
                for a, b in pairwise(labels):
                    tally.add(*_common(a, b))
    return _told({"traced": traced, "traced, followed": followed})


def _whole(frame: tuple[int, Drawing | InvoluteError]) -> Drawing:
    """The drawing of a frame; a frame that failed ends the benchmark."""
    _, drawing = frame
    if isinstance(drawing, InvoluteError):
        raise drawing
    return drawing


def _told(tallies: dict[str, Tally]) -> Figures:
    for name, tally in tallies.items():
        print(f"{name:18} {tally.share()}")
    return {name: tally.figures() for name, tally in tallies.items()}


def read_drawing(path: Path, number: int) -> list[Array]:
    """The pen strokes of one training drawing, (N, 2) px in a box of 1024 px."""
    with np.load(path) as file:
        first, last = file["drawing_offsets"][number : number + 2]
        offsets = file["stroke_offsets"][first : last + 1]
        points = file["points"][offsets[0] : offsets[-1]] / 32.0
    return np.split(points, offsets[1:-1] - offsets[0])


def animate(strokes: Sequence[Array], count: int, seed: int) -> Iterator[list[Array]]:
    """The strokes at `count` moments: a walk over the page, a swing, a bend, a shaking hand."""
    rng = np.random.default_rng(seed)
    waves = rng.uniform(0, 2 * np.pi, (4, 2))
    for t in np.linspace(0, 2 * np.pi, count, endpoint=False):
        angle = 0.12 * np.sin(t + waves[0, 0])
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        shift = [60 * np.sin(t), 25 * np.sin(2 * t)]
        moved = []
        for points in strokes:
            place = 0.8 * (points - SIZE / 2)
            bend = 25 * np.sin(place[:, ::-1] / 180 + waves[1] + [np.sin(t), np.cos(t)])
            along = np.linspace(0, 3, len(points))[:, None]
            shake = rng.normal(0, 1.5, 2) + 1.2 * np.sin(along + rng.uniform(0, 6, 2))
            moved.append((place + bend) @ turn + shift + shake + SIZE / 2)
        yield moved


def render(strokes: Sequence[Array], rng: np.random.Generator) -> Array:
    """Ink on paper, (SIZE, SIZE) uint8."""
    page = np.full((SIZE, SIZE), 245, np.uint8)
    for points in strokes:
        cv2.polylines(page, [np.round(points * 16).astype(np.int32)], False, 30, 3, cv2.LINE_AA, 4)
    noise = rng.normal(0, 3, page.shape)
    return np.clip(cv2.GaussianBlur(page, (0, 0), 0.6) + noise, 0, 255).astype(np.uint8)


def label(drawing: Drawing, truth: Sequence[Array]) -> dict[int, tuple[int, bool]]:
    """Pen stroke -> (number of the traced stroke that shows most of it, runs the same way)."""
    length = [np.hypot(*np.diff(points, axis=0).T).sum() for points in truth]
    dense = [dense(points) for points in truth]
    owner = np.repeat(np.arange(len(truth)), [len(d) for d in dense])
    along = np.concatenate([np.linspace(0, 1, len(d)) for d in dense])
    tree = cKDTree(np.concatenate(dense))
    samples = sample_strokes(drawing.strokes)
    distance, near = tree.query(samples)
    found: dict[int, tuple[int, bool]] = {}
    for number, (stroke, hits, off) in enumerate(zip(drawing.strokes, near, distance, strict=True)):
        counts = np.bincount(owner[hits][off < 4], minlength=len(truth))
        best = int(counts.argmax())
        long = np.hypot(*np.diff(stroke.points, axis=0).T).sum()
        if counts[best] < 0.8 * len(hits) or not 0.6 < long / max(length[best], 1) < 1.3:
            continue
        if length[best] > 20 and not stroke.closed:
            step = np.diff(along[hits][owner[hits] == best])
            found[best] = (number, bool(np.median(np.sign(step)) > 0))
    return found


def dense(points: Array) -> Array:
    """The same line with a point a pixel."""
    whole = arc(points)[-1]
    return along(points, np.linspace(0, whole, max(2, int(whole))))


def _common(
    before: dict[int, tuple[int, bool]], after: dict[int, tuple[int, bool]]
) -> tuple[Array, Array, Array]:
    both = sorted(before.keys() & after.keys())
    a, b = (np.array([labels[k] for k in both]).reshape(-1, 2) for labels in (before, after))
    return a[:, 0], b[:, 0], a[:, 1] == b[:, 1]


def _real(folder: Path, jobs: int) -> Figures:
    """What a second, independent matching of the followed drawings says: no truth, so no proof."""
    frames = number_frames(sorted(p for p in folder.iterdir() if p.suffix in (".png", ".jpg")))
    tallies = {}
    with tempfile.TemporaryDirectory() as parts:
        for follow in (False, True):
            tally = tallies["traced, followed" if follow else "traced"] = Tally()
            drawings = trace_sequence(frames, Settings(), jobs=jobs, parts=parts, follow=follow)
            for a, b in pairwise(map(_whole, drawings)):
                _count_matched(a, b, tally)
    return _told(tallies)


def _count_matched(a: Drawing, b: Drawing, tally: Tally) -> None:
    for ink in {s.color for s in a.strokes} & {s.color for s in b.strokes}:
        one, other = ([s for s in d.strokes if s.color == ink] for d in (a, b))
        matches = match_strokes(one, other)
        tally.add(matches.old, matches.new, ~matches.flipped)


if __name__ == "__main__":
    main()
