"""A sequence traced behind Blender's back: worker processes, one thread that waits for them."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import closing, suppress
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING

from ...command.kept_drawings import folder_for, tidy
from ...engine import Cancelled, InvoluteError, Settings
from ...engine.sequence import Frame
from ..job import Job

if TYPE_CHECKING:
    from ...command.batch import Outcome
    from ...engine import Drawing

TracedFrame = tuple[int, "Drawing | InvoluteError", bool]


class SequenceJob(Job):
    """Traces frames in parallel processes."""

    def __init__(
        self, frames: Sequence[Frame], settings: Settings, *, jobs: int, parts: Path, follow: bool
    ) -> None:
        self.frames = list(frames)
        super().__init__("{done} of {count} frames")
        self.counts = {"done": 0, "count": len(self.frames)}
        self._results: SimpleQueue[TracedFrame] = SimpleQueue()
        self.unaligned: list[Frame] = []  # that should have been
        self._kept: set[int] = set()
        self._done = 0
        self._options = {"jobs": jobs, "parts": parts, "follow": follow}
        self._settings = settings

    @property
    def pictures(self) -> int:
        """How many frames there are."""
        return len(self.frames)

    def results(self) -> list[TracedFrame]:
        """What came since the last call: (frame, drawing or problem, not traced anew)."""
        found = []
        with suppress(Empty):
            while True:
                found.append(self._results.get_nowait())
        return found

    def work(self) -> None:
        """Trace frame by frame; what comes is taken by `results`."""
        from ...command import trace_sequence  # brings in OpenCV

        tidy(self._options["parts"].parent, used=self._options["parts"])
        drawings = trace_sequence(self.frames, self._settings, progress=self._tick, **self._options)
        with closing(drawings):
            for frame, drawing in drawings:
                self._results.put((frame, drawing, frame in self._kept))
                if self.cancelled:
                    return

    def _tick(self, frame: Frame, outcome: Outcome) -> None:
        self._done += 1
        self.counts = self.counts | {"done": self._done}
        self.fraction = self._done / len(self.frames)
        if outcome.resumed:
            self._kept.add(frame.frame)
        if outcome.report.get("aligned") is False:
            self.unaligned.append(frame)
        if self.heard is not None:
            self.heard(f"frame {frame.frame}", outcome)
        if self.cancelled:
            raise Cancelled


def parts_folder(cache: Path, frames: Sequence[Frame]) -> Path:
    """Where the drawings of these files are kept, so that only changed ones are traced again."""
    first = Path(frames[0].path)
    return folder_for(cache, first if frames[0].page != frames[-1].page else first.parent)
