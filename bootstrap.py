"""Run a command in the environment of this checkout; makes all that is missing for it.

    python3 bootstrap.py [--extra NAME ...] COMMAND ...

This is `uv run --extra blender ...`; uv comes from the variable UV, from the path, or else into
.venv-uv, so that no system's Python is touched. Standard library only; any Python from 3.8.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import venv
from importlib.util import find_spec
from pathlib import Path

ROOT = Path(__file__).resolve().parent
HOME = ROOT / ".venv-uv"
_BIN, _EXE = ("Scripts", ".exe") if os.name == "nt" else ("bin", "")


def main(arguments: list[str]) -> int:
    if not arguments or arguments[0] in ("-h", "--help"):
        print(__doc__)
        return 0 if arguments else 2
    command = [uv(), "run", "--project", str(ROOT), "--extra", "blender", *arguments]
    os.environ.pop("VIRTUAL_ENV", None)  # this checkout has an environment of its own
    if os.name == "posix":  # elsewhere, the new process would not take the place of this one
        os.execv(command[0], command)
    return subprocess.call(command)


def uv() -> str:
    """The path of a uv that runs.

    Raises:
        SystemExit: it can't be had.
    """
    own = str(HOME / _BIN / f"uv{_EXE}")
    for name in (os.environ.get("UV") or "uv", "uv", own):
        found = shutil.which(name)
        if found and _runs(found):
            return found
    try:
        subprocess.check_call([*_pip(), "install", "--quiet", "uv"])
    except (OSError, subprocess.CalledProcessError) as error:
        raise SystemExit(f"Could not install uv into {HOME}: {error}") from None
    return own


def _runs(program: str) -> bool:
    try:
        told = subprocess.run([program, "--version"], capture_output=True, check=False)
    except OSError:
        return False
    return told.returncode == 0


def _pip() -> list[str]:
    """A pip that installs into HOME, which is made anew."""
    python = str(HOME / _BIN / f"python{_EXE}")
    if find_spec("ensurepip"):
        venv.create(HOME, clear=True, with_pip=True)
        return [python, "-m", "pip"]
    if find_spec("pip"):  # Debian keeps ensurepip in another package
        venv.create(HOME, clear=True)
        return [sys.executable, "-m", "pip", "--python", python]
    raise SystemExit(
        "This Python can't install anything: it has neither pip nor ensurepip. "
        "On Debian and Ubuntu, run first: apt install python3-venv"
    )


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
