"""Fit the weights of `engine/routing/geometric.py` to the true strokes of drawings.

    python -m training run traced --data FOLDER --out traced.npz --pages 110
    python -m training run traced --data FOLDER --out held.npz --pages 40 --held-out
    python -m training run routing-geometric --data FOLDER --traced traced.npz \\
        --traced-held-out held.npz

The weights maximise the likelihood of the true involution of every junction among all involutions
of its half-branches (a log-linear model, so that the optimum is unique). The examples are perfect
graphs, the same roughened a little, and pages that were really traced. Prints the table for
`geometric.py`, and how often junctions and pairs of held-out drawings come out right. Takes about
two minutes.
"""

from __future__ import annotations

import argparse
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from involute.engine.involution import pair_matrix
from involute.engine.routing.candidates import by_degree, candidate_pairs, pair_starts
from involute.engine.routing.features import FEATURES, pair_features
from involute.engine.values import PlanarGraph
from involute.synthesis.library import DrawingSet, read_sets
from involute.synthesis.true_graph import graph_from_strokes
from scipy.optimize import minimize

from . import traced

Array = np.ndarray
# Per number of half-branches: features (n, P, F), the true involution (n,), weight (n,).
Examples = dict[int, tuple[Array, Array, Array]]

# Drawings taken from each set, and how much the set counts.
SETS = {
    "openclipart": (220, 4.0),
    "streamline": (400, 3.0),
    "quickdraw_raw": (1200, 3.0),
    "quickdraw_simplified": (200, 1.0),
    "excalidraw": (300, 2.0),
    "openmoji": (250, 2.0),
    "kanjivg": (100, 1.0),
    "arcticons": (200, 1.0),
    "icons_permissive": (150, 0.5),
    "fishdraw": (6, 0.3),
}
TRACED = 8.0  # how much traced pages count
PEN = (1.7, 5.0)  # px
MAX_DEGREE = 8
MOST_JUNCTIONS = 120  # of one drawing that count fully
RIDGE = 1e-4
# True strokes know no ink: chosen by hand, mild for width and strength, strict for another ink.
GIVEN = {"width": -1.5, "strength": -1.0, "tint": -6.0}


def drawings(drawn: DrawingSet, count: int) -> Iterator[tuple[bool, list[Array]]]:
    """The first drawings of a set: whether it is held out, and its (N, 2) strokes in px."""
    for number in range(min(count, len(drawn))):
        yield bool(drawn.held_out[number]), drawn.strokes(number)


def roughened(graph: PlanarGraph, rng: np.random.Generator) -> PlanarGraph:
    """The graph as a tracer might have found it: vertices and lines a little off."""
    pen = float(np.median(graph.widths))
    moved = rng.normal(0, 0.12 * pen, graph.vertices.shape) * (graph.degrees >= 3)[:, None]
    vertices = (graph.vertices + moved).astype(np.float32)
    step = np.hypot(*np.diff(graph.points, axis=0, prepend=graph.points[:1]).T)
    key = np.cumsum(step) / (1.5 * pen)
    knots = np.arange(int(key[-1]) + 2)
    noise = rng.normal(0, 0.08 * pen, (len(knots), 2))
    wobble = np.stack([np.interp(key, knots, noise[:, c]) for c in (0, 1)], 1)
    points = (graph.points + wobble).astype(np.float32)
    points[graph.offsets[:-1]] = vertices[graph.ends[:, 0]]
    points[graph.offsets[1:] - 1] = vertices[graph.ends[:, 1]]
    return replace(graph, vertices=vertices, points=points)


def examples(
    data: Path, traced_pages: Path | None, traced_held_out: Path | None, rng: np.random.Generator
) -> tuple[Examples, dict[str, Examples]]:
    """Examples for fitting, and for judging those of each set."""
    fit: dict[int, list] = defaultdict(list)
    judge: dict[str, Examples] = {}
    for name, drawn in read_sets(data, SETS).items():
        count, share = SETS[name]
        held: dict[int, list] = defaultdict(list)
        learnt: dict[int, list] = defaultdict(list)
        for held_out, strokes in drawings(drawn, count):
            pen = float(np.exp(rng.uniform(*np.log(PEN))))
            graph, partner = graph_from_strokes(
                strokes, merge=max(1.0, 0.35 * pen), widths=[pen] * len(strokes)
            )
            if not 0 < len(graph.junctions) <= 1500:
                continue
            if held_out:
                _collect(held, graph, partner)
            else:
                _collect(learnt, graph, partner)
                _collect(learnt, roughened(graph, rng), partner)
        _add(fit, learnt, share)
        judge[name] = _joined(held)
        print(f"{name}: {sum(len(v[1]) for v in judge[name].values())} junctions held out")
    if traced_pages:
        _add(fit, _traced(traced_pages), TRACED)
    if traced_held_out:
        judge["traced"] = _joined(_traced(traced_held_out))
    return _joined(fit), judge


def _traced(path: Path) -> dict[int, list]:
    """Examples of the pages in a file by `traced`."""
    found: dict[int, list] = defaultdict(list)
    for page in traced.load(path):
        if len(page.graph.junctions):
            _collect(found, page.graph, page.partner)
    return found


def _add(fit: dict[int, list], learnt: dict[int, list], share: float) -> None:
    """Add a set to the examples, weighted so that all of it counts `share`."""
    total = sum(weight.sum() for parts in learnt.values() for *_, weight in parts)
    for degree, parts in learnt.items():
        fit[degree] += [(x, y, w * share / total) for x, y, w in parts]


def _collect(into: dict[int, list], graph: PlanarGraph, partner: Array) -> None:
    pairs, starts = candidate_pairs(graph), pair_starts(graph)
    features = pair_features(graph, pairs)
    joined = partner[pairs[:, 0]] == pairs[:, 1]
    weight = min(1.0, MOST_JUNCTIONS / len(graph.junctions))
    for junctions, halves in by_degree(graph):
        degree = halves.shape[1]
        if degree > MAX_DEGREE:
            continue
        rows = starts[junctions][:, None] + np.arange(degree * (degree - 1) // 2)
        # Each set of pairs is a binary number, by which the true involution is found.
        digit = 2.0 ** np.arange(rows.shape[1])
        code = pair_matrix(degree).astype(np.float64) @ digit
        order = np.argsort(code)
        truth = order[np.searchsorted(code[order], joined[rows] @ digit)]
        into[degree].append((features[rows], truth, np.full(len(junctions), weight)))


def _joined(parts: dict[int, list]) -> Examples:
    return {d: tuple(np.concatenate(z) for z in zip(*v, strict=True)) for d, v in parts.items()}


def fit(data: Examples) -> Array:
    """(F,) weights of greatest likelihood, with a slight pull towards 0."""
    free = np.array([name not in GIVEN for name in FEATURES])
    flat = np.concatenate([x.reshape(-1, x.shape[-1])[:, free] for x, _, _ in data.values()])
    scale = np.maximum(flat.std(0), 1e-3)
    scale[flat.std(0) < 1e-9] = 1.0
    scaled = {d: (x[..., free] / scale, y, w) for d, (x, y, w) in data.items()}
    total = sum(w.sum() for _, _, w in data.values())

    def loss(theta: Array) -> tuple[float, Array]:
        value, slope = RIDGE * theta @ theta, 2 * RIDGE * theta
        for degree, (x, truth, weight) in scaled.items():
            ways = pair_matrix(degree).astype(np.float64)
            sums = (x @ theta) @ ways.T
            sums -= sums.max(1, keepdims=True)
            share = np.exp(sums)
            norm = share.sum(1, keepdims=True)
            value -= weight @ (sums[np.arange(len(truth)), truth] - np.log(norm[:, 0])) / total
            miss = ways[truth] - (share / norm) @ ways
            slope = slope - np.einsum("n,np,npf->f", weight, miss, x) / total
        return value, slope

    found = minimize(loss, np.zeros(free.sum()), jac=True, method="L-BFGS-B")
    weights = np.array([GIVEN.get(name, 0.0) for name in FEATURES])
    weights[free] = found.x / scale
    return weights


def report(name: str, data: Examples, weights: Array) -> None:
    """How often the junctions and pairs of one set come out right."""
    junctions = right = made = true = hit = 0
    for degree, (x, truth, _) in data.items():
        ways = pair_matrix(degree)
        best = ((x @ weights) @ ways.T).argmax(1)
        junctions, right = junctions + len(truth), right + int((best == truth).sum())
        made, true = made + ways[best].sum(), true + ways[truth].sum()
        hit += (ways[best] * ways[truth]).sum()
    print(
        f"{name:22}{junctions:6} junctions, {right / junctions:.3f} right; "
        f"pairs {hit / true:.3f} found, {1 - hit / made:.3f} of those made are wrong"
    )


def main(argv: Sequence[str] | None = None) -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--data", type=Path, required=True, help="folder with the .npz sets")
    parser.add_argument("--traced", type=Path, help="pages that traced.py made")
    parser.add_argument("--traced-held-out", type=Path, help="the same with its --held-out")
    parser.add_argument("--seed", type=int, default=0)
    args = parser.parse_args(argv)
    learnt, judged = examples(
        args.data, args.traced, args.traced_held_out, np.random.default_rng(args.seed)
    )
    weights = fit(learnt)
    for name, data in judged.items():
        report(name, data, weights)
    print("WEIGHTS = {")
    for name, weight in zip(FEATURES, weights, strict=True):
        print(f'    "{name}": {weight:.2f},')
    print("}")


if __name__ == "__main__":
    main()
