"""How many points curves save: `python -m benchmarks.curve_points`.

Every page of the benchmark is traced once; its lines are then written as polylines and as Bezier
curves that stray at most `--tolerance` px from them. Both also keep points where the ink changes,
curves with twice the tolerance of that; "no ink" leaves these out. The ends, corners and junctions
of a stroke are points in any case; the last row has only these.
The errors are measured: the distance of every sample of the line from what was written.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import shapely
from involute.engine import Drawing, Settings, Stroke, vectorize
from involute.engine.strokes import Page, build, walk

from .judged_pages import DATA, pages
from .run_record import Figures
from .tables import markdown

Array = np.ndarray


def main(argv: Sequence[str] | None = None) -> Figures:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.curve_points",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--data", type=Path, default=DATA)
    parser.add_argument("--tolerance", type=float, default=0.5, metavar="PX")
    parser.add_argument("--limit", type=int, help="only so many pages")
    options = parser.parse_args(argv)
    exact = Settings(tolerance=0.0)
    polyline = replace(exact, tolerance=options.tolerance)
    bezier = replace(polyline, curve="bezier")
    kinds = {
        "polyline": (polyline, True),
        "Bezier": (bezier, True),
        "polyline, no ink": (polyline, False),
        "Bezier, no ink": (bezier, False),
        "ends, corners, junctions": (replace(polyline, tolerance=50.0), False),
    }
    points = dict.fromkeys(kinds, 0)
    errors: dict[str, list[Array]] = {name: [] for name in kinds}
    count = 0
    for page in pages(options.data)[: options.limit]:
        drawing = vectorize(page.image, exact)
        lines = drawing.strokes
        count += len(lines)
        for name, (settings, ink) in kinds.items():
            strokes = written(drawing, settings, ink)
            points[name] += sum(len(stroke.points) for stroke in strokes)
            errors[name].append(away(lines, strokes))
    figures = {}
    for name, total in points.items():
        error = np.concatenate(errors[name])
        figures[name] = {
            "points a stroke": total / count,
            "fewer": points["polyline"] / total,
            "RMS px": float(np.sqrt(np.mean(error**2))),
            "greatest px": float(error.max()),
        }
    forms = "{:.2f}", "{:.2f}", "{:.3f}", "{:.2f}"
    rows = [
        [name, *(form.format(v) for form, v in zip(forms, own.values(), strict=True))]
        for name, own in figures.items()
    ]
    print(f"{count} strokes, tolerance {options.tolerance:g} px\n")
    print(markdown(["written as", "points a stroke", "fewer", "RMS px", "greatest px"], rows))
    return figures


def written(drawing: Drawing, settings: Settings, ink: bool) -> list[Stroke]:
    """The strokes of a drawing with other settings; without ink, its lines are even and opaque."""
    graph = drawing.graph
    if not ink:
        assert graph.widths is not None, "a drawing's graph is measured"
        even = np.full_like(graph.widths, np.median(graph.widths)) if len(graph.widths) else None
        graph = replace(graph, widths=even, strength=None)
    return build(Page.of(graph, settings), walk(drawing.routing.partner))


def away(lines: Sequence[Stroke], strokes: Sequence[Stroke]) -> Array:
    """How far each sample of the lines lies from what was written, px."""
    found = [np.zeros(0)]
    for line, stroke in zip(lines, strokes, strict=True):
        shape = shapely.LineString(dense(stroke))
        found.append(shapely.distance(shapely.points(line.points), shape))
    return np.concatenate(found)


def dense(stroke: Stroke) -> Array:
    """A stroke as a polyline so fine that its own error does not count, (N, 2)."""
    points, handles = stroke.points.astype(float), stroke.handles
    if stroke.closed:
        points = np.vstack([points, points[:1]])
    if handles is None:
        return points
    leaving = handles[: len(points) - 1, 1]
    arriving = np.roll(handles, -1, axis=0)[: len(points) - 1, 0]
    t = np.linspace(0, 1, 129)[1:, None, None]
    curve = (1 - t) ** 3 * points[:-1] + t**3 * points[1:]
    curve += 3 * t * (1 - t) * ((1 - t) * leaving + t * arriving)
    return np.vstack([points[:1], curve.swapaxes(0, 1).reshape(-1, 2)])


if __name__ == "__main__":
    main()
