"""What every limit of the graph stage is worth: halved and doubled, on held-out pages.

    python -m synthesis.held_out_pages --data DIR --out PAGES --pages 24 --seed 41
    python -m benchmarks.graph_limits --data PAGES [--every N] [--only NAME ...]

Each page is read and looked at by the centerline network once; then its graph is made with one
limit changed, routed by geometry, and judged against the true strokes as in `benchmarks.quality`.
The table goes to docs/graph-limits.md. Shares, degrees and percentiles move half the way to their
end instead of beyond it. Never run it on the benchmark's own pages: limits are not tuned on those.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from involute.engine import Settings
from involute.engine.centerline import provider_for
from involute.engine.fills.solids import split_solids
from involute.engine.graph import Evidence, traced
from involute.engine.graph.limits import MEASURED, Row, changed, table
from involute.engine.routing import route
from involute.engine.scan import read_scan

from .graph_stage import polylines
from .judged_pages import JudgedPage, pages
from .metrics import Score, evaluate, scaled, summarize
from .tables import markdown

Array = np.ndarray

OUT = Path(__file__).parents[1] / "docs" / "graph-limits.md"
_MOST = {"share": 1.0, "cosine": 1.0, "probability": 1.0, "degrees": 90.0, "percentile": 100.0}
_JUDGED = ("crossings", "branching", "precision", "f1")  # in per cent of what they are


def main(argv: Sequence[str] | None = None) -> None:
    """The command line; its figures are the table that it writes."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.graph_limits", description=__doc__.split("\n")[0]
    )
    parser.add_argument("--data", type=Path, required=True, help="folder of held-out pages")
    parser.add_argument("--every", type=int, default=1, help="only every n-th page")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME", help="only these limits")
    parser.add_argument("--out", type=Path, default=OUT)
    arguments = parser.parse_args(argv)
    cv2.setNumThreads(1)
    settings = Settings(provider="network", router="geometric")
    seen = [look(page, settings) for page in pages(arguments.data)[:: arguments.every]]
    base = judged(seen, settings)
    rows = []
    for one in table():
        if not arguments.only or one.name in arguments.only:
            rows.append([one.name, f"{one.value:g} {one.unit}", one.why])
            for value in (lower(one), higher(one)) if one.source == MEASURED else ():
                with changed(**{one.name: value}):
                    # What was computed from the ridges of a page holds for its limits only.
                    found = judged([(replace(e), s, t) for e, s, t in seen], settings)
                rows[-1].append(f"{value:g}: {difference(base, found)}")
            if one.source != MEASURED:
                rows[-1] += [one.source, ""]
            print(*rows[-1], sep=" | ", flush=True)
    head = f"{len(seen)} pages: " + ", ".join(f"{key} {base[key]:.3f}" for key in _JUDGED)
    text = markdown(["limit", "value", "what it is", "halved", "doubled"], rows)
    if not arguments.only:
        arguments.out.write_text(_document(head, text), "utf-8")


def look(page: JudgedPage, settings: Settings) -> tuple[Evidence, tuple[int, int], list[Array]]:
    """What is seen of a page, its size in working px, and its true strokes."""
    scan = read_scan(page.image, settings)
    lines, _ = split_solids(scan, settings)
    maps = provider_for(settings)(lines, lambda fraction: None)
    height, width = scan.ink.shape
    return Evidence.of(lines, maps), (width, height), page.true_strokes()


def judged(
    seen: Sequence[tuple[Evidence, tuple[int, int], list[Array]]], settings: Settings
) -> dict[str, float]:
    """The figures of all pages with the limits in force."""
    scores: list[Score] = []
    for evidence, size, truth in seen:
        strokes = polylines(*traced(evidence, settings, route))
        scores.append(evaluate(scaled(strokes, size), truth))
    return summarize(scores) | {"f1": float(np.mean([score.f1 for score in scores]))}


def lower(one: Row) -> float:
    """Half of a limit."""
    return type(one.value)(one.value / 2)


def higher(one: Row) -> float:
    """Twice a limit, or half the way to where its unit ends."""
    most = _MOST.get(one.unit)
    return type(one.value)(2 * one.value if most is None else (one.value + most) / 2)


def difference(base: dict[str, float], found: dict[str, float]) -> str:
    """Percentage points, for every figure that changes."""
    moved = {key: 100 * (found[key] - base[key]) for key in _JUDGED}
    said = [f"{key} {points:+.1f}" for key, points in moved.items() if abs(points) >= 0.05]
    return ", ".join(said) or "nothing"


def _document(head: str, text: str) -> str:
    return (
        "# The limits of the graph stage\n\n"
        "Made by `python -m benchmarks.graph_limits` on held-out pages (router: geometry), from\n"
        "`engine/graph/limits.py`. Behind each value stands what changes when it is halved and\n"
        "when it is doubled (or moved half the way to 1, to 90 degrees or to 100), in percentage\n"
        "points: crossings and branchings found, the share of the junctions that are true\n"
        "(precision), and the mean F1 of strokes.\n\n"
        f"{head}\n\n{text}\n"
    )


if __name__ == "__main__":
    main()
