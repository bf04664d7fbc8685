"""How long a trace takes, stage by stage, and how much memory; and how both grow with the page.

    python -m benchmarks.speed [--sizes 512 1024 2048 4096] [--methods NAME ...] [--json FILE]

A page of N px is laid out of the white pages of the benchmark side by side, so that the ink grows
with the area, as it does in a larger drawing by the same hand. Every method and size runs in a
process of its own, once to warm up (that loads the networks) and then `--repeat` times; the median
counts. Memory is the peak of the process, less what it held before the trace. Where bpy is
installed, the times of `benchmarks.blender_costs` follow: writing, rerouting, the overlay.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from importlib.util import find_spec
from itertools import cycle
from multiprocessing import get_context
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from .judged_pages import DATA, pages
from .methods import METHODS
from .tables import markdown

SIZES = (512, 1024, 2048, 4096)
_CELL = 1024


@dataclass(frozen=True)
class Timing:
    """One method on one page: medians over the runs.

    cpu, wall: seconds; stages: wall seconds of each of our stages (no rival tells its own);
    first: wall seconds of the first trace in the process, imports and loading included;
    memory, base: MB, the peak above the base, and what the process held before.
    """

    method: str
    size: int
    cpu: float
    wall: float
    first: float
    stages: dict[str, float]
    memory: float
    base: float
    strokes: int


def page(size: int, folder: Path = DATA) -> np.ndarray:
    """A (size, size) uint8 page; the smaller ones are windows of the drawings."""
    import cv2

    white = [p for p in pages(folder) if p.paper == "white"]
    canvas = np.full((size, size), 255, np.uint8)
    cells = [(y, x) for y in range(0, size, _CELL) for x in range(0, size, _CELL)]
    for (y, x), drawing in zip(cells, cycle(white), strict=False):
        grey = cv2.imread(str(drawing.image), cv2.IMREAD_GRAYSCALE)
        side = min(size, _CELL)
        top, left = (max(0, (n - side) // 2) for n in grey.shape)
        part = grey[top : top + side, left : left + side]
        canvas[y : y + part.shape[0], x : x + part.shape[1]] = part
    return canvas


def measure(method: str, size: int, repeat: int, folder: Path = DATA) -> Timing:
    """Time one method on one page; meant for a fresh process."""
    import cv2

    with TemporaryDirectory() as temporary:
        path = Path(temporary) / "page.png"
        cv2.imwrite(str(path), page(512, folder))
        start = time.perf_counter()
        _trace(method, path)
        first = time.perf_counter() - start
        cv2.imwrite(str(path), page(size, folder))
        base = _resident()
        runs = []
        for _ in range(repeat):
            cpu, wall = time.process_time(), time.perf_counter()
            strokes, stages = _trace(method, path)
            runs.append((time.process_time() - cpu, time.perf_counter() - wall, stages))
    return Timing(
        method=method,
        size=size,
        cpu=float(np.median([run[0] for run in runs])),
        wall=float(np.median([run[1] for run in runs])),
        first=first,
        stages={k: float(np.median([run[2][k] for run in runs])) for k in runs[0][2]},
        memory=_peak() - base,
        base=base,
        strokes=strokes,
    )


def _trace(method: str, path: Path) -> tuple[int, dict[str, float]]:
    """The number of strokes, and the seconds of the stages where they are known."""
    if method != "involute":
        return len(METHODS[method](path)), {}
    from involute.engine import vectorize

    drawing = vectorize(path)
    return len(drawing.strokes), drawing.seconds


def _resident() -> float:
    """MB of memory in use; not a number where the system doesn't tell."""
    return _status("VmRSS")


def _peak() -> float:
    return _status("VmHWM")


def _status(key: str) -> float:
    try:
        lines = Path("/proc/self/status").read_text("ascii").splitlines()
    except OSError:
        return float("nan")
    return next(int(line.split()[1]) / 1024 for line in lines if line.startswith(key))


def growth(timings: list[Timing]) -> float:
    """The exponent e of time ~ pixels ** e over the sizes; 1 = linear in the area."""
    if len(timings) < 2:
        return float("nan")
    area = np.log([float(t.size) ** 2 for t in timings])
    return float(np.polyfit(area, np.log([t.cpu for t in timings]), 1)[0])


def report(timings: list[Timing]) -> str:
    """Markdown: our stages by size, then all methods by size."""
    methods = list(dict.fromkeys(t.method for t in timings))
    sizes = sorted({t.size for t in timings})
    at = {(t.method, t.size): t for t in timings}
    ours = [t for t in timings if t.stages]
    text = ""
    if ours:
        rows = [
            [str(t.size), *(f"{s:.2f}" for s in t.stages.values()), f"{t.wall:.2f}", f"{t.cpu:.2f}",
             f"{t.memory:.0f}", str(t.strokes)]
            for t in ours
        ]  # fmt: skip
        head = ["page px", *ours[0].stages, "wall s", "CPU s", "peak MB", "strokes"]
        text += "Seconds by stage\n\n" + markdown(head, rows)
        text += f"\n\nFirst trace of 512 px in a new process: {ours[0].first:.2f} s.\n\n"
    head = ["CPU s (times ours), MB", *(f"{size} px" for size in sizes), "growth"]
    rows = []
    for method in methods:
        row = [method]
        for size in sizes:
            t, own = at[method, size], at.get(("involute", size))
            ratio = f" ({t.cpu / own.cpu:.2f})" if own else ""
            row.append(f"{t.cpu:.2f}{ratio}, {t.memory:.0f}")
        rows.append([*row, f"area ^ {growth([at[method, s] for s in sizes]):.2f}"])
    return text + markdown(head, rows)


def _in_blender() -> str:
    from .blender_costs import report

    return report()


def main(argv: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.speed",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    default = ["involute", "skeleton + greedy", "nijiGPen's method", "autotrace"]
    parser.add_argument("--data", type=Path, default=DATA)
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES, metavar="PX")
    parser.add_argument("--methods", nargs="+", choices=METHODS, default=default, metavar="NAME")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--json", type=Path, help="write all figures to this file")
    options = parser.parse_args(argv)
    timings = []
    # A new process each, so that one peak of memory does not hide the next.
    with ProcessPoolExecutor(1, get_context("spawn"), max_tasks_per_child=1) as pool:
        for size in options.sizes:
            for method in options.methods:
                job = pool.submit(measure, method, size, options.repeat, options.data)
                timings.append(job.result())
                print(f"{method}, {size} px: {timings[-1].wall:.2f} s", file=sys.stderr)
    print(report(timings))
    if find_spec("bpy"):
        with ProcessPoolExecutor(1, get_context("spawn")) as pool:
            print("\nIn Blender\n\n" + pool.submit(_in_blender).result())
    if options.json:
        options.json.write_text(json.dumps([asdict(t) for t in timings], indent=1), "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
