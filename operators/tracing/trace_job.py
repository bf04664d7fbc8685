"""Pictures traced one after the other, in the background."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ...engine import Cancelled, InvoluteError, Settings
from ..job import Job, unexpected
from .recent import PAGES, Recent
from .sources import Source

if TYPE_CHECKING:
    from ...command.batch import Outcome
    from ...engine import Drawing

STAGES = {
    "scan": "Reading the picture",
    "solids": "Looking for solid blacks",
    "centerline": "Finding the lines",
    "graph": "Finding the junctions",
    "routing": "Routing the junctions",
    "strokes": "Drawing the strokes",
    "check": "Comparing with the ink",
}


@dataclass(frozen=True, eq=False)
class TracedSource:
    """A traced source, or the sentence that says why it could not be traced."""

    source: Source
    drawing: Drawing | None
    problem: str = ""


class TraceJob(Job):
    """Traces sources; results: what is done so far. recent: where it is kept."""

    recent: Recent = PAGES

    def __init__(self, sources: Sequence[Source], settings: Settings) -> None:
        super().__init__(STAGES["scan"])
        self.sources = list(sources)
        self.settings = settings
        self.results: list[TracedSource] = []

    @property
    def pictures(self) -> int:
        """How many sources there are."""
        return len(self.sources)

    def work(self) -> None:
        """Trace one source after the other; one that fails does not stop the others."""
        for source in self.sources:
            if self.cancelled:
                return
            self.results.append(self._trace(source))
            if self.heard is not None:
                self.heard(source.name, self._outcome(self.results[-1]))

    def _outcome(self, result: TracedSource) -> Outcome:
        """As the command line tells it."""
        from ...command.batch import Outcome, Task, summary

        task = Task(result.source.name, (), self.settings)
        if result.drawing is None:
            return Outcome(task, {}, result.problem)
        return Outcome(task, summary(result.drawing))

    def _trace(self, source: Source) -> TracedSource:
        from ...engine import vectorize

        try:
            drawing = self.recent.recall(source, self.settings)
            if drawing is None:
                kept = self.recent.stages
                drawing = vectorize(
                    source.picture, self.settings, self._tick, page=source.page, kept=kept
                )
                self.recent.remember(source, self.settings, drawing)
        except (InvoluteError, Cancelled) as problem:
            return TracedSource(source, None, str(problem))
        except MemoryError:
            return TracedSource(
                source, None, "There is not enough memory for a picture of this size."
            )
        except Exception as problem:  # the other sources may be all right
            return TracedSource(source, None, unexpected(problem))
        return TracedSource(source, drawing)

    def _tick(self, stage: str, fraction: float) -> None:
        if self.cancelled:
            raise Cancelled
        self.stage = STAGES.get(stage, stage)
        self.fraction = (len(self.results) + fraction) / len(self.sources)
