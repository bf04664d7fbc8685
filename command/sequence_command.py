"""`involute trace --sequence`: numbered images become one drawing that moves."""

from __future__ import annotations

import argparse
import hashlib
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..engine.errors import InvoluteError
from ..engine.formats import Format, either, format_of
from ..engine.formats.whole_file import remove_leftovers, whole_files
from ..engine.sequence.frames import Frame, FrameRange, number_frames, number_pages
from ..engine.settings import Settings
from . import batch, inputs, planning, receipts
from .inputs import Inputs
from .receipts import Standing
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
class SequencePlan:
    """What a sequence command is to do; all its arguments have been checked."""

    frames: tuple[Frame, ...]
    settings: Settings
    target: planning.Target | None
    parts: Path | None
    jobs: int
    follow: bool
    resume: bool
    overwrite: bool
    sources: Inputs
    note: str | None = None

    def outputs(self) -> dict[int | None, list[Path]]:
        """The files of each frame; a file that holds them all stands under None."""
        if self.target is None:
            return {}
        if self.target.is_file:
            return {None: [self.target.path]}
        return {
            frame.frame: [
                self.target.path / f"{self._title(frame)}{f.suffix}" for f in self.formats
            ]
            for frame in self.frames
        }

    @property
    def formats(self) -> tuple[Format, ...]:
        return self.target.formats if self.target else ()

    def _title(self, frame: Frame) -> str:
        """Files are named as the images are; pages by their frame."""
        stem = Path(frame.path).stem
        return f"{stem}-{frame.number:04d}" if frame.page or len(self.frames) == 1 else stem


@dataclass
class SequenceOutcome:
    """What became of the frames, in the order that they finished."""

    outcomes: dict[Frame, batch.Outcome] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)

    @property
    def failed(self) -> bool:
        return any(outcome.error for outcome in self.outcomes.values())

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


def plan(
    options: argparse.Namespace, settings: Settings, formats: Sequence[Format]
) -> SequencePlan:
    """Check the arguments.

    Raises:
        InvoluteError: they don't fit together, or an output is in the way.
    """
    target = planning.target(options.output, options.format, formats) if options.output else None
    if target is None and not options.parts:
        raise InvoluteError("Say where the drawings go with -o, or with --parts.")
    moving = [f.suffix for f in formats if f.write_sequence]
    if target and target.is_file and target.formats[0].suffix not in moving:
        places = either([*(f"a {suffix}" for suffix in moving), "a folder with --format"])
        raise InvoluteError(f"A sequence goes into {places}.")
    parts = Path(options.parts) if options.parts else None
    if parts is None and options.resume:
        parts = target.path.with_name(target.path.name + ".parts")
    found = inputs.find(options.inputs)
    frames = _frames(found.images, options.start, options.step, options.frames, options.skip_failed)
    if options.align:
        from ..engine.scan.registration import first_anchors

        # Of the whole sequence: every chunk of it aligns to the same page.
        first = _frames(found.images)[0]
        settings = replace(settings, align=first_anchors(first.path, first.page, settings))
    made = SequencePlan(
        frames=tuple(frames),
        settings=settings,
        target=target,
        parts=parts,
        jobs=options.jobs,
        follow=options.follow,
        resume=options.resume,
        overwrite=options.overwrite,
        sources=Inputs(found.images),
        note=found.about_left_out(),
    )
    _check_outputs(made)
    return made


def _check_outputs(plan: SequencePlan) -> None:
    """Refuse to write where something stands that must stay.

    Raises:
        InvoluteError: says what.
    """
    seen: set[str] = set()
    for output in chain.from_iterable(plan.outputs().values()):
        if output in plan.sources:
            raise InvoluteError(plan.sources.refusal(output))
        if not plan.overwrite and not plan.resume and output.exists():
            raise InvoluteError(f"{output} exists already; use --overwrite to replace it.")
        if planning.folded(str(output)) in seen:
            raise InvoluteError(f"Two frames would go into {output}; rename an image.")
        seen.add(planning.folded(str(output)))


def find_frames(
    names: list[str], start: int | None = None, step: int = 1, frames: str | None = None
) -> list[Frame]:
    """The frames that files, a folder or globs stand for, or the pages of one file.

    Raises:
        InvoluteError: there are none, or they are not of one sequence.
    """
    return _frames(inputs.find(names).images, start, step, frames)


def _frames(
    paths: Sequence[Path],
    start: int | None = None,
    step: int = 1,
    frames: str | None = None,
    may_be_empty: bool = False,
) -> list[Frame]:
    """The frames of images, or the pages of one; with `may_be_empty` a choice may find none."""
    from ..engine.scan import page_count

    chosen = FrameRange.parse(frames) if frames else None
    count = page_count(paths[0]) if len(paths) == 1 else 1
    if count > 1:
        found = number_pages(paths[0], count, start=start, step=step, frames=chosen)
    else:
        found = number_frames(paths, start=start, step=step, frames=chosen)
    if not found and not (chosen and may_be_empty):
        raise InvoluteError(f"There are no frames {frames} among the images.")
    return found


def run(plan: SequencePlan, progress: Callable[..., None]) -> SequenceOutcome:
    """Trace and write; `progress(frame, outcome)` as in `trace_sequence`.

    Raises:
        InvoluteError: an output can't be written.
    """
    from .sequence_tracing import PARTS_REPLACE, part_tasks

    result = SequenceOutcome()

    def note(frame: Frame, outcome: batch.Outcome) -> None:
        result.outcomes[frame] = outcome
        progress(frame, outcome)

    if plan.target is None:
        tasks = dict(
            zip(part_tasks(plan.frames, plan.settings, plan.parts), plan.frames, strict=True)
        )
        running = batch.run(tasks, jobs=plan.jobs, resume=True, over=PARTS_REPLACE)
        with closing(running) as outcomes:
            for outcome in outcomes:
                note(tasks[outcome.task], outcome)
    else:
        _write(plan, note, result)
    pages = [f for f, o in result.outcomes.items() if o.report.get("aligned") is False]
    if pages:
        result.warnings.append(unaligned(pages))
    return result


def _write(
    plan: SequencePlan, note: Callable[[Frame, batch.Outcome], None], result: SequenceOutcome
) -> None:
    from .sequence_tracing import part_tasks, trace_sequence

    outputs = _Outputs(plan, result)
    if outputs.nothing_to_do:
        for frame, task in zip(
            plan.frames, part_tasks(plan.frames, plan.settings, plan.parts), strict=True
        ):
            report = receipts.read(Path(task.receipt)).report
            note(frame, batch.Outcome(task, report, resumed=True))
        return
    traced = trace_sequence(
        plan.frames,
        plan.settings,
        jobs=plan.jobs,
        parts=plan.parts,
        follow=plan.follow,
        progress=note,
    )
    with closing(traced):
        good = ((frame, d) for frame, d in traced if not isinstance(d, InvoluteError))
        outputs.write(good)


class _Outputs:
    """The files that a sequence goes to, and how they stand to what is to be made."""

    def __init__(self, plan: SequencePlan, result: SequenceOutcome) -> None:
        self._plan, self._outputs, self._result = plan, plan.outputs(), result
        self._key = ""
        every = list(chain.from_iterable(self._outputs.values()))
        remove_leftovers(every)
        self._to_make = set(every)
        if plan.resume:
            self._key = _key(plan)
            self._to_make = set(self._free(every))

    @property
    def nothing_to_do(self) -> bool:
        return not self._to_make

    def write(self, drawings: Iterator[tuple[int, Drawing]]) -> None:
        """Write what is to be made.

        Raises:
            InvoluteError: it can't be written.
        """
        target = self._plan.target
        if target.is_file:
            with self._whole([target.path]) as (part,):
                kind = target.formats[0]
                kind.write_sequence(kind.stem(target.path), drawings, part)
            return
        planning.make_folder(target.path)
        for frame, drawing in drawings:
            pairs = zip(self._outputs[frame], target.formats, strict=True)
            wanted = {output: kind for output, kind in pairs if output in self._to_make}
            if wanted:
                with self._whole(list(wanted)) as parts:
                    for (output, kind), part in zip(wanted.items(), parts, strict=True):
                        kind.save(drawing, kind.stem(output), part)

    def _whole(self, outputs: list[Path]) -> Any:
        def note(parts: Sequence[Path]) -> None:
            # What lacks a frame is ours, and not yet what is to be made.
            key = f"{self._key} {'incomplete' if self._result.failed else ''}".rstrip()
            for output, part in zip(outputs, parts, strict=True):
                if self._key:
                    receipts.note(receipts.path_for(output), key, {output.name: part}, {})

        return whole_files(outputs, note)

    def _free(self, outputs: Iterable[Path]) -> Iterator[Path]:
        over = receipts.ALL if self._plan.overwrite else ()
        for output in outputs:
            receipt = receipts.read(receipts.path_for(output))
            kind = format_of(output, self._plan.formats)
            found = receipts.standing(output, kind, receipt, self._key)
            if receipts.to_be_made(found, over):
                yield output
            elif found is Standing.FOREIGN:
                raise InvoluteError(batch.foreign(str(output)))
            elif found is Standing.EDITED:
                self._result.warnings.append(
                    f"{output} was edited since and stays; --overwrite replaces it."
                )


def _key(plan: SequencePlan) -> str:
    """Changes whenever the moving drawing would."""
    found = hashlib.blake2b(f"{plan.follow}".encode(), digest_size=16)
    receipts.forget_images()
    for frame in plan.frames:
        try:
            one = receipts.fingerprint(frame.path, frame.page, plan.settings)
        except OSError:
            one = "can't be read"
        found.update(f"{frame.number} {frame.frame} {one}\n".encode())
    return found.hexdigest()
