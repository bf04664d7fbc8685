"""Many images, several processes: what was traced is not traced again, what fails stops nothing.

Each worker is a Python process of its own (`worker`), so that memory is given back, a crash costs
one image, and Blender's own process stays free. Workers write the drawings themselves and hand back
only a few figures: memory does not grow with the number of images.
"""

from __future__ import annotations

import os
import sys
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing, suppress
from dataclasses import dataclass, field, replace
from functools import lru_cache
from itertools import chain
from pathlib import Path
from queue import SimpleQueue
from typing import TYPE_CHECKING, Any

from ..engine.errors import InvoluteError
from ..engine.formats import format_of
from ..engine.formats.whole_file import remove_leftovers, whole_files
from ..engine.settings import Settings
from . import machine, receipts, stopping
from .inputs import Inputs
from .receipts import Standing

if TYPE_CHECKING:
    from ..engine.centerline.frame_before import FrameBefore
    from ..engine.drawing import Drawing

_MEMORY_PER_WORKER = 1.5e9  # bytes, for a page of A4 at 300 dpi with room to spare


@dataclass(frozen=True)
class Task:
    """One image to trace into one or more files; how the name of each ends says its format.

    receipt: where it is noted what was made; "" = beside the first output.
    turn: look at the drawing in the same pose however its page was turned; see `vectorize`.
    stretch: number of the stretch of a sequence that it is a frame of; one process traces all of
        them in their order, since each takes over what has not changed. None = it stands alone.
    """

    source: str
    outputs: tuple[str, ...]
    settings: Settings = field(default_factory=Settings)
    page: int = 0
    receipt: str = ""
    turn: bool = True
    stretch: int | None = None


@dataclass(frozen=True)
class Outcome:
    """What became of a task.

    report: seconds of each stage that ran (none where it is the same picture again), strokes,
        junctions, doubtful, width, height, peak_rss_mb; and aligned, where that was asked for,
        bundles and doubtful_bundles of a rough drawing.
    error: one sentence, or None when the outputs are there.
    resumed: nothing had to be made.
    kept: outputs that were left alone because someone has edited them.
    """

    task: Task
    report: Mapping[str, Any]
    error: str | None = None
    resumed: bool = False
    kept: tuple[str, ...] = ()


@dataclass(frozen=True)
class _Todo:
    """What is left to do of a task, and the outputs that someone has edited."""

    task: Task
    kept: tuple[str, ...] = ()


def run(
    tasks: Iterable[Task],
    *,
    jobs: int = 0,
    resume: bool = False,
    over: Collection[Standing] = (),
    progress: Callable[[str, float], None] | None = None,
    begin: Callable[[Task], None] | None = None,
) -> Iterator[Outcome]:
    """Trace many images; yields every outcome as soon as it is there, in no fixed order.

    Closing the iterator stops the work; no output is ever left half-written, and no source of any
    task is ever written.

    Args:
        jobs: processes at once, never more than cores: together their threads are as many as
            these; 0 = one per core, as far as memory goes. 1 works in this process.
        resume: leave out what an earlier run with `resume` has made of the same image bytes with
            the same settings, and what was edited since; also keeps the receipts that a later run
            needs for that.
        over: what `resume` replaces besides files that an earlier run has made.
        progress: called as progress(stage, fraction of the image), and
        begin: called with each task, when working in this process.
    """
    tasks = list(tasks)
    receipts.forget_images()
    inputs = Inputs(task.source for task in tasks)

    def clear_up() -> None:
        remove_leftovers(Path(output) for task in tasks for output in task.outputs)

    def before(task: Task) -> _Todo | Outcome:
        """What is left to do of a task, or what became of it already."""
        for output in task.outputs:
            if output in inputs:
                return Outcome(task, {}, inputs.refusal(output))
        return _left_to_do(task, over) if resume else _Todo(task)

    stopping.check()
    clear_up()
    groups = _alike(tasks)
    jobs = min(jobs or default_jobs(), len(groups))
    try:
        if jobs <= 1:
            yield from _here(chain.from_iterable(groups), before, progress, begin)
        else:
            yield from _elsewhere(_stretches(groups), before, min(jobs, machine.cores()))
    finally:
        clear_up()  # a worker of a killed run may have ended only now


def default_jobs() -> int:
    """As many processes as the cores and the memory that this process may use allow."""
    return max(1, min(machine.cores(), int(machine.memory() / _MEMORY_PER_WORKER)))


def _alike(tasks: Sequence[Task]) -> list[list[Task]]:
    """Tasks of the same picture with the same settings together, in the order of their first: held
    drawings and cycles of a sequence are traced once."""

    def look(task: Task) -> tuple[int, int, Settings] | None:
        try:
            return os.stat(task.source).st_size, task.page, task.settings
        except OSError:  # tracing will say so
            return None

    looks = [look(task) for task in tasks]
    count = Counter(looks)
    groups: dict[object, list[Task]] = {}
    for number, (task, seen) in enumerate(zip(tasks, looks, strict=True)):
        key: object = number
        if seen and count[seen] > 1:  # only what may be alike has to be read
            with suppress(OSError):
                key = receipts.fingerprint(task.source, task.page, task.settings)
        groups.setdefault(key, []).append(task)
    return list(groups.values())


def _here(
    tasks: Iterable[Task],
    before: Callable[[Task], _Todo | Outcome],
    progress: Callable[[str, float], None] | None,
    begin: Callable[[Task], None] | None,
) -> Iterator[Outcome]:
    try:
        for task in tasks:
            stopping.check()
            if begin:
                begin(task)
            todo = before(task)
            if isinstance(todo, Outcome):
                yield todo
            else:
                yield _outcome(task, todo, perform(todo.task, progress))
    finally:
        _frame_before.cache_clear()  # for the memory


def _stretches(groups: Sequence[Sequence[Task]]) -> list[list[Task]]:
    """What one process is to trace in one go: groups whose first tasks are of one stretch, in
    their order. So a drawing does not depend on how many processes there are."""
    together: dict[object, list[Task]] = {}
    for number, group in enumerate(groups):
        stretch = group[0].stretch
        key = ("alone", number) if stretch is None else ("stretch", stretch)
        together.setdefault(key, []).extend(group)
    return list(together.values())


def _elsewhere(
    stretches: Sequence[Sequence[Task]], before: Callable[[Task], _Todo | Outcome], jobs: int
) -> Iterator[Outcome]:
    from .workers import Workers

    workers = Workers(jobs)
    done: SimpleQueue[Outcome | BaseException] = SimpleQueue()

    def trace(stretch: Sequence[Task]) -> None:
        try:
            found = [before(task) for task in stretch]
            left = [todo.task for todo in found if isinstance(todo, _Todo)]
            # One process for all of them: it remembers what it has just drawn.
            with closing(workers.trace(left)) as replies:
                for task, todo in zip(stretch, found, strict=True):
                    ended = isinstance(todo, Outcome)
                    done.put(todo if ended else _outcome(task, todo, next(replies)))
        except BaseException as error:  # whoever waits for it must hear of it
            done.put(error)

    executor = ThreadPoolExecutor(jobs, thread_name_prefix="involute")
    try:
        for stretch in stretches:
            executor.submit(trace, stretch)
        for _ in range(sum(map(len, stretches))):
            outcome = done.get()
            if isinstance(outcome, BaseException):
                raise outcome
            stopping.check()
            yield outcome
    finally:
        workers.stop()
        executor.shutdown(wait=True, cancel_futures=True)


def _outcome(task: Task, todo: _Todo, reply: Mapping[str, Any]) -> Outcome:
    return Outcome(task, reply.get("report", {}), reply.get("error"), kept=todo.kept)


def _left_to_do(task: Task, over: Collection[Standing]) -> _Todo | Outcome:
    """A task for the outputs that are still to be made, or its outcome when there are none."""
    path = Path(task.receipt) if task.receipt else receipts.path_for(Path(task.outputs[0]))
    receipt = receipts.read(path)
    try:
        key = receipts.fingerprint(task.source, task.page, task.settings)
        stand = {o: _standing(o, receipt, key) for o in task.outputs}
    except OSError:
        return _Todo(replace(task, receipt=str(path)))  # tracing it will say what is wrong
    for output, found in stand.items():
        if found is Standing.FOREIGN and found not in over:
            return Outcome(task, {}, foreign(output))
    left = tuple(o for o, found in stand.items() if receipts.to_be_made(found, over))
    kept = tuple(o for o, found in stand.items() if found is Standing.EDITED and o not in left)
    if left:
        return _Todo(replace(task, outputs=left, receipt=str(path)), kept)
    return Outcome(task, receipt.report, resumed=True, kept=kept)


def _standing(output: str, receipt: receipts.Receipt, key: str) -> Standing:
    return receipts.standing(Path(output), format_of(output), receipt, key)


def foreign(output: str) -> str:
    """Why a file that no earlier run made is left alone."""
    return f"{output} exists already and no run with --resume made it; --overwrite replaces it."


def perform(task: Task, progress: Callable[[str, float], None] | None = None) -> dict[str, Any]:
    """Trace one image in this process; returns {"report": ...} or {"error": sentence}."""
    try:
        key = ""
        with suppress(OSError):  # a missing file is vectorize's to report
            key = receipts.fingerprint(task.source, task.page, task.settings)
        drawing = _traced(task, key, progress)
        report = summary(drawing)
        _write(drawing, task, key, report)
    except InvoluteError as error:
        return {"error": str(error)}
    except MemoryError:
        return {"error": "There is not enough memory for it; use fewer jobs or a smaller picture."}
    except Exception as error:  # a bug must not cost the other images
        return {"error": f"Something went wrong inside ({type(error).__name__}: {error})."}
    return {"report": report}


_newest: dict[str, Drawing] = {}  # fingerprint -> the drawing that this process made last


@lru_cache(maxsize=1)
def _frame_before(stretch: int) -> FrameBefore:
    """What this process saw in the last frame of a stretch."""
    from ..engine.centerline.frame_before import FrameBefore

    return FrameBefore()


def _traced(task: Task, key: str, progress: Callable[[str, float], None] | None) -> Drawing:
    """The drawing of a task; that of the last one, at no cost, where it has the same key."""
    from ..engine.pipeline import vectorize

    key = key and f"{key} {task.turn}"
    if key in _newest:
        return _newest[key].with_seconds({})
    _newest.clear()
    before = None if task.stretch is None else _frame_before(task.stretch)
    drawing = vectorize(
        task.source, task.settings, progress, page=task.page, turn=task.turn, before=before
    )
    if key:
        _newest[key] = drawing
    return drawing


def _write(drawing: Drawing, task: Task, key: str, report: Mapping[str, Any]) -> None:
    """Write the outputs of a task, all or none; the receipt first.

    Raises:
        InvoluteError: they can't be written, or one is the image itself.
    """
    outputs = [Path(output) for output in task.outputs]
    source = Inputs([task.source])
    for output in outputs:
        if output in source:
            raise InvoluteError(source.refusal(output))

    def note(parts: Sequence[Path]) -> None:
        if task.receipt:
            files = dict(zip((output.name for output in outputs), parts, strict=True))
            receipts.note(Path(task.receipt), key, files, report)

    with whole_files(outputs, note) as parts:
        for output, part in zip(outputs, parts, strict=True):
            format_of(output).write(drawing, part)


def summary(drawing: Drawing) -> dict[str, Any]:
    """The figures of one drawing for a report."""
    aligned = {"aligned": drawing.aligned} if drawing.settings.align else {}
    return {
        "seconds": {stage: round(value, 4) for stage, value in drawing.seconds.items()},
        "strokes": len(drawing.strokes),
        "junctions": len(drawing.junctions),
        "doubtful": len(drawing.doubtful) - len(drawing.doubtful_bundles),
        "width": drawing.size[0],
        "height": drawing.size[1],
        "peak_rss_mb": peak_rss_mb(),
        **aligned,
        **_bundles(drawing),
        **_checked(drawing),
    }


def _bundles(drawing: Drawing) -> dict[str, Any]:
    """Of a rough drawing, what may be one line or two."""
    if drawing.pencil is None:
        return {}
    return {"bundles": len(drawing.bundles), "doubtful_bundles": len(drawing.doubtful_bundles)}


def _checked(drawing) -> dict[str, Any]:
    """What the drawing says of itself: shares lost and invented, notes and warnings."""
    found = drawing.fidelity
    figures = {"lost": round(found.lost, 5), "invented": round(found.invented, 5)} if found else {}
    return {**figures, "notes": list(drawing.notes), "warnings": list(drawing.warnings)}


def peak_rss_mb() -> float | None:
    """The most memory that this process has held, in MB; None where the system does not say."""
    try:
        import resource
    except ImportError:  # Windows
        return None
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return round(peak / (1e6 if sys.platform == "darwin" else 1e3), 1)
