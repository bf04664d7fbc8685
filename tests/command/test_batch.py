"""Many images, several processes: failures stay alone, nothing is done twice or left half-done."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from contextlib import closing
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
import pytest
from involute.command import machine, trace_sequence
from involute.command.batch import Task, run
from involute.command.receipts import FOLDER as RECEIPTS
from involute.engine import Drawing, InvoluteError, Settings, vectorize
from involute.engine.formats import whole_file
from involute.engine.sequence import number_frames

SETTINGS = Settings(provider="classical", router="geometric")
SUBPROCESS = """
import sys
from involute.engine import Settings
from involute.command.batch import Task, run
settings = Settings(provider="classical", router="geometric")
tasks = [Task(a, (a[:-4] + ".svg",), settings) for a in sys.argv[2:]]
for outcome in run(tasks, jobs=int(sys.argv[1]), resume=True):
    print(outcome.task.source, outcome.resumed, outcome.error, flush=True)
"""


def make_images(folder, count, size=160):
    """A few lines each, moving from one to the next."""
    paths = []
    for k in range(count):
        image = np.full((size, size), 255, np.uint8)
        cv2.line(image, (20, 10 + k), (140, 20 + k), 0, 3, cv2.LINE_AA)
        cv2.line(image, (20, 130), (140, 100 + k), 0, 3, cv2.LINE_AA)
        cv2.circle(image, (70 + k, 70), 20, 0, 3, cv2.LINE_AA)
        paths.append(folder / f"frame_{k + 1:03d}.png")
        cv2.imwrite(str(paths[-1]), image)
    return paths


def tasks_for(paths, out, suffix=".json", settings=SETTINGS):
    out.mkdir(exist_ok=True)
    return [Task(str(p), (str(out / f"{p.stem}{suffix}"),), settings) for p in paths]


def points_of(drawing):
    return [stroke.points.tolist() for stroke in drawing.strokes]


def long_strokes(drawing):
    return [s for s in drawing.strokes if np.hypot(*np.ptp(s.points, axis=0)) > 30]


def test_processes_make_what_one_process_makes(tmp_path):
    paths = make_images(tmp_path, 3)
    tasks = tasks_for(paths, tmp_path / "out")
    outcomes = {o.task: o for o in run(tasks, jobs=2)}
    assert set(outcomes) == set(tasks)
    for task in tasks:
        drawing = Drawing.load(task.outputs[0])
        expected = vectorize(task.source, SETTINGS)
        # The number of threads may change the last bits, and so which points are spared.
        for one, other in zip(drawing.strokes, expected.strokes, strict=True):
            np.testing.assert_allclose(one.points[[0, -1]], other.points[[0, -1]], atol=0.5)
        report = outcomes[task].report
        assert report["strokes"] == len(drawing.strokes) > 0
        assert (report["width"], report["height"]) == (160, 160)
        assert sum(report["seconds"].values()) > 0
    assert not (tmp_path / "out" / RECEIPTS).exists()


@pytest.mark.parametrize("jobs", [1, 2])
def test_held_drawings_and_cycles_are_traced_once(tmp_path, jobs):
    first, second = make_images(tmp_path, 2)
    paths = [first, second]
    for number, again in enumerate((second, first, second, first), 3):
        paths.append(tmp_path / f"frame_{number:03d}.png")
        paths[-1].write_bytes(again.read_bytes())
    tasks = tasks_for(paths, tmp_path / "out")
    other = Settings(provider="classical", router="geometric", min_length=3.0)
    tasks += tasks_for(paths[:1], tmp_path / "other", settings=other)
    outcomes = {o.task: o for o in run(tasks, jobs=jobs)}
    assert set(outcomes) == set(tasks)
    ran = [task for task in tasks if outcomes[task].report["seconds"]]
    assert ran == [tasks[0], tasks[1], tasks[-1]]
    drawn = [points_of(Drawing.load(task.outputs[0])) for task in tasks[:-1]]
    assert drawn[0] == drawn[3] == drawn[5] != drawn[1] == drawn[2] == drawn[4]


def test_there_are_never_more_processes_than_cores(tmp_path, monkeypatch):
    monkeypatch.setattr(machine, "cores", lambda: 1)
    tasks = tasks_for(make_images(tmp_path, 3), tmp_path / "out")
    with closing(run(tasks, jobs=3)) as results:
        next(results)
        assert len(worker_ids()) == 1


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_bad_image_stops_nothing(tmp_path, jobs):
    paths = make_images(tmp_path, 2)
    bad = tmp_path / "frame_003.png"
    bad.write_text("not a picture")
    tasks = tasks_for([*paths, bad, tmp_path / "missing.png"], tmp_path / "out")
    errors = {Path(o.task.source).name: o.error for o in run(tasks, jobs=jobs)}
    assert errors["frame_001.png"] is None
    assert errors["frame_002.png"] is None
    assert "frame_003.png" in errors["frame_003.png"]
    assert "missing.png" in errors["missing.png"]
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == [
        "frame_001.json",
        "frame_002.json",
    ]


def test_only_what_is_missing_or_changed_is_traced_again(tmp_path):
    paths = make_images(tmp_path, 4)
    tasks = tasks_for(paths, tmp_path / "out")

    def traced(tasks):
        outcomes = list(run(tasks, jobs=1, resume=True))
        assert not any(o.error for o in outcomes)
        return {Path(o.task.source).stem[-1] for o in outcomes if not o.resumed}

    assert traced(tasks) == {"1", "2", "3", "4"}
    assert traced(tasks) == set()
    image = cv2.imread(str(paths[1]), cv2.IMREAD_GRAYSCALE)
    cv2.imwrite(str(paths[1]), np.roll(image, 3, axis=1))
    os.unlink(tasks[2].outputs[0])
    os.utime(paths[3])  # the same bytes: not a change
    assert traced(tasks) == {"2", "3"}
    other = tasks_for(
        paths, tmp_path / "out", settings=Settings(**{**vars(SETTINGS), "tolerance": 1})
    )
    assert traced(other) == {"1", "2", "3", "4"}


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_killed_run_leaves_nothing_half_and_is_taken_up(tmp_path, jobs):
    paths = make_images(tmp_path, 16, size=220)
    command = [sys.executable, "-c", SUBPROCESS, str(jobs), *map(str, paths)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    first = [process.stdout.readline() for _ in range(3)]
    process.kill()
    process.wait()
    assert all("False None" in line for line in first)
    time.sleep(0.3)  # workers notice
    done = {p: p.stat().st_mtime_ns for p in tmp_path.glob("frame_*.svg")}
    receipts = [p.name for p in (tmp_path / RECEIPTS).glob("frame_*.json")]
    assert 3 <= len(done) < len(paths)
    for path in done:
        assert Drawing.load(path).strokes

    left = whole_file._new_part(tmp_path / "frame_009.svg")
    left.rename(left.with_name(left.name.replace(f"-{os.getpid()}-", f"-{process.pid}-")))
    again = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
    resumed = {line.split()[0] for line in again if " True " in line}
    assert len(again) == len(paths)
    assert {f"{Path(p).stem}.json" for p in resumed} == set(receipts)
    assert len(resumed) >= 3
    for path in resumed:
        svg = Path(path).with_suffix(".svg")
        assert svg.stat().st_mtime_ns == done[svg]
    assert len(list(tmp_path.glob("frame_*.svg"))) == len(paths)
    assert not list(tmp_path.glob(".*.part*"))


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="needs Linux to find the workers")
def test_a_dead_worker_costs_one_image(tmp_path):
    tasks = tasks_for(make_images(tmp_path, 8, size=220), tmp_path / "out")
    outcomes = []
    with closing(run(tasks, jobs=2)) as results:
        for outcome in results:
            if not outcomes:
                os.kill(worker_ids()[0], signal.SIGKILL)
            outcomes.append(outcome)
    assert len(outcomes) == 8
    failed = [o for o in outcomes if o.error]
    assert len(failed) <= 1
    assert all("died" in o.error for o in failed)


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="needs Linux to find the workers")
def test_stopping_ends_the_workers(tmp_path):
    tasks = tasks_for(make_images(tmp_path, 10), tmp_path / "out")
    results = run(tasks, jobs=2)
    next(results)
    assert worker_ids()
    results.close()
    assert not worker_ids()


def worker_ids():
    """Processes started by this one that run the worker script."""
    ids = []
    for file in Path("/proc/self/task").glob("*/children"):
        for child in file.read_text().split():
            if b"worker.py" in Path(f"/proc/{child}/cmdline").read_bytes():
                ids.append(int(child))
    return ids


def test_a_sequence_comes_in_order_with_its_failures(tmp_path):
    paths = make_images(tmp_path, 4)
    paths[2].write_text("torn page")
    done = []
    frames = number_frames(paths, start=10, step=2)
    results = list(
        trace_sequence(frames, SETTINGS, jobs=2, progress=lambda f, o: done.append(f.number))
    )
    assert [frame for frame, _ in results] == [10, 12, 14, 16]
    assert sorted(done) == [1, 2, 3, 4]
    assert isinstance(results[2][1], InvoluteError)
    drawings = [d for _, d in results if isinstance(d, Drawing)]
    assert len(drawings) == 3
    for one, other in pairwise([long_strokes(d) for d in drawings]):
        assert len(one) == len(other) == 3
        for a, b in zip(one, other, strict=True):
            assert a.closed == b.closed
            assert np.hypot(*(a.points[0] - b.points[0])) < 15
            assert np.hypot(*(a.points[-1] - b.points[-1])) < 15 + 30 * a.closed


def test_a_damaged_part_is_made_anew(tmp_path):
    paths = make_images(tmp_path, 2)
    frames = number_frames(paths)
    before = [d for _, d in trace_sequence(frames, SETTINGS, jobs=1, parts=tmp_path / "parts")]
    part = tmp_path / "parts" / "000002.json"
    part.write_bytes(part.read_bytes()[: part.stat().st_size // 2])
    after = [d for _, d in trace_sequence(frames, SETTINGS, jobs=1, parts=tmp_path / "parts")]
    assert [points_of(d) for d in before] == [points_of(d) for d in after]
