"""The benchmarks: run them, compare what they found, draw it, and bring the README up to date.

python -m benchmarks run NAME ... [options of the run]
python -m benchmarks compare RESULT RESULT      NAME, NAME~1 (the one before), NAME@COMMIT
python -m benchmarks plot [NAME ...] [--out DIR]
python -m benchmarks tables                     writes the README's tables from the results
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from itertools import takewhile
from pathlib import Path

from . import charts, readme_tables, run_record, side_by_side
from .named_runs import RUNS


def main(argv: Sequence[str] | None = None) -> int:
    """The command line; 1 when a run failed, 2 for wrong usage."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="runs:\n" + "\n".join(f"  {name:17} {run.what}" for name, run in RUNS.items()),
    )
    commands = parser.add_subparsers(dest="command", required=True)
    run = commands.add_parser("run", help="run benchmarks and keep what they find")
    run.add_argument("rest", nargs=argparse.REMAINDER, metavar="NAME ... [options of the run]")
    compare = commands.add_parser("compare", help="two results side by side")
    compare.add_argument("results", nargs=2, metavar="RESULT")
    plot = commands.add_parser("plot", help="pictures of the last results, SVG")
    plot.add_argument("names", nargs="*", metavar="NAME", help="default: all with results")
    plot.add_argument("--out", type=Path, default=Path("out"))
    commands.add_parser("tables", help="write the README's tables from the results")
    options = parser.parse_args(argv)
    try:
        return _COMMANDS[options.command](options)
    except ValueError as problem:
        parser.error(str(problem))


def _run(options: argparse.Namespace) -> int:
    names = list(takewhile(lambda word: not word.startswith("-"), options.rest))
    if not names or (unknown := [name for name in names if name not in RUNS]):
        raise ValueError(f"Run what? {', '.join(unknown if names else [])} Choose: {_known()}")
    arguments = options.rest[len(names) :]
    faults = 0
    for name in names:
        commit = run_record.commit()  # before: somebody may work on while it runs
        figures = RUNS[name](arguments)
        if figures is None:
            continue  # a picture
        record = run_record.Record.of(name, arguments, figures, commit)
        print(f"\n{name}: kept in {record.append()}", file=sys.stderr)
        faults += sum(row.get("faults", 0) > 0 for row in figures.values())
    return 1 if faults else 0


def _compare(options: argparse.Namespace) -> int:
    print(side_by_side.table(*(run_record.found(name) for name in options.results)))
    return 0


def _plot(options: argparse.Namespace) -> int:
    names = options.names or [name for name in RUNS if run_record.read(name)]
    options.out.mkdir(parents=True, exist_ok=True)
    for name in names:
        path = options.out / f"{name}.svg"
        path.write_text(charts.chart(run_record.found(name)), "utf-8")
        print(path)
    return 0


def _tables(options: argparse.Namespace) -> int:
    old = readme_tables.README.read_text("utf-8")
    readme_tables.README.write_text(readme_tables.with_results(old), "utf-8")
    return 0


def _known() -> str:
    return ", ".join(RUNS)


_COMMANDS = {"run": _run, "compare": _compare, "plot": _plot, "tables": _tables}

if __name__ == "__main__":
    sys.exit(main())
