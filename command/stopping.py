"""Being told to end, also while Blender works, which Python's exception for it would break.

Raised in the scripts that Blender runs while it loads, it is printed and lost, or Blender crashes.
So it is only noted there, and raised thereafter; and asked for again between two pieces of work,
because whatever Python runs to free an object swallows it, too.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

_told = threading.Event()
_held = threading.Event()  # while it must not be raised


def check() -> None:
    """Stop here when this process was told to end.

    Raises:
        KeyboardInterrupt: it was.
    """
    if _told.is_set():
        raise KeyboardInterrupt


def answered() -> None:
    """Python, too, takes what interrupted it as dealt with, and leaves the exit code to us.

    Interrupted in a text that `exec` or `eval` runs, as where a dataclass is made, it remembers
    that until the next such text, and ends as if killed by SIGINT, whoever caught it (CPython,
    Python/pythonrun.c, `run_eval_code_obj`).
    """
    exec("")


@contextmanager
def held() -> Iterator[None]:
    """What runs here is not interrupted; who told to end is heard after it.

    Raises:
        KeyboardInterrupt: the process was told to end.
    """
    _held.set()
    try:
        yield
    finally:
        _held.clear()
    check()


@contextmanager
def by_signals() -> Iterator[None]:
    """Being told to end is like Ctrl-C: what was begun is cleared away."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def stop(number: int, frame: FrameType | None) -> None:
        _told.set()
        if not _held.is_set():
            raise KeyboardInterrupt

    names = ("SIGINT", "SIGTERM", "SIGHUP")
    numbers = [getattr(signal, name) for name in names if hasattr(signal, name)]
    before = {number: signal.getsignal(number) for number in numbers}
    try:
        for number in numbers:
            if before[number] is not signal.SIG_IGN:  # as under nohup
                signal.signal(number, stop)
        yield
    except Exception as error:
        if _told.is_set():  # what is written in C makes another error of it, as while it is loaded
            raise KeyboardInterrupt from error
        raise
    finally:
        _told.clear()
        for number, handler in before.items():
            # None: it was not set by Python, as Blender's own; that can't be put back.
            signal.signal(number, signal.SIG_DFL if handler is None else handler)
