"""How exactly the network finds straight lines and their crossings, in fractions of a pixel.

python -m involute.training.centerline.precision [--weights FILE]
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from involute.engine.centerline.backends import Infer, load
from involute.engine.centerline.learned import WEIGHTS

from ...synthesis.line_art import Array, Rng
from ...synthesis.media import Medium, draw, sample
from .page_figures import peaks, ridge_points

SIZE = 256
_PEN = Medium((3.0, 3.0), density=(1.0, 1.0), fade=(0.0, 0.0), swell=(0.0, 0.0), ragged=(0.0, 0.0))


def main(arguments: list[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(prog="precision", description=__doc__.splitlines()[0])
    parser.add_argument("--weights", type=Path, default=WEIGHTS)
    parser.add_argument("--tries", type=int, default=12)
    options = parser.parse_args(arguments)
    infer, rng = load(options.weights, "cpu"), np.random.default_rng(0)
    print("| line width px | 1.5 | 3 | 5 | 8 | 12 |\n|---|---|---|---|---|---|")
    errors = [
        np.concatenate([line_errors(rng, infer, width) for _ in range(options.tries)])
        for width in (1.5, 3, 5, 8, 12)
    ]
    print("| mean error px | " + " | ".join(f"{e.mean():.3f}" for e in errors) + " |\n")
    print("| crossing angle | 15 | 20 | 30 | 45 | 90 |\n|---|---|---|---|---|---|")
    offsets = [
        [crossing_error(rng, infer, angle) for _ in range(options.tries)]
        for angle in (15, 20, 30, 45, 90)
    ]
    print("| median error px | " + " | ".join(f"{np.median(o):.2f}" for o in offsets) + " |")


def _line(center: Array, angle: float) -> Array:
    along = np.array([np.cos(angle), np.sin(angle)])
    return np.stack([center - 95 * along, center + 95 * along]).astype(np.float32)


def _look(rng: Rng, infer: Infer, lines: list[Array], width: float) -> Array:
    ink, _ = draw(rng, sample(lines, SIZE), _PEN, width, SIZE)
    return infer(ink)


def line_errors(rng: Rng, infer: Infer, width: float) -> Array:
    """Distances (N,) px of the found crest from a straight line, away from its ends."""
    center, angle = SIZE / 2 + rng.uniform(-20, 20, 2), rng.uniform(0, np.pi)
    found = ridge_points(_look(rng, infer, [_line(center, angle)], width)[0]) - center
    along = found @ (np.cos(angle), np.sin(angle))
    across = found @ (-np.sin(angle), np.cos(angle))
    return np.abs(across[np.abs(along) < 80])


def crossing_error(rng: Rng, infer: Infer, degrees: float) -> float:
    """Distance in px from the crossing of two 3 px lines to the nearest junction; inf = none."""
    center, angle = SIZE / 2 + rng.uniform(-5, 5, 2), rng.uniform(0, np.pi)
    lines = [_line(center, angle), _line(center, angle + np.deg2rad(degrees))]
    found = peaks(_look(rng, infer, lines, 3.0)[1], 0.3)
    return float(np.hypot(*(found - center).T).min()) if len(found) else float("inf")


if __name__ == "__main__":
    main()
