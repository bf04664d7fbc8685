"""Weights are known by their content: other ones make other drawings, damaged ones none."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest
from involute.engine import weights
from involute.training import digests, lineage

RENEW = "run `python -m training.digests` and commit engine/weights/digests.json"
FINGERPRINT = """
import sys
from program.command.receipts import fingerprint
from program.engine import Settings
print(fingerprint(sys.argv[1], 0, Settings()))
"""
TRACE = """
import sys
from program.command.cli import main
sys.exit(main(["trace", sys.argv[1], "-o", sys.argv[2], "--format", "json", "--resume",
               "--corners", "0", "--report", sys.argv[3],
               "--provider", sys.argv[4], "--drawing", sys.argv[5]]))
"""
FRAMES = """
import sys
from program.command import trace_sequence
from program.engine.sequence import number_frames
def show(frame, outcome):
    print(outcome.resumed, outcome.error)
for _ in trace_sequence(number_frames([sys.argv[1]]), jobs=1, parts=sys.argv[2], progress=show):
    pass
"""


@pytest.fixture
def engine(tmp_path: Path) -> Path:
    """A copy of the engine, in a copy of the program beside `page.png`."""
    page = np.full((90, 120), 255, np.uint8)
    cv2.line(page, (10, 20), (110, 60), 0, 3, cv2.LINE_AA)
    cv2.line(page, (10, 70), (110, 20), 0, 3, cv2.LINE_AA)
    cv2.imwrite(str(tmp_path / "page.png"), page)
    origin, program = weights.FOLDER.parents[1], tmp_path / "program"
    ignored = shutil.ignore_patterns("__pycache__")
    for room in ("command", "engine"):
        shutil.copytree(origin / room, program / room, ignore=ignored)
    (program / "__init__.py").touch()
    return program / "engine"


def python(engine: Path, code: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-B", "-c", code, "page.png", *arguments]
    return subprocess.run(
        command, cwd=engine.parents[1], capture_output=True, text=True, check=False
    )


def said(engine: Path, code: str, *arguments: str) -> str:
    done = python(engine, code, *arguments)
    assert not done.returncode, done.stderr
    return done.stdout.strip()


def change(path: Path) -> None:
    """Another byte in the middle of a file; its size stays."""
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)


def other_calibration(engine: Path) -> None:
    """Routing that joins less, in a file of the same size, with its digest renewed."""
    path = engine / "weights" / "routing.json"
    before = path.read_text("utf-8")
    path.write_text(before.replace("0.", "1.", 1), "utf-8")
    assert path.read_text("utf-8") != before
    digests.write(path.parent)


def test_every_weight_has_the_digest_of_its_content() -> None:
    noted = json.loads((weights.FOLDER / weights.DIGESTS).read_text("utf-8"))
    found = {name: lineage.sha256(weights.FOLDER / name) for name in weights.names()}
    assert noted == found, RENEW
    assert {"centerline.onnx", "routing.onnx", "routing.json", "undrawn.npz"} <= set(found)


def test_every_weight_and_every_source_is_in_the_fingerprint(engine: Path) -> None:
    seen = {said(engine, FINGERPRINT)}
    assert {said(engine, FINGERPRINT)} == seen
    files = [*(engine / "weights" / name for name in weights.names()), engine / "graph/gaps.py"]
    for count, file in enumerate(files, 2):
        if file.suffix == ".py":
            file.write_text(file.read_text("utf-8").replace("the", "teh", 1), "utf-8")
        else:
            change(file)
        seen.add(said(engine, FINGERPRINT))
        assert len(seen) == count, f"{file.name} is not in it"


def resumed_batch(engine: Path) -> bool:
    assert python(engine, TRACE, "out", "report.json", "auto", "rough").returncode == 0
    report = json.loads((engine.parents[1] / "report.json").read_text("utf-8"))
    return report["images"][0]["resumed"]


def kept_frame(engine: Path) -> bool:
    return said(engine, FRAMES, "parts") == "True None"


@pytest.mark.parametrize("was_kept", [resumed_batch, kept_frame])
def test_weights_of_the_same_size_make_drawings_anew(
    engine: Path, was_kept: Callable[[Path], bool]
) -> None:
    assert [was_kept(engine) for _ in range(2)] == [False, True]
    other_calibration(engine)
    assert [was_kept(engine) for _ in range(2)] == [False, True]


@pytest.mark.parametrize("name", weights.names())
def test_damaged_weights_are_said_in_one_sentence(engine: Path, name: str) -> None:
    change(engine / "weights" / name)
    provider = "lean" if "lean" in name else "auto"
    drawing = "clean" if "second" in name else "rough"
    done = python(engine, TRACE, "out", "report.json", provider, drawing)
    assert done.returncode == 1
    assert f"The weights in {name} are damaged; reinstall Involute" in done.stderr
    assert "Traceback" not in done.stderr
    assert not list((engine.parents[1] / "out").glob("*.json"))


def test_weights_of_ones_own_are_taken_as_they_are(tmp_path: Path) -> None:
    (tmp_path / "routing.json").write_text("{}")
    assert weights.read(tmp_path / "routing.json") == b"{}"


def test_who_writes_shipped_weights_renews_the_digests(engine: Path) -> None:
    folder = engine / "weights"
    digests.note(engine / "page.npz")
    assert not (engine / weights.DIGESTS).exists()
    change(folder / "undrawn.npz")
    digests.note(folder / "undrawn.npz")
    noted = json.loads((folder / weights.DIGESTS).read_text("utf-8"))
    assert noted["undrawn.npz"] == lineage.sha256(folder / "undrawn.npz")
