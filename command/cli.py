"""The command line: `involute trace`, `involute inspect` and `involute evaluate`.

Thin over the engine: what can be asked is said here, how it is done is not. What the engine may
not import (Blender for .blend, the metrics of the benchmark) is handed to `main` by its caller.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..engine.errors import InvoluteError
from ..engine.formats import FORMATS, Format, either
from ..engine.settings import ABOUT, DEFAULTS, Settings
from . import batch, planning
from . import sequence_command as sequence
from .setting_options import option

if TYPE_CHECKING:
    from ..engine.drawing import Drawing

Evaluate = Callable[[Path, Path], Mapping[str, float]]

DONE, FAILED, WRONG_USAGE, STOPPED = 0, 1, 2, 130


def main(
    argv: Sequence[str] | None = None,
    formats: Sequence[Format] = (),
    evaluate: Evaluate | None = None,
) -> int:
    """Run the command line.

    Args:
        argv: the arguments, without the program's name; None = those of this process.
        formats: what drawings can be written to, besides the engine's own formats.
        evaluate: function that compares two SVG files, for `involute evaluate`.

    Returns:
        0 when all went well, 1 when something failed, 2 for wrong usage, 130 after Ctrl-C.
    """
    known = (*FORMATS, *formats)
    try:
        options = _parser(known).parse_args(argv)
    except SystemExit as stop:  # argparse has said why
        return int(stop.code or 0)
    try:
        if options.command == "trace" and (options.sequence or options.parts):
            return _trace_sequence(options, known)
        if options.command == "trace":
            return _trace(options, known)
        if options.command == "farm-job":
            print(sequence.write_farm_job(options, _settings(options)))
            return DONE
        if options.command == "inspect":
            return _inspect(options)
        return _evaluate(options, evaluate)
    except _UsageError as error:
        return _say(str(error), WRONG_USAGE)
    except InvoluteError as error:
        return _say(str(error), FAILED)
    except KeyboardInterrupt:
        return _say("Stopped; finished files are whole, nothing is half-written.", STOPPED)
    except BrokenPipeError:  # whoever read our output has gone, as in `involute inspect | head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED


class _UsageError(Exception):
    """The arguments can't be meant together."""


def _say(sentence: str, code: int) -> int:
    print(f"involute: {sentence}", file=sys.stderr)
    return code


# --- what can be asked -----------------------------------------------------------------------


def _parser(formats: Sequence[Format] = FORMATS) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="involute", description="Turn scanned line drawings into editable strokes."
    )
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")

    trace = commands.add_parser(
        "trace",
        help="trace images",
        description="Trace images. Every image, and every page of a TIFF, gives one drawing; "
        "only a .blend holds several.",
    )
    trace.add_argument("inputs", nargs="+", metavar="INPUT", help="an image, a folder or a glob")
    trace.add_argument(
        "-o",
        "--output",
        metavar="OUT",
        help=f"a file that ends in {either(f.suffix for f in formats)}, or a folder",
    )
    trace.add_argument(
        "--format",
        metavar="LIST",
        help=f"formats for a folder, such as svg,json (default: {formats[0].name}); "
        + "; ".join(f"{f.name}: {f.about}" for f in formats),
    )
    trace.add_argument("--report", metavar="FILE", help="write times and counts as JSON")
    trace.add_argument("--overwrite", action="store_true", help="replace outputs that exist")
    trace.add_argument(
        "--jobs", type=_count, default=1, metavar="N", help="processes at once; 0 = one per core"
    )
    trace.add_argument(
        "--resume",
        action="store_true",
        help="leave out what an earlier run with --resume has done; replace what has changed since",
    )
    trace.add_argument(
        "--skip-failed", action="store_true", help="exit with 0 though some images failed"
    )
    sequence.add_options(trace)
    _add_settings(trace)

    job = commands.add_parser(
        "farm-job",
        help="write a render farm's job for a sequence",
        description="Write an Open Job Description bundle that traces a sequence chunk by chunk on "
        "many machines and joins the parts. Submit it with `deadline bundle submit DIR`, or try it "
        "here with `openjd run DIR/template.json --step Join --run-dependencies -p Images=INPUT "
        "-p OutputDir=FOLDER`.",
    )
    job.add_argument("folder", metavar="DIR", help="where the bundle goes")
    job.add_argument("images", metavar="INPUT", help="the folder of images, or one file of pages")
    job.add_argument(
        "-o", "--output", required=True, metavar="OUT", help="the .blend that the job makes"
    )
    job.add_argument(
        "--chunk", type=_count, default=10, metavar="N", help="images that one task traces"
    )
    job.add_argument(
        "--call",
        default="involute",
        metavar="COMMAND",
        help="how the workers call Involute, such as 'blender -b --command involute' "
        "(default: %(default)s)",
    )
    sequence.add_frame_options(job)
    _add_settings(job)

    inspect = commands.add_parser(
        "inspect",
        help="say what is in a drawing or a scan",
        description="Print the size, strokes, widths and junctions of a drawing (.json, .svg), or "
        "what would be traced in an image.",
    )
    inspect.add_argument("file", metavar="FILE", help="a drawing or an image")

    evaluate = commands.add_parser(
        "evaluate",
        help="compare a traced drawing with the truth",
        description="Print how close a traced SVG comes to the true pen strokes, with the long "
        "side of the page scaled to 1024 px.",
    )
    evaluate.add_argument("prediction", metavar="PRED", help="the traced .svg")
    evaluate.add_argument("truth", metavar="TRUTH", help="an .svg with one path per true stroke")
    evaluate.add_argument("--json", action="store_true", help="print JSON instead of a table")
    return parser


def _add_settings(parser: argparse.ArgumentParser) -> None:
    """One option for every setting that can be typed."""
    group = parser.add_argument_group("settings")
    for name, about in ABOUT.items():
        default, text = DEFAULTS[name], (about.tip[0].lower() + about.tip[1:]).replace("%", "%%")
        if about.kind is bool:
            does, text = ("store_false", about.off) if default else ("store_true", text)
            group.add_argument(option(name), dest=name, action=does, help=text)
            continue
        kind: dict[str, Any] = {"type": about.kind, "metavar": "X"}
        if about.kind is tuple:
            kind = {"type": _names, "metavar": "LIST"}
            text += f" (such as {','.join(about.values[:2])}); of {', '.join(about.values)}"
        elif about.choices:
            kind = {"choices": about.values}
        if default != ():
            text += " (default: %(default)s)"
        group.add_argument(option(name), default=default, help=text, **kind)
    group.add_argument(
        "--centerline",
        dest="provider",
        action="store_const",
        const="given",
        help="the input is a centerline image, white on black; the same as --provider given",
    )


def _names(text: str) -> tuple[str, ...]:
    return tuple(filter(None, (name.strip() for name in text.split(","))))


def _count(text: str) -> int:
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of processes")
    return int(text)


def _settings(options: argparse.Namespace) -> Settings:
    try:
        return Settings(**{name: getattr(options, name) for name in ABOUT})
    except InvoluteError as error:
        raise _UsageError(str(error)) from None


# --- trace -----------------------------------------------------------------------------------


def _trace(options: argparse.Namespace, formats: Sequence[Format]) -> int:
    settings = _settings(options)
    if not options.output:
        raise _UsageError("Say where the drawings go with -o.")
    if options.start is not None or options.step != 1 or options.align or not options.follow:
        raise _UsageError("--start, --step, --align and --no-follow need --sequence.")
    try:
        target = planning.target(options.output, options.format, formats)
    except InvoluteError as error:
        raise _UsageError(str(error)) from None

    failures: dict[str, str] = {}
    sources = []
    for path in _chosen(planning.images(options.inputs), options.frames):
        try:
            sources.append((path, _page_count(path)))
        except InvoluteError as error:
            failures[str(path)] = str(error)
    try:
        pages = planning.pages(sources, target)
    except InvoluteError as error:
        raise _UsageError(str(error)) from None
    if not options.overwrite and not options.resume:
        pages = list(_without_existing(pages, failures))
    for path, sentence in failures.items():
        _say(f"{path}: {sentence}", FAILED)
    if not target.is_file:
        planning.make_folder(target.path)
    elif not target.path.parent.is_dir():
        raise InvoluteError(f"Can't write {target.path}: its folder doesn't exist; make it first.")

    writers = {f.suffix: f.write_many for f in target.formats if f.write_many}
    outcomes = _run(pages, settings, options, writers) if pages else {}
    failed = [page for page, outcome in outcomes.items() if outcome.error]
    if options.report:
        _write_report(Path(options.report), outcomes, failures)
    return FAILED if (failed or failures) and not options.skip_failed else DONE


def _chosen(paths: Iterator[Path], frames: str | None) -> Iterator[Path]:
    """The images whose number is asked for; all when nothing is."""
    if frames is None:
        return paths
    from ..engine.sequence.frames import FrameRange, number_frames

    return iter(Path(f.path) for f in number_frames(paths, frames=FrameRange.parse(frames)))


def _page_count(path: Path) -> int:
    from ..engine.scan import page_count

    return page_count(path)


def _without_existing(
    pages: Sequence[planning.Page], failures: dict[str, str]
) -> Iterator[planning.Page]:
    for page in pages:
        there = [str(output) for output in page.outputs if output.exists()]
        if there:
            failures[there[0]] = "It exists already; use --overwrite to replace it."
        else:
            yield page


def _run(
    pages: Sequence[planning.Page],
    settings: Settings,
    options: argparse.Namespace,
    writers: Mapping[str, Callable[..., None]],
) -> dict[planning.Page, batch.Outcome]:
    """Trace the pages; a drawing for a format of `writers` waits as JSON until all are traced."""
    with tempfile.TemporaryDirectory(prefix="involute-") as folder:
        tasks: dict[batch.Task, planning.Page] = {}
        waiting: dict[planning.Page, Path] = {}
        for page in pages:
            outputs = [str(output) for output in page.outputs if output.suffix not in writers]
            if len(outputs) < len(page.outputs):
                waiting[page] = Path(folder, f"{len(waiting)}.json")
                outputs.append(str(waiting[page]))
            tasks[batch.Task(str(page.source), tuple(outputs), settings, page.page)] = page
        outcomes: dict[planning.Page, batch.Outcome] = {}
        with _Bar(len(tasks)) as bar:
            # One image does not pay for another process; and only here can it show its stages.
            jobs = 1 if len(tasks) == 1 else options.jobs
            results = batch.run(tasks, jobs=jobs, resume=options.resume, progress=bar.stage)
            with closing(results):
                for outcome in results:
                    page = tasks[outcome.task]
                    outcomes[page] = outcome
                    bar.next()
                    if outcome.error:
                        bar.say(f"{page.name}: {outcome.error}")
                    elif not outcome.report["strokes"]:
                        bar.say(f"{page.name}: warning: there are no lines; the drawing is empty.")
        for page, sentence in _write_waiting(waiting, outcomes, writers).items():
            outcomes[page] = replace(outcomes[page], error=sentence)
            _say(f"{page.name}: {sentence}", FAILED)
    return outcomes


def _write_waiting(
    waiting: Mapping[planning.Page, Path],
    outcomes: Mapping[planning.Page, batch.Outcome],
    writers: Mapping[str, Callable[..., None]],
) -> dict[planning.Page, str]:
    """Hand the drawings to the extra writers, all that go to one file together.

    Returns:
        What went wrong, page by page.
    """
    from ..engine.formats import load
    from ..engine.formats.whole_file import whole_file

    groups: dict[Path, list[planning.Page]] = {}
    for page in waiting:
        for output in page.outputs:
            if output.suffix in writers and not outcomes[page].error:
                groups.setdefault(output, []).append(page)
    problems: dict[planning.Page, str] = {}
    for output, members in groups.items():
        try:
            with whole_file(output) as part:
                writers[output.suffix]([(page.name, load(waiting[page])) for page in members], part)
        except InvoluteError as error:
            problems.update(dict.fromkeys(members, str(error)))
    return problems


def _write_report(
    path: Path, outcomes: Mapping[planning.Page, batch.Outcome], failures: Mapping[str, str]
) -> None:
    images = [
        {
            "input": str(page.source),
            "page": page.page,
            "outputs": [str(output) for output in page.outputs],
            "error": outcome.error,
            "resumed": outcome.resumed,
            **outcome.report,
        }
        for page, outcome in outcomes.items()
    ]
    images += [{"input": name, "error": sentence} for name, sentence in failures.items()]
    _write_json(path, {"images": images})


def _write_json(path: Path, content: Mapping[str, Any]) -> None:
    from ..engine.formats.whole_file import whole_file, write_text

    with whole_file(path) as part:
        write_text(json.dumps(content, indent=1) + "\n", part)


class _Bar:
    """A progress bar on a terminal, nothing elsewhere; messages go above it to stderr."""

    def __init__(self, total: int) -> None:
        self._bar = None
        if sys.stderr is not None and sys.stderr.isatty():
            try:
                from tqdm import tqdm
            except ImportError:  # Blender has none
                return
            layout = "{desc:>10} {percentage:3.0f}% {bar} {elapsed} < {remaining}"
            self._bar = tqdm(total=total, bar_format=layout, leave=False, dynamic_ncols=True)
        self._finished = 0

    def __enter__(self) -> _Bar:
        return self

    def __exit__(self, *error: object) -> None:
        if self._bar is not None:
            self._bar.close()

    def stage(self, name: str, fraction: float) -> None:
        """Show how far the image in hand has come."""
        self._move(fraction)
        if self._bar is not None:
            self._bar.set_description_str(name, refresh=False)

    def next(self) -> None:
        """One image more is finished."""
        self._finished += 1
        self._move(0.0)

    def say(self, sentence: str) -> None:
        """Print a line without breaking the bar."""
        if self._bar is not None:
            self._bar.clear()
        _say(sentence, DONE)

    def _move(self, fraction: float) -> None:
        if self._bar is not None:
            self._bar.update(self._finished + fraction - self._bar.n)


def _trace_sequence(options: argparse.Namespace, formats: Sequence[Format]) -> int:
    settings = _settings(options)
    try:
        plan = sequence.plan(options, settings, formats)
    except InvoluteError as error:
        raise _UsageError(str(error)) from None
    with _Bar(len(plan.frames)) as bar:

        def progress(frame: sequence.Frame, outcome: batch.Outcome) -> None:
            bar.next()
            if outcome.error:
                bar.say(f"{Path(frame.path).name}: {outcome.error}")

        result = sequence.run(plan, progress)
    if result.warning:
        _say(f"warning: {result.warning}", DONE)
    if options.report:
        _write_json(Path(options.report), {"images": result.report()})
    return FAILED if result.failed and not options.skip_failed else DONE


# --- inspect and evaluate --------------------------------------------------------------------


def _inspect(options: argparse.Namespace) -> int:
    path = Path(options.file)
    if path.suffix.lower() in (".json", ".svg"):
        from ..engine.formats import load

        print("\n".join(_about_drawing(load(path))))
    else:
        print("\n".join(_about_scan(path)))
    return DONE


def _about_drawing(drawing: Drawing) -> Iterator[str]:
    import numpy as np

    widths = np.concatenate([s.widths for s in drawing.strokes] or [np.zeros(1)])
    low, middle, high = np.percentile(widths, (5, 50, 95))
    colors = {stroke.color for stroke in drawing.strokes}
    yield f"size       {drawing.size[0]} x {drawing.size[1]} px"
    yield f"strokes    {len(drawing.strokes)}, {sum(s.closed for s in drawing.strokes)} closed"
    yield f"points     {sum(len(s.points) for s in drawing.strokes)}"
    yield f"widths     {middle:.1f} px (5 % under {low:.1f}, 5 % over {high:.1f})"
    yield f"inks       {len(colors)}"
    yield f"fills      {len(drawing.fills)}"
    yield f"branches   {drawing.graph.branch_count}"
    yield f"junctions  {len(drawing.junctions)}, {len(drawing.doubtful)} doubtful"
    if not drawing.junctions:
        return
    yield ""
    yield " junction        x        y  degree  doubt  joined (next best)"
    doubtful = set(drawing.doubtful)
    order = [*drawing.doubtful, *(j.index for j in drawing.junctions if j.index not in doubtful)]
    for junction in (drawing.junctions[index] for index in order):
        x, y = junction.position
        others = [a for a in junction.alternatives if a.pairs != junction.pairs]
        second = f"({_pairs(others[0].pairs)}: {others[0].probability:.0%})" if others else ""
        state = "lock " if junction.locked else f"{junction.doubt:5.0%}"
        yield (
            f"{junction.index:9d} {x:8.1f} {y:8.1f} {junction.degree:7d}  {state}  "
            f"{_pairs(junction.pairs)} {second}"
        )


def _pairs(pairs: Sequence[tuple[int, int]]) -> str:
    return " ".join(f"{a}-{b}" for a, b in pairs) or "none"


def _about_scan(path: Path) -> Iterator[str]:
    from ..engine.scan import page_count, read_scan

    scan, count = read_scan(path, Settings()), page_count(path)
    yield f"size       {scan.size[0]} x {scan.size[1]} px" + (
        f", {count} pages" if count > 1 else ""
    )
    yield f"pen        {scan.pen_width * scan.scale:.1f} px wide"
    yield f"worked at  {scan.ink.shape[1]} x {scan.ink.shape[0]} px"
    yield f"ink        {float(scan.ink.mean()):.1%} of the page"
    yield f"color      {'no' if scan.color is None else 'yes'}"


def _evaluate(options: argparse.Namespace, evaluate: Evaluate | None) -> int:
    if evaluate is None:
        raise InvoluteError("Evaluating needs Involute's sources; run it from a checkout.")
    figures = evaluate(Path(options.prediction), Path(options.truth))
    if options.json:
        print(json.dumps(figures))
    else:
        print("\n".join(f"{name:12} {value:10.3f}" for name, value in figures.items()))
    return DONE
