"""Figures by medium and kind of page on held-out drawings, beside the classical provider's.

python -m involute.training.centerline.validate --data DIR [--weights FILE] [--pages 12]
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from involute.engine.centerline.backends import load
from involute.engine.centerline.classical import classical
from involute.engine.centerline.learned import HALF_WIDTH_UNIT, WEIGHTS, trace_maps
from involute.engine.scan.pen_width import measure_pen
from involute.engine.values import LineMaps, Scan

from ...synthesis.line_art import Array, Library
from ...synthesis.media import MEDIA
from .page_figures import page_figures, pooled
from .training_page import KINDS, page

SIZE = 512


def main(arguments: list[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(prog="validate", description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True)
    parser.add_argument("--weights", type=Path, default=WEIGHTS)
    parser.add_argument("--pages", type=int, default=12, help="for each medium and kind")
    parser.add_argument("--seed", type=int, default=77)
    parser.add_argument("--device", default="cpu", choices=["cpu", "gpu"])
    parser.add_argument("--json", type=Path, help="write the figures here as well")
    options = parser.parse_args(arguments)
    infer = load(options.weights, options.device)

    def network(scan: Scan) -> LineMaps:
        return trace_maps(scan.ink, infer, lambda fraction: None)

    ways = {"network": network, "classical": lambda scan: classical(scan, lambda fraction: None)}
    library = Library.load(options.data)
    table = {way: {} for way in ways}
    everything: dict[str, list] = {way: [] for way in ways}
    names = [(medium, medium, None) for medium in MEDIA]
    names += [(kind, None, kind) for kind in KINDS if kind != "paper"]
    for number, (name, medium, kind) in enumerate(names):
        seeds = ((options.seed, number, k) for k in range(options.pages))
        pages = [
            page(np.random.default_rng(seed), library, SIZE, True, medium, kind) for seed in seeds
        ]
        for way, provider in ways.items():
            figures = [judge(p, provider) for p in pages]
            everything[way] += figures
            table[way][name] = pooled(figures)
    for way in ways:
        table[way]["all"] = pooled(everything[way])
    print_table(table)
    if options.json:
        options.json.write_text(json.dumps(table, indent=1))


def judge(drawn: Array, provider: Callable[[Scan], LineMaps]) -> dict[str, Any]:
    """Counts of `metrics.page_figures` for one page, channels as sample.CHANNELS, uint8."""
    truth = drawn[1:].astype(np.float32) / 255
    ink = drawn[0].astype(np.float32) / 255
    seen = provider(Scan(ink, None, 1.0, ink.shape[::-1], measure_pen(ink) or 3.0))
    nothing = np.zeros_like(ink)
    half = _distance_to_paper(ink) if seen.half_width is None else seen.half_width
    others = [nothing if m is None else m for m in (seen.junctions, seen.endpoints)]
    maps = [seen.centerline, *others, half / HALF_WIDTH_UNIT, nothing]
    if seen.clean is not None:
        maps += [seen.doubled, seen.apart / HALF_WIDTH_UNIT, seen.clean]
    if seen.lifted is not None:
        maps.append(seen.lifted)
    return page_figures(np.stack(maps), truth)


def _distance_to_paper(ink: Array) -> Array:
    """Half-widths as the distance transform knows them, px; valid on the centerline."""
    dark = (ink > 0.5).astype(np.uint8)
    return cv2.distanceTransform(dark, cv2.DIST_L2, cv2.DIST_MASK_PRECISE) - 0.25


def print_table(table: dict[str, dict[str, dict[str, float]]]) -> None:
    """Markdown: one row for each medium and kind; the classical figure after the slash."""
    columns = list(table["network"]["all"])
    both = ("precision", "recall", "chamfer_px", "half_width_error_px")
    print("| medium | " + " | ".join(columns) + " |\n" + "|---" * (len(columns) + 1) + "|")
    for medium in table["network"]:
        mine, other = table["network"][medium], table["classical"][medium]
        cells = [
            f"{mine[c]:.3f} / {other[c]:.3f}" if c in both else f"{mine[c]:.3f}" for c in columns
        ]
        print(f"| {medium} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    main()
