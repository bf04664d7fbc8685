"""The graph stage alone: behind perfect centerlines, and against a plain skeleton.

    python -m benchmarks.graph_stage [--cases DIR]           the case images there: u12, t40 ...
    python -m benchmarks.graph_stage --ideal [--data DIR]    the benchmark's true strokes, 1 px wide
    python -m benchmarks.graph_stage --stage [--data DIR]    scans: our graph, a skeleton's, from
                                                       the network's centerline

`--without NAME` leaves out a pass of the graph stage, to see what it brings; `--passes` lists them.

Lines are paired by geometry only. A case is NAME.png, white lines on black, with its truth in
NAME.svg; one without truth is only timed. Seconds are CPU seconds of one core, best of three;
memory is the growth of the peak of the process. Crossings, Chamfer, F1: see `metrics`. `dense` is
the Chamfer distance on points 0.1 px apart: points 1 px apart, as `metrics` has them, are 0.25 px
off on average even where two lines are the same.
"""

from __future__ import annotations

import argparse
import resource
import time
from collections.abc import Collection, Iterable, Sequence
from pathlib import Path

import cv2
import numpy as np
from involute.engine import Settings
from involute.engine.arrays.ragged import along, arc, offsets_of
from involute.engine.centerline import provider_for
from involute.engine.fills.solids import split_solids
from involute.engine.graph import PASSES, Evidence, routed, run_passes
from involute.engine.graph.passes import MEASURED, ROUTED
from involute.engine.graph.topology import join
from involute.engine.routing import route
from involute.engine.scan import read_scan
from involute.engine.strokes.walk import walk
from involute.engine.values import LineMaps, PlanarGraph, Routing
from scipy.spatial import cKDTree

from .judged_pages import DATA, JudgedPage, pages, picture
from .metrics import LONG_SIDE, Score, evaluate, read_svg, scaled, summarize
from .rivals.plain_skeleton import pieces
from .run_record import Figures
from .tables import markdown

Array = np.ndarray

SETTINGS = Settings(router="geometric")
_HEAD = [
    "case",
    "found",
    "precision",
    "3+ found",
    "Chamfer",
    "dense",
    "length",
    "F1",
    "CPU s",
    "MB",
]


def main(argv: Sequence[str] | None = None) -> Figures:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.graph_stage", description=__doc__.split("\n")[0]
    )
    parser.add_argument("--cases", type=Path, help="folder of centerline images, some with truth")
    parser.add_argument("--ideal", action="store_true", help="draw the benchmark's truth")
    parser.add_argument("--stage", action="store_true", help="against a plain skeleton")
    parser.add_argument("--data", type=Path, default=DATA, help="folder with a manifest.json")
    parser.add_argument("--every", type=int, default=1, help="only every n-th drawing")
    parser.add_argument("--without", action="append", default=[], metavar="NAME", help="of a pass")
    parser.add_argument("--passes", action="store_true", help="list the passes, and stop")
    arguments = parser.parse_args(argv)
    if arguments.passes:
        print(pass_table())
        return {}
    without = arguments.without
    cv2.setNumThreads(1)
    rows = []
    if arguments.cases:
        for path in sorted(arguments.cases.glob("*.png")):
            image = picture(path)
            truth = path.with_suffix(".svg")
            rows.append(
                _row(path.stem, [(image, read_svg(truth) if truth.exists() else None)], without)
            )
    if arguments.ideal:
        drawings = pages(arguments.data)[:: arguments.every]
        truths = [page.true_strokes() for page in drawings]
        rows.append(_row(f"ideal, {len(truths)} drawings", [(draw(t), t) for t in truths], without))
    if rows:
        print(markdown(_HEAD, rows), "\n")
    figures = {row[0]: _numbers(row[1:]) for row in rows}
    if arguments.stage:
        head, rows = stage(pages(arguments.data)[:: arguments.every], without)
        print(markdown(head, rows))
        return figures | {row[0]: _numbers(row[1:], head[1:]) for row in rows}
    told, times = growth()
    print(told)
    return figures | {"growth": {"times for 16 times the area": times}}


def _numbers(cells: Sequence[str], names: Sequence[str] = _HEAD[1:]) -> dict[str, float]:
    return {name: float(c.rstrip(" %")) for name, c in zip(names, cells, strict=True) if c}


def pass_table() -> str:
    """Every pass with what it does, reads and promises, in the order in which they run."""
    rows = []
    for one in PASSES:
        lines = [line.strip() for line in (one.run.__doc__ or "").splitlines()]
        said = [line for line in lines if line.startswith(("Reads:", "Promises:"))]
        rows.append([one.name, lines[0], *(line.split(": ", 1)[1] for line in said)])
    return markdown(["pass", "does", "reads", "promises"], rows)


def _row(
    name: str, cases: Iterable[tuple[Array, list[Array] | None]], without: Collection[str]
) -> list[str]:
    """One line of the table: counts pooled, distances as medians over the cases."""
    scores: list[Score] = []
    dense, length, seconds = [], [], []
    before = _peak()
    for image, truth in cases:
        took, graph = timed(image, without)
        seconds.append(took)
        if truth is None:
            continue
        strokes = scaled(polylines(graph, route(graph, SETTINGS)), _size(image))
        scores.append(evaluate(strokes, truth))
        dense.append(dense_chamfer(strokes, truth))
        length.append(abs(scores[-1].length / max(scores[-1].true_length, 1e-9) - 1))
    cost = [f"{np.median(seconds):.3f}", f"{_peak() - before:.0f}"]
    if not scores:
        return [name, *[""] * 7, *cost]

    def pooled(part: str, whole: str) -> str:
        values = [getattr(s, part) for s in scores]
        total = sum(v[0] if isinstance(v, tuple) else v for v in values)
        return f"{total / max(1, sum(getattr(s, whole) for s in scores)):.3f}"

    return [
        name,
        pooled("crossings_found", "true_crossings"),
        pooled("crossings_found", "crossings"),
        pooled("branching_found", "true_branching"),
        f"{np.median([s.chamfer for s in scores]):.3f}",
        f"{np.median(dense):.3f}",
        f"{100 * np.median(length):.2f} %",
        f"{np.median([s.f1 for s in scores]):.2f}",
        *cost,
    ]


def timed(image: Array, without: Collection[str] = ()) -> tuple[float, PlanarGraph]:
    """CPU seconds, best of three, and the graph of an 8-bit centerline image."""
    maps = LineMaps(image.astype(np.float32) / 255)
    seconds: list[float] = []
    for _ in range(3):
        start = time.process_time()
        graph = run_passes(Evidence(maps, 2.0), SETTINGS, until=MEASURED, without=without)
        seconds.append(time.process_time() - start)
    return min(seconds), graph


def stage(
    drawings: Sequence[JudgedPage], without: Collection[str] = ()
) -> tuple[list[str], list[list[str]]]:
    """What the graph stage brings: all else is the same, the network's centerline included."""
    settings = Settings(provider="network", router="geometric")
    scores: dict[str, list[Score]] = {"plain skeleton": [], "graph stage": []}
    for page in drawings:
        scan = read_scan(page.image, settings)
        lines, _ = split_solids(scan, settings)
        maps = provider_for(settings)(lines, lambda fraction: None)
        evidence = Evidence.of(lines, maps)
        ours = run_passes(evidence, settings, until=MEASURED, without=without)
        graphs = skeleton_graph(maps), ours
        truth = page.true_strokes()
        for own, graph in zip(scores.values(), graphs, strict=True):
            graph = run_passes(
                evidence, settings, graph, start=MEASURED, until=ROUTED, without=without
            )
            strokes = polylines(*routed(graph, evidence, settings, route, without))
            own.append(evaluate(scaled(strokes, _size(scan.ink)), truth))
    figures = {"crossings": "found", "branching": "3+ found", "precision": "precision"}
    figures |= {"chamfer": "Chamfer", "density": "r_SD", "f1": "F1"}
    rows = []
    for name, own in scores.items():
        summary = summarize(own)
        rows.append([name, *(f"{summary[key]:.3f}" for key in figures)])
    return [f"{len(drawings)} drawings", *figures.values()], rows


def skeleton_graph(maps: LineMaps) -> PlanarGraph:
    """The pieces of the thinned centerline above one half as they are, px."""
    mask = (maps.centerline > 0.5).astype(np.uint8) * 255
    found = pieces(cv2.ximgproc.thinning(mask, thinningType=cv2.ximgproc.THINNING_ZHANGSUEN) > 0)
    if not found.paths:
        return PlanarGraph.empty()
    used, ends = np.unique(found.ends, return_inverse=True)
    graph = PlanarGraph(
        found.nodes[used].astype(np.float32),
        np.concatenate(found.paths).astype(np.float32),
        offsets_of([len(path) for path in found.paths]).astype(np.int32),
        ends.reshape(-1, 2).astype(np.int32),
    )
    return join(graph)


def polylines(graph: PlanarGraph, routing: Routing) -> list[Array]:
    """The strokes of a routed graph, with all its points."""
    strokes = []
    for halves, *_ in walk(routing.partner):
        parts = [graph.half_branch(int(h)) for h in halves]
        strokes.append(np.concatenate([parts[0], *(p[1:] for p in parts[1:])]))
    return strokes


def _size(image: Array) -> tuple[float, float]:
    height, width = image.shape
    return width, height


def draw(strokes: Sequence[Array], side: int = int(LONG_SIDE), scale: int = 8) -> Array:
    """Polylines 1 px wide with exact coverage, white on black, (side, side) uint8."""
    big = np.zeros((side * scale, side * scale), np.uint8)
    for line in strokes:
        fixed = np.rint((np.asarray(line) * scale - 0.5) * 16).astype(np.int32)
        cv2.polylines(big, [fixed.reshape(-1, 1, 2)], False, 255, scale, cv2.LINE_8, 4)
    return cv2.resize(big, (side, side), interpolation=cv2.INTER_AREA)


def dense_chamfer(one: Sequence[Array], two: Sequence[Array]) -> float:
    """Mean distance between two sets of polylines, both ways, on points 0.1 px apart."""
    if not one or not two:
        return float("inf")
    a, b = (np.concatenate([_dense(line) for line in lines]) for lines in (one, two))
    there, back = cKDTree(b).query(a[::5])[0].mean(), cKDTree(a).query(b[::5])[0].mean()
    return float(there + back) / 2


def _dense(line: Array) -> Array:
    whole = arc(line)[-1]
    return along(line, np.linspace(0, whole, max(2, int(10 * whole))))


def growth() -> tuple[str, float]:
    """How the time grows with the page: 16 times the area with 16 times the lines."""
    rng = np.random.default_rng(5)
    t = np.linspace(0, 1, 60)[:, None]
    corner = rng.uniform(10, 500, (20, 4, 2))
    weight = np.concatenate([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3], 1)
    tile = draw([weight @ c for c in corner], 512)
    small, large = timed(tile)[0], timed(np.tile(tile, (4, 4)))[0]
    times = large / small
    told = f"512 px, 20 lines: {small:.3f} s; 2048 px, 320 lines: {large:.3f} s ({times:.1f} x)"
    return told, times


def _peak() -> float:
    """Peak memory of the process so far, MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


if __name__ == "__main__":
    main()
