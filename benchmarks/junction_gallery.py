"""Ten kinds of junctions and what the graph makes of them: writes docs/junctions.png.

    python -m benchmarks.junction_gallery [--out FILE]

Every tile: the ideal centerline with the graph on it; branches in their own colours with a dot per
point, junctions as red rings, ends as blue ones.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np
from involute.engine import Settings
from involute.engine.graph import Evidence, build_graph
from involute.engine.values import LineMaps, PlanarGraph

from .graph_stage import draw

Array = np.ndarray

_SIZE, _ZOOM, _COLUMNS = 60, 8, 4
_MIDDLE = np.array([30.3, 29.6])
_COLORS = ((120, 200, 90), (230, 160, 70), (90, 190, 230), (200, 120, 220), (150, 220, 210))


def main(argv: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.junction_gallery", description=__doc__.split("\n")[0]
    )
    docs = Path(__file__).parents[1] / "docs"
    parser.add_argument("--out", type=Path, default=docs / "junctions.png")
    tiles = [_tile(name, lines) for name, lines in kinds().items()]
    tiles += [np.full_like(tiles[0], 255)] * (-len(tiles) % _COLUMNS)
    rows = [np.hstack(tiles[i : i + _COLUMNS]) for i in range(0, len(tiles), _COLUMNS)]
    cv2.imwrite(str(parser.parse_args(argv).out), np.vstack(rows))


def kinds() -> dict[str, list[Array]]:
    """The strokes of each tile, px."""
    t = np.linspace(0, 1, 50)[:, None]
    turn = 2 * np.pi * t
    round_ = np.concatenate([np.cos(turn), np.sin(turn)], 1)
    bow = np.concatenate([np.sin(turn / 4 - 0.8), np.cos(turn / 4 - 0.8)], 1)
    arc = _MIDDLE + np.array([0, 18]) - 18 * bow
    return {
        "X, steep": [_ray(10, -26, 26), _ray(85, -26, 26)],
        "X, 14 degrees": [_ray(20, -28, 28), _ray(34, -28, 28)],
        "T": [_ray(8, -26, 26), _ray(75, 0, 26)],
        "Y": [_ray(d, 0, 26) for d in (30, 150, 265)],
        "K": [_ray(88, -26, 26), _ray(40, 0, 26), _ray(-35, 0, 26)],
        "star of 5": [_ray(d, 0, 26) for d in (10, 85, 150, 225, 300)],
        "star of 8": [_ray(d, -26, 26) for d in (5, 48, 95, 140)],
        "two close Ts": [_ray(0, -26, 26), _ray(90, 0, 24, (-3, 0)), _ray(-80, 0, 24, (3, 0))],
        "tangent merge": [_ray(0, -26, 26), arc],
        "parallels, 3 px apart": [_ray(25, -26, 26, (k, -2 * k)) for k in (-1.34, 0, 1.34)],
        "V tip": [_ray(80, 0, 44, (0, -22)), _ray(99, 0, 44, (0, -22))],
        "loops": [
            _MIDDLE - np.array([12, 0]) + 11 * round_,
            _MIDDLE + np.array([14, 6]) + 4 * round_,
        ],
    }


def _ray(degrees: float, start: float, stop: float, offset: Sequence[float] = (0, 0)) -> Array:
    way = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
    return _MIDDLE + offset + way * np.array([[start], [stop]])


def _tile(name: str, lines: list[Array]) -> Array:
    image = draw(lines, _SIZE)
    graph = build_graph(Evidence(LineMaps(image.astype(np.float32) / 255), 2.0), Settings())
    tile = cv2.resize(255 - image // 3, None, fx=_ZOOM, fy=_ZOOM, interpolation=cv2.INTER_NEAREST)
    tile = cv2.cvtColor(tile, cv2.COLOR_GRAY2BGR)
    _draw_graph(tile, graph)
    cv2.putText(tile, name, (10, 24), cv2.FONT_HERSHEY_SIMPLEX, 0.6, 0, 1, cv2.LINE_AA)
    return cv2.copyMakeBorder(tile, 2, 2, 2, 2, cv2.BORDER_CONSTANT, value=(255, 255, 255))


def _draw_graph(tile: Array, graph: PlanarGraph) -> None:
    def at(points: Array) -> Array:
        return np.rint((points * _ZOOM - 0.5) * 16).astype(np.int32).reshape(-1, 1, 2)

    for b in range(graph.branch_count):
        color = tuple(int(0.8 * c) for c in _COLORS[b % len(_COLORS)])
        cv2.polylines(tile, [at(graph.branch(b))], False, color, 2, cv2.LINE_AA, 4)
        for (point,) in at(graph.branch(b)).tolist():
            cv2.circle(tile, point, 40, color, -1, cv2.LINE_AA, 4)
    for (point,), degree in zip(at(graph.vertices).tolist(), graph.degrees, strict=True):
        color, radius = ((40, 40, 230), 9) if degree > 2 else ((230, 120, 30), 6)
        cv2.circle(tile, point, radius * 16, color, 2, cv2.LINE_AA, 4)


if __name__ == "__main__":
    main()
