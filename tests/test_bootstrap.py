"""The README's commands: one way to run things, the same everywhere. `.ci/fresh` really runs it."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
BOOTSTRAP = str(ROOT / "bootstrap.py")


def commands() -> list[str]:
    readme = (ROOT / "README.md").read_text("utf-8")
    return re.findall(r"^python3 bootstrap\.py .*", readme.split("## Install it")[0], re.M)


def test_the_readme_has_two_commands_and_ci_runs_the_tests_by_the_second() -> None:
    trace, tests = commands()
    assert "involute trace" in trace
    assert (ROOT / ".ci" / "run").read_text("utf-8").rstrip().splitlines()[-1] == tests
    assert f"    {tests} [NAME ...]" in (ROOT / "tests" / "run.py").read_text("utf-8")


@pytest.mark.skipif(os.name == "nt", reason="the stand-in is a shell script")
def test_what_is_asked_goes_to_the_given_uv_and_its_exit_code_comes_back(tmp_path: Path) -> None:
    given = tmp_path / "uv"
    given.write_text('#!/bin/sh\n[ "$1" = --version ] && exit 0\nprintf "%s\\n" "$@"\nexit 7\n')
    given.chmod(0o755)
    command = [sys.executable, BOOTSTRAP, "--extra", "test", "python", "-c", "print(1, 2)"]
    environment = {**os.environ, "UV": str(given)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    asked = ["run", "--project", str(ROOT), "--extra", "blender", *command[2:]]
    assert (done.returncode, done.stdout.splitlines()) == (7, asked)


def test_without_a_command_it_says_how_to_use_it() -> None:
    for arguments, code in ((["--help"], 0), ([], 2)):
        command = [sys.executable, BOOTSTRAP, *arguments]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == code
        assert "python3 bootstrap.py [--extra NAME ...] COMMAND" in done.stdout
