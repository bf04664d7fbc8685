"""The job type for Flamenco, in a JavaScript engine, against Flamenco's documented interface; the
commands that it yields run for real. No Flamenco can be had here: it is in no package index.
"""

from __future__ import annotations

import json
import shlex
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from involute.command.cli import main
from involute.command.flamenco import JOB_TYPE, write_job_type
from involute.command.setting_options import settings_options
from involute.engine import Drawing, Settings
from involute.engine.settings import ABOUT, DEFAULTS

from tests.command.numbered_scans import make_frames

js = pytest.importorskip("py_mini_racer")

CALL = f"{shlex.quote(sys.executable)} -m involute"
QUICK = ["--provider", "classical", "--router", "geometric"]
# What the schema AvailableJobSetting of Flamenco's API allows.
TYPES = {"string", "int32", "float", "bool"}
SUBTYPES = {"file_path", "dir_path", "file_name", "hashed_file_path"}
VISIBLE = {"visible", "hidden", "submission", "web"}
KEYS = {
    *("key", "type", "subtype", "choices", "propargs", "description", "label", "default"),
    *("eval", "evalInfo", "visible", "required", "editable"),
}


@pytest.fixture(scope="module")
def manager(tmp_path_factory):
    """A JavaScript engine that has what a Manager gives, and the job type as a user writes it."""
    scripts = tmp_path_factory.mktemp("flamenco") / "scripts"
    assert main(["flamenco", str(scripts)]) == 0
    engine = js.MiniRacer()
    engine.eval(Path(__file__).with_name("flamenco_manager.js").read_text("utf-8"))
    engine.eval((scripts / JOB_TYPE).read_text("utf-8"))
    return engine


def settings_of(manager):
    return json.loads(manager.eval("JSON.stringify(JOB_TYPE.settings)"))


def submit(manager, **settings):
    """The tasks of a job with these settings, the others as Blender's panel begins."""
    usual = {s["key"]: s["default"] for s in settings_of(manager) if "default" in s}
    return json.loads(manager.eval(f"compiled({json.dumps({**usual, **settings})})"))


def run(tasks, variables=()):
    """Do the tasks as a worker does, in an order that their dependencies allow."""
    done: set[str] = set()
    while len(done) < len(tasks):
        ready = [t for t in tasks if t["name"] not in done and done.issuperset(t["dependencies"])]
        for task in ready:
            for command in task["commands"]:
                assert command["name"] == "exec"
                words = [command["parameters"]["exe"], *command["parameters"]["args"]]
                for name, value in variables:
                    words = [word.replace(f"{{{name}}}", value) for word in words]
                ran = subprocess.run(words, capture_output=True, text=True)
                assert ran.returncode == 0, ran.stderr
            done.add(task["name"])


def test_the_job_makes_what_one_command_makes(manager, tmp_path):
    scans = tmp_path / "scans of 'shot' 7"
    numbers = [1, 2, 3, 6, 7, 8]
    make_frames(scans, numbers)
    (scans / "walk_0007.png").write_text("torn page")
    out = tmp_path / "out" / "shöt"
    job = submit(
        manager, images=str(scans), output=str(out), frames="1..3, 6-8", chunk_size=4, step=2,
        options=" ".join(QUICK), smoothing=0.30000001192092896, involute="{involute} -m involute",
    )  # fmt: skip
    tasks = job["tasks"]
    assert [t["name"] for t in tasks] == ["trace-1-3,6", "trace-7,8", "join"]
    assert [t["type"] for t in tasks] == ["blender"] * 3
    assert tasks[-1]["dependencies"] == [t["name"] for t in tasks[:-1]]
    run(tasks, [("involute", sys.executable)])

    single = tmp_path / "single"
    command = ["trace", str(scans), "--sequence", "-o", str(single), "--step", "2", *QUICK]
    assert main(command) == 1  # the torn page
    made = sorted(path.name for path in out.iterdir())
    assert made == sorted(path.name for path in single.iterdir())
    assert len(made) == 5
    for name in made:
        farmed, local = Drawing.load(out / name), Drawing.load(single / name)
        for one, other in zip(farmed.strokes, local.strokes, strict=True):
            np.testing.assert_allclose(one.points[[0, -1]], other.points[[0, -1]], atol=0.5)
    report = json.loads((out.parent / "shöt-report.json").read_text("utf-8"))["images"]
    assert [Path(r["input"]).name for r in report if r["error"]] == ["walk_0007.png"]
    assert sum(r["resumed"] for r in report) == 5


def test_the_settings_are_such_as_flamenco_knows(manager):
    for setting in settings_of(manager):
        assert set(setting) <= KEYS, setting
        assert setting["type"] in TYPES
        assert setting.get("subtype", "dir_path") in SUBTYPES
        assert setting.get("visible", "visible") in VISIBLE
        assert "choices" not in setting or setting["default"] in setting["choices"]
        if setting["key"] in ABOUT:
            about = ABOUT[setting["key"]]
            assert setting["default"] == DEFAULTS[setting["key"]]
            assert tuple(setting.get("choices", ())) == about.values
            if about.kind is float:
                assert setting["propargs"] == {"min": about.low, "max": about.high}


def test_what_the_panel_finds_out_by_itself(manager, tmp_path):
    make_frames(tmp_path / "in", [3, 7])
    (tmp_path / "in" / ".0001.png").touch()
    evals = {s["key"]: s["eval"] for s in settings_of(manager) if "eval" in s}

    def value(key, **settings):
        names = {"abspath": Path, "Path": Path, "settings": SimpleNamespace(**settings)}
        return eval(evals[key], {}, names)

    assert value("frames", images=str(tmp_path / "in")) == "3-7"
    assert value("frames", images=str(tmp_path / "nowhere")) == ""
    assert value("frames", images="") == value("images_path", images="") == ""
    assert value("images_path", images="/scans") == str(Path("/scans"))
    assert value("output_path", output="/o/x.blend") == str(Path("/o/x.blend"))


def test_options_are_handed_on(manager):
    given = {"polarity": "light", "curve": "bezier", "smoothing": 0.5, "tolerance": 1.5}
    job = submit(
        manager, images="/in", output="/o/x.blend", frames="1-2", **given, align=True, start="101",
        options="--ignore-inks 'blue,red'", involute="'/opt/my tools/involute'",
    )  # fmt: skip
    tracing, joining = (t["commands"][0]["parameters"] for t in job["tasks"])
    assert tracing["exe"] == joining["exe"] == "/opt/my tools/involute"
    words = settings_options(Settings(**given))
    assert all(word in tracing["args"] for word in [*words, "--align", "--start", "101"])
    assert tracing["args"][tracing["args"].index("--ignore-inks") + 1] == "blue,red"
    assert joining["args"][-5:] == [
        "-o",
        "/o/x.blend",
        "--report",
        "/o/x-report.json",
        "--overwrite",
    ]


def test_paths_may_begin_with_a_variable_for_farms_of_several_systems(manager):
    for path in ("{my_storage}/shot 1/in", r"S:\shot\in", r"\\server\in", "/in"):
        job = submit(manager, images=path, output="{my_storage}/x.blend", frames="1")
        arguments = job["tasks"][0]["commands"][0]["parameters"]["args"]
        assert arguments[:5] == ["-b", "--command", "involute", "trace", path]


@pytest.mark.parametrize(
    "name",
    ["a'b", 'a"b', "$(touch x)", "`x`", "é漢", "-x", "--overwrite", "a;b", "a b", "%s", "${x"[:1]],
)
def test_odd_names_reach_the_command_as_they_are(name, manager):
    job = submit(manager, images=f"/{name}", output=f"/{name}.blend", frames="1")
    arguments = job["tasks"][1]["commands"][0]["parameters"]["args"]
    assert arguments[4] == f"/{name}"
    assert arguments[arguments.index("-o") + 1] == f"/{name}.blend"


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"images": "/in/{blender}"}, "variable to Flamenco"),
        ({"images": "{a}{blender}/in"}, "variable to Flamenco"),
        ({"output": "/o/{{Param.X}}.blend"}, "variable to Flamenco"),
        ({"output": "/o/${x}.blend"}, "variable to Flamenco"),
        ({"options": "--report {secret}"}, "variable to Flamenco"),
        ({"start": "{x}"}, "variable to Flamenco"),
        ({"options": "'"}, "quote"),
        ({"images": "//scans"}, "no whole path"),
        ({"images": "scans"}, "no whole path"),
        ({"images": ""}, "no whole path"),
        ({"output": "/a\nb"}, "no name for a farm"),
        ({"images": "/" + "x" * 5000}, "no name for a farm"),
        ({"frames": ""}, "Frames"),
        ({"frames": "1-{x}"}, "Frames"),
        ({"frames": "1-48:2"}, "Frames"),
        ({"chunk_size": 0}, "Chunk Size"),
        ({"involute": " "}, "how the workers call Involute"),
    ],
)
def test_what_a_worker_would_read_otherwise_is_refused_in_a_sentence(wrong, said, manager):
    right = {"images": "/in", "output": "/o/x.blend", "frames": "1-3"}
    assert said in submit(manager, **{**right, **wrong})["error"]


def test_a_job_type_replaces_only_ours(tmp_path, capsys):
    path = write_job_type(tmp_path / "scripts")
    ours = path.read_bytes()
    path.write_text(path.read_text("utf-8") + "// an older one\n", "utf-8")
    assert main(["flamenco", str(path.parent)]) == 0
    assert path.read_bytes() == ours
    path.write_text("const JOB_TYPE = {};")
    assert main(["flamenco", str(path.parent)]) == 1
    assert "move it away" in capsys.readouterr().err
