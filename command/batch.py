"""Many images, several processes: what was traced is not traced again, what fails stops nothing.

Each worker is a Python process of its own (`worker`), so that memory is given back, a crash costs
one image, and Blender's own process stays free. Workers write the drawings themselves and hand back
only a few figures: memory does not grow with the number of images.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import subprocess
import sys
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cache, lru_cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from queue import SimpleQueue
from typing import Any

from ..engine import weights
from ..engine.errors import InvoluteError
from ..engine.formats.whole_file import whole_file, write_text
from ..engine.settings import Settings

RECEIPTS = ".involute"  # folder beside the outputs; one small file for each drawing made there
_MEMORY_PER_WORKER = 1.5e9  # bytes, for a page of A4 at 300 dpi with room to spare
_IMAGES_PER_WORKER = 200  # then a fresh process takes over
_LIBRARIES = ("numpy", "opencv-contrib-python-headless", "networkx")  # they compute the drawings


@dataclass(frozen=True)
class Task:
    """One image to trace into one or more files; the suffix of each says its format."""

    source: str
    outputs: tuple[str, ...]
    settings: Settings = field(default_factory=Settings)
    page: int = 0


@dataclass(frozen=True)
class Outcome:
    """What became of a task.

    report: seconds of each stage, strokes, junctions, doubtful, width, height, peak_rss_mb; and
        aligned, where that was asked for.
    error: one sentence, or None when the outputs are there.
    resumed: the outputs were there already.
    """

    task: Task
    report: Mapping[str, Any]
    error: str | None = None
    resumed: bool = False


def run(
    tasks: Iterable[Task],
    *,
    jobs: int = 0,
    resume: bool = False,
    progress: Callable[[str, float], None] | None = None,
) -> Iterator[Outcome]:
    """Trace many images; yields every outcome as soon as it is there, in no fixed order.

    Closing the iterator stops the work; no output is ever left half-written.

    Args:
        jobs: processes at once; 0 = one per CPU core, as far as memory goes. 1 works in this
            process.
        resume: leave out what an earlier run with `resume` has made of the same image bytes with
            the same settings; also keeps the receipts that a later run needs for that.
        progress: called as progress(stage, fraction of the image) when working in this process.
    """
    tasks = list(tasks)
    _content.cache_clear()  # an image may have changed since the last run
    jobs = min(jobs or _default_jobs(), len(tasks))
    if resume:
        _remove_leftovers(tasks)
    if jobs <= 1:
        for task in tasks:
            before = _done_before(task) if resume else None
            yield before or _outcome(task, perform(task, resume, progress))
        return
    pool = _Workers(jobs, resume)
    executor = ThreadPoolExecutor(jobs, thread_name_prefix="involute")
    try:
        futures = [executor.submit(pool.trace, task) for task in tasks]
        for future in as_completed(futures):
            yield future.result()
    finally:
        pool.stop()
        executor.shutdown(wait=True, cancel_futures=True)


def _default_jobs() -> int:
    cores = os.cpu_count() or 1
    try:
        memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, OSError, ValueError):  # Windows
        return min(cores, 8)
    return max(1, min(cores, int(memory / _MEMORY_PER_WORKER)))


def perform(
    task: Task, receipt: bool = False, progress: Callable[[str, float], None] | None = None
) -> dict[str, Any]:
    """Trace one image in this process; returns {"report": ...} or {"error": sentence}."""
    from ..engine.pipeline import vectorize

    try:
        with suppress(OSError):  # a missing file is vectorize's to report
            key = fingerprint(task) if receipt else ""
        drawing = vectorize(task.source, task.settings, progress, page=task.page)
        for output in task.outputs:
            drawing.save(output)
        report = summary(drawing)
        if receipt:
            path = _receipt(task)
            path.parent.mkdir(exist_ok=True)
            with whole_file(path) as part:
                write_text(json.dumps({"key": key, "report": report}), part)
    except InvoluteError as error:
        return {"error": str(error)}
    except MemoryError:
        return {"error": "There is not enough memory for it; use fewer jobs or a smaller picture."}
    except Exception as error:  # a bug must not cost the other images
        return {"error": f"Something went wrong inside ({type(error).__name__}: {error})."}
    return {"report": report}


def summary(drawing) -> dict[str, Any]:
    """The figures of one drawing for a report."""
    aligned = {"aligned": drawing.aligned} if drawing.settings.align else {}
    return {
        "seconds": {stage: round(value, 4) for stage, value in drawing.seconds.items()},
        "strokes": len(drawing.strokes),
        "junctions": len(drawing.junctions),
        "doubtful": len(drawing.doubtful),
        "width": drawing.size[0],
        "height": drawing.size[1],
        "peak_rss_mb": peak_rss_mb(),
        **aligned,
    }


def peak_rss_mb() -> float | None:
    """The most memory that this process has held, in MB; None where the system does not say."""
    try:
        import resource
    except ImportError:  # Windows
        return None
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return round(peak / (1e6 if sys.platform == "darwin" else 1e3), 1)


def fingerprint(task: Task) -> str:
    """Changes whenever the drawing would: image bytes, page, settings, formats, program, weights.

    Raises:
        OSError: the image can't be read.
    """
    info = os.stat(task.source)
    image = _content(task.source, info.st_size, info.st_mtime_ns, info.st_ctime_ns)
    digest = hashlib.blake2b(image, digest_size=16)
    recipe = [
        task.settings.as_dict(),
        task.page,
        sorted(Path(output).suffix.lower() for output in task.outputs),
        _program(),
    ]
    digest.update(json.dumps(recipe, sort_keys=True).encode())
    return digest.hexdigest()


@lru_cache(4)
def _content(source: str, size: int, changed: int, status: int) -> bytes:
    """The hash of a file's bytes; remembered for a run: the images of a movie are in one file."""
    digest = hashlib.blake2b(digest_size=32)
    with open(source, "rb") as file:
        while block := file.read(1 << 20):
            digest.update(block)
    return digest.digest()


@cache
def _program() -> str:
    """The hash of what makes the drawings: all sources and weights, and the libraries' versions."""
    folder = Path(weights.__file__).resolve().parents[1]
    files = [*folder.rglob("*.py"), *(weights.FOLDER / name for name in weights.names())]
    digest = hashlib.blake2b(digest_size=16)
    for file in sorted(files):
        content = hashlib.blake2b(file.read_bytes()).hexdigest()
        digest.update(f"{file.relative_to(folder).as_posix()} {content}\n".encode())
    for name in _LIBRARIES:
        with suppress(PackageNotFoundError):
            digest.update(f"{name} {version(name)}\n".encode())
    return digest.hexdigest()


def _receipt(task: Task) -> Path:
    first = Path(task.outputs[0])
    return first.parent / RECEIPTS / f"{first.name}.json"


def _done_before(task: Task) -> Outcome | None:
    """The outcome of an earlier run when its outputs still stand for this task."""
    try:
        receipt = json.loads(_receipt(task).read_text(encoding="utf-8"))
        if receipt["key"] == fingerprint(task) and all(map(os.path.exists, task.outputs)):
            return Outcome(task, receipt["report"], resumed=True)
    except (OSError, ValueError, KeyError):
        pass
    return None


def _remove_leftovers(tasks: Iterable[Task]) -> None:
    """Temporary files of these very outputs that a killed run has left."""
    folders: dict[Path, set[str]] = {}
    for output in (Path(o) for task in tasks for o in task.outputs):
        folders.setdefault(output.parent, set()).add(output.stem[:100] + output.suffix)
    for folder, names in folders.items():
        with suppress(OSError):
            for entry in os.scandir(folder):
                match = re.fullmatch(r"\.(.+)\.\d+\.part(\.\w+)", entry.name)
                if match and match[1] + match[2] in names:
                    os.unlink(entry.path)


def _outcome(task: Task, reply: Mapping[str, Any]) -> Outcome:
    return Outcome(task, reply.get("report", {}), reply.get("error"))


class _Workers:
    """A handful of worker processes, each used by one thread at a time."""

    def __init__(self, jobs: int, resume: bool) -> None:
        self._threads = max(1, (os.cpu_count() or 1) // jobs)
        self._resume = resume
        self._idle: SimpleQueue[_Worker] = SimpleQueue()
        self._all: set[_Worker] = set()
        self._lock = threading.Lock()
        self._stopped = False
        for _ in range(jobs):
            self._idle.put(_Worker())

    def trace(self, task: Task) -> Outcome:
        """Wait for an idle worker and let it trace."""
        if self._resume and (before := _done_before(task)):
            return before
        worker = self._idle.get()
        try:
            with self._lock:
                if self._stopped:
                    return Outcome(task, {}, "Stopped.")
                worker.ensure(self._threads)
                self._all.add(worker)
            return _outcome(task, worker.ask(task, self._resume))
        finally:
            self._idle.put(worker)

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

    def ensure(self, threads: int) -> None:
        """Have a live process with images left to trace."""
        if self._process and (self._left <= 0 or self._process.poll() is not None):
            self.end()
        if self._process is None:
            self._process = _start(threads)
            self._left = _IMAGES_PER_WORKER
        self._left -= 1

    def ask(self, task: Task, receipt: bool) -> Mapping[str, Any]:
        request = {
            "source": task.source,
            "outputs": task.outputs,
            "page": task.page,
            "settings": task.settings.as_dict(),
            "receipt": receipt,
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
