"""Many pages in one batch: `python -m benchmarks.many_pages --data TRAIN --work FOLDER` (Linux).

Renders pages of 1024 px from training drawings, in ink, pencil, chalk and colour, traces them all
with `involute trace --jobs 0`, and watches the memory of the whole tree of processes. Then the same
once more into another folder, killed half-way (SIGKILL to the process group) and taken up with
`--resume`: nothing may be traced twice or left broken, and both folders must be equal byte by byte.
Exits with 1 when one of that is not so.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
from involute.command.receipts import FOLDER as RECEIPTS
from involute.engine import Drawing, InvoluteError

from .run_record import Figures

Array = np.ndarray
SIZE = 1024
_SETS = ("openclipart", "streamline", "openmoji", "excalidraw", "kanjivg", "quickdraw_raw")
_PAPERS = ((250, 250, 250), (244, 238, 222), (228, 228, 224))
_INKS = ((25, 25, 28), (90, 90, 92), (150, 60, 40), (60, 50, 190))  # BGR
_EVERY = 5.0  # seconds between two looks at the memory
_LEAST_LINE = 3000  # px of line that a page must have: no page of a single doodle


@dataclass
class WatchedRun:
    """One run of the command: its seconds, processor seconds, exit code, and (seconds, MB) of its
    processes."""

    seconds: float = 0.0
    cpu: float = 0.0
    code: int | None = None
    memory: list[tuple[float, float]] = field(default_factory=list)


def main(argv: Sequence[str] | None = None) -> Figures:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.many_pages",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--data", type=Path, required=True, help="training drawings (.npz)")
    parser.add_argument("--work", type=Path, required=True, help="a new folder for all files")
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--jobs", type=int, default=0)
    options = parser.parse_args(argv)
    images = options.work / "pages"
    images.mkdir(parents=True)
    for k, page in enumerate(pages(options.data, options.count)):
        cv2.imwrite(str(images / f"page_{k + 1:04d}.jpg"), page, [cv2.IMWRITE_JPEG_QUALITY, 92])

    whole, broken = options.work / "whole", options.work / "killed"
    run = trace(images, whole, options.jobs)
    print(
        f"{options.count} pages in {run.seconds:.0f} s: {60 * options.count / run.seconds:.1f} a "
        f"minute, {run.cpu / options.count:.2f} processor seconds a page, exit code {run.code}"
    )
    print(memory(run))

    first = trace(images, broken, options.jobs, stop_at=options.count // 2)
    time.sleep(1.0)
    done = {p.name: p.stat().st_mtime_ns for p in broken.glob("*.svg")}
    receipts = {f"{p.stem}.svg" for p in (broken / RECEIPTS).glob("*.json")}
    unreadable = [name for name in done if not _is_whole(broken / name)]
    print(f"killed after {first.seconds:.0f} s: {len(done)} drawings, {len(receipts)} receipts")
    second = trace(images, broken, options.jobs)
    entries = json.loads((broken / "report.json").read_text("utf-8"))["images"]
    again = [n for n in receipts if (broken / n).stat().st_mtime_ns != done[n]]
    resumed = sum(entry["resumed"] for entry in entries)
    print(f"resumed: {second.seconds:.0f} s, {resumed} kept, {len(entries) - resumed} traced")
    differ = sorted(
        path.name for path in whole.glob("*.svg") if not _same(path, broken / path.name)
    )
    left = [p.name for p in broken.glob(".*") if ".part" in p.name]
    figures = {
        "unreadable after the kill": unreadable,
        "traced twice": again,
        "different from the whole run": differ,
        "left over": left,
        "failed": [e["input"] for e in entries if e["error"]],
    }
    for name, members in figures.items():
        print(f"{name}: {len(members)} {' '.join(members[:5])}")
    complete = resumed == len(receipts) and len(entries) == options.count
    faults = sum(map(len, figures.values())) + (not complete)
    rate = 60 * options.count / run.seconds
    cost = {"pages_a_minute": rate, "cpu_s_a_page": run.cpu / options.count}
    return {"all pages": cost | {"most_mb": max(m for _, m in run.memory), "faults": faults}}


def trace(images: Path, output: Path, jobs: int, stop_at: int | None = None) -> WatchedRun:
    """Trace a folder of images in a process group of its own; kill it at so many receipts."""
    command = [sys.executable, "-m", "involute", "trace", str(images), "-o", str(output)]
    command += ["--jobs", str(jobs), "--resume", "--report", str(output / "report.json")]
    run, start, next_look = WatchedRun(), time.monotonic(), 0.0
    before = _cpu()
    process = subprocess.Popen(command, start_new_session=True)
    try:
        while (code := process.poll()) is None:
            run.seconds = time.monotonic() - start
            if run.seconds >= next_look:
                run.memory.append((run.seconds, _tree_megabytes(process.pid)))
                next_look += _EVERY
            if stop_at and len(list((output / RECEIPTS).glob("*.json"))) >= stop_at:
                break
            time.sleep(0.05)
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
    run.seconds, run.code, run.cpu = time.monotonic() - start, code, _cpu() - before
    return run


def _cpu() -> float:
    """Processor seconds of all processes that have ended below this one."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def memory(run: WatchedRun) -> str:
    """The most memory in each fifth of a run."""
    at, used = np.array(run.memory).T
    part = np.minimum((5 * at / max(run.seconds, 1e-9)).astype(int), 4)
    most = [f"{used[part == k].max():.0f}" for k in range(5) if (part == k).any()]
    return f"most memory of all processes in each fifth of the time, MB: {', '.join(most)}"


def pages(data: Path, count: int) -> Iterator[Array]:
    """Drawings in turn from every set, each page in a medium of its own, (SIZE, SIZE, 3) BGR."""
    sources = [_drawings(data / f"{name}.npz") for name in _SETS]
    rng = np.random.default_rng(0)
    return (_page(sources[k % len(sources)], rng) for k in range(count))


def _drawings(path: Path) -> list[list[Array]]:
    with np.load(path) as file:
        points = file["points"] / 32.0
        strokes = np.split(points, file["stroke_offsets"][1:-1])
        cuts = file["drawing_offsets"]
    return [strokes[a:b] for a, b in pairwise(cuts)]


def _page(drawings: list[list[Array]], rng: np.random.Generator) -> Array:
    """One drawing or several small ones, in one medium."""
    strokes: list[Array] = []
    while sum(np.hypot(*np.diff(s, axis=0).T).sum() for s in strokes) < _LEAST_LINE:
        angle, size = rng.uniform(-0.3, 0.3), rng.uniform(0.5, 0.9)
        turn = size * np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        place = SIZE / 2 + rng.uniform(-0.5, 0.5, 2) * (1 - size) * SIZE
        drawing = drawings[rng.integers(len(drawings))]
        strokes += [(points - SIZE / 2) @ turn + place for points in drawing]
    ink = np.zeros((SIZE, SIZE), np.uint8)
    width = int(rng.integers(2, 8))
    for points in strokes:
        cv2.polylines(
            ink, [np.round(points * 16).astype(np.int32)], False, 255, width, cv2.LINE_AA, 4
        )
    share = cv2.GaussianBlur(ink, (0, 0), rng.uniform(0.5, 1.0))[..., None] / 255
    if rng.random() < 0.3:  # the grain of pencil and chalk
        grain = cv2.GaussianBlur(rng.normal(0, 1, ink.shape).astype(np.float32), (0, 0), 0.8)
        share = share * np.clip(0.8 + 0.8 * grain, 0, 1)[..., None]
    paper = np.array(_PAPERS[rng.integers(len(_PAPERS))], float)
    color = np.array(_INKS[rng.integers(len(_INKS))], float)
    shade = 1 - rng.uniform(0, 0.3) * np.linspace(0, 1, SIZE)[:, None, None]
    page = (paper * (1 - share) + color * share) * shade
    if rng.random() < 0.1:  # a blackboard
        page = 255 - page
    return np.clip(page + rng.normal(0, 3, page.shape), 0, 255).astype(np.uint8)


def _tree_megabytes(root: int) -> float:
    """Resident memory of a process and all its descendants; what they share counts for each."""
    total, waiting = 0.0, [root]
    while waiting:
        process = Path(f"/proc/{waiting.pop()}")
        try:
            lines = (process / "status").read_text("ascii").splitlines()
            for thread in (process / "task").iterdir():
                waiting += map(int, (thread / "children").read_text("ascii").split())
        except OSError:  # it has just ended
            continue
        total += sum(int(line.split()[1]) for line in lines if line.startswith("VmRSS")) / 1e3
    return total


def _is_whole(path: Path) -> bool:
    try:
        return bool(Drawing.load(path).strokes)
    except InvoluteError:
        return False


def _same(one: Path, other: Path) -> bool:
    return other.exists() and one.read_bytes() == other.read_bytes()


if __name__ == "__main__":
    sys.exit(1 if main()["all pages"]["faults"] else 0)
