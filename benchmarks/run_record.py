"""What a run of a benchmark found, with what it depends on: a line of JSON in results/NAME.jsonl.

A result without the commit, the weights and the machine that it was taken with can't be compared
with another. Every run is appended; commit the few lines that the README or a change rests on.
"""

from __future__ import annotations

import hashlib
import json
import os
import platform
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from pathlib import Path

from involute.engine import weights

# Row -> column -> figure, as a table shows them.
Figures = Mapping[str, Mapping[str, float]]

RESULTS = Path(__file__).parent / "results"
_ROOT = Path(__file__).resolve().parents[1]
_DIGITS = 4  # significant digits: what is behind them is noise, and the file stays small


@dataclass(frozen=True)
class Record:
    """One run of a benchmark.

    commit: short name of the sources' commit, with "+" when files were changed since.
    weights: the start of the SHA-256 of all shipped weights. arguments: options that were given.
    """

    run: str
    when: str
    commit: str
    weights: str
    machine: dict[str, str | int]
    arguments: list[str]
    figures: dict[str, dict[str, float]]

    @staticmethod
    def of(run: str, arguments: Sequence[str], figures: Figures, at: str | None = None) -> Record:
        """A record of now, here; at: the commit when the run began, if that is not now."""
        rows = {
            row: {name: rounded(value) for name, value in columns.items()}
            for row, columns in figures.items()
        }
        now = datetime.now(UTC).isoformat(timespec="minutes")
        at = commit() if at is None else at
        return Record(run, now, at, weights_digest(), machine(), list(arguments), rows)

    def append(self, folder: Path = RESULTS) -> Path:
        """Write the record below the others of its run."""
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / f"{self.run}.jsonl"
        with path.open("a", encoding="utf-8") as file:
            file.write(json.dumps(asdict(self)) + "\n")
        return path


def read(run: str, folder: Path = RESULTS) -> list[Record]:
    """All records of a run, the oldest first; none when it has never been run."""
    path = folder / f"{run}.jsonl"
    if not path.exists():
        return []
    return [Record(**json.loads(line)) for line in path.read_text("utf-8").splitlines() if line]


def found(name: str, folder: Path = RESULTS) -> Record:
    """One record: "RUN" is its last one, "RUN~1" that before it, "RUN@COMMIT" the last of a commit.

    Raises:
        ValueError: there is none of that name.
    """
    run, _, commit_name = name.partition("@")
    run, _, back = run.partition("~")
    records = [r for r in read(run, folder) if r.commit.startswith(commit_name)]
    if not back.isdecimal() and back:
        raise ValueError(f"{name}: after ~ goes a number, as in {run}~1.")
    if int(back or 0) >= len(records):
        raise ValueError(f"There is no result {name}; first: python -m benchmarks run {run}")
    return records[-1 - int(back or 0)]


def rounded(value: float) -> float:
    """A figure with the digits that mean something."""
    return float(f"{float(value):.{_DIGITS}g}")


def commit() -> str:
    """The commit of these sources, "+" behind it when they differ from it; "" without git."""
    try:
        name, changed = (
            subprocess.run(
                ["git", *command], cwd=_ROOT, capture_output=True, text=True, check=True
            ).stdout.strip()
            for command in (
                ["rev-parse", "--short=10", "HEAD"],
                # Results that were just written change no result.
                ["status", "--porcelain", "--untracked-files=no", "--", ".", ":!*.jsonl"],
            )
        )
    except (OSError, subprocess.CalledProcessError):
        return ""
    return f"{name}+" if changed else name


def weights_digest() -> str:
    """The start of the SHA-256 of all shipped weights, file by file."""
    digest = hashlib.sha256()
    for name in weights.names():
        digest.update(name.encode())
        digest.update(hashlib.sha256((weights.FOLDER / name).read_bytes()).digest())
    return digest.hexdigest()[:12]


def machine() -> dict[str, str | int]:
    """Cores that this process may use, their name, and the Python that runs."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return {"cores": cores or 1, "cpu": _cpu_name(), "python": platform.python_version()}


def _cpu_name() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text("utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    named = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(named, platform.machine())
