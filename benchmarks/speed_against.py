"""This version's processor time against an older one's, page by page in turn: paired ratios.

    python -m benchmarks.speed_against OLD [--only NAME ...] [--repeat 2]

OLD is a checkout of another version (`git worktree add ../old COMMIT`). Both trace the same pages
in turn, each in a process of its own with one thread, so that what else the machine does hits both
alike; rounds are repeated, and the best of each counts. The pages:

    white pages     three of the benchmark, in OpenCV and, where it is installed, in ONNX Runtime
    A4              at 200 dpi, pens of 1.5 px; and the same in one bit, which is traced enlarged
    junctions       a dense scan, three times over; graph and routing, seconds for 3,000 of them
    sequence        12 frames of 1024 px, of which a quarter moves

Skeleton + greedy traces the white pages in the same rounds. Linux and macOS.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from involute.engine import runtimes

from .judged_pages import pages, picture
from .run_record import Figures
from .speed import drawn, page
from .tables import markdown

_ROOT = Path(__file__).resolve().parents[1]
_SCAN = _ROOT / "examples" / "max_und_moritz.jpg"  # 510 junctions
_A4 = 1654, 2339  # px at 200 dpi
_FRAMES, _SIDE = 12, 1024
_JUNCTIONS = 3000
_YARDSTICK = "skeleton + greedy"

# Run in either version: traces files, and tells seconds, stages and junctions of each.
_TRACE = """
import inspect, json, os, sys, time
import cv2
cv2.setNumThreads(1)
from involute.engine import vectorize
asked = json.load(sys.stdin)
more = {}
if asked["sequence"]:
    more["turn"] = False
    if "before" in inspect.signature(vectorize).parameters:
        from involute.engine.centerline.frame_before import FrameBefore
        more["before"] = FrameBefore()
vectorize(asked["warm"])
told = []
for path in asked["paths"]:
    began = {}
    tell = lambda stage, done: began.setdefault(stage, time.process_time())
    start = time.process_time()
    drawing = vectorize(path, progress=tell, **more)
    at = [*began.values(), time.process_time()]
    stages = {k: b - a for k, a, b in zip(began, at, at[1:])}
    told.append({"cpu": at[-1] - start, "stages": stages, "junctions": len(drawing.junctions)})
print(json.dumps(told))
"""


def cases(folder: Path) -> dict[str, list[Path]]:
    """Name of a case -> its pages, written into a folder."""
    import cv2

    def put(name: str, pixels: np.ndarray) -> Path:
        path = folder / f"{name}.png"
        cv2.imwrite(str(path), pixels)
        return path

    sheet = page("ordinary, thin", max(_A4))[:, : min(_A4)]
    bits = np.where(sheet < 128, 0, 255).astype(np.uint8)
    dense = np.vstack([picture(_SCAN)] * 3)
    return {
        "white pages": [p.image for p in pages() if p.paper == "white"][:3],
        "A4, 1.5 px": [put("a4", sheet)],
        "A4, one bit": [put("bits", bits)],
        "junctions": [put("dense", dense)],
        "sequence": [put(f"frame_{k:04d}", frame) for k, frame in enumerate(_frames())],
    }


def _frames() -> Iterator[np.ndarray]:
    """Pages of four drawings; the last one is moved from frame to frame."""
    held = [p.true_strokes() for p in pages()[:16:4]]
    grain = np.random.default_rng(1).normal(0, 2, (_SIDE, _SIDE))
    half = _SIDE / 2
    for number in range(_FRAMES):
        way = np.array([6 * number, 4 * np.sin(number)])
        moved = [line + way for line in held[3]]
        lines = [
            0.42 * line + np.array(corner) * half + 20
            for corner, strokes in zip(np.ndindex(2, 2), [*held[:3], moved], strict=True)
            for line in strokes
        ]
        frame = drawn(iter([lines]), 1.0, 3.0).astype(float) + grain
        yield np.clip(frame - 6, 0, 255).astype(np.uint8)


def traced(tree: Path, case: str, paths: Sequence[Path], runtime: str) -> list[dict[str, Any]]:
    """What a version tells of its traces, one entry a page."""
    with TemporaryDirectory() as folder:
        (Path(folder) / "involute").symlink_to(tree.resolve(), target_is_directory=True)
        environment = {**os.environ, "PYTHONPATH": folder, "OMP_NUM_THREADS": "1"}
        environment[runtimes.VARIABLE] = runtime
        asked = {
            "paths": [str(path) for path in paths],
            "sequence": case == "sequence",
            "warm": str(pages()[0].image),
        }
        done = subprocess.run(
            [sys.executable, "-c", _TRACE], input=json.dumps(asked), cwd=folder, env=environment,
            capture_output=True, text=True, check=True,
        )  # fmt: skip
    return list(json.loads(done.stdout.splitlines()[-1]))


def seconds(case: str, told: Sequence[Mapping[str, Any]]) -> float:
    """CPU seconds a page; for junctions, of graph and routing for 3,000 of them."""
    if case != "junctions":
        return float(np.mean([one["cpu"] for one in told]))
    (one,) = told
    both = one["stages"]["graph"] + one["stages"]["routing"]
    return float(both * _JUNCTIONS / max(1, one["junctions"]))


def _runtimes(case: str) -> Sequence[runtimes.Runtime]:
    """In what a case is traced: OpenCV, or whatever is fastest where the network does not count."""
    if case == "junctions":
        return runtimes.here()[:1]
    return runtimes.here() if case == "white pages" else runtimes.RUNTIMES[-1:]


def _yardstick(paths: Sequence[Path]) -> float:
    from .methods import METHODS

    METHODS[_YARDSTICK](paths[0])
    start = time.process_time()
    for path in paths:
        METHODS[_YARDSTICK](path)
    return (time.process_time() - start) / len(paths)


def main(argv: Sequence[str] | None = None) -> Figures:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.speed_against",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("old", type=Path, metavar="OLD", help="a checkout of another version")
    parser.add_argument("--only", nargs="+", metavar="CASE", help="only these cases")
    parser.add_argument("--repeat", type=int, default=2)
    options = parser.parse_args(argv)
    trees = {"old s": options.old, "new s": _ROOT}
    rows: dict[str, dict[str, float]] = {}

    def keep(row: str, column: str, value: float) -> None:
        known = rows.setdefault(row, {})
        known[column] = min(value, known.get(column, value))

    with TemporaryDirectory() as folder:
        for case, paths in cases(Path(folder)).items():
            if options.only and case not in options.only:
                continue
            for _ in range(options.repeat):
                for runtime in _runtimes(case):
                    row = f"{case}, {runtime.label}"
                    for column, tree in trees.items():
                        told = traced(tree, case, paths, runtime.name)
                        keep(row, column, seconds(case, told))
                        print(f"{row}, {column}: {rows[row][column]:.2f}", file=sys.stderr)
                    if case == "white pages":
                        keep(row, f"{_YARDSTICK} s", _yardstick(paths))
    for known in rows.values():
        known["old / new"] = known["old s"] / known["new s"]
        with suppress(KeyError):
            known[f"times {_YARDSTICK}"] = known["new s"] / known[f"{_YARDSTICK} s"]
            known[f"old, times {_YARDSTICK}"] = known["old s"] / known[f"{_YARDSTICK} s"]
    columns = list(dict.fromkeys(name for row in rows.values() for name in row))
    lines = [
        [name, *(f"{known[c]:.2f}" if c in known else "" for c in columns)]
        for name, known in rows.items()
    ]
    print(markdown(["CPU s a page, one thread", *columns], lines))
    return rows


if __name__ == "__main__":
    main()
