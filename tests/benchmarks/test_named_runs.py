"""The benchmarks' command: named runs, kept results, comparison, pictures, the README's tables."""

from __future__ import annotations

import ast
import json
import re
from pathlib import Path
from xml.etree import ElementTree

import cv2
import numpy as np
import pytest
from involute.engine import Settings, vectorize
from involute.engine.weights import names
from involute.package import ROOT

import benchmarks
from benchmarks import (
    charts,
    quality,
    readme_tables,
    run_record,
    side_by_side,
    speed,
    speed_against,
)
from benchmarks.__main__ import main
from benchmarks.aliased import one_bit
from benchmarks.judged_pages import DATA, pages
from benchmarks.lost_and_invented import fidelity, ink_of
from benchmarks.named_runs import RUNS, NamedRun
from benchmarks.run_record import Record

FIGURES = {"ours": {"f1": 0.651234567, "cpu_s": 1.5}, "theirs": {"f1": 0.25, "cpu_s": 0.1}}
CROSS = [np.array([[100.0, 200.0], [800.0, 210.0]]), np.array([[300.0, 100.0], [310.0, 900.0]])]


@pytest.fixture
def results(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(run_record, "RESULTS", tmp_path)
    monkeypatch.setattr(Record.append, "__defaults__", (tmp_path,))
    monkeypatch.setattr(run_record.read, "__defaults__", (tmp_path,))
    monkeypatch.setattr(run_record.found, "__defaults__", (tmp_path,))
    return tmp_path


def sources() -> dict[str, ast.Module]:
    folder = Path(benchmarks.__file__).parent
    return {path.stem: ast.parse(path.read_text("utf-8")) for path in folder.glob("*.py")}


def test_whatever_can_be_run_has_a_name() -> None:
    modules = {run.module for run in RUNS.values()}
    mains = {
        name
        for name, tree in sources().items()
        if any(isinstance(node, ast.FunctionDef) and node.name == "main" for node in tree.body)
    }
    assert mains - modules == {"__main__", "redraw"}  # redraw runs inside Blender's window


def test_what_the_window_measures_is_where_it_looks_for_it() -> None:
    # That script can't import the project: it looks the modules up by name, in the extension.
    text = Path(benchmarks.__file__).with_name("redraw.py").read_text("utf-8")
    names = re.findall(r'_module\("([\w.]+)"\)', text)
    files = {name: (ROOT / Path(*name.split("."))).with_suffix(".py") for name in names}
    assert len(names) == 3
    overlay = files["ui.overlay.overlay"].read_text("utf-8")
    for name in ("_handles", "_seen", "draw_rings_and_routes", "draw_labels", "unregister", "kept"):
        assert re.search(rf"\b{name}\b", overlay), name
    assert "def shown_in" in files["operators.view.view_state"].read_text("utf-8")
    assert "kept" in files["ui.overlay.cards"].read_text("utf-8")


@pytest.mark.parametrize("name", RUNS)
def test_every_run_can_be_asked_what_it_does(name: str, capsys: pytest.CaptureFixture) -> None:
    if RUNS[name].module == "blender_costs":
        pytest.importorskip("bpy")
    if RUNS[name].module == "true_graphs":
        pytest.importorskip("torch")
    with pytest.raises(SystemExit) as done:
        main(["run", name, "--help"])
    assert done.value.code == 0
    assert "usage" in capsys.readouterr().out


def test_a_result_is_kept_with_what_it_depends_on(
    results: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(RUNS, "made_up", NamedRun("made_up", "for this test"))
    monkeypatch.setattr(NamedRun, "__call__", lambda self, argv: FIGURES)
    for arguments in ([], ["--every", "2"]):
        assert main(["run", "made_up", *arguments]) == 0
    first, last = run_record.read("made_up")
    assert (first.arguments, last.arguments) == ([], ["--every", "2"])
    assert last.figures["ours"] == {"f1": 0.6512, "cpu_s": 1.5}
    assert len(last.weights) == 12
    assert set(last.machine) == {"cores", "cpu", "python"}
    assert run_record.found("made_up~1") == first
    assert run_record.found(f"made_up@{last.commit[:4]}") == last
    with pytest.raises(ValueError, match="no result"):
        run_record.found("made_up~2")


def test_a_run_with_faults_fails(results: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(RUNS, "made_up", NamedRun("made_up", "for this test"))
    monkeypatch.setattr(NamedRun, "__call__", lambda self, argv: {"all": {"faults": 2}})
    assert main(["run", "made_up"]) == 1


def test_an_unknown_run_is_said(capsys: pytest.CaptureFixture) -> None:
    with pytest.raises(SystemExit):
        main(["run", "qualty"])
    assert "qualty" in capsys.readouterr().err


def test_two_results_side_by_side() -> None:
    before = Record.of("quality", [], FIGURES)
    after = Record.of("quality", [], {"ours": {"f1": 0.7, "new": 1.0}})
    told = side_by_side.table(before, after)
    row = next(line for line in told.splitlines() if "ours: f1" in line)
    assert "0.6512" in row
    assert "+0.0488 (+7.5 %)" in row
    assert "Only quality" in told
    assert "ours: new" in told


@pytest.mark.parametrize(
    "figures",
    [FIGURES, {f"dense, thin, {s} px": {"CPU s/MP": s / 1e3} for s in (512, 1024)}, {}],
)
def test_pictures_of_results_can_be_read(figures: run_record.Figures) -> None:
    drawn = ElementTree.fromstring(charts.chart(Record.of("a < b", [], figures)))
    texts = " ".join(text.text or "" for text in drawn.iter("{http://www.w3.org/2000/svg}text"))
    assert "a < b" in texts
    assert all(column in texts for row in figures.values() for column in row)


def test_the_weights_of_a_result_are_known_by_content(monkeypatch: pytest.MonkeyPatch) -> None:
    before = run_record.weights_digest()
    monkeypatch.setattr(run_record.weights, "names", lambda: names()[1:])
    assert run_record.weights_digest() != before


def test_the_readme_shows_what_was_found() -> None:
    text = readme_tables.README.read_text("utf-8")
    assert "<!-- benchmark: quality -->" in text
    assert readme_tables.with_results(text) == text, "run: python -m benchmarks tables"


def test_readme_tables_come_from_the_last_whole_run(tmp_path: Path) -> None:
    own = {key: 0.5 for key, _ in quality.COLUMNS.values()}
    rival = own | {"f1": 0.25, "chamfer": 0.75}
    timing = speed.Timing("involute", "scan", 1024, 1.0, 0.6, 2.0, {"scan": 0.1, "graph": 0.5},
                          100.0, 50.0, 12)  # fmt: skip
    Record.of("quality", [], {"involute": own, "autotrace": rival}).append(tmp_path)
    Record.of("quality", ["--every", "9"], {"involute": rival}).append(tmp_path)
    Record.of("speed", [], speed.figures([timing])).append(tmp_path)
    text = (
        "<!-- benchmark: quality -->\nold\n<!-- end -->\n<!-- benchmark: speed -->\n\n<!-- end -->"
    )
    made = readme_tables.with_results(text, tmp_path)
    assert "old" not in made
    assert "**Involute**" in made
    assert "**0.50**" in made
    assert "graph 83 %" in made


def test_the_fast_runtime_stands_beside_the_yardstick_and_the_default() -> None:
    def timing(method: str, cpu: float, stages: dict[str, float]) -> speed.Timing:
        return speed.Timing(method, "scan", 1024, cpu, cpu, 0.0, stages, 1.0, 1.0, 9)

    timings = [
        timing("involute", 2.0, {"scan": 0.5, "graph": 1.5}),
        timing("skeleton + greedy", 0.1, {}),
        timing("involute in ONNX Runtime", 1.0, {"scan": 0.5, "graph": 0.5}),
    ]
    row = speed.figures(timings)["scan, 1024 px"]
    assert row["times skeleton + greedy"] == pytest.approx(20)
    assert row["fast, times skeleton + greedy"] == pytest.approx(10)
    assert row["share of graph"] == pytest.approx(0.75)  # of the default's time


def test_faithful_lost_and_invented() -> None:
    ink = one_bit(CROSS, 3).astype(np.float32)
    page = np.where(ink > 0, 0, 255).astype(np.uint8)
    drawing = vectorize(page, Settings(provider="classical", router="geometric"))
    right = fidelity(ink, drawing)
    assert right.ink == ink.sum()
    assert right.lost < 0.001 * right.ink
    assert right.invented == 0
    assert right.length == pytest.approx(700 + 800, abs=12)
    assert fidelity(ink_of(page), drawing) == right
    # More ink than the drawing has, and less.
    more = one_bit([*CROSS, np.array([[500.0, 500.0], [900.0, 500.0]])], 3).astype(np.float32)
    assert fidelity(more, drawing).lost == pytest.approx(1200, abs=30)
    assert fidelity(one_bit(CROSS[:1], 3).astype(np.float32), drawing).invented > 700


@pytest.mark.parametrize("wide", [1, 2, 3, 4])
def test_one_bit_lines_are_as_wide_as_they_say(wide: int) -> None:
    drawn = one_bit(CROSS[:1], wide)
    assert drawn.dtype == bool
    assert drawn[:, 400].sum() == wide


def test_the_tangles_are_held_out_and_well_formed() -> None:
    tangles = pages(DATA / "tangles")
    assert len(tangles) == 20
    for page in tangles:
        strokes = page.true_strokes()
        assert len(strokes) >= 15
        assert max(line.max() for line in strokes) <= 1024


def test_pages_of_every_kind_and_size() -> None:
    dark = {kind: (speed.page(kind, 512) < 128).mean() for kind in speed.KINDS}
    assert dark["sparse, thin"] < dark["ordinary, thin"] < dark["dense, thin"]
    assert dark["ordinary, thin"] < dark["ordinary, thick"]
    assert speed.page("dense, thick", 1500).shape == (1500, 1500)


def test_old_results_are_plain_lines(results: Path) -> None:
    Record.of("quality", [], FIGURES).append()
    (line,) = (results / "quality.jsonl").read_text().splitlines()
    assert json.loads(line)["figures"]["theirs"]["f1"] == 0.25


def test_times_over_the_size_are_lines_and_growth_is_bars() -> None:
    rows = {f"scan, {side} px": {"CPU s/MP": 1.0 + side / 1e4} for side in (512, 1024)}
    drawn = charts.chart(Record.of("speed", [], rows | {"scan: growth": {"involute": 0.99}}))
    assert drawn.count("<polyline") == 1
    assert "scan: growth: 0.99" in drawn


def test_versions_are_compared_on_all_that_was_promised(tmp_path: Path) -> None:
    cases = speed_against.cases(tmp_path)
    assert len(cases["sequence"]) == 12
    frames = [cv2.imread(str(path), cv2.IMREAD_GRAYSCALE) for path in cases["sequence"][:2]]
    assert not cv2.absdiff(*frames)[:500].any()
    assert cv2.absdiff(*frames)[512:, 512:].any()
    assert cv2.imread(str(cases["A4, 1.5 px"][0])).shape[:2] == (2339, 1654)
    told = [{"cpu": 9.0, "stages": {"graph": 1.0, "routing": 0.5}, "junctions": 1500}]
    assert speed_against.seconds("junctions", told) == pytest.approx(3.0)
    assert speed_against.seconds("A4, 1.5 px", told) == pytest.approx(9.0)
