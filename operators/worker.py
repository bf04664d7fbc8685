"""Tracing in a thread that touches nothing of Blender; the operator looks in now and then."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..engine import Cancelled, InvoluteError, Settings
from .sources import Source

if TYPE_CHECKING:
    from ..engine import Drawing

STAGES = {
    "scan": "Reading the picture",
    "solids": "Looking for solid blacks",
    "centerline": "Finding the lines",
    "graph": "Finding the junctions",
    "routing": "Routing the junctions",
    "strokes": "Drawing the strokes",
}


@dataclass(frozen=True, eq=False)
class Result:
    """A traced source, or the sentence that says why it could not be traced."""

    source: Source
    drawing: Drawing | None
    problem: str = ""


class Worker:
    """Traces sources one after the other.

    results: what is done so far. stage, fraction: where it is, for progress bars.
    """

    def __init__(self, sources: Sequence[Source], settings: Settings) -> None:
        self.sources = list(sources)
        self.settings = settings
        self.results: list[Result] = []
        self.stage = STAGES["scan"]
        self.fraction = 0.0
        self.cancelled = False
        self._thread = threading.Thread(target=self.run, name="involute", daemon=True)

    def start(self) -> None:
        self._thread.start()

    def cancel(self) -> None:
        """Ask to stop; the engine does at its next step."""
        self.cancelled = True

    @property
    def running(self) -> bool:
        return self._thread.is_alive()

    def run(self) -> None:
        """Trace all sources; never raises."""
        for source in self.sources:
            if self.cancelled:
                return
            self.results.append(self._trace(source))

    def _trace(self, source: Source) -> Result:
        from ..engine import vectorize

        try:
            drawing = vectorize(source.picture, self.settings, self._tick, page=source.page)
        except (InvoluteError, Cancelled) as problem:
            return Result(source, None, str(problem))
        except MemoryError:
            return Result(source, None, "There is not enough memory for a picture of this size.")
        except Exception as problem:  # a defect of ours must not leave the interface waiting
            return Result(source, None, _unexpected(problem))
        return Result(source, drawing)

    def _tick(self, stage: str, fraction: float) -> None:
        if self.cancelled:
            raise Cancelled
        self.stage = STAGES.get(stage, stage)
        self.fraction = (len(self.results) + fraction) / len(self.sources)


def _unexpected(problem: Exception) -> str:
    import traceback

    traceback.print_exc()
    return f"Tracing failed unexpectedly ({problem!r}); please report it."


current: Worker | None = None
"""The trace that runs now, for the sidebar; there is at most one."""
