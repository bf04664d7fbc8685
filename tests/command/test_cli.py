"""The command line: what is written, what is said, and with which exit code it ends."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import cv2
import numpy as np
import pytest
from involute.command import cli, planning
from involute.command.arguments import parser
from involute.command.inputs import natural
from involute.engine import Drawing, Settings
from involute.engine.formats import FORMATS, Format, load

FAST = ["--provider", "classical", "--router", "geometric"]


def page(path: Path, *, seed: int = 0) -> Path:
    """A cross and a circle."""
    picture = np.full((120, 160), 255, np.uint8)
    cv2.line(picture, (20, 20), (140, 100 - seed), 0, 2, cv2.LINE_AA)
    cv2.line(picture, (20, 100), (140, 20), 0, 2, cv2.LINE_AA)
    cv2.circle(picture, (40, 60), 12, 0, 2, cv2.LINE_AA)
    cv2.imwrite(str(path), picture)
    return path


def run(*arguments, **handed) -> int:
    return cli.main([str(a) for a in arguments], **handed)


def trace(*arguments, **handed) -> int:
    return run("trace", *FAST, *arguments, **handed)


@pytest.fixture
def scans(tmp_path):
    folder = tmp_path / "scans"
    folder.mkdir()
    for number in (1, 2, 10):
        page(folder / f"page{number}.png", seed=number)
    (folder / "notes.txt").write_text("no picture")
    return folder


def names(folder: Path) -> list[str]:
    return sorted(p.name for p in folder.iterdir())


# --- trace -----------------------------------------------------------------------------------


@pytest.mark.parametrize("suffix", [".svg", ".json", ".png"])
def test_one_image_to_one_file(suffix, tmp_path):
    out = tmp_path / f"out{suffix}"
    assert trace(page(tmp_path / "in.png"), "-o", out) == 0
    assert out.stat().st_size > 500
    assert names(tmp_path) == sorted(["in.png", out.name])


def test_a_folder_gives_a_folder(scans, tmp_path):
    out = tmp_path / "new" / "out"
    report = tmp_path / "report.json"
    assert trace(scans, "-o", out, "--format", "svg,json", "--report", report) == 0
    assert names(out) == sorted(f"page{n}.{s}" for n in (1, 2, 10) for s in ("svg", "json"))
    images = json.loads(report.read_text())["images"]
    assert [Path(i["input"]).name for i in images] == ["page1.png", "page2.png", "page10.png"]
    for image in images:
        assert {"strokes", "junctions", "doubtful", "peak_rss_mb"} <= image.keys()
        assert (image["width"], image["height"]) == (160, 120)
        assert {"scan", "centerline", "graph", "routing", "strokes"} <= image["seconds"].keys()
        drawing = load(image["outputs"][1])
        assert image["strokes"] == len(drawing.strokes)


def test_globs_and_same_names(scans, tmp_path):
    page(scans / "page1.jpg")
    out = tmp_path / "out"
    assert trace(scans / "page1.*", scans / "page1.png", "-o", out) == 0
    assert names(out) == ["page1-jpg.svg", "page1-png.svg"]


def test_every_page_of_a_tiff_gives_a_drawing(tmp_path):
    pictures = [cv2.imread(str(page(tmp_path / "in.png", seed=n)), 0) for n in (0, 9)]
    cv2.imwritemulti(str(tmp_path / "pages.tif"), pictures)
    assert trace(tmp_path / "pages.tif", "-o", tmp_path / "out.svg") == 0
    assert names(tmp_path) == ["in.png", "out-1.svg", "out-2.svg", "pages.tif"]


def test_several_processes_write_the_same(scans, tmp_path):
    for jobs in (1, 2):
        assert trace(scans, "-o", tmp_path / str(jobs), "--jobs", jobs) == 0
    for name in ("page1.svg", "page2.svg", "page10.svg"):
        one, two = ((tmp_path / jobs / name).read_text() for jobs in "12")
        assert one == two


def test_existing_outputs_need_overwrite(tmp_path, capsys):
    source, out = page(tmp_path / "in.png"), tmp_path / "out.svg"
    out.write_text("mine")
    assert trace(source, "-o", out) == 1
    assert out.read_text() == "mine"
    assert "--overwrite" in capsys.readouterr().err
    assert trace(source, "-o", out, "--overwrite") == 0
    assert out.read_text() != "mine"


def test_resume_leaves_out_what_is_done(scans, tmp_path):
    out, report = tmp_path / "out", tmp_path / "report.json"

    def resumed() -> list[bool]:
        assert trace(scans, "-o", out, "--resume", "--report", report) == 0
        return [image["resumed"] for image in json.loads(report.read_text())["images"]]

    assert resumed() == [False, False, False]
    page(scans / "page2.png", seed=30)
    assert resumed() == [True, False, True]


def test_what_fails_stops_nothing_else(scans, tmp_path, capsys):
    (scans / "page3.png").write_text("no picture at all")
    (scans / "page4.png").write_bytes((scans / "page1.png").read_bytes()[:-20])
    out, report = tmp_path / "out", tmp_path / "report.json"
    assert trace(scans, tmp_path / "gone.png", "-o", out, "--report", report) == 1
    assert names(out) == ["page1.svg", "page10.svg", "page2.svg"]
    lines = [line for line in capsys.readouterr().err.splitlines() if "libpng" not in line]
    assert sum("left out: notes.txt (not a picture)" in line for line in lines) == 1
    assert len(lines) == 4
    assert all(line.startswith("involute: ") and line[-1] in ".)" for line in lines)
    errors = [image.get("error") for image in json.loads(report.read_text())["images"]]
    assert sum(error is not None for error in errors) == 3


def test_a_blank_page_is_a_warning(tmp_path, capsys):
    cv2.imwrite(str(tmp_path / "in.png"), np.full((60, 60), 250, np.uint8))
    assert trace(tmp_path / "in.png", "-o", tmp_path / "out.svg") == 0
    assert "warning" in capsys.readouterr().err
    assert load(tmp_path / "out.svg").strokes == ()


def test_a_centerline_image(tmp_path):
    picture = np.zeros((100, 100), np.uint8)
    cv2.line(picture, (10, 50), (90, 52), 255, 1, cv2.LINE_AA)
    cv2.imwrite(str(tmp_path / "in.png"), picture)
    assert run("trace", tmp_path / "in.png", "-o", tmp_path / "out.json", "--centerline") == 0
    drawing = Drawing.load(tmp_path / "out.json")
    assert len(drawing.strokes) == 1
    assert drawing.settings.provider == "given"


def test_settings_reach_the_drawing(tmp_path):
    source, out = page(tmp_path / "in.png"), tmp_path / "out.json"
    assert trace(source, "-o", out, "--tolerance", "2.5", "--no-solids", "--no-inks") == 0
    settings = Drawing.load(out).settings
    assert (settings.tolerance, settings.solids, settings.inks) == (2.5, False, False)


def test_every_setting_has_an_option():
    options = vars(parser().parse_args(["trace", "x", "-o", "y"]))
    hidden = {f.name for f in fields(Settings)} - options.keys()
    assert hidden <= {"align"}  # points, which `--align` measures


def test_drawings_are_handed_to_extra_writers(scans, tmp_path):
    written = {}

    def write(drawings, path):
        written[path.suffix] = [(name, len(d.strokes) > 0) for name, d in drawings]
        path.write_text("blend")

    out = tmp_path / "all.blend"
    blend = Format(suffix=".blend", about="many drawings", endings=(b"blend",), write_many=write)
    assert trace(scans, "-o", out, formats=[blend]) == 0
    assert written == {".blend": [("page1", True), ("page2", True), ("page10", True)]}
    assert out.read_text() == "blend"
    assert trace(scans / "page1.png", "-o", tmp_path / "x.blend") == 2  # there is no such format


def test_a_failing_writer_leaves_nothing(tmp_path, capsys):
    def write(drawings, path):
        path.write_text("half")
        raise OSError(28, "No space left on device")

    source, out = page(tmp_path / "in.png"), tmp_path / "out.blend"
    blend = Format(suffix=".blend", about="many drawings", endings=(b"blend",), write_many=write)
    assert trace(source, "-o", out, formats=[blend]) == 1
    assert "disk is full" in capsys.readouterr().err
    assert names(tmp_path) == ["in.png"]


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["paint"],
        ["trace"],
        ["trace", "in.png"],
        ["trace", "in.png", "-o", "out.svg", "--sharpness", "3"],
        ["trace", "in.png", "-o", "out.svg", "--smoothing", "7"],
        ["trace", "in.png", "-o", "out.svg", "--polarity", "blue"],
        ["trace", "in.png", "-o", "out.svg", "--jobs", "-2"],
        ["trace", "in.png", "-o", "out.svg", "--format", "json"],
        ["trace", "in.png", "-o", "out.doc"],
        ["trace", "in.png", "-o", "out", "--format", "svg,doc"],
        ["trace", "in.png", "in2.png", "-o", "out.svg"],
        ["trace", "in.png", "-o", "out.svg", "--align"],
        ["trace", "in.png", "-o", "out.svg", "--start", "5"],
    ],
)
def test_wrong_usage_is_2_and_writes_nothing(arguments, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for name in ("in.png", "in2.png"):
        page(tmp_path / name)
    assert run(*arguments) == 2
    assert names(tmp_path) == ["in.png", "in2.png"]
    assert capsys.readouterr().err


@pytest.mark.parametrize(
    ("inputs", "out", "says"),
    [
        (["gone.png"], "out.svg", "no file gone.png"),
        (["empty"], "out", "no image in empty"),
        (["*.tiff"], "out", "no image in"),
        (["in.png"], "nowhere/out.svg", "folder doesn't exist"),
        (["in.png"], "in.png/out.svg", "Can't"),
        (["in.png"], "in.png/out", "Can't"),
    ],
)
def test_what_can_not_be_done_is_1_and_a_sentence(inputs, out, says, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    page(tmp_path / "in.png")
    (tmp_path / "empty").mkdir()
    assert trace(*inputs, "-o", out) == 1
    error = capsys.readouterr().err
    assert says in error
    assert "Traceback" not in error
    assert len(error.splitlines()) == 1


def test_help_is_there(capsys):
    for command in ([], ["trace"], ["inspect"], ["evaluate"]):
        assert run(*command, "--help") == 0
        assert "usage: involute" in capsys.readouterr().out


# --- inspect and evaluate --------------------------------------------------------------------


def test_inspect_lists_junctions(tmp_path, capsys):
    out = tmp_path / "out.json"
    trace(page(tmp_path / "in.png"), "-o", out)
    assert run("inspect", out) == 0
    text = capsys.readouterr().out
    drawing = Drawing.load(out)
    assert "160 x 120 px" in text
    assert f"strokes    {len(drawing.strokes)}" in text
    assert len(text.split("junction ")[1].splitlines()) == 1 + len(drawing.junctions)


def test_inspect_looks_at_scans(tmp_path, capsys):
    assert run("inspect", page(tmp_path / "in.png")) == 0
    assert "px wide" in capsys.readouterr().out
    assert run("inspect", tmp_path / "gone.png") == 1
    assert run("inspect", tmp_path / "gone.json") == 1


def test_evaluate_prints_what_it_is_given(tmp_path, capsys):
    figures = {"chamfer": 0.5, "f1": 0.75}
    assert run("evaluate", "a.svg", "b.svg", "--json", evaluate=lambda a, b: figures) == 0
    assert json.loads(capsys.readouterr().out) == figures
    assert run("evaluate", "a.svg", "b.svg", evaluate=lambda a, b: figures) == 0
    assert "0.750" in capsys.readouterr().out
    assert run("evaluate", "a.svg", "b.svg") == 1


def test_evaluate_finds_a_drawing_equal_to_itself(tmp_path, capsys):
    pytest.importorskip("shapely")
    from involute.__main__ import main

    out = tmp_path / "out.svg"
    trace(page(tmp_path / "in.png"), "-o", out)
    assert main(["evaluate", str(out), str(out), "--json"]) == 0
    figures = json.loads(capsys.readouterr().out)
    assert figures["f1"] == 1.0
    assert figures["chamfer"] == pytest.approx(0, abs=1e-6)
    assert main(["evaluate", str(out), str(tmp_path / "gone.svg")]) == 1
    assert "gone.svg" in capsys.readouterr().err


# --- planning --------------------------------------------------------------------------------


def test_natural_order():
    paths = [Path(n) for n in ("b.png", "a10.png", "a2.png", "A1.png", "1.png")]
    ordered = [p.name for p in sorted(paths, key=natural)]
    assert ordered == ["1.png", "A1.png", "a2.png", "a10.png", "b.png"]


def test_outputs_never_collide():
    target = planning.target("out", "svg,json", FORMATS)
    sources = [(Path(n), 1) for n in ("x/a.png", "y/a.png", "a.png", "A.jpg", "b.tif")]
    sources[-1] = (Path("b.tif"), 12)
    pages = planning.pages(sources, target)
    outputs = [str(o).lower() for p in pages for o in p.outputs]
    assert len(set(outputs)) == len(outputs) == 2 * (4 + 12)
    assert pages[-1].name == "b-12"
    assert pages[4].name == "b-01"


def test_importing_the_command_line_is_light():
    code = (
        "import sys, involute.command.cli; print({'cv2', 'torch', 'networkx'} & sys.modules.keys())"
    )
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert result.stdout.strip() == "set()"


# --- for other programs ----------------------------------------------------------------------


def test_formats_for_other_programs_are_listed_and_written(tmp_path, capsys):
    assert run("trace", "--help") == 0
    told = " ".join(capsys.readouterr().out.split())
    assert all(f"{kind.name}: {kind.about}" in told for kind in FORMATS)
    source, out = page(tmp_path / "page.png"), tmp_path / "out"
    chosen = ",".join(kind.name for kind in FORMATS)
    assert trace(source, "-o", out, "--format", chosen) == 0
    assert names(out) == sorted(f"page{kind.suffix}" for kind in FORMATS)
    assert trace(source, "-o", out, "--format", chosen, "--resume", "--overwrite") == 0
    assert trace(source, "-o", tmp_path / "lines.plot.svg") == 0
    assert "mm" in (tmp_path / "lines.plot.svg").read_text()[:300]


def test_an_image_named_like_a_format_does_not_become_one(tmp_path):
    pages = [page(tmp_path / "page.png"), page(tmp_path / "page.plot.png", seed=3)]
    out = tmp_path / "out"
    assert trace(*pages, "-o", out, "--format", "svg,plot.svg") == 0
    assert names(out) == [
        "page.plot-png.plot.svg",
        "page.plot-png.svg",
        "page.plot.svg",
        "page.svg",
    ]
    assert "data-stroke" in (out / "page.svg").read_text()


def test_an_svg_of_another_program_is_cleaned_up(tmp_path):
    other = tmp_path / "other.svg"
    other.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 99 99" stroke="red" stroke-width="3">'
        '<path d="M9 50 h40"/><path d="M49 50 h40"/></svg>'
    )
    assert trace(other, "-o", tmp_path / "clean.json") == 0
    (stroke,) = load(tmp_path / "clean.json").strokes
    assert np.ptp(stroke.points[:, 0]) == pytest.approx(80, abs=1)
    assert trace(other, "-o", other, "--overwrite") == 1  # what is read is never written


@pytest.mark.parametrize("name", ["shot.pli", "shot.pdf", "shot.lottie.json"])
def test_a_sequence_goes_into_one_file_for_other_programs(name, scans, tmp_path):
    assert trace(scans, "-o", tmp_path / name, "--sequence") == 0
    assert (tmp_path / name).stat().st_size > 500


def test_a_format_without_its_library_is_told_before_anything_is_traced(
    tmp_path, capsys, monkeypatch
):
    monkeypatch.setattr("involute.engine.formats.find_spec", lambda name: None)
    assert trace(page(tmp_path / "page.png"), "-o", tmp_path / "page.dxf") == 2
    assert "needs the library ezdxf" in capsys.readouterr().err
