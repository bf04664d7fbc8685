"""The processes of a batch: each a Python of its own that traces one image after the other."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
from collections.abc import Generator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from queue import SimpleQueue
from typing import TYPE_CHECKING, Any

from ..engine.errors import InvoluteError
from . import machine

if TYPE_CHECKING:
    from .batch import Task

_IMAGES_PER_WORKER = 200  # then a fresh process takes over


class Workers:
    """A handful of worker processes, each used by one thread at a time."""

    def __init__(self, jobs: int) -> None:
        self._threads = max(1, machine.cores() // jobs)  # all together, never more than cores
        self._idle: SimpleQueue[_Worker] = SimpleQueue()
        self._all: set[_Worker] = set()
        self._lock = threading.Lock()
        self._stopped = False
        for _ in range(jobs):
            self._idle.put(_Worker())

    def trace(self, tasks: Sequence[Task]) -> Generator[Mapping[str, Any]]:
        """Wait for an idle worker and let it trace; its answers are those of `batch.perform`, as
        they come."""
        if not tasks:
            return
        worker = self._idle.get()
        try:
            worker.retire_when_due()
            for task in tasks:
                yield self._answer(worker, task)
        finally:
            self._idle.put(worker)

    def _answer(self, worker: _Worker, task: Task) -> Mapping[str, Any]:
        try:
            with self._lock:
                if self._stopped:
                    return {"error": "Stopped."}
                worker.ensure(self._threads)
                self._all.add(worker)
            return worker.ask(task)
        except OSError as error:
            return {"error": f"Can't start a process for it: {error.strerror or error}."}
        except InvoluteError as error:
            return {"error": str(error)}

    def stop(self) -> None:
        """End all processes at once; safe at any time, since outputs appear only when whole."""
        with self._lock:
            self._stopped = True
            for worker in self._all:
                worker.end()


class _Worker:
    """One process that traces images one after the other; started when first needed."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[str] | None = None
        self._left = 0

    def retire_when_due(self) -> None:
        """End a process that has traced enough images; never in the middle of a stretch."""
        if self._left <= 0:
            self.end()

    def ensure(self, threads: int) -> None:
        """Have a live process."""
        if self._process and self._process.poll() is not None:
            self.end()
        if self._process is None:
            self._process = _start(threads)
            self._left = _IMAGES_PER_WORKER
        self._left -= 1

    def ask(self, task: Task) -> Mapping[str, Any]:
        request = {
            "source": task.source,
            "outputs": task.outputs,
            "page": task.page,
            "settings": task.settings.as_dict(),
            "receipt": task.receipt,
            "turn": task.turn,
            "stretch": task.stretch,
        }
        process = self._process
        try:
            process.stdin.write(json.dumps(request) + "\n")
            process.stdin.flush()
            return json.loads(process.stdout.readline())
        except (OSError, ValueError):
            with suppress(subprocess.TimeoutExpired):
                process.wait(1)
            process.kill()
            code = process.wait()
            return {"error": f"The process that traced it has died (exit code {code})."}

    def end(self) -> None:
        if self._process:
            self._process.kill()
            self._process.wait()
            for stream in (self._process.stdin, self._process.stdout):
                with suppress(OSError):
                    stream.close()
            self._process = None


def _start(threads: int) -> subprocess.Popen[str]:
    """Start worker.py with this program's module path; OpenCV gets that many threads."""
    environment = {**os.environ, "OMP_NUM_THREADS": str(threads), "PYTHONIOENCODING": "utf-8"}
    process = subprocess.Popen(
        [python(), "-P", str(Path(__file__).with_name("worker.py"))],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env=environment,
        encoding="utf-8",
        creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
    )
    process.stdin.write(json.dumps({"path": sys.path, "threads": threads}) + "\n")
    process.stdin.flush()
    return process


def python() -> str:
    """The interpreter to start workers with.

    Raises:
        InvoluteError: this program runs without one (then only jobs = 1 works).
    """
    names = [
        sys.executable,
        *(Path(sys.prefix, "bin").glob("python3*")),
        Path(sys.prefix, "python.exe"),
    ]
    for name in names:
        if name and "python" in Path(name).name.lower() and Path(name).is_file():
            return str(name)
    raise InvoluteError("There is no Python to start other processes with; trace with 1 job.")
