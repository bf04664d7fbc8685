"""How good the strokes are, ours and the rivals', on the drawings of `benchmarks/data`.

    python -m benchmarks.quality [--data DIR] [--methods NAME ...] [--jobs 2] [--json FILE]

Chamfer, length difference, density (r_SD) and F1 are medians over the drawings; all else is pooled
over the junctions of all drawings. A drawing that fails counts as all wrong. See `metrics`.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from .judged_pages import DATA, JudgedPage, pages
from .methods import METHODS
from .metrics import Score, evaluate, summarize
from .run_record import Figures, Record
from .tables import markdown

# Column of the table: which figure, and how to print it.
COLUMNS = {
    "Chamfer px": ("chamfer", "{:.2f}"),
    "length diff px": ("length_diff", "{:.0f}"),
    "crossings": ("crossings", "{:.2f}"),
    "3+ branches": ("branching", "{:.2f}"),
    "precision": ("precision", "{:.2f}"),
    "r_SD": ("density", "{:.2f}"),
    "F1": ("f1", "{:.2f}"),
    "routing": ("routing", "{:.2f}"),
    "false joins": ("false_joins", "{:.3f}"),
    "failed": ("failed", "{:.0f}"),
    "CPU s": ("cpu_s", "{:.2f}"),
}
_TITLES = {
    "involute": "**Involute**",
    "involute, geometric routing": "",  # says more about routing than about the whole
    "involute, no network": "Involute without its networks",
    "autotrace": "autotrace -centerline",
}
# Of what a column shows, the best is that with the least of this.
_BEST: dict[str, Callable[[float], float]] = {
    **dict.fromkeys(("chamfer", "length_diff", "false_joins"), abs),
    **dict.fromkeys(("branching", "precision", "f1", "routing"), lambda share: -share),
    "density": lambda ratio: abs(math.log(ratio)),
}


@dataclass(frozen=True)
class Verdict:
    """One page traced by one method; seconds of CPU; error: why it failed, or empty."""

    method: str
    page: JudgedPage
    score: Score
    seconds: float
    error: str


def run(
    methods: Iterable[str], drawings: list[JudgedPage], jobs: int, svg: Path | None = None
) -> Iterator[Verdict]:
    """Trace and judge every drawing with every method, in parallel processes."""
    work = [(method, page, svg) for page in drawings for method in methods]
    if jobs == 1:
        yield from map(_judge, work)
        return
    with ProcessPoolExecutor(jobs, get_context("spawn"), one_thread) as pool:
        yield from pool.map(_judge, work)


def one_thread() -> None:
    """One thread a process: the processes are the parallelism."""
    import cv2

    cv2.setNumThreads(1)


def _judge(work: tuple[str, JudgedPage, Path | None]) -> Verdict:
    method, page, svg = work
    error = ""
    start = time.process_time()
    try:
        strokes = METHODS[method](page.image)
    except Exception as problem:  # whatever goes wrong, the drawing counts as all wrong
        strokes, error = [], f"{type(problem).__name__}: {problem}"
    seconds = time.process_time() - start
    if svg:
        _write_svg(strokes, svg / method / f"{page.name}.svg")
    score = evaluate(strokes, page.true_strokes(), failed=bool(error))
    return Verdict(method, page, score, seconds, error)


def _write_svg(strokes: list[np.ndarray], path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    lines = "\n".join(
        '<path d="M' + " L".join(f"{x:.3f} {y:.3f}" for x, y in s) + '"/>' for s in strokes
    )
    path.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1024 1024">'
        f'<g fill="none" stroke="#000">\n{lines}\n</g></svg>\n',
        "utf-8",
    )


def table(rows: dict[str, list[Verdict]], head: str) -> str:
    """A Markdown table, a row per name."""
    cells = []
    for name, results in rows.items():
        found = figures(results)
        values = [form.format(found[key]) for key, form in COLUMNS.values()]
        cells.append([name, *values])
    return markdown([head, *COLUMNS], cells)


def figures(results: Iterable[Verdict]) -> dict[str, float]:
    """What `summarize` finds, and the median CPU seconds of a page."""
    results = list(results)
    found = summarize(r.score for r in results)
    return found | {"cpu_s": float(np.median([r.seconds for r in results]))}


def readme_table(record: Record) -> str:
    """The README's table: its columns, the best of each in bold; crossings are those that a method
    can see, of three branches and more."""
    columns = COLUMNS | {"crossings": COLUMNS["3+ branches"]}
    del columns["3+ branches"]
    names = {_TITLES.get(method, method): own for method, own in record.figures.items() if own}
    rows = [[name, *(form.format(own[key]) for key, form in columns.values())]
            for name, own in names.items() if name]  # fmt: skip
    for place, (key, form) in enumerate(columns.values(), 1):
        if key not in _BEST or len(rows) < 2:
            continue
        best = min((own[key] for own in record.figures.values()), key=_BEST[key])
        for row in rows:
            if row[place] == form.format(best):
                row[place] = f"**{row[place]}**"
    return markdown(["method", *columns], rows)


def main(argv: Sequence[str] | None = None) -> Figures:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.quality", description=__doc__.split("\n")[0]
    )
    parser.add_argument(
        "--data", type=Path, default=DATA, help="folder with manifest.json, NAME.jpg, NAME.svg"
    )
    parser.add_argument(
        "--methods",
        nargs="+",
        choices=METHODS,
        default=list(METHODS),
        metavar="NAME",
        help=", ".join(METHODS),
    )
    parser.add_argument("--every", type=int, default=1, help="only every n-th drawing")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="parallel processes")
    parser.add_argument("--json", type=Path, help="write all figures of all drawings to this file")
    parser.add_argument("--svg", type=Path, help="write the traced strokes to this folder")
    arguments = parser.parse_args(argv)
    try:
        drawings = pages(arguments.data)[:: arguments.every]
    except FileNotFoundError:
        parser.error(f"{arguments.data} has no manifest.json.")

    results: list[Verdict] = []
    total = len(drawings) * len(arguments.methods)
    for result in run(arguments.methods, drawings, arguments.jobs, arguments.svg):
        results.append(result)
        if result.error:
            print(f"{result.method}: {result.page.name}: {result.error}", file=sys.stderr)
        if sys.stderr.isatty():
            print(f"\r{len(results)} of {total}", end="", file=sys.stderr)

    by_method = {m: [r for r in results if r.method == m] for m in arguments.methods}
    print(f"\n{len(drawings)} drawings\n\n{table(by_method, 'method')}")
    for method, own in by_method.items():
        for kind in ("medium", "paper"):
            names = sorted({getattr(r.page, kind) for r in own})
            print(f"\n{method}, by {kind}\n")
            print(table({n: [r for r in own if getattr(r.page, kind) == n] for n in names}, kind))
    if arguments.json:
        arguments.json.write_text(json.dumps(_plain(by_method), indent=1), "utf-8")
    return {method: figures(own) for method, own in by_method.items()}


def _plain(by_method: dict[str, list[Verdict]]) -> dict[str, object]:
    return {
        method: {
            "summary": summarize(r.score for r in results),
            "drawings": {
                r.page.name: {
                    **asdict(r.score),
                    "f1": r.score.f1,
                    "density": r.score.density,
                    "seconds": r.seconds,
                    "error": r.error,
                }
                for r in results
            },
        }
        for method, results in by_method.items()
    }


if __name__ == "__main__":
    main()
