"""The farm's job: valid, runs for real, makes what one command makes."""

from __future__ import annotations

import json
import shlex
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from involute.command import cli
from involute.command.arguments import parser
from involute.command.cli import main
from involute.command.farm import frame_ranges, write_job
from involute.command.setting_options import settings_options
from involute.engine import Drawing, InvoluteError, Settings
from involute.engine.sequence.frames import FrameRange

from tests.command.numbered_scans import make_frames

CALL = f"{shlex.quote(sys.executable)} -m involute"
QUICK = ["--provider", "classical", "--router", "geometric"]


def openjd(*words):
    pytest.importorskip("openjd.cli")
    command = [sys.executable, "-m", "openjd", *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True)


def template_of(folder):
    return json.loads((folder / "template.json").read_text(encoding="utf-8"))


def test_the_job_run_for_real_makes_what_one_command_makes(tmp_path):
    scans = tmp_path / "scans of shot 7"
    numbers = [*range(1, 9), *range(11, 23)]
    make_frames(scans, numbers)
    (scans / "walk_0012.png").write_text("torn page")
    out, job = tmp_path / "out", tmp_path / "job"
    write = ["farm-job", str(job), str(scans), "-o", str(out / "shot"), "--chunk", "10"]
    assert main([*write, "--call", CALL, "--step", "2", *QUICK]) == 0
    checked = openjd("check", job / "template.json")
    assert checked.returncode == 0, checked.stdout + checked.stderr
    ran = openjd(
        "run",
        job / "template.json",
        "--step",
        "Join",
        "--run-dependencies",
        "-p",
        f"Images={scans}",
        "-p",
        f"OutputDir={out}",
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr

    single = tmp_path / "single"
    command = ["trace", str(scans), "--sequence", "-o", str(single), "--step", "2", *QUICK]
    assert main(command) == 1  # the torn page
    made = sorted(p.name for p in (out / "shot").iterdir())
    assert made == sorted(p.name for p in single.iterdir())
    assert len(made) == 19
    for name in made:
        farmed, local = Drawing.load(out / "shot" / name), Drawing.load(single / name)
        # The number of threads may change the last bits, and so which points are spared.
        for one, other in zip(farmed.strokes, local.strokes, strict=True):
            np.testing.assert_allclose(one.points[[0, -1]], other.points[[0, -1]], atol=0.5)
    report = json.loads((out / "shot-report.json").read_text(encoding="utf-8"))["images"]
    assert [r["frame"] for r in report] == [1 + 2 * (n - 1) for n in numbers]
    assert [Path(r["input"]).name for r in report if r["error"]] == ["walk_0012.png"]
    assert sum(r["resumed"] for r in report) == 19


def test_the_bundle_is_whole_and_names_no_folder_in_its_template(tmp_path):
    scans, job = tmp_path / "scans", tmp_path / "job"
    make_frames(scans, [1, 2, 3, 7])
    write = ["farm-job", str(job), str(scans), "-o", str(tmp_path / "o" / "shot.blend")]
    assert main([*write, "--ignore-inks", "blue,red", "--no-solids", "--align"]) == 0
    template = template_of(job)
    assert str(tmp_path) not in json.dumps(template)
    values = json.loads((job / "parameter_values.json").read_text(encoding="utf-8"))
    assert {v["name"]: Path(v["value"]) for v in values["parameterValues"]} == {
        "Images": scans,
        "OutputDir": tmp_path / "o",
    }
    frames = next(p for p in template["parameterDefinitions"] if p["name"] == "Frames")
    assert frames["default"] == "1-3,7"
    for step in template["steps"]:
        words = step["script"]["actions"]["onRun"]["args"]
        assert "--no-solids" in words
        assert "--align" in words
        assert words[words.index("--ignore-inks") + 1] == "blue,red"
    assert template["steps"][1]["dependencies"] == [{"dependsOn": "Trace"}]


def test_wrong_jobs_are_refused(tmp_path, capsys):
    scans = tmp_path / "scans"
    make_frames(scans, [1])
    job = ["farm-job", str(tmp_path / "job"), str(scans), "-o", str(tmp_path / "o.blend")]
    assert main([*job, "--chunk", "0"]) == 1
    assert main([*job, "--call", " "]) == 1
    assert main([*job, "--frames", "5-9"]) == 1
    assert main(["farm-job", str(tmp_path / "job")]) == 2
    assert "no frames 5-9" in capsys.readouterr().err


@given(st.sets(st.integers(0, 5000), min_size=1, max_size=400))
def test_ranges_hold_all_the_numbers(numbers):
    text = frame_ranges(numbers)
    assert len(text) <= 1024
    chosen = FrameRange.parse(text)
    assert all(n in chosen for n in numbers)
    if len(numbers) < 100:
        assert sum(n in chosen for n in range(5001)) == len(numbers)


def test_every_setting_can_be_handed_on():
    settings = Settings(
        polarity="light",
        pen_width=4,
        solids=False,
        inks=False,
        ignore_inks=("blue", "gray"),
        marks=False,
        min_length=2,
        smoothing=0.5,
        router="geometric",
        tolerance=1,
        curve="bezier",
    )
    words = settings_options(settings)
    options = parser().parse_args(["trace", "a.png", "-o", "b.svg", *words])
    assert cli.settings_of(options) == settings


def test_bad_call_is_one_sentence():
    with pytest.raises(InvoluteError, match="workers call Involute"):
        write_job(Path("x"), Path("."), Path("o.blend"), [1], command="")


@pytest.mark.parametrize(
    "name",
    ["{{Param.Images}}", "{{", "}}", "a\nb", "a\x01b", "{{ Param.Nothing }}", "{{Session.X}}"],
)
def test_names_that_a_farm_would_read_otherwise_are_refused(name, tmp_path, capsys):
    make_frames(tmp_path / "in", [1, 2])
    for words in (["-o", f"out/{name}.blend"], ["-o", "out/x.blend", "--call", f"x '{name}'"]):
        assert main(["farm-job", str(tmp_path / "job"), str(tmp_path / "in"), *words]) == 1
        assert not (tmp_path / "job").exists()
        assert "choose another name" in capsys.readouterr().err


@pytest.mark.parametrize(
    "name", ["a'b", 'a"b', "$(touch x)", "é漢", "-x", "--overwrite", "x" * 200]
)
def test_odd_names_reach_the_command_as_they_are(name, tmp_path):
    make_frames(tmp_path / "in", [1, 2])
    job = tmp_path / "job"
    words = ["-o", str(tmp_path / f"{name}.blend"), "--call", CALL]
    assert main(["farm-job", str(job), str(tmp_path / "in"), *words]) == 0
    joining = template_of(job)["steps"][1]["script"]["actions"]["onRun"]["args"]
    assert joining[joining.index("-o") + 1] == f"{{{{Param.OutputDir}}}}/{name}.blend"


def test_a_job_replaces_only_a_job(tmp_path, capsys):
    make_frames(tmp_path / "in", [1, 2])
    words = ["farm-job", str(tmp_path), str(tmp_path / "in"), "-o", "x.blend"]
    (tmp_path / "template.json").write_text('{"mine": 1}')
    assert main(words) == 1
    assert (tmp_path / "template.json").read_text() == '{"mine": 1}'
    (tmp_path / "template.json").unlink()
    assert main(words) == main(words) == 0
    assert main([*words, "--call", "'"]) == 1
    assert "Can't read the command" in capsys.readouterr().err
