"""The n-th write, rename or sync of a batch fails, for every n: the promises hold each time."""

from __future__ import annotations

import builtins
import errno
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import cv2
import numpy as np
import pytest
from involute.command import cli
from involute.engine import Drawing
from involute.engine.formats import Format

FAST = ["--provider", "classical", "--router", "geometric"]
CALLS = ("open", "write", "fsync", "replace")


def write_blend(drawings, path: Path) -> None:
    with open(path, "wb") as file:
        file.write(b"".join(name.encode() for name, _ in drawings) + b" blend")


BLEND = Format(suffix=".blend", about="stand-in", endings=(b"blend",), write_many=write_blend)


def trace(*arguments) -> int:
    return cli.main(["trace", *FAST, "--quiet", *map(str, arguments)], formats=[BLEND])


@pytest.fixture
def scans(tmp_path) -> Path:
    folder = tmp_path / "in"
    folder.mkdir()
    for number in range(2):
        page = np.full((40, 60), 255, np.uint8)
        cv2.line(page, (5, 5 + 4 * number), (55, 35), 0, 2, cv2.LINE_AA)
        cv2.imwrite(str(folder / f"p{number}.png"), page)
    return folder


class Fault:
    """Counts the calls that change the disk below a folder, and makes one of them fail."""

    def __init__(self, at: int, folder: Path) -> None:
        self.count, self._at, self._folder = 0, at, str(folder)

    def __call__(self, path: object) -> None:
        if str(path).startswith(self._folder):
            self.count += 1
            if self.count == self._at:
                raise OSError(errno.ENOSPC, "No space left on device", str(path))


class Writing:
    """A file whose writes may fail, half-way."""

    def __init__(self, file, fault: Fault) -> None:
        self._file, self._fault = file, fault

    def write(self, data) -> int:
        try:
            self._fault(self._file.name)
        except OSError:
            self._file.write(data[: len(data) // 2])
            raise
        return self._file.write(data)

    def __getattr__(self, name: str):
        return getattr(self._file, name)

    def __enter__(self) -> Writing:
        return self

    def __exit__(self, *error: object) -> None:
        self._file.close()


@contextmanager
def failing(fault: Fault, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    def watched(call: Callable, place: int = 0) -> Callable:
        def run(*arguments, **more):
            fault(arguments[place])
            return call(*arguments, **more)

        return run

    def opened(path, mode="r", *more, **options):
        file = real_open(path, mode, *more, **options)
        return Writing(file, fault) if mode == "wb" else file

    def synced(number: int) -> None:
        fault(os.readlink(f"/proc/self/fd/{number}"))
        real_sync(number)

    real_open, real_sync, real_os_open = builtins.open, os.fsync, os.open

    def made(path, flags, *more, **options):
        if flags & os.O_CREAT:
            fault(path)
        return real_os_open(path, flags, *more, **options)

    with monkeypatch.context() as patch:
        patch.setattr(os, "replace", watched(os.replace, 1))
        patch.setattr(os, "fsync", synced)
        patch.setattr(os, "open", made)
        patch.setattr(builtins, "open", opened)
        yield


def contents(folder: Path) -> dict[str, bytes]:
    return {p.name: p.read_bytes() for p in folder.iterdir() if p.is_file()}


def check(out: Path, before: dict[str, bytes]) -> None:
    """Outputs are whole, or absent, or what they were; nothing else is left."""
    for path in out.rglob("*") if out.is_dir() else ():
        assert ".part" not in path.name
        if path.parent != out or path.is_dir():
            continue
        if path.read_bytes() == before.get(path.name):
            continue
        if path.suffix in (".svg", ".json"):
            assert Drawing.load(path).strokes
        elif path.suffix == ".blend":
            assert path.read_bytes().endswith(b" blend")
        else:
            assert cv2.imread(str(path)) is not None


@pytest.mark.skipif(not Path("/proc/self/fd").exists(), reason="needs Linux to name what is synced")
@pytest.mark.parametrize(
    ("formats", "words"),
    [("svg,json", ["--resume"]), ("png,blend", ["--resume"]), ("svg", ["--overwrite"])],
)
def test_a_fault_at_every_write_breaks_no_promise(formats, words, scans, tmp_path, monkeypatch):
    images = contents(scans)
    reference = tmp_path / "reference"
    assert trace(scans, "-o", reference, "--format", formats) == 0
    names = contents(reference).keys()
    faults = 0
    while True:
        out = tmp_path / f"out{faults}"
        before = {}
        if words == ["--overwrite"]:
            out.mkdir()
            before = dict.fromkeys(names, b"an older drawing")
            for name, content in before.items():
                (out / name).write_bytes(content)
        fault = Fault(faults + 1, out)
        with failing(fault, monkeypatch):
            code = trace(scans, "-o", out, "--format", formats, *words)
        if fault.count <= faults:
            assert code == 0
            break
        faults += 1
        assert code == 1, f"fault {faults} was not told"
        assert contents(scans) == images
        check(out, before)
        # Going on from there makes all that is missing, and takes nothing of ours for another's.
        assert trace(scans, "-o", out, "--format", formats, *words) == 0, f"after fault {faults}"
        assert contents(out).keys() == names
        for name, content in contents(reference).items():
            if not name.endswith(".json"):  # holds times
                assert (out / name).read_bytes() == content
    assert faults >= 4 * len(CALLS) - 2 * (formats == "svg") * len(CALLS)
