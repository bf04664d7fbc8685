"""Pencil told from the ink over it: `python -m benchmarks.pencil_under_ink --data TRAIN`.

Training drawings are drawn in black over faint, sketchy construction lines, and, to see that
nothing is split that is one, in ink alone and in pencil of uneven pressure alone. Of the traced
line that lies clearly on one of the two media: how much is in its colour.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np
from involute.engine import Settings, vectorize
from scipy.spatial import cKDTree

from .run_record import Figures
from .steadiness import SIZE, dense, read_drawing

Array = np.ndarray
_NUMBERS = range(10, 900, 97)  # drawings of each set
_MOST = 150  # pen strokes of a drawing


def main(argv: Sequence[str] | None = None) -> Figures:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True, help="training drawings (.npz)")
    parser.add_argument("--sets", nargs="+", default=["streamline", "openmoji", "quickdraw_raw"])
    parser.add_argument("--count", type=int, default=8, help="drawings of each set")
    options = parser.parse_args(argv)
    right = np.zeros((2, 2))
    split = dict.fromkeys(("ink over pencil", "ink alone", "pencil alone"), 0)
    pages = 0
    for name in options.sets:
        for number in _NUMBERS[: options.count]:
            rng = np.random.default_rng(number)
            drawn = read_drawing(options.data / f"{name}.npz", number)[:_MOST]
            ink = [(points - SIZE / 2) * 0.8 + SIZE / 2 for points in drawn]
            pencil = sketched(ink, rng)
            media = {
                "ink over pencil": page(ink, pencil, rng.uniform(0.25, 0.5), rng),
                "ink alone": page(ink, [], 0.0, rng),
                "pencil alone": page([], ink, rng.uniform(0.35, 0.7), rng),
            }
            pages += 1
            for medium, picture in media.items():
                strokes = vectorize(picture, Settings()).strokes
                split[medium] += len({stroke.color for stroke in strokes}) > 1
                if medium == "ink over pencil":
                    right += _judged(strokes, ink, pencil)
    figures = {medium: {"pages": pages, "split": count} for medium, count in split.items()}
    for medium, count in split.items():
        print(f"{medium:16} split on {count} of {pages} pages")
    for k, medium in enumerate(("ink", "pencil")):
        own = right[k, k] / right[k].sum()
        print(f"{medium:16} in its own colour: {own:.3f} of its length")
        figures["ink over pencil"][f"{medium} in its own colour"] = own
    return figures


def sketched(strokes: Sequence[Array], rng: np.random.Generator) -> list[Array]:
    """Construction lines for strokes: drawn once or twice beside them, and a cross and a circle."""
    lines = []
    for points in strokes:
        along = np.linspace(0, 3, len(points))[:, None]
        for _ in range(rng.integers(1, 3)):
            wave = 3 * np.sin(along + rng.uniform(0, 6, 2))
            lines.append(points + rng.normal(0, 4, 2) + wave)
    centre, radius = rng.uniform(300, 700, 2), rng.uniform(100, 300)
    angle = np.linspace(0, 2 * np.pi, 80)
    lines.append(centre + radius * np.stack([np.cos(angle), np.sin(angle)], 1))
    for arm in ((radius + 50, 10), (-5, radius + 50)):
        lines.append(np.array([centre - arm, centre + arm]))
    return lines


def page(
    ink: Sequence[Array], pencil: Sequence[Array], level: float, rng: np.random.Generator
) -> Array:
    """Black ink over pencil of uneven pressure on paper, (SIZE, SIZE) uint8."""
    black, gray = np.zeros((2, SIZE, SIZE), np.float32)
    for target, lines, pen in (
        (black, ink, rng.integers(3, 6)),
        (gray, pencil, rng.integers(2, 5)),
    ):
        for points in lines:
            drawn = np.zeros((SIZE, SIZE), np.uint8)
            cv2.polylines(
                drawn,
                [np.round(points * 16).astype(np.int32)],
                False,
                255,
                int(pen),
                cv2.LINE_AA,
                4,
            )
            pressure = 1.0 if target is black else np.clip(rng.normal(1, 0.2), 0.3, 1.3)
            np.maximum(target, drawn / np.float32(255) * np.float32(pressure), out=target)
    grain = cv2.GaussianBlur(rng.normal(0, 1, gray.shape).astype(np.float32), (0, 0), 0.8)
    gray *= np.clip(0.7 + 0.3 * grain / grain.std(), 0, 1)
    black, gray = (cv2.GaussianBlur(layer, (0, 0), 0.7) for layer in (black, gray))
    paper = 245 * (1 - 0.9 * black) * (1 - np.minimum(level * gray, 1))
    return np.clip(paper + rng.normal(0, 2, paper.shape), 0, 255).astype(np.uint8)


def _judged(strokes: Sequence, ink: Sequence[Array], pencil: Sequence[Array]) -> Array:
    """px of line on (ink, pencil) by being (black, gray)."""
    trees = [cKDTree(np.concatenate([dense(line) for line in lines])) for lines in (ink, pencil)]
    counts = np.zeros((2, 2))
    for stroke in strokes:
        to_ink, to_pencil = (t.query(dense(stroke.points.astype(float)))[0] for t in trees)
        gray = int(stroke.color != (0, 0, 0))
        counts[0, gray] += ((to_ink < 2) & (to_pencil > 6)).sum()
        counts[1, gray] += ((to_pencil < 3) & (to_ink > 4)).sum()
    return counts


if __name__ == "__main__":
    main()
