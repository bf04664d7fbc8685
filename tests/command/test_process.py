"""The command as a process: pipes, signals, closed streams, odd names, what it may use and says."""

from __future__ import annotations

import json
import os
import re
import signal
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import cv2
import numpy as np
import pytest
from involute.command import cli, machine
from involute.command.temporary import temporary_folder
from involute.engine import Drawing

fcntl, pty, termios = map(pytest.importorskip, ("fcntl", "pty", "termios"))
pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals and terminals of Unix")
FAST = ["--provider", "classical", "--router", "geometric"]
COMMAND = [sys.executable, "-m", "involute", "trace", *FAST]


def page(path: Path, side: int = 60) -> Path:
    picture = np.full((side, side), 255, np.uint8)
    cv2.line(picture, (5, 5), (side - 5, side - 9), 0, 2, cv2.LINE_AA)
    path.parent.mkdir(exist_ok=True)
    cv2.imwrite(str(path), picture)
    return path


def trace(*arguments) -> int:
    return cli.main(["trace", *FAST, *map(str, arguments)])


def run(*arguments, **more) -> subprocess.CompletedProcess:
    more = {"capture_output": True, "timeout": 120} | more
    return subprocess.run([*COMMAND, *map(os.fspath, arguments)], **more)


# --- what is said ----------------------------------------------------------------------------


def test_in_a_pipe_only_trouble_is_told(tmp_path, capsys):
    page(tmp_path / "in" / "a.png")
    (tmp_path / "in" / "notes.txt").write_text("words")
    (tmp_path / "in" / "plan.kra").write_text("PK")
    assert trace(tmp_path / "in", "-o", tmp_path / "out") == 0
    said = capsys.readouterr().err
    assert said.startswith("involute: left out: notes.txt (not a picture); plan.kra (Krita is not")
    assert len(said.splitlines()) == 1
    assert trace(tmp_path / "in", "-o", tmp_path / "out2", "--quiet") == 0
    assert capsys.readouterr().err == ""
    assert (
        trace(
            tmp_path / "in" / "a.png", "-o", tmp_path / "b.svg", "--verbose", "--smoothing", "0.4"
        )
        == 0
    )
    said = capsys.readouterr().err.splitlines()
    assert said[0].startswith("involute: a.png: 1 stroke, 0 doubtful junctions")
    assert said[0].endswith(" -> b.svg")
    assert "centerline" in said[-1]
    assert trace(tmp_path / "gone.png", "-o", tmp_path / "c.svg", "--quiet") == 1
    assert "no file" in capsys.readouterr().err


def test_on_a_terminal_each_image_gets_a_line(tmp_path):
    scan, out = page(tmp_path / "a.png"), tmp_path / "a.svg"
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 80, 0, 0))
    done = subprocess.Popen([*COMMAND, scan, "-o", out], stderr=theirs)
    os.close(theirs)
    said = b""
    try:
        while block := os.read(ours, 4096):
            said += block
    except OSError:  # the other end is closed
        pass
    assert done.wait(60) == 0
    assert b"a.png: 1 stroke, 0 doubtful junctions" in said
    assert b"-> a.svg" in said
    assert b"%" in said  # the bar


# --- what is read and written ----------------------------------------------------------------


def test_an_image_comes_through_a_pipe(tmp_path):
    scan = page(tmp_path / "a.png")
    done = run("-", "-o", tmp_path / "b.svg", input=scan.read_bytes())
    assert done.returncode == 0, done.stderr
    assert len(Drawing.load(tmp_path / "b.svg").strokes) == 1
    done = run("-", "-o", tmp_path / "c.svg", input=b"nothing")
    assert done.returncode == 1
    assert b"not a picture" in done.stderr


@pytest.mark.skipif(sys.platform == "darwin", reason="names there are always UTF-8")
@pytest.mark.parametrize("more", [{}, {"LC_ALL": "POSIX", "PYTHONUTF8": "0"}])
def test_names_that_are_no_text_are_traced(more, tmp_path):
    scan = page(tmp_path / "in" / "a.png")
    odd = os.fsdecode(os.fsencode(tmp_path / "in" / "b") + b"\xff\xfe.png")
    os.rename(scan, odd)
    page(tmp_path / "in" / "漢.png")
    words = [tmp_path / "in", "-o", tmp_path / "out", "--jobs", "2", "--verbose"]
    done = run(*words, "--report", tmp_path / "r.json", env=os.environ | more)
    assert done.returncode == 0, done.stderr
    assert b"b\xff\xfe.svg" in os.listdir(os.fsencode(tmp_path / "out"))


@pytest.mark.parametrize("closed", [(0,), (1,), (2,), (0, 1, 2)])
def test_closed_streams_do_no_harm(closed, tmp_path):
    scan, out = page(tmp_path / "a.png"), tmp_path / "a.json"
    streams = {"stdin": None, "stdout": None, "stderr": None, "capture_output": False}
    done = run(scan, "-o", out, preexec_fn=lambda: [os.close(n) for n in closed], **streams)
    assert done.returncode == 0
    assert Drawing.load(out).strokes


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="Linux")
def test_a_reader_that_takes_nothing_is_no_traceback(tmp_path):
    assert trace(page(tmp_path / "a.png"), "-o", tmp_path / "a.json") == 0
    for words in (["inspect", tmp_path / "a.json"], ["--help"], ["trace", "--help"]):
        with open("/dev/full", "w") as full:
            done = subprocess.run(
                [*COMMAND[:3], *map(str, words)], stdout=full, stderr=subprocess.PIPE, timeout=60
            )
        assert done.returncode == 1 or "--help" in words  # which argparse prints
        assert b"Traceback" not in done.stderr
        assert b"ignored" not in done.stderr


WRONG, FAILED = cli.WRONG_USAGE, cli.FAILED


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (["--frames", "9" * 5000], WRONG),
        (["--frames", "1-99999999999999999999"], WRONG),
        (["--frames", ""], WRONG),
        (["--jobs", "9" * 30], WRONG),
        (["--jobs", "²"], WRONG),
        (["--pen-width", "nan"], WRONG),
        (["--smoothing", "inf"], WRONG),
        (["--ignore-inks", "x"], WRONG),
        (["--format", ","], WRONG),
        (["--report", "/"], FAILED),
        (["--report", ""], WRONG),
        (["--sequence", "--start", "99999999999"], WRONG),
        (["--sequence", "--step", "999999999999"], WRONG),
        (["--sequence", "--step", "0"], WRONG),
        (["--sharpness", "new\nline"], WRONG),
        (["--jobs", "two\nlines"], WRONG),
    ],
)
def test_odd_arguments_are_one_sentence(words, code, tmp_path, capsys):
    page(tmp_path / "in" / "a1.png")
    page(tmp_path / "in" / "a2.png")
    assert trace(tmp_path / "in", "-o", tmp_path / "out", "--format", "svg", *words) == code
    said = capsys.readouterr().err
    assert len(said.splitlines()) == 1
    assert re.match(r"involute( trace)?: [A-Z].*\.$", said.rstrip())


def test_a_link_round_to_its_own_folder_gives_each_picture_once(tmp_path):
    scan = page(tmp_path / "in" / "a.png")
    (scan.parent / "round").symlink_to(".")
    (scan.parent / "held.png").symlink_to("a.png")  # a drawing that is held is one of its own
    assert trace(f"{scan.parent}/**/*.png", "-o", tmp_path / "out") == 0
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["a.svg", "held.svg"]


@pytest.mark.skipif(not Path("/sys/kernel").is_dir(), reason="a folder where not even root may")
def test_a_folder_that_may_not_be_made_is_said(tmp_path, capsys):
    assert trace(page(tmp_path / "a.png"), "-o", "/sys/kernel/drawings") == 1
    assert "you may not write there; choose another folder." in capsys.readouterr().err


def test_a_file_in_the_way_of_a_folder_is_said(tmp_path, capsys):
    scan, out = page(tmp_path / "a.png"), tmp_path / "out"
    out.mkdir()
    (out / ".involute").write_text("a file")
    assert trace(scan, "-o", out, "--resume") == 1
    assert "a file of that name is in the way; choose another name." in capsys.readouterr().err


def test_what_is_no_file_is_never_replaced(tmp_path):
    scan, pipe = page(tmp_path / "a.png"), tmp_path / "pipe.svg"
    os.mkfifo(pipe)
    (tmp_path / "link.svg").symlink_to(pipe)
    for out in (pipe, tmp_path / "link.svg"):
        assert trace(scan, "-o", out, "--overwrite") == 1
    assert pipe.is_fifo()
    assert (tmp_path / "link.svg").is_symlink()
    assert trace(scan, "-o", tmp_path / "a.svg", "--report", pipe) == 1
    assert pipe.is_fifo()


@pytest.mark.parametrize("words", [[""], ["/dev/null"], ["["], ["x" * 5000], ["**"], ["/dev"]])
def test_odd_inputs_are_one_sentence(words, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert trace(*words, "-o", "out") in (1, 2)
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_numbers_that_are_times_are_ranks(tmp_path):
    for second in (0, 1, 7):
        page(tmp_path / "in" / f"scan_2024010112000{second}.png")
    report = tmp_path / "r.json"
    words = [tmp_path / "in", "--sequence", "-o", tmp_path / "out", "--format", "svg"]
    assert trace(*words, "--report", report) == 0
    assert [image["frame"] for image in json.loads(report.read_text())["images"]] == [1, 2, 3]


def test_a_blend_that_does_not_fit_is_not_there(tmp_path):
    """Blender itself says that all went well, and leaves the first part of the file."""
    pytest.importorskip("bpy")
    resource = pytest.importorskip("resource")
    scan, out = page(tmp_path / "a.png"), tmp_path / "out"
    out.mkdir()
    (out / "a.blend").write_text("an older one")
    words = [scan, "-o", out, "--format", "blend", "--overwrite"]
    done = run(*words, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (30_000,) * 2))
    assert done.returncode == 1
    assert b"a.blend" in done.stderr
    assert [path.name for path in out.iterdir()] == ["a.blend"]
    assert (out / "a.blend").read_text() == "an older one"
    assert run(*words).returncode == 0
    assert (out / "a.blend").stat().st_size > 30_000


# --- being stopped ---------------------------------------------------------------------------


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("wait", [0.0, 0.05, 0.3, 1.0, 2.0])
def test_told_to_end_it_leaves_nothing(number, wait, tmp_path):
    for k in range(12):
        page(tmp_path / "in" / f"{k}.png", 200)
    temporary, out = tmp_path / "tmp", tmp_path / "out"
    temporary.mkdir()
    process = subprocess.Popen(
        [*COMMAND, tmp_path / "in", "-o", out, "--jobs", "2"],
        env=os.environ | {"TMPDIR": str(temporary)},
        stderr=subprocess.PIPE,
    )
    time.sleep(wait)
    process.send_signal(number)
    said = process.communicate(timeout=60)[1].decode()
    done = sorted(out.iterdir()) if out.is_dir() else []
    if process.returncode == cli.STOPPED:
        assert re.fullmatch(r"(involute: left .*\n)?involute: Stopped; .*\n", said)
    elif process.returncode == 0:  # it was faster
        assert (len(done), said) == (12, "")
    else:  # not begun yet, or all done: Python, which was starting or ending, ended in its own way
        assert process.returncode in (-number, 1 if number == signal.SIGINT else -number)
        assert len(done) in (0, 12)
        assert f"{os.sep}command{os.sep}" not in said
        assert f"{os.sep}engine{os.sep}" not in said
    assert not list(temporary.iterdir())
    for path in done:
        assert ".part" not in path.name
        assert Drawing.load(path).strokes


def test_told_to_end_while_python_runs_a_text_it_ends_in_its_own_way(tmp_path):
    """As while a dataclass is made: Python would kill itself, although it was caught."""
    (tmp_path / "ended.py").write_text(
        "import os, signal, sys\n"
        "from involute.command import cli\n"
        "cli._run = lambda *_: exec('os.kill(os.getpid(), signal.SIGTERM)\\nwhile True: pass')\n"
        "sys.exit(cli.main([]))\n"
    )
    command = [sys.executable, "-m", "ended"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout) == (cli.STOPPED, "")
    assert re.fullmatch(r"involute: Stopped; .*\n", done.stderr)


def test_whatever_a_library_makes_of_it_is_being_stopped(monkeypatch, capsys):
    """OpenCV says that NumPy failed when it is interrupted while it is loaded."""

    def loading(*_):
        try:
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(10)
        except KeyboardInterrupt:
            raise ImportError("numpy._core.multiarray failed to import") from None

    monkeypatch.setattr(cli, "_run", loading)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # shells let jobs ignore it
    try:
        assert cli.main(["inspect", "x"]) == cli.STOPPED
    finally:
        signal.signal(signal.SIGINT, before)
    assert capsys.readouterr().err.startswith("involute: Stopped;")


@pytest.mark.skipif(not Path("/proc/self/maps").exists(), reason="Linux tells what is loaded")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("wait", [0.0, 0.2])
def test_told_to_end_while_blender_loads_it_ends(number, wait, tmp_path):
    """Blender prints what is raised while it loads, and goes on."""
    pytest.importorskip("bpy")
    for k in range(6):
        page(tmp_path / "in" / f"{k}.png", 200)
    out = tmp_path / "out" / "all.blend"
    out.parent.mkdir()
    process = subprocess.Popen(
        [*COMMAND, tmp_path / "in", "-o", out, "--sequence", "--parts", tmp_path / "parts"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        preexec_fn=lambda: signal.signal(number, signal.default_int_handler),
    )
    loaded = Path(f"/proc/{process.pid}/maps")
    while process.poll() is None and "/bpy/" not in loaded.read_text():
        time.sleep(0.01)
    time.sleep(wait)
    process.send_signal(number)
    said = process.communicate(timeout=60)[1]
    assert process.returncode == cli.STOPPED
    assert said.endswith(b"nothing is half-written.\n")
    assert not list(out.parent.iterdir())


def test_folders_of_killed_runs_are_cleared_away(tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    dead = subprocess.Popen([sys.executable, "-c", ""])
    dead.wait()
    for name in (f"involute-{dead.pid}-abc", f"involute-{os.getpid()}-abc", "involute-notes"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "0.json").write_text("{}")
    with temporary_folder() as folder:
        assert folder.stat().st_mode & 0o777 == 0o700
        left = {path.name for path in tmp_path.iterdir()}
        assert left == {f"involute-{os.getpid()}-abc", "involute-notes", folder.name}
    assert not folder.exists()


# --- what it may use -------------------------------------------------------------------------


def groups(folder: Path, monkeypatch, **files: str) -> None:
    for name, content in files.items():
        path = folder / name.replace("__", "/")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content)
    monkeypatch.setattr(machine, "_GROUPS", folder)
    monkeypatch.setattr(machine, "_OWN_GROUP", folder / "own")


def test_a_container_limits_cores_and_memory(tmp_path, monkeypatch):
    before = machine.cores(), machine.memory()
    files = {"own": "0::/a/b\n", "a__cpu.max": "50000 100000", "a__b__memory.max": "1000000000"}
    groups(tmp_path, monkeypatch, **files)
    assert machine.cores() == 1
    assert machine.memory() == 1e9
    files = {"own": "0::/a/b\n", "a__cpu.max": "max 100000", "a__b__memory.max": "max"}
    groups(tmp_path, monkeypatch, **files)
    assert machine.cores() >= before[0]
    assert machine.memory() >= before[1]
    old = {"own": "4:memory:/x\n", "memory__x__memory.limit_in_bytes": "2000000000"}
    groups(tmp_path / "old", monkeypatch, **old)
    assert machine.memory() == 2e9


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="Linux")
def test_affinity_limits_the_cores():
    allowed = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(allowed)})
    try:
        assert machine.cores() == 1
    finally:
        os.sched_setaffinity(0, allowed)


def test_handlers_that_are_not_of_python_do_not_matter(monkeypatch, capsys):
    """An installed Blender sets its own in C, and Python knows of them only that they are there."""
    before = signal.getsignal(signal.SIGINT)
    with monkeypatch.context() as patched:
        patched.setattr(signal, "getsignal", lambda number: None)
        assert cli.main(["--help"]) == 0
    signal.signal(signal.SIGINT, before)
    assert "trace images" in capsys.readouterr().out
