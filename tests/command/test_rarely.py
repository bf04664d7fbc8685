"""What rarely happens loses nothing either: no memory, a bug, files that vanish or are closed."""

from __future__ import annotations

import errno
import json
import os
import time
from pathlib import Path

import pytest
from involute.command import batch, receipts, trace_sequence
from involute.command.batch import Task, run
from involute.engine import Drawing, InvoluteError, Settings, pipeline
from involute.engine.formats import format_of, whole_file
from involute.engine.sequence import number_frames

from tests.command.test_batch import make_images, tasks_for

SETTINGS = Settings(provider="classical", router="geometric")


def unreadable(monkeypatch, *places: Path) -> None:
    """As for files of somebody else, which root can read all the same."""
    real = open

    def guarded(file, mode="r", *arguments, **names):
        if isinstance(file, str | Path) and Path(file) in places and "r" in mode:
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(file))
        return real(file, mode, *arguments, **names)

    monkeypatch.setattr("builtins.open", guarded)


@pytest.mark.parametrize("error", [MemoryError(), ZeroDivisionError("of a bug")])
def test_a_bug_or_too_little_memory_costs_one_image(error, tmp_path, monkeypatch):
    tasks = tasks_for(make_images(tmp_path, 3), tmp_path / "out")
    old = Path(tasks[1].outputs[0])
    old.write_text("what stood there")
    real = pipeline.vectorize

    def sometimes(source, *arguments, **names):
        if source == tasks[1].source:
            raise error
        return real(source, *arguments, **names)

    monkeypatch.setattr(pipeline, "vectorize", sometimes)
    outcomes = {outcome.task: outcome.error for outcome in run(tasks, jobs=1)}
    assert [bool(outcomes[task]) for task in tasks] == [False, True, False]
    assert outcomes[tasks[1]].endswith(".")
    assert "\n" not in outcomes[tasks[1]]
    assert old.read_text() == "what stood there"
    assert all(Drawing.load(tasks[k].outputs[0]).strokes for k in (0, 2))


def test_an_output_that_cannot_be_read_is_not_replaced(tmp_path, monkeypatch):
    tasks = tasks_for(make_images(tmp_path, 2), tmp_path / "out")
    theirs = Path(tasks[0].outputs[0])
    theirs.write_text("of somebody else")
    with monkeypatch.context() as patch:
        unreadable(patch, theirs)
        outcomes = {outcome.task: outcome.error for outcome in run(tasks, jobs=1, resume=True)}
    assert "--overwrite replaces it" in outcomes[tasks[0]]
    assert outcomes[tasks[1]] is None
    assert theirs.read_text() == "of somebody else"
    # Our own, too, may have been edited since: who can't look does not know.
    ours = Path(tasks[1].outputs[0])
    edited = json.loads(ours.read_text()) | {"note": "mine"}
    ours.write_text(json.dumps(edited))
    with monkeypatch.context() as patch:
        unreadable(patch, ours)
        (outcome,) = run(tasks[1:], jobs=1, resume=True)
    assert outcome.error
    assert json.loads(ours.read_text()) == edited


def test_an_output_that_vanishes_while_it_is_looked_at_is_made(tmp_path, monkeypatch):
    place = tmp_path / "a.svg"
    place.write_text("<svg/>")

    def gone(file):
        Path(file).unlink()
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), str(file))

    monkeypatch.setattr(receipts, "digest", gone)
    kind = format_of(str(place))
    assert receipts.standing(place, kind, receipts.Receipt(), "key") is receipts.Standing.FREE


@pytest.mark.parametrize(
    "damaged",
    ["", "[]", "null", '{"made": 3}', '{"made": {"a.json": []}, "report": {}}', "[" * 10**5],
)
def test_a_damaged_receipt_makes_nobodys_file_ours(damaged, tmp_path):
    (task,) = tasks_for(make_images(tmp_path, 1), tmp_path / "out")
    (outcome,) = run([task], jobs=1, resume=True)
    assert outcome.error is None
    before = Path(task.outputs[0]).read_bytes()
    receipts.path_for(Path(task.outputs[0])).write_text(damaged)
    (outcome,) = run([task], jobs=1, resume=True)
    assert "--overwrite replaces it" in outcome.error
    assert Path(task.outputs[0]).read_bytes() == before


def test_a_worker_never_writes_its_own_image(tmp_path):
    # The command looks before it starts; this is the look at the last moment.
    (path,) = make_images(tmp_path, 1)
    before = path.read_bytes()
    link = tmp_path / "link.png"
    link.hardlink_to(path)
    for output in (path, link):
        assert "error" in batch.perform(Task(str(path), (str(output),), SETTINGS))
    assert path.read_bytes() == before


def test_a_fault_while_looking_ends_the_run_and_its_workers(tmp_path, monkeypatch):
    tasks = tasks_for(make_images(tmp_path, 3), tmp_path / "out")

    def broken(*_):
        raise ZeroDivisionError("of a bug")

    monkeypatch.setattr(batch, "_left_to_do", broken)
    with pytest.raises(ZeroDivisionError):
        list(run(tasks, jobs=2, resume=True))
    assert not any((tmp_path / "out").iterdir())


@pytest.mark.parametrize("still_there", [True, False])
def test_a_part_that_is_damaged_meanwhile_costs_at_most_its_frame(still_there, tmp_path):
    paths = make_images(tmp_path, 3)
    parts = tmp_path / "parts"
    frames = number_frames(paths)
    before = [len(d.strokes) for _, d in trace_sequence(frames, SETTINGS, jobs=1)]

    def meanwhile(frame, outcome):
        if frame.frame == frames[1].frame:
            Path(outcome.task.outputs[0]).write_text("{")
            if not still_there:
                Path(frame.path).unlink()

    found = [
        d for _, d in trace_sequence(frames, SETTINGS, jobs=1, parts=parts, progress=meanwhile)
    ]
    assert [isinstance(d, Drawing) for d in found] == [True, still_there, True]
    assert still_there or isinstance(found[1], InvoluteError)
    counts = [len(d.strokes) for d in found if isinstance(d, Drawing)]
    assert counts == (before if still_there else [before[0], before[2]])


def test_a_writer_that_leaves_nothing_leaves_the_old_file(tmp_path):
    place = tmp_path / "a.png"
    place.write_bytes(b"what stood there")
    with pytest.raises(InvoluteError, match="disk is full"), whole_file.whole_file(place):
        pass
    assert [p.name for p in tmp_path.iterdir()] == ["a.png"]
    assert place.read_bytes() == b"what stood there"


def test_only_what_is_surely_abandoned_is_cleared_away(tmp_path, monkeypatch):
    place = tmp_path / "a.svg"
    with whole_file.whole_file(place) as part:
        mine = part.name
        part.write_text("<svg/>")
    here, process = mine.split("-")[1:3]
    dead, alive = "999999998", "999999999"

    def ask(number: int, _: int) -> None:
        raise ProcessLookupError if str(number) == dead else PermissionError

    monkeypatch.setattr(whole_file.os, "kill", ask)
    left = {
        "of a dead process": (mine.replace(process, dead), 0.0, False),
        "of another user's": (mine.replace(process, alive), 0.0, True),
        "of this one": (mine, 0.0, True),
        "of another machine": (mine.replace(here, "0" * 8).replace(process, dead), 0.0, True),
        "of another machine, old": (mine.replace(here, "1" * 8), 2e5, False),
        "of another output": (mine.replace(mine[1:9], "0" * 8).replace(process, dead), 0.0, True),
        "nobody's": (".notes.part.svg", 2e5, True),
    }
    for name, age, _ in left.values():
        (tmp_path / name).write_text("half")
        os.utime(tmp_path / name, (time.time() - age,) * 2)
    whole_file.remove_leftovers([place, tmp_path / "no folder" / "b.svg"])
    assert {why: (tmp_path / name).exists() for why, (name, *_) in left.items()} == {
        why: stays for why, (*_, stays) in left.items()
    }
    assert place.read_text() == "<svg/>"
