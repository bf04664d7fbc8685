"""`involute trace --sequence`: numbered images become one drawing that moves."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..engine.errors import InvoluteError
from ..engine.formats import Format, either
from ..engine.formats.whole_file import whole_file
from ..engine.sequence.frames import Frame, FrameRange, number_frames, number_pages
from ..engine.settings import Settings
from . import batch, planning
from .setting_options import settings_options

if TYPE_CHECKING:
    from ..engine.drawing import Drawing

_NAMED = 8  # pages that a warning names


def add_options(parser: argparse.ArgumentParser) -> None:
    """The options of `involute trace` for a sequence."""
    group = add_frame_options(parser)
    group.add_argument(
        "--sequence",
        action="store_true",
        help="the images are the frames of one animation; numbers missing in the names are holds",
    )
    group.add_argument(
        "--parts",
        metavar="DIR",
        help="keep the drawing of every frame there and don't trace it again; without -o, do only "
        "that (default with --resume: a folder beside OUT)",
    )


def add_frame_options(parser: argparse.ArgumentParser) -> argparse._ArgumentGroup:
    """The options that say which frames there are; the group, for more of them."""
    group = parser.add_argument_group(
        "sequences", "Numbered images, or the pages of one TIFF, become keyframes."
    )
    group.add_argument(
        "--start", type=int, metavar="N", help="frame of the first drawing (default: its number)"
    )
    group.add_argument(
        "--step", type=int, default=1, metavar="N", help="frames from one number to the next"
    )
    group.add_argument(
        "--frames", metavar="LIST", help="only these numbers, such as 101-200 or 1-48:2,50"
    )
    group.add_argument(
        "--align",
        action="store_true",
        help="bring all pages to where the peg holes or registration marks of the first one lie",
    )
    group.add_argument(
        "--no-follow",
        dest="follow",
        action="store_false",
        help="keep each frame's own order and direction of strokes",
    )
    return group


def write_farm_job(options: argparse.Namespace, settings: Settings) -> Path:
    """Do `involute farm-job`: check the frames here, write the bundle for the farm.

    Raises:
        InvoluteError: there are no such frames, or the bundle can't be written.
    """
    from . import farm

    frames = find_frames([options.images], options.start, options.step, options.frames)
    words = settings_options(settings)
    words += [] if options.start is None else ["--start", str(options.start)]
    words += [] if options.step == 1 else ["--step", str(options.step)]
    words += ["--align"] * options.align + ["--no-follow"] * (not options.follow)
    return farm.write_job(
        Path(options.folder),
        Path(options.images),
        Path(options.output),
        [frame.number for frame in frames],
        options=words,
        chunk=options.chunk,
        command=options.call,
    )


@dataclass(frozen=True)
class Plan:
    """What a sequence command is to do; all its arguments have been checked."""

    frames: tuple[Frame, ...]
    settings: Settings
    target: planning.Target | None
    parts: Path | None
    jobs: int
    follow: bool


@dataclass
class Result:
    """What became of the frames, in the order that they finished."""

    outcomes: dict[Frame, batch.Outcome] = field(default_factory=dict)

    @property
    def failed(self) -> bool:
        return any(outcome.error for outcome in self.outcomes.values())

    @property
    def warning(self) -> str | None:
        """A sentence about the pages that could not be aligned, or None."""
        pages = [f for f, o in self.outcomes.items() if o.report.get("aligned") is False]
        return unaligned(pages) if pages else None

    def report(self) -> list[dict[str, Any]]:
        """An entry for every frame, in order."""
        return [
            {
                "input": frame.path,
                "page": frame.page,
                "frame": frame.frame,
                "error": outcome.error,
                "resumed": outcome.resumed,
                **outcome.report,
            }
            for frame, outcome in sorted(self.outcomes.items(), key=lambda item: item[0].number)
        ]


def unaligned(pages: Iterable[Frame]) -> str:
    """What to tell about pages that should have been aligned."""
    names = [
        f"{Path(page.path).name}, page {page.page + 1}" if page.page else Path(page.path).name
        for page in sorted(pages, key=lambda page: page.number)
    ]
    shown = ", ".join(names[:_NAMED]) + (", ..." if len(names) > _NAMED else "")
    if len(names) == 1:
        return f"A page has no holes or marks like the first one's and stays as scanned: {shown}."
    return (
        f"{len(names)} pages have no holes or marks like the first one's and stay as scanned: "
        f"{shown}."
    )


def plan(options: argparse.Namespace, settings: Settings, formats: Sequence[Format]) -> Plan:
    """Check the arguments.

    Raises:
        InvoluteError: they don't fit together.
    """
    target = planning.target(options.output, options.format, formats) if options.output else None
    if target is None and not options.parts:
        raise InvoluteError("Say where the drawings go with -o, or with --parts.")
    moving = [f.suffix for f in formats if f.write_sequence]
    if target and target.is_file and target.formats[0].suffix not in moving:
        places = either([*(f"a {suffix}" for suffix in moving), "a folder with --format"])
        raise InvoluteError(f"A sequence goes into {places}.")
    replacing = options.overwrite or options.resume
    if target and target.is_file and target.path.exists() and not replacing:
        raise InvoluteError(f"{target.path} exists already; use --overwrite to replace it.")
    parts = Path(options.parts) if options.parts else None
    if parts is None and options.resume:
        parts = target.path.with_name(target.path.name + ".parts")
    frames = find_frames(
        options.inputs, options.start, options.step, options.frames, options.skip_failed
    )
    if options.align:
        from ..engine.scan.registration import first_anchors

        # Of the whole sequence: every chunk of it aligns to the same page.
        first = find_frames(options.inputs)[0]
        settings = replace(settings, align=first_anchors(first.path, first.page, settings))
    return Plan(tuple(frames), settings, target, parts, options.jobs, options.follow)


def find_frames(
    inputs: list[str],
    start: int | None = None,
    step: int = 1,
    frames: str | None = None,
    may_be_empty: bool = False,
) -> list[Frame]:
    """The frames that files, a folder or globs stand for, or the pages of one file.

    Args:
        may_be_empty: a choice of frames that none has is nothing to do, not an error.

    Raises:
        InvoluteError: there are none, or they are not of one sequence.
    """
    from ..engine.scan import page_count

    chosen = FrameRange.parse(frames) if frames else None
    paths = list(planning.images(inputs))
    count = page_count(paths[0]) if len(paths) == 1 else 1
    if count > 1:
        found = number_pages(paths[0], count, start=start, step=step, frames=chosen)
    else:
        found = number_frames(paths, start=start, step=step, frames=chosen)
    if not found and not (chosen and may_be_empty):
        raise InvoluteError(f"There are no frames {frames} among the images.")
    return found


def run(plan: Plan, progress: Callable[..., None]) -> Result:
    """Trace and write; `progress(frame, outcome)` as in `trace_sequence`.

    Raises:
        InvoluteError: an output can't be written.
    """
    from .sequence_tracing import part_tasks, trace_sequence

    result = Result()

    def note(frame: Frame, outcome: batch.Outcome) -> None:
        result.outcomes[frame] = outcome
        progress(frame, outcome)

    if plan.target is None:
        tasks = dict(
            zip(part_tasks(plan.frames, plan.settings, plan.parts), plan.frames, strict=True)
        )
        with closing(batch.run(tasks, jobs=plan.jobs, resume=True)) as outcomes:
            for outcome in outcomes:
                note(tasks[outcome.task], outcome)
        return result
    frames = trace_sequence(
        plan.frames,
        plan.settings,
        jobs=plan.jobs,
        parts=plan.parts,
        follow=plan.follow,
        progress=note,
    )
    with closing(frames):
        good = ((frame, d) for frame, d in frames if not isinstance(d, InvoluteError))
        if plan.target.is_file:
            with whole_file(plan.target.path) as part:
                plan.target.formats[0].write_sequence(plan.target.path.stem, good, part)
        else:
            _write_folder(plan, good)
    return result


def _write_folder(plan: Plan, drawings: Iterator[tuple[int, Drawing]]) -> None:
    """One file per frame and format, named as the images are; pages by their frame."""
    folder = planning.make_folder(plan.target.path)
    names = {
        frame.frame: f"{Path(frame.path).stem}-{frame.number:04d}"
        if frame.page or len(plan.frames) == 1
        else Path(frame.path).stem
        for frame in plan.frames
    }
    for frame, drawing in drawings:
        for kind in plan.target.formats:
            drawing.save(folder / f"{names[frame]}{kind.suffix}")
