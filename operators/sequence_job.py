"""A sequence traced behind Blender's back: worker processes, one thread that waits for them."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from contextlib import closing, suppress
from hashlib import blake2b
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING

from ..engine import Cancelled, InvoluteError, Settings
from ..engine.sequence import Frame

if TYPE_CHECKING:
    from ..engine import Drawing
    from ..engine.batch import Outcome

Result = tuple[int, "Drawing | InvoluteError", bool]


class SequenceJob:
    """Traces frames in parallel processes; touches nothing of Blender.

    stage, fraction, running, cancel(): as of `worker.Worker`, for the sidebar.
    """

    def __init__(
        self, frames: Sequence[Frame], settings: Settings, *, jobs: int, parts: Path, follow: bool
    ) -> None:
        self.frames = list(frames)
        self.stage = f"0 of {len(self.frames)} frames"
        self.fraction = 0.0
        self.cancelled = False
        self.problem = ""
        self._results: SimpleQueue[Result] = SimpleQueue()
        self._kept: set[int] = set()
        self._done = 0
        self._options = {"jobs": jobs, "parts": parts, "follow": follow}
        self._settings = settings
        self._thread = threading.Thread(target=self.run, name="involute", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def cancel(self) -> None:
        """Ask to stop; what is in hand is given up as soon as an image is finished."""
        self.cancelled = True

    @property
    def running(self) -> bool:
        return self._thread.is_alive()

    def results(self) -> list[Result]:
        """What came since the last call: (frame, drawing or problem, not traced anew)."""
        found = []
        with suppress(Empty):
            while True:
                found.append(self._results.get_nowait())
        return found

    def run(self) -> None:
        """Trace all frames; never raises."""
        from ..engine.sequence import trace_sequence  # brings in OpenCV

        try:
            drawings = trace_sequence(
                self.frames, self._settings, progress=self._tick, **self._options
            )
            with closing(drawings):
                for frame, drawing in drawings:
                    self._results.put((frame, drawing, frame in self._kept))
                    if self.cancelled:
                        return
        except Cancelled:
            pass
        except InvoluteError as problem:
            self.problem = str(problem)
        except Exception as problem:  # a defect of ours must not leave the interface waiting
            import traceback

            traceback.print_exc()
            self.problem = f"Tracing failed unexpectedly ({problem!r}); please report it."

    def _tick(self, frame: Frame, outcome: Outcome) -> None:
        self._done += 1
        self.stage = f"{self._done} of {len(self.frames)} frames"
        self.fraction = self._done / len(self.frames)
        if outcome.resumed:
            self._kept.add(frame.frame)
        if self.cancelled:
            raise Cancelled


def parts_folder(cache: Path, frames: Sequence[Frame]) -> Path:
    """Where the drawings of these files are kept, so that only changed ones are traced again."""
    place = str(Path(frames[0].path).absolute().parent) if frames else ""
    if frames and frames[0].page != frames[-1].page:
        place = str(Path(frames[0].path).absolute())
    return cache / blake2b(place.encode("utf-8"), digest_size=8).hexdigest()
