"""Work in a thread that touches nothing of Blender; an operator looks in now and then."""

from __future__ import annotations

import threading
import traceback
from collections.abc import Callable
from typing import TYPE_CHECKING

from ..engine import Cancelled, InvoluteError

if TYPE_CHECKING:
    from ..command.batch import Outcome


class Job:
    """What all traces in the background share; subclasses say in `work` what is done.

    stage, fraction: where it is, for progress bars; counts fill the places in `stage`.
    problem: the sentence that says why all of it failed.
    heard: is told of each picture that is done, by its name, and what became of it.
    gives_way: another trace may take its place at any time.
    """

    gives_way = False

    def __init__(self, stage: str) -> None:
        self.stage = stage
        self.counts: dict[str, int] = {}
        self.fraction = 0.0
        self.cancelled = False
        self.problem = ""
        self.heard: Callable[[str, Outcome], None] | None = None
        self._thread = threading.Thread(target=self.run, name="involute", daemon=True)

    @property
    def pictures(self) -> int:
        """How many there are to trace."""
        raise NotImplementedError

    def work(self) -> None:
        """Do it; may raise."""
        raise NotImplementedError

    def start(self) -> None:
        """Do it in a thread of its own."""
        self._thread.start()

    def cancel(self) -> None:
        """Ask to stop, at the next step."""
        self.cancelled = True

    def wait(self, seconds: float) -> None:
        """Wait until the thread has ended, but no longer than that."""
        if self.running:
            self._thread.join(seconds)

    @property
    def running(self) -> bool:
        """Is the thread still at work?"""
        return self._thread.is_alive()

    def run(self) -> None:
        """Do it here and now; never raises."""
        try:
            self.work()
        except Cancelled:
            pass
        except InvoluteError as problem:
            self.problem = str(problem)
        except Exception as problem:  # a defect of ours must not leave the interface waiting
            self.problem = unexpected(problem)


def unexpected(problem: Exception) -> str:
    """What to tell about a defect; the console gets all of it."""
    traceback.print_exc()
    return f"Tracing failed unexpectedly ({problem!r}); please report it."


current: Job | None = None
"""The trace that runs now, for the sidebar; there is at most one."""


def abandon(wait: float = 0.0) -> None:
    """Whoever waited for the job is gone: let it stop by itself, and the next one begin.

    Args:
        wait: seconds that it is given to have stopped when this returns.
    """
    global current
    if current is not None:
        current.cancel()
        current.wait(wait)
        current = None
