"""No input is ever written; finished work stays; names never collide: whatever the options."""

from __future__ import annotations

import json
import os
from itertools import product
from pathlib import Path

import cv2
import numpy as np
import pytest
from involute.command import cli
from involute.engine import Drawing
from involute.engine.formats import Format

FAST = ["--provider", "classical", "--router", "geometric"]


def page(path: Path, seed: int = 0) -> Path:
    """Two lines."""
    picture = np.full((80, 100), 255, np.uint8)
    cv2.line(picture, (10, 10 + seed), (90, 60), 0, 2, cv2.LINE_AA)
    cv2.line(picture, (10, 60), (90, 20), 0, 2, cv2.LINE_AA)
    path.parent.mkdir(exist_ok=True)
    cv2.imwrite(str(path), picture)
    return path


def write_blend(drawings, path: Path) -> None:
    path.write_text(" ".join(name for name, _ in drawings) + " blend")


def write_moving(name: str, frames, path: Path) -> None:
    path.write_text(" ".join(str(frame) for frame, _ in frames) + " blend")


BLEND = Format(
    suffix=".blend",
    about="a stand-in",
    endings=(b"blend",),
    write_many=write_blend,
    write_sequence=write_moving,
)


def trace(*arguments) -> int:
    return cli.main(["trace", *FAST, *map(str, arguments)], formats=[BLEND])


def contents(folder: Path) -> dict[str, bytes]:
    return {p.name: p.read_bytes() for p in folder.iterdir() if p.is_file()}


def resumed(*arguments, report: Path) -> list[bool]:
    assert trace(*arguments, "--resume", "--report", report) == 0
    return [image["resumed"] for image in json.loads(report.read_text())["images"]]


# --- inputs ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("formats", "more"),
    list(
        product(
            ("png", "svg,png", "blend,png"),
            ([], ["--resume"], ["--overwrite"], ["--resume", "--overwrite"], ["--jobs", "2"]),
        )
    ),
)
def test_scans_are_never_replaced_by_their_previews(formats, more, tmp_path):
    for number in range(2):
        page(tmp_path / f"p{number}.png", number)
    before = contents(tmp_path)
    assert trace(tmp_path, "-o", tmp_path, "--format", formats, *more) == 1
    assert {name: (tmp_path / name).read_bytes() for name in before} == before


@pytest.mark.parametrize("more", [[], ["--resume"], ["--overwrite"]])
@pytest.mark.parametrize("how", ["itself", "link", "hard link", "report", "sequence"])
def test_an_image_is_never_written_by_whatever_name(how, more, tmp_path):
    scan = page(tmp_path / "in" / "p1.png")
    page(tmp_path / "in" / "p2.png", 5)
    before = scan.read_bytes()
    out, words = tmp_path / "out.png", [scan]
    if how == "itself":
        out = scan
    elif how == "link":
        out.symlink_to(scan)
    elif how == "hard link":
        os.link(scan, out)
    elif how == "report":
        out, words = tmp_path / "out.svg", [scan, "--report", scan]
    else:
        words = [tmp_path / "in", "--sequence", "--format", "png"]
        out = tmp_path / "in"
    assert trace(*words, "-o", out, *more) in (1, 2)
    assert scan.read_bytes() == before
    if how == "link":
        assert out.is_symlink()


# --- finished work ---------------------------------------------------------------------------


def test_resume_leaves_what_it_did_not_make(tmp_path, capsys):
    scan, out = page(tmp_path / "in" / "p.png"), tmp_path / "out"
    out.mkdir()
    for suffix in ("svg", "blend"):
        mine = out / f"p.{suffix}"
        mine.write_text("drawn by hand for days")
        assert trace(scan, "-o", out, "--format", suffix, "--resume") == 1
        assert mine.read_text() == "drawn by hand for days"
        assert "--overwrite" in capsys.readouterr().err
        assert trace(scan, "-o", out, "--format", suffix, "--resume", "--overwrite") == 0
        assert "drawn by hand" not in mine.read_text()


@pytest.mark.parametrize("suffix", ["svg", "json", "blend"])
def test_resume_leaves_what_was_edited_since(suffix, tmp_path, capsys):
    scan, out = page(tmp_path / "in" / "p.png"), tmp_path / "out"
    words = [scan, "-o", out, "--format", suffix]
    assert trace(*words, "--resume") == 0
    made = out / f"p.{suffix}"
    edited = "edited " + made.read_text()
    made.write_text(edited)
    assert trace(*words, "--resume") == 0
    assert trace(*words, "--resume", "--smoothing", "0.5") == 0
    assert made.read_text() == edited
    assert "edited since" in capsys.readouterr().err
    assert trace(*words, "--resume", "--overwrite") == 0
    assert not made.read_text().startswith("edited")


@pytest.mark.parametrize("suffix", ["svg", "json", "png", "blend"])
def test_a_file_that_was_cut_short_is_made_again(suffix, tmp_path):
    scan, out = page(tmp_path / "in" / "p.png"), tmp_path / "out"
    words = [scan, "-o", out, "--format", suffix, "--resume"]
    assert trace(*words) == 0
    made = out / f"p.{suffix}"
    whole = made.read_bytes()
    for size in (0, len(whole) // 2, len(whole) - 3):
        made.write_bytes(whole[:size])
        assert trace(*words) == 0
        assert len(made.read_bytes()) > len(whole) - 40  # seconds differ
        if suffix in ("svg", "json"):
            assert Drawing.load(made).strokes


def test_nothing_is_traced_again_for_a_blend(tmp_path):
    scans, out, report = tmp_path / "in", tmp_path / "out", tmp_path / "report.json"
    for number in range(2):
        page(scans / f"p{number}.png", number)
    for formats in ("blend", "svg,blend"):
        words = [scans, "-o", out, "--format", formats]
        resumed(*words, report=report)
        before = {p: p.stat().st_mtime_ns for p in out.iterdir() if p.is_file()}
        assert resumed(*words, report=report) == [True, True]
        assert {p: p.stat().st_mtime_ns for p in out.iterdir() if p.is_file()} == before
    page(scans / "p1.png", 9)
    assert resumed(*words, report=report) == [True, False]


def test_all_drawings_stay_in_a_shared_blend(tmp_path):
    scans, out, report = tmp_path / "in", tmp_path / "all.blend", tmp_path / "report.json"
    for number in range(2):
        page(scans / f"p{number}.png", number)
    assert resumed(scans, "-o", out, report=report) == [False, False]
    assert resumed(scans, "-o", out, report=report) == [True, True]
    page(scans / "p1.png", 9)
    assert resumed(scans, "-o", out, report=report) == [True, False]  # one is traced, both written
    assert out.read_text() == "p0 p1 blend"
    out.write_text("edited blend")
    page(scans / "p1.png", 12)
    assert resumed(scans, "-o", out, report=report) == [True, True]
    assert out.read_text() == "edited blend"


@pytest.mark.parametrize("out", ["shot.blend", "shot"])
def test_a_sequence_keeps_finished_work(out, tmp_path, capsys):
    scans, report = tmp_path / "in", tmp_path / "report.json"
    for number in (1, 2):
        page(scans / f"p{number}.png", number)
    words = [scans, "--sequence", "-o", tmp_path / out]
    words += [] if out.endswith(".blend") else ["--format", "svg"]
    assert resumed(*words, report=report) == [False, False]
    made = tmp_path / out if out.endswith(".blend") else tmp_path / out / "p1.svg"
    before = made.stat().st_mtime_ns
    assert resumed(*words, report=report) == [True, True]
    assert made.stat().st_mtime_ns == before
    edited = "edited " + made.read_text()
    made.write_text(edited)
    page(scans / "p2.png", 9)
    assert resumed(*words, report=report) in ([True, False], [True, True])
    assert made.read_text() == edited
    assert "edited since" in capsys.readouterr().err
    assert trace(*words, "--resume", "--overwrite") == 0
    assert made.read_text() != edited
    made.write_text("by hand")
    assert trace(*words) == 2
    assert made.read_text() == "by hand"


# --- names -----------------------------------------------------------------------------------


def test_pages_and_images_of_the_same_name_all_get_a_file(tmp_path):
    scans, out = tmp_path / "in", tmp_path / "out"
    for number in (1, 2, 3):
        page(scans / f"a-{number}.png", number)
    pictures = [cv2.imread(str(scans / f"a-{k}.png"), 0) for k in (1, 2, 3)]
    cv2.imwritemulti(str(scans / "a.tif"), pictures)
    assert trace(scans, "-o", out) == 0
    assert len(contents(out)) == 6
    assert {"a-1-png.svg", "a-tif-1.svg"} <= contents(out).keys()


def test_no_drawing_takes_over_the_name_of_another(tmp_path):
    scans, out = tmp_path / "in", tmp_path / "out"
    odd = ["a.png", "A.png", "a.jpg", "A.jpeg", "a-png.png", "a-jpg.png", "a.tif", "a-2.png"]
    for seed, name in enumerate(odd):
        page(scans / name, seed)
    assert trace(scans, "-o", out, "--resume") == 0
    first = contents(out)
    assert len({name.lower() for name in first}) == len(odd)
    (scans / "A.png").unlink()
    assert trace(scans, "-o", out, "--resume") == 0
    assert {name: (out / name).read_bytes() for name in first} == first


def test_long_names_are_cut_and_stay_apart(tmp_path):
    scans, out = tmp_path / "in", tmp_path / "out"
    for seed, end in enumerate("xy"):
        page(scans / f"{'漢' * 81}{end}.png", seed)
    assert trace(scans, "-o", out, "--format", "svg,blend", "--resume") == 0
    assert len(contents(out)) == 4
