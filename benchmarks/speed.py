"""How long a trace takes, by page and by stage, how much memory, and how both grow with the page.

    python -m benchmarks.speed [--pages scan] [--sizes 512 1024 2048 4096] [--largest] [--fast]
                               [--methods NAME ...] [--repeat 3] [--json FILE]

A page of N px is laid out of cells of 1024 px side by side, so that the ink grows with the area, as
it does in a larger drawing by the same hand:

    scan      the white pages of the benchmark
    sparse, ordinary, dense
              the true strokes of the benchmark, drawn at twice, once and half their size, with
              thin pens (1.5 px) and thick ones (6 px)

`involute` runs its networks in OpenCV, as everywhere; `--fast` adds it in ONNX Runtime, where that
is installed. Every method and page runs in a process of its own, once to warm up (that loads the
networks) and then `--repeat` times; the median counts. Memory is the peak of the process, less what
it held before the trace. Times of one run can be compared with each other, and hardly with
another's: what counts are ratios. Where bpy is installed, the times of `benchmarks.blender_costs`
follow.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from importlib.util import find_spec
from itertools import cycle
from multiprocessing import get_context
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from involute.engine import runtimes

from .judged_pages import DATA, pages
from .methods import METHODS
from .run_record import Figures, Record
from .tables import markdown

SIZES = (512, 1024, 2048, 4096)
_LARGEST = 12_000  # px; A3 at 700 dpi
_CELL = 1024  # px
_ZOOMS = {"sparse": 2.0, "ordinary": 1.0, "dense": 0.5}
_PENS = {"thin": 1.5, "thick": 6.0}  # px
KINDS = ("scan", *(f"{zoom}, {pen}" for zoom in _ZOOMS for pen in _PENS))
_YARDSTICK = "skeleton + greedy"
_FAST = "involute in ONNX Runtime"
_METHODS = ("involute", _YARDSTICK, "nijiGPen's method", "autotrace")


@dataclass(frozen=True)
class Timing:
    """One method on one page: medians over the runs.

    cpu, wall: seconds; stages: CPU seconds of each of our stages (no rival tells its own);
    first: wall seconds of the first trace in the process, imports and loading included;
    memory, base: MB, the peak above the base, and what the process held before.
    """

    method: str
    kind: str
    size: int
    cpu: float
    wall: float
    first: float
    stages: dict[str, float]
    memory: float
    base: float
    strokes: int

    @property
    def megapixel(self) -> float:
        """CPU seconds a megapixel."""
        return self.cpu / (self.size**2 / 1e6)


def page(kind: str, size: int, folder: Path = DATA) -> np.ndarray:
    """A (size, size) uint8 page; the smaller ones are windows of the drawings."""
    canvas = np.full((size, size), 255, np.uint8)
    corners = [(y, x) for y in range(0, size, _CELL) for x in range(0, size, _CELL)]
    for (y, x), cell in zip(corners, _cells(kind, folder), strict=False):
        side = min(size, _CELL)
        top, left = (max(0, (n - side) // 2) for n in cell.shape)
        part = cell[top : top + side, left : left + side][: size - y, : size - x]
        canvas[y : y + part.shape[0], x : x + part.shape[1]] = part
    return canvas


def _cells(kind: str, folder: Path) -> Iterator[np.ndarray]:
    """Pictures of up to 1024 px, without end."""
    import cv2

    if kind == "scan":
        white = [p for p in pages(folder) if p.paper == "white"]
        yield from cycle(cv2.imread(str(p.image), cv2.IMREAD_GRAYSCALE) for p in white)
    zoom, pen = kind.split(", ")
    truths = cycle([p.true_strokes() for p in pages(folder)])
    while True:
        yield drawn(truths, _ZOOMS[zoom], _PENS[pen])


def drawn(truths: Iterator[list[np.ndarray]], zoom: float, pen: float) -> np.ndarray:
    """A cell full of true drawings at a size; those larger than the cell are cut."""
    import cv2

    over = 4  # drawn so much larger, for widths and greys between whole pixels
    cell = np.full((_CELL * over, _CELL * over), 255, np.uint8)
    step = round(_CELL * min(zoom, 1.0))
    for corner in np.ndindex(_CELL // step, _CELL // step):
        shift = np.array(corner) * step - max(0.0, (zoom - 1) * _CELL / 2)
        for line in next(truths):
            fixed = np.rint(((line * zoom + shift) * over - 0.5) * 16).astype(np.int32)
            cv2.polylines(cell, [fixed], False, 20, round(pen * over), cv2.LINE_8, 4)
    return cv2.resize(cell, (_CELL, _CELL), interpolation=cv2.INTER_AREA)


def measure(method: str, kind: str, size: int, repeat: int, folder: Path = DATA) -> Timing:
    """Time one method on one page; meant for a fresh process."""
    import cv2

    os.environ[runtimes.VARIABLE] = "onnxruntime" if method == _FAST else "opencv"
    with TemporaryDirectory() as temporary:
        path = Path(temporary) / "page.png"
        cv2.imwrite(str(path), page(kind, 512, folder))
        start = time.perf_counter()
        _trace(method, path)
        first = time.perf_counter() - start
        cv2.imwrite(str(path), page(kind, size, folder))
        base = _resident()
        runs = []
        for _ in range(repeat):
            cpu, wall = time.process_time(), time.perf_counter()
            strokes, stages = _trace(method, path)
            runs.append((time.process_time() - cpu, time.perf_counter() - wall, stages))
    return Timing(
        method=method,
        kind=kind,
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
    """The number of strokes, and the CPU seconds of the stages where they are known."""
    if method not in ("involute", _FAST):
        return len(METHODS[method](path)), {}
    from involute.engine import vectorize

    began: dict[str, float] = {}

    def tell(stage: str, done: float) -> None:
        began.setdefault(stage, time.process_time())

    drawing = vectorize(path, progress=tell)
    at = [*began.values(), time.process_time()]
    return len(drawing.strokes), dict(zip(began, np.diff(at).tolist(), strict=True))


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


def growth(timings: Sequence[Timing]) -> float:
    """The exponent e of time ~ pixels ** e over the sizes; 1 = linear in the area."""
    if len(timings) < 2:
        return float("nan")
    area = np.log([float(t.size) ** 2 for t in timings])
    return float(np.polyfit(area, np.log([t.cpu for t in timings]), 1)[0])


def figures(timings: Sequence[Timing]) -> dict[str, dict[str, float]]:
    """A row for every page: ours a megapixel and by stage, and how many times a rival's time that
    is; then a row for every kind of page and method with the exponent of growth."""
    rows: dict[str, dict[str, float]] = {}
    at = {(t.method, t.kind, t.size): t for t in timings}
    for t in timings:
        row = rows.setdefault(f"{t.kind}, {t.size} px", {})
        name = "" if t.method == "involute" else f"{t.method}: "
        yardstick = at.get((_YARDSTICK, t.kind, t.size))
        if yardstick and t.method == _FAST:
            row[f"fast, times {_YARDSTICK}"] = t.cpu / max(yardstick.cpu, 1e-9)
        row[f"{name}CPU s/MP"] = t.megapixel
        own = at.get(("involute", t.kind, t.size))
        if own and own is not t:
            row[f"times {t.method}"] = own.cpu / max(t.cpu, 1e-9)
        if t.stages and t.method == "involute":
            whole = sum(t.stages.values())
            row |= {f"share of {name}": s / whole for name, s in t.stages.items()}
            row |= {"wall s": t.wall, "peak MB": t.memory, "strokes": t.strokes}
    return rows


def exponents(timings: Sequence[Timing]) -> dict[str, dict[str, float]]:
    """Kind of page -> method -> exponent of growth, where there are several sizes."""
    found: dict[str, dict[str, float]] = {}
    for kind in dict.fromkeys(t.kind for t in timings):
        for method in dict.fromkeys(t.method for t in timings):
            own = [t for t in timings if (t.kind, t.method) == (kind, method)]
            if len(own) > 1:
                found.setdefault(kind, {})[method] = growth(own)
    return found


def report(timings: Sequence[Timing]) -> str:
    """Markdown: our stages by page, then all methods by page, then growth."""
    ours = [t for t in timings if t.stages]
    parts = []
    if ours:
        rows = [
            [f"{t.kind}, {t.size} px{_aside(t)}", *(f"{s:.2f}" for s in t.stages.values()),
             f"{t.wall:.2f}", f"{t.cpu:.2f}", f"{t.megapixel:.2f}",
             f"{t.memory:.0f}", str(t.strokes)]
            for t in ours
        ]  # fmt: skip
        head = ["page", *ours[0].stages, "wall s", "CPU s", "CPU s/MP", "peak MB", "strokes"]
        parts.append("CPU seconds by stage\n\n" + markdown(head, rows))
        parts.append(f"First trace of 512 px in a new process: {ours[0].first:.2f} s.")
    methods = list(dict.fromkeys(t.method for t in timings))
    at = {(t.method, t.kind, t.size): t for t in timings}
    places = list(dict.fromkeys((t.kind, t.size) for t in timings))
    rows = [
        [f"{kind}, {size} px", *(_beside(at[m, kind, size], at) for m in methods)]
        for kind, size in places
    ]
    parts.append(markdown(["CPU s (ours are so many times it), MB", *methods], rows))
    if grown := exponents(timings):
        rows = [[kind, *(f"{e:.2f}" for e in own.values())] for kind, own in grown.items()]
        parts.append(markdown(["grows with the area to the power of", *methods], rows))
    return "\n\n".join(parts)


def _aside(t: Timing) -> str:
    return ", ONNX Runtime" if t.method == _FAST else ""


def _beside(t: Timing, at: dict[tuple[str, str, int], Timing]) -> str:
    own = at.get(("involute", t.kind, t.size))
    ratio = f" ({own.cpu / max(t.cpu, 1e-9):.1f})" if own and own is not t else ""
    return f"{t.cpu:.2f}{ratio}, {t.memory:.0f}"


def readme_table(record: Record) -> str:
    """The README's table: every kind of page at 1024 px, or at the size nearest to it."""
    rows = []
    for kind in KINDS:
        own = {int(row.split(", ")[-1][:-3]): v for row, v in record.figures.items()
               if row.startswith(f"{kind}, ") and row.endswith(" px")}  # fmt: skip
        if not own:
            continue
        size = min(own, key=lambda side: abs(side - _CELL))
        row, grown = own[size], record.figures.get(f"{kind}: growth", {})
        stages = {k.removeprefix("share of "): v for k, v in row.items() if k.startswith("share")}
        most = sorted(stages, key=stages.__getitem__)[-2:][::-1]
        rows.append(
            [kind, f"{row['CPU s/MP']:.2f}", f"{row.get(f'times {_YARDSTICK}', float('nan')):.0f}",
             ", ".join(f"{name} {100 * stages[name]:.0f} %" for name in most),
             f"{grown.get('involute', float('nan')):.2f}"]
        )  # fmt: skip
    return markdown(
        ["page", "CPU s/MP", f"times {_YARDSTICK}", "most of it in", "growth with the area"], rows
    )


def _in_blender() -> str:
    from .blender_costs import report

    return report()[0]


def main(argv: Sequence[str] | None = None) -> Figures:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.speed",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--data", type=Path, default=DATA)
    parser.add_argument(
        "--pages", nargs="+", choices=["all", *KINDS], default=["scan"], metavar="KIND",
        help="; ".join(["all", *KINDS]),
    )  # fmt: skip
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES, metavar="PX")
    parser.add_argument("--largest", action="store_true", help=f"also {_LARGEST} px")
    parser.add_argument("--fast", action="store_true", help="also with ONNX Runtime")
    parser.add_argument("--methods", nargs="+", choices=METHODS, default=_METHODS, metavar="NAME")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--json", type=Path, help="write all figures to this file")
    options = parser.parse_args(argv)
    kinds = KINDS if "all" in options.pages else options.pages
    sizes = [*options.sizes, *([_LARGEST] if options.largest else [])]
    if options.fast and runtimes.here()[0].name != "onnxruntime":
        parser.error("--fast needs ONNX Runtime: pip install onnxruntime")
    methods = [*options.methods, *([_FAST] if options.fast else [])]
    timings = []
    # A new process each, so that one peak of memory does not hide the next.
    with ProcessPoolExecutor(1, get_context("spawn"), max_tasks_per_child=1) as pool:
        for kind, size, method in ((k, s, m) for k in kinds for s in sizes for m in methods):
            job = pool.submit(measure, method, kind, size, options.repeat, options.data)
            timings.append(job.result())
            print(f"{kind}, {size} px, {method}: {timings[-1].wall:.2f} s", file=sys.stderr)
    print(report(timings))
    if find_spec("bpy"):
        with ProcessPoolExecutor(1, get_context("spawn")) as pool:
            print("\nIn Blender\n\n" + pool.submit(_in_blender).result())
    if options.json:
        options.json.write_text(json.dumps([asdict(t) for t in timings], indent=1), "utf-8")
    grown = {f"{kind}: growth": own for kind, own in exponents(timings).items()}
    return figures(timings) | grown


if __name__ == "__main__":
    main()
