"""`involute trace`: every image, and every page of a TIFF, becomes a drawing of its own."""

from __future__ import annotations

import argparse
import json
import shutil
import sys
from collections.abc import Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ..engine.errors import InvoluteError
from ..engine.formats import Format, format_of
from ..engine.formats.whole_file import whole_file, write_text
from ..engine.settings import Settings
from . import batch, inputs, planning, receipts
from .inputs import Inputs
from .planning import PlannedPage, Target
from .progress_display import ProgressDisplay, say
from .receipts import Standing
from .temporary import temporary_folder

_WAITING = ".json"  # a drawing that waits for a writer that runs here, such as Blender's


class UsageError(Exception):
    """The arguments can't be meant together."""


@dataclass(frozen=True)
class Plan:
    """What a trace is to do; nothing has been written yet.

    failures: name of an image -> why it can't be traced.
    """

    pages: tuple[PlannedPage, ...]
    target: Target
    settings: Settings
    sources: Inputs
    failures: Mapping[str, str] = field(default_factory=dict)
    note: str | None = None


def trace(options: argparse.Namespace, settings: Settings, formats: Sequence[Format]) -> bool:
    """Trace what the options say; True when all went well.

    Raises:
        UsageError: they don't fit together.
        InvoluteError: nothing can be done.
    """
    with temporary_folder() as folder:
        plan = _plan(options, settings, formats, folder)
        if plan.note and options.loudness >= 0:
            say(plan.note)
        for name, sentence in plan.failures.items():
            say(f"{name}: {sentence}")
        if not plan.target.is_file:
            planning.make_folder(plan.target.path)
        elif not plan.target.path.parent.is_dir():
            path = plan.target.path
            raise InvoluteError(f"Can't write {path}: its folder doesn't exist; make it first.")
        outcomes = _Tracing(plan, options, folder).run() if plan.pages else {}
    if options.report:
        write_report(options.report, _entries(outcomes, plan.failures), plan.sources)
    return not plan.failures and not any(outcome.error for outcome in outcomes.values())


def write_report(path: str, images: Sequence[Mapping[str, Any]], sources: Inputs) -> None:
    """Write the figures of a run as JSON.

    Raises:
        InvoluteError: it can't be written, or is one of the images.
    """
    if path in sources:
        raise InvoluteError(sources.refusal(path))
    with whole_file(path) as part:
        write_text(json.dumps({"images": list(images)}, indent=1) + "\n", part)


def _entries(
    outcomes: Mapping[PlannedPage, batch.Outcome], failures: Mapping[str, str]
) -> list[dict[str, Any]]:
    images: list[dict[str, Any]] = [
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
    return images + [{"input": name, "error": why} for name, why in failures.items()]


# --- what is to be done ----------------------------------------------------------------------


def _plan(
    options: argparse.Namespace, settings: Settings, formats: Sequence[Format], folder: Path
) -> Plan:
    """Find the images and their pages, and where each goes; nothing is written but `folder`."""
    try:
        target = planning.target(options.output, options.format, formats)
    except InvoluteError as error:
        raise UsageError(str(error)) from None
    found = inputs.find(_with_piped(options.inputs, folder))
    failures: dict[str, str] = {}
    counted = []
    for path in _chosen(found.images, options.frames):
        try:
            counted.append((path, _page_count(path)))
        except InvoluteError as error:
            failures[str(path)] = str(error)
    try:
        pages = planning.pages(counted, target)
    except InvoluteError as error:
        raise UsageError(str(error)) from None
    sources = Inputs(found.images)
    good = []
    for page in pages:
        if why := _refused(page, sources, options):
            failures.setdefault(*why)
        else:
            good.append(page)
    if options.report and options.report in sources:
        raise UsageError(sources.refusal(options.report))
    return Plan(tuple(good), target, settings, sources, failures, found.about_left_out())


def _refused(
    page: PlannedPage, sources: Inputs, options: argparse.Namespace
) -> tuple[str, str] | None:
    """What is in the way of a page, and a sentence about it; None when nothing is."""
    for output in page.outputs:
        if output in sources:
            return str(page.source), sources.refusal(output)
        if not options.overwrite and not options.resume and output.exists():
            return str(output), "It exists already; use --overwrite to replace it."
    return None


def _with_piped(names: Sequence[str], folder: Path) -> list[str]:
    """The inputs, with what comes through a pipe in a file."""
    if "-" not in names:
        return list(names)
    piped = folder / "stdin"
    try:
        with open(piped, "wb") as file:
            shutil.copyfileobj(sys.stdin.buffer, file)
    except (OSError, AttributeError) as error:
        raise InvoluteError(f"Can't read the standard input: {error}.") from None
    return [str(piped) if name == "-" else name for name in names]


def _chosen(images: Sequence[Path], frames: str | None) -> Sequence[Path]:
    """The images whose number is asked for; all when nothing is.

    Raises:
        UsageError: it can't be read what is asked for.
    """
    if frames is None:
        return images
    from ..engine.sequence.frames import FrameRange, number_frames

    try:
        wanted = FrameRange.parse(frames)
    except InvoluteError as error:
        raise UsageError(str(error)) from None
    return [Path(f.path) for f in number_frames(images, frames=wanted)]


def _page_count(path: Path) -> int:
    from ..engine.scan import page_count

    return page_count(path)


# --- doing it --------------------------------------------------------------------------------


class _Tracing:
    """One run over the pages of a plan.

    What only a writer in this process can write (`Format.write_many`) waits as JSON until all are
    traced; with --resume beside the outputs, where a later run finds it.
    """

    def __init__(self, plan: Plan, options: argparse.Namespace, folder: Path) -> None:
        self._plan, self._options, self._folder = plan, options, folder
        self._over = receipts.ALL if options.overwrite else frozenset[Standing]()
        self._late = [f for f in plan.target.formats if f.write_many]
        self._waiting: dict[PlannedPage, Path] = {}
        self._keys: dict[PlannedPage, str] = {}
        self._outcomes: dict[PlannedPage, batch.Outcome] = {}

    def run(self) -> dict[PlannedPage, batch.Outcome]:
        """Trace and write; what became of each page."""
        pages, options = self._plan.pages, self._options
        with ProgressDisplay(len(pages), options.loudness) as display:
            tasks = self._tasks(display)
            results = batch.run(
                tasks,
                # One image does not pay for another process; and only here can it show its stages.
                jobs=1 if len(tasks) == 1 else options.jobs,
                resume=options.resume,
                over=self._over,
                progress=display.stage,
                begin=lambda task: display.working_on(tasks[task].source.name),
            )
            with closing(results):
                for outcome in results:
                    page = tasks[outcome.task]
                    self._outcomes[page] = outcome
                    display.done(self._name(page), outcome, page.outputs)
            for page, sentence in self._write_waiting().items():
                self._outcomes[page] = replace(self._outcomes[page], error=sentence)
                display.trouble(f"{self._name(page)}: {sentence}")
        return {page: self._outcomes[page] for page in pages}

    def _tasks(self, display: ProgressDisplay) -> dict[batch.Task, PlannedPage]:
        """What workers are to do; pages for which nothing is to be done get their outcome here."""
        pages, late = self._plan.pages, {}
        if self._options.resume:
            receipts.forget_images()
            late = {page: self._late_outcome(page) for page in pages if self._is_late(page)}
            if self._plan.target.shared and None in late.values():
                late = {}  # one file: all of them or none
        tasks = {}
        for page in pages:
            outputs = [o for o in page.outputs if not format_of(o, self._late)]
            done = late.get(page)
            if done and (done.error or not outputs):
                self._outcomes[page] = done
                display.done(self._name(page), done, page.outputs)
                continue
            if self._is_late(page) and not done:
                self._waiting[page] = self._waiting_place(page)
                outputs.append(self._waiting[page])
            paths = tuple(map(str, outputs))
            receipt = str(self._receipt(page)) if self._options.resume else ""
            task = batch.Task(str(page.source), paths, self._plan.settings, page.page, receipt)
            tasks[task] = page
        return tasks

    @staticmethod
    def _name(page: PlannedPage) -> str:
        """How a page is spoken of."""
        return page.source.name + (f", page {page.page + 1}" if page.page else "")

    def _is_late(self, page: PlannedPage) -> bool:
        return any(format_of(output, self._late) for output in page.outputs)

    def _late_output(self, page: PlannedPage) -> Path:
        return next(o for o in page.outputs if format_of(o, self._late))

    def _receipt(self, page: PlannedPage) -> Path:
        shared = page.name if self._plan.target.shared else ""
        return receipts.path_for(page.outputs[0], shared)

    def _waiting_place(self, page: PlannedPage) -> Path:
        if not self._options.resume:
            return self._folder / f"{len(self._waiting)}{_WAITING}"
        receipt = self._receipt(page)
        planning.make_folder(receipt.parent)
        return receipt.with_name(receipt.stem + ".waiting" + _WAITING)

    def _late_outcome(self, page: PlannedPage) -> batch.Outcome | None:
        """What became of a page's late output already; None when it is to be made."""
        output, receipt = self._late_output(page), receipts.read(self._receipt(page))
        task = batch.Task(str(page.source), (str(output),), self._plan.settings, page.page)
        try:
            key = receipts.fingerprint(task.source, task.page, task.settings)
            found = receipts.standing(output, format_of(output, self._late), receipt, key)
        except OSError:
            return None
        self._keys[page] = key
        if receipts.to_be_made(found, self._over):
            return None
        if found is Standing.FOREIGN:
            return batch.Outcome(task, {}, batch.foreign(str(output)))
        kept = (str(output),) if found is Standing.EDITED else ()
        return batch.Outcome(task, receipt.report, resumed=True, kept=kept)

    def _write_waiting(self) -> dict[PlannedPage, str]:
        """Hand the drawings to the late writers, all that go to one file together.

        Returns:
            What went wrong, page by page.
        """
        groups: dict[Path, list[PlannedPage]] = {}
        for page in self._waiting:
            if not self._outcomes[page].error:
                groups.setdefault(self._late_output(page), []).append(page)
        problems: dict[PlannedPage, str] = {}
        for output, members in groups.items():
            try:
                self._write_late(output, members)
            except InvoluteError as error:
                problems.update(dict.fromkeys(members, str(error)))
        return problems

    def _write_late(self, output: Path, members: Sequence[PlannedPage]) -> None:
        from ..engine.formats import load
        from ..engine.formats.whole_file import whole_files

        def note(parts: Sequence[Path]) -> None:
            for page in self._keys.keys() & members:
                report = self._outcomes[page].report
                files = {output.name: parts[0]}
                receipts.note(self._receipt(page), self._keys[page], files, report)

        write = format_of(output, self._late).write_many
        with whole_files([output], note) as (part,):
            write([(page.name, load(self._waiting[page])) for page in members], part)
        if self._options.resume and not self._plan.target.shared:
            for page in members:
                self._waiting[page].unlink(missing_ok=True)
