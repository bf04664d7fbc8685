"""The command line: `involute trace`, `inspect`, `evaluate`, `farm-job` and `flamenco`.

Thin over the engine: what can be asked is said in `arguments`, how it is done in a module for each
command. What the engine may not import (Blender for .blend, the metrics of the benchmark) is handed
to `main` by its caller.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path

from ..engine.errors import InvoluteError
from ..engine.formats import FORMATS, Format
from ..engine.settings import ABOUT, Settings
from . import batch, sequence_command, stopping, trace_command
from .arguments import parser
from .progress_display import ProgressDisplay, say
from .trace_command import UsageError

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
    _open_streams()
    try:
        with stopping.by_signals():
            code = _run(argv, (*FORMATS, *formats), evaluate)
            if sys.stdout is not None:
                sys.stdout.flush()
            return code
    except SystemExit as stop:  # argparse has said why
        return int(stop.code or 0)
    except UsageError as error:
        return _say(str(error), WRONG_USAGE)
    except InvoluteError as error:
        return _say(str(error), FAILED)
    except KeyboardInterrupt:
        stopping.answered()
        return _say("Stopped; finished files are whole, nothing is half-written.", STOPPED)
    except MemoryError:
        return _say("There is not enough memory.", FAILED)
    except OSError as error:
        return _not_heard(error)


def _run(argv: Sequence[str] | None, formats: Sequence[Format], evaluate: Evaluate | None) -> int:
    options = parser(formats).parse_args(argv)
    if options.command == "trace" and (options.sequence or options.parts):
        return _trace_sequence(options, formats)
    if options.command == "trace":
        return _trace(options, formats)
    if options.command == "farm-job":
        print(sequence_command.write_farm_job(options, settings_of(options)))
    elif options.command == "flamenco":
        from .flamenco import write_job_type

        print(write_job_type(Path(options.folder)))
    elif options.command == "inspect":
        from . import inspect_command

        lines = inspect_command.about_runtimes() if options.runtime else None
        print("\n".join(lines or inspect_command.about(Path(options.file))))
    else:
        _evaluate(options, evaluate)
    return DONE


def settings_of(options: argparse.Namespace) -> Settings:
    """The settings that the options say.

    Raises:
        UsageError: one can't be.
    """
    try:
        return Settings(**{name: getattr(options, name) for name in ABOUT})
    except InvoluteError as error:
        raise UsageError(str(error)) from None


def _trace(options: argparse.Namespace, formats: Sequence[Format]) -> int:
    settings = settings_of(options)
    if not options.output:
        raise UsageError("Say where the drawings go with -o.")
    if options.start is not None or options.step != 1 or options.align or not options.follow:
        raise UsageError("--start, --step, --align and --no-follow need --sequence.")
    good = trace_command.trace(options, settings, formats)
    return DONE if good or options.skip_failed else FAILED


def _trace_sequence(options: argparse.Namespace, formats: Sequence[Format]) -> int:
    settings = settings_of(options)
    try:
        plan = sequence_command.plan(options, settings, formats)
    except InvoluteError as error:
        raise UsageError(str(error)) from None
    if options.report and options.report in plan.sources:
        raise UsageError(plan.sources.refusal(options.report))
    with ProgressDisplay(len(plan.frames), options.loudness) as display:
        if plan.note:
            display.warning(plan.note)

        def progress(frame: sequence_command.Frame, outcome: batch.Outcome) -> None:
            display.done(Path(frame.path).name, outcome)

        result = sequence_command.run(plan, progress)
        for warning in result.warnings:
            display.warning(f"warning: {warning}")
    if options.report:
        trace_command.write_report(options.report, result.report(), plan.sources)
    return FAILED if result.failed and not options.skip_failed else DONE


def _evaluate(options: argparse.Namespace, evaluate: Evaluate | None) -> None:
    if evaluate is None:
        raise InvoluteError("Evaluating needs Involute's sources; run it from a checkout.")
    figures = evaluate(Path(options.prediction), Path(options.truth))
    if options.json:
        print(json.dumps(figures))
    else:
        print("\n".join(f"{name:12} {value:10.3f}" for name, value in figures.items()))


# --- the process -----------------------------------------------------------------------------


def _say(sentence: str, code: int) -> int:
    with suppress(OSError):
        say(sentence)
    return code


def _not_heard(error: OSError) -> int:
    """Whoever read our output has gone, as in `involute inspect | head`; or it can't be written."""
    with suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    if isinstance(error, BrokenPipeError):
        return FAILED
    what = f"{error.filename}: " if error.filename else ""
    return _say(f"Can't go on: {what}{error.strerror or error}.", FAILED)


def _open_streams() -> None:
    """Have all three standard streams, so that no file that is opened later passes for one."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            with suppress(OSError):
                os.open(os.devnull, os.O_RDWR)  # takes the lowest free number
    for stream in (sys.stdout, sys.stderr):
        if reconfigure := getattr(stream, "reconfigure", None):
            reconfigure(errors="backslashreplace")  # names of files need not be text
