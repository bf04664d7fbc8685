"""Routing alone, on perfect graphs: `python -m benchmarks.true_graphs [--data DIR]`.

The true strokes of the benchmark are cut where they meet, so that every junction is where it
should be, and the scorers are asked which half-branches were one stroke. Prints a table: pairs
found and pairs wrongly made, all junctions and the hard ones, how honest the probabilities are,
what correcting the most doubtful junctions would bring, what fixing some junctions does for the
others, and times.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from involute.engine.involution import MAX_LISTED_DEGREE
from involute.engine.routing import geometric, network
from involute.engine.routing.candidates import candidate_pairs
from involute.engine.routing.encoding import along
from involute.engine.values import Pair, PlanarGraph
from involute.synthesis.true_graph import graph_from_strokes
from involute.training.routing.judge import Verdict, judge, tables

from .judged_pages import DATA, pages
from .run_record import Figures

Array = np.ndarray
Truth = tuple[PlanarGraph, Array]
Fixed = dict[int, tuple[Pair, ...]]
Scorer = Callable[[PlanarGraph, Array, Fixed], Array]

SCORERS: dict[str, Scorer] = {
    "geometric": lambda graph, pairs, fixed: geometric.score(graph, pairs),
    "network": network.score,
}
_SHALLOW = 30.0  # degrees between two half-branches
_CROWDED = 8.0  # px between two junctions


def main(argv: Sequence[str] | None = None) -> Figures:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, default=DATA, help="folder with a manifest.json")
    args = parser.parse_args(argv)
    truths = [graph_from_strokes(page.true_strokes()) for page in pages(args.data)]
    truths = [(graph, partner) for graph, partner in truths if len(graph.junctions)]
    print(f"{len(truths)} drawings, perfect graphs\n")
    scorers = {name: s for name, s in SCORERS.items() if name != "network" or network.available()}
    figures = {name: judged(truths, scorer) for name, scorer in scorers.items()}
    print(report(figures))
    print(speed(truths, scorers))
    return figures


def judged(truths: Sequence[Truth], scorer: Scorer) -> dict[str, float]:
    """All figures of a scorer."""
    tough = np.concatenate([hard(graph) for graph, _ in truths])
    verdict = decided(truths, scorer)
    every, some = verdict.summary(), verdict.summary(tough)
    figures = {
        "junctions": every["junctions"],
        "pairs found": every["pairs_right"],
        "pairs made that are wrong": every["pairs_wrong"],
        "junctions wholly right": every["junctions_right"],
        "strokes made per true stroke": _stroke_ratio(truths, verdict),
        "hard junctions": some["junctions"],
        "hard: pairs found": some["pairs_right"],
        "hard: pairs made that are wrong": some["pairs_wrong"],
        "hard: junctions wholly right": some["junctions_right"],
        "expected calibration error": every["calibration_error"],
        "truth among the two best": every["top2"],
        "errors at the 10 % most doubtful": every["doubt_removes"],
    }
    for share in (0.1, 0.3):
        alone, told = asked_again(truths, scorer, share)
        figures[f"{share:.0%} fixed: errors at the others, before"] = alone
        figures[f"{share:.0%} fixed: errors at the others, asked again"] = told
    return figures


def report(columns: Figures) -> str:
    """The figures of every scorer as a Markdown table."""
    lines = ["| | " + " | ".join(columns) + " |", "|---" * (len(columns) + 1) + "|"]
    for row in next(iter(columns.values())):
        values = [columns[name][row] for name in columns]
        cells = [f"{v:.3f}" if isinstance(v, float) else str(v) for v in values]
        lines.append(f"| {row} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def decided(truths: Sequence[Truth], scorer: Scorer) -> Verdict:
    """How a scorer decides all junctions of all drawings."""
    parts = []
    for graph, partner in truths:
        pairs = candidate_pairs(graph)
        parts.append(judge(*tables(graph, pairs, scorer(graph, pairs, {}), partner)))
    return Verdict.joined(parts)


def asked_again(truths: Sequence[Truth], scorer: Scorer, share: float) -> tuple[float, float]:
    """Errors per junction at the junctions that are not fixed, without and with the fixed ones."""
    rng = np.random.default_rng(0)
    before: list[Array] = []
    after: list[Array] = []
    for graph, partner in truths:
        pairs = candidate_pairs(graph)
        listed = np.flatnonzero(graph.degrees[graph.junctions] <= MAX_LISTED_DEGREE)
        fixed = {
            int(j): _true_pairs(graph, partner, int(j)) for j in listed if rng.random() < share
        }
        free = ~np.isin(listed, list(fixed))
        for known, errors in (({}, before), (fixed, after)):
            verdict = judge(*tables(graph, pairs, scorer(graph, pairs, known), partner))
            errors.append(verdict.errors[free])
    return float(np.concatenate(before).mean()), float(np.concatenate(after).mean())


def _true_pairs(graph: PlanarGraph, partner: Array, junction: int) -> tuple[Pair, ...]:
    halves = graph.halves_of(int(graph.junctions[junction]))
    return tuple((int(h), int(partner[h])) for h in halves if h < partner[h])


def _stroke_ratio(truths: Sequence[Truth], verdict: Verdict) -> float:
    """A stroke is a branch less one for every join: made over true, all drawings together."""
    branches = sum(graph.branch_count for graph, _ in truths)
    return float((branches - verdict.made.sum()) / (branches - verdict.true.sum()))


def hard(graph: PlanarGraph) -> Array:
    """Which junctions are hard: shallow or tangent, of degree five or more, or close to another.

    Junctions with more half-branches than involutions are listed for are left out, as in `tables`.
    """
    length = along(graph, np.array([np.inf]))[1]
    ahead = along(graph, np.minimum(_CROWDED, length)[:, None])[0][:, 0]
    angle = np.degrees(np.angle(ahead))
    found = []
    for vertex in graph.junctions:
        halves = graph.halves_of(int(vertex))
        if len(halves) > MAX_LISTED_DEGREE:
            continue
        around = np.sort(angle[halves])
        gap = np.diff(around, append=around[0] + 360)
        far = graph.half_vertex[halves ^ 1]
        crowded = (length[halves] < _CROWDED) & (graph.degrees[far] >= 3) & (far != vertex)
        found.append(len(halves) >= 5 or gap.min() < _SHALLOW or crowded.any())
    return np.array(found, bool)


def speed(truths: Sequence[Truth], scorers: dict[str, Scorer]) -> str:
    """CPU and wall seconds for pages of two sizes; the first run of each scorer is not counted."""
    lines = ["| seconds (CPU / wall) | " + " | ".join(scorers) + " |"]
    lines.append("|---" * (len(scorers) + 1) + "|")
    for size in (600, 5000):
        graph = crowd(truths, size)
        pairs = candidate_pairs(graph)
        cells = []
        for scorer in scorers.values():
            scorer(graph, pairs, {})
            cpu, wall = time.process_time(), time.perf_counter()
            scorer(graph, pairs, {})
            cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
            cells.append(f"{cpu:.3f} / {wall:.3f}")
        lines.append(f"| {2 * graph.branch_count} half-branches | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def crowd(truths: Sequence[Truth], halves: int) -> PlanarGraph:
    """Drawings side by side, over and over, until a page has so many half-branches."""
    graphs: list[PlanarGraph] = []
    count = 0
    while count < halves:
        graphs.append(truths[len(graphs) % len(truths)][0])
        count += 2 * graphs[-1].branch_count
    moved = [np.array([1100 * k, 0], np.float32) for k in range(len(graphs))]
    vertex = np.cumsum([0] + [len(g.vertices) for g in graphs])
    point = np.cumsum([0] + [len(g.points) for g in graphs])
    together = list(zip(graphs, moved, vertex, point, strict=False))
    return PlanarGraph(
        np.concatenate([g.vertices + m for g, m, _, _ in together]),
        np.concatenate([g.points + m for g, m, _, _ in together]),
        np.concatenate([[0], *(g.offsets[1:] + p for g, _, _, p in together)]).astype(np.int32),
        np.concatenate([g.ends + v for g, _, v, _ in together]).astype(np.int32),
    )


if __name__ == "__main__":
    main()
