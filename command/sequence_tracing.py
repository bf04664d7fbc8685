"""A sequence of images -> one drawing per frame, traced in parallel, handed out in order."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from os import PathLike
from pathlib import Path

from ..engine.drawing import Drawing
from ..engine.errors import InvoluteError
from ..engine.grain import is_decided
from ..engine.pipeline import grain_of
from ..engine.scan.preparing import SEEN_AT
from ..engine.sequence.follow import Follower
from ..engine.sequence.frames import Frame
from ..engine.settings import Settings
from . import batch, receipts
from .planning import make_folder
from .receipts import Standing
from .temporary import temporary_folder

PARTS_REPLACE = frozenset({Standing.FOREIGN})  # a part without receipt is of an older Involute
# Frames that one process traces one after the other. A stretch begins with a frame that takes over
# nothing from another, so that the number of processes makes no difference.
_STRETCH = 12
Progress = Callable[[Frame, batch.Outcome], None]


def trace_sequence(
    frames: Sequence[Frame],
    settings: Settings | None = None,
    *,
    jobs: int = 0,
    parts: str | PathLike[str] | None = None,
    follow: bool = True,
    progress: Progress | None = None,
) -> Iterator[tuple[int, Drawing | InvoluteError]]:
    """Trace every frame; yields (frame, drawing) in the order of the frames.

    A frame that fails yields its error and stops nothing. Closing the iterator stops the work.

    Args:
        frames: see `frames.number_frames`.
        jobs: processes at once; 0 = one per CPU core.
        parts: a folder that keeps the drawing of every frame, as frame NUMBER.json; frames that are
            there and whose image and settings have not changed are not traced again. None = a
            temporary folder.
        follow: give neighbouring frames the same order and direction of strokes.
        progress: called for every image as soon as it is done, in no fixed order; may raise
            `Cancelled`.

    Raises:
        InvoluteError: a parts folder that can't be made or written.
    """
    if parts is None:
        with temporary_folder() as folder:
            yield from trace_sequence(
                frames, settings, jobs=jobs, parts=folder, follow=follow, progress=progress
            )
        return
    seen = _seen_alike(frames, settings or Settings(), make_folder(Path(parts)))
    tasks = part_tasks(frames, seen, parts)
    numbers = {task: k for k, task in enumerate(tasks)}
    follower = Follower()
    done: dict[int, batch.Outcome] = {}
    following = 0
    for outcome in batch.run(tasks, jobs=jobs, resume=True, over=PARTS_REPLACE):
        done[numbers[outcome.task]] = outcome
        if progress:
            progress(frames[numbers[outcome.task]], outcome)
        while following in done:
            drawing = _drawing(done.pop(following))
            if follow and isinstance(drawing, Drawing):
                drawing = follower(drawing)
            yield frames[following].frame, drawing
            following += 1


def _seen_alike(frames: Sequence[Frame], settings: Settings, folder: Path) -> Settings:
    """The settings for all frames: they are looked at as suits the first one.

    That is remembered beside the parts in `folder`, and asked again of another picture only.
    """
    if not frames or is_decided(settings):
        return settings
    first, receipt = frames[0], receipts.path_for(folder / "grain")
    try:
        key = receipts.fingerprint(first.path, first.page, settings)
        known = receipts.read(receipt).report
        if known.get("of") == key and known.get("grain") in SEEN_AT:
            return replace(settings, grain=known["grain"])
        grain = grain_of(first.path, settings, first.page)
    except (InvoluteError, OSError):  # told when its turn comes
        return settings
    receipts.note(receipt, key, {}, {"of": key, "grain": grain})
    return replace(settings, grain=grain)


def part_tasks(
    frames: Sequence[Frame], settings: Settings, parts: str | PathLike[str]
) -> list[batch.Task]:
    """What to trace for which file of the parts folder; the folder is made.

    Raises:
        InvoluteError: the folder can't be made.
    """
    folder = make_folder(Path(parts))
    places = [folder / part_name(frame) for frame in frames]
    return [
        batch.Task(
            source=frame.path,
            outputs=(str(place),),
            settings=settings,
            page=frame.page,
            receipt=str(receipts.path_for(place)),
            turn=False,
            stretch=number // _STRETCH,
        )
        for number, (frame, place) in enumerate(zip(frames, places, strict=True))
    ]


def part_name(frame: Frame) -> str:
    """The file that holds a frame's drawing before the parts are joined."""
    return f"{frame.number:06d}.json"


def _drawing(outcome: batch.Outcome) -> Drawing | InvoluteError:
    if outcome.error:
        return InvoluteError(outcome.error)
    part = outcome.task.outputs[0]
    try:
        return Drawing.load(part)
    except InvoluteError:  # damaged since: make it anew
        reply = batch.perform(outcome.task)
        return InvoluteError(reply["error"]) if "error" in reply else Drawing.load(part)
