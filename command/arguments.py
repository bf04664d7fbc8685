"""What can be asked of the command line: every option, from the settings and formats there are."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import Any, NoReturn

from ..engine.formats import FORMATS, Format, either
from ..engine.settings import ABOUT, DEFAULTS
from . import sequence_command
from .progress_display import QUIET, USUAL, VERBOSE
from .setting_options import option


class _Parser(argparse.ArgumentParser):
    """Says in one sentence what is wrong, without all the options there are."""

    def error(self, message: str) -> NoReturn:
        said = " ".join((message[:1].upper() + message[1:]).splitlines())
        self.exit(2, f"{self.prog}: {said}; {self.prog} --help tells what can be asked.\n")


def parser(formats: Sequence[Format] = FORMATS) -> argparse.ArgumentParser:
    """The parser of `involute` for these formats of drawings."""
    made = _Parser(prog="involute", description="Turn scanned line drawings into editable strokes.")
    commands = made.add_subparsers(dest="command", required=True, metavar="COMMAND")
    _add_trace(commands, formats)
    _add_farm_job(commands)
    _add_flamenco(commands)
    _add_inspect(commands)
    _add_evaluate(commands)
    return made


def _add_trace(commands: Any, formats: Sequence[Format]) -> None:
    trace = commands.add_parser(
        "trace",
        help="trace images",
        description="Trace images. Every image, and every page of a TIFF, gives one drawing; "
        "only a .blend holds several. No image is ever written.",
    )
    trace.add_argument(
        "inputs", nargs="+", metavar="INPUT", help="an image, a folder, a glob, or - for a pipe"
    )
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
    trace.add_argument(
        "--report", type=_named, metavar="FILE", help="write times and counts as JSON"
    )
    trace.add_argument("--overwrite", action="store_true", help="replace outputs that exist")
    trace.add_argument(
        "--jobs", type=_count, default=1, metavar="N", help="processes at once; 0 = one per core"
    )
    trace.add_argument(
        "--resume",
        action="store_true",
        help="leave out what an earlier run with --resume has done, and what was edited since",
    )
    trace.add_argument(
        "--skip-failed", action="store_true", help="exit with 0 though some images failed"
    )
    said = trace.add_mutually_exclusive_group()
    for name, loudness, text in (
        ("quiet", QUIET, "say nothing but what went wrong"),
        ("verbose", VERBOSE, "say what became of each image, and how long its stages took"),
    ):
        said.add_argument(
            f"--{name}",
            dest="loudness",
            action="store_const",
            const=loudness,
            default=USUAL,
            help=text,
        )
    sequence_command.add_options(trace)
    _add_settings(trace)


def _add_farm_job(commands: Any) -> None:
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
    sequence_command.add_frame_options(job)
    _add_settings(job)


def _add_flamenco(commands: Any) -> None:
    flamenco = commands.add_parser(
        "flamenco",
        help="write the job type for Flamenco",
        description="Put the job type 'Involute: Trace Drawings' into a Flamenco Manager's folder "
        "`scripts`. After a restart of the Manager it is in Blender's Flamenco panel.",
    )
    flamenco.add_argument("folder", metavar="DIR", help="the folder `scripts` beside the Manager")


def _add_inspect(commands: Any) -> None:
    inspect = commands.add_parser(
        "inspect",
        help="say what is in a drawing or a scan",
        description="Print the size, strokes, widths and junctions of a drawing (.json, .svg), or "
        "what would be traced in an image.",
    )
    what = inspect.add_mutually_exclusive_group(required=True)
    what.add_argument("file", metavar="FILE", nargs="?", help="a drawing or an image")
    what.add_argument(
        "--runtime", action="store_true", help="say what runs the networks here, and how fast"
    )


def _add_evaluate(commands: Any) -> None:
    evaluate = commands.add_parser(
        "evaluate",
        help="compare a traced drawing with the truth",
        description="Print how close a traced SVG comes to the true pen strokes, with the long "
        "side of the page scaled to 1024 px.",
    )
    evaluate.add_argument("prediction", metavar="PRED", help="the traced .svg")
    evaluate.add_argument("truth", metavar="TRUTH", help="an .svg with one path per true stroke")
    evaluate.add_argument("--json", action="store_true", help="print JSON instead of a table")


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
    if not text.isdecimal() or len(text) > 9:
        raise argparse.ArgumentTypeError(f"{text[:40]!r} is not a number of that kind")
    return int(text)


def _named(text: str) -> str:
    if not text:
        raise argparse.ArgumentTypeError("a file without a name can't be written")
    return text
