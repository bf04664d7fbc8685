"""All tests, each in the environments that it is for: the README's test command.

    python3 bootstrap.py --extra test --extra bench python tests/run.py [NAME ...] [--seed N]

    main    this environment: ruff, mypy, every test; the Blender ones against the built extension
    4.5     bpy 4.5 on Python 3.11: the same extension
    5.2     bpy 5.2 on Python 3.13: the same extension
    fast    what runs networks, with the extra `fast`: ONNX Runtime
    torch   training tests, in an environment made by plain pip from training/requirements.txt
    coverage  branch coverage of what must not fail: formats, batches, sequences, what a .blend
              remembers; only when it is named

The environments are made when missing, in .venv-NAME.
"""

from __future__ import annotations

import argparse
import os
import secrets
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path

from involute.operators import system_libraries

ROOT = Path(__file__).resolve().parents[1]
PYTEST = "pytest==9.2.0"
HYPOTHESIS = "hypothesis==6.170.15"


def main(argv: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help="default: " + " ".join(RUNS))
    parser.add_argument("--seed", type=int, help="of the property tests; else a new one")
    options = parser.parse_args(argv)
    names = options.names or [name for name in RUNS if name not in ON_REQUEST]
    if unknown := set(names) - set(RUNS):
        parser.error(f"unknown: {', '.join(sorted(unknown))}; choose from {', '.join(RUNS)}")
    if libraries := system_libraries.missing():
        raise SystemExit(system_libraries.lacks(libraries))
    seed = secrets.randbits(32) if options.seed is None else options.seed
    told = f"property tests: --seed {seed} repeats this run"
    print(told)
    outcomes = {}
    for name in names:
        print(f"\n==== {name} ====", flush=True)
        start = time.monotonic()
        passed, closing = RUNS[name](seed)
        minutes = (time.monotonic() - start) / 60
        outcomes[name] = passed, f"{name}: {closing} ({minutes:.1f} min in all)"
    print(f"\n==== summary ==== ({told})")
    for passed, line in outcomes.values():
        print("ok    " if passed else "FAILED", line)
    return 0 if all(passed for passed, _ in outcomes.values()) else 1


def in_this_environment(seed: int) -> tuple[bool, str]:
    _as_package()
    checks = ["ruff", "check", "."], ["ruff", "format", "--check", "."], ["mypy"]
    untidy = [" ".join(c[:2]) for c in checks if _call([sys.executable, "-m", *c])]
    passed, closing = _pytest(
        Path(sys.executable), "tests", _seeded(seed), INVOLUTE_ZIP=_extension()
    )
    if untidy:
        return False, f"{' and '.join(untidy)} failed; {closing}"
    return passed, closing


def _as_package() -> None:
    """The repository under the name that it is imported by, for mypy: build/types/involute."""
    link = ROOT / "build" / "types" / "involute"
    link.parent.mkdir(parents=True, exist_ok=True)
    if not link.exists():
        link.unlink(missing_ok=True)
        link.symlink_to(ROOT, target_is_directory=True)


def in_blender(version: str, bpy: str, python: str) -> tuple[bool, str]:
    home = ROOT / f".venv-{version}"
    requirements = [f"bpy=={bpy}", PYTEST]

    def make() -> None:
        _check([*_uv(), "venv", "--clear", "--python", _interpreter(python), str(home)])
        _check([*_uv(), "pip", "install", "--python", str(_python(home)), *requirements])

    _once(home, "\n".join(requirements), make)
    return _pytest(_python(home), "tests/blender", INVOLUTE_ZIP=_extension())


def in_fast(seed: int) -> tuple[bool, str]:
    home = ROOT / ".venv-fast"
    what = [PYTEST, HYPOTHESIS, "scipy==1.17.1", "--editable", f"{ROOT}[fast]"]

    def make() -> None:
        _check([*_uv(), "venv", "--clear", "--python", _interpreter("3.11"), str(home)])
        install = [*_uv(), "pip", "install", "--python", str(_python(home))]
        # OpenCV 5 asks for numpy 2, and runs on what Blender brings.
        _check([*install, f"--overrides={_numpy(home)}", *what])

    _once(home, "\n".join([*what, (ROOT / "pyproject.toml").read_text("utf-8")]), make)
    tests = ("runtimes", "centerline_network", "routing_network", "pipeline")
    return _pytest(_python(home), *(f"tests/engine/test_{t}.py" for t in tests), _seeded(seed))


def _numpy(home: Path) -> Path:
    pin = home / "numpy.txt"
    pin.write_text("numpy==1.26.4\n", "utf-8")
    return pin


def in_torch(seed: int) -> tuple[bool, str]:
    home = ROOT / ".venv-torch"
    requirements = ROOT / "training" / "requirements.txt"

    def make() -> None:
        interpreter = _interpreter("3.11")
        if not Path(interpreter).exists():
            interpreter = sys.executable
        _check([interpreter, "-m", "venv", "--clear", str(home)])
        pip = [str(_python(home)), "-m", "pip", "install", "--quiet", PYTEST, HYPOTHESIS]
        _check([*pip, "--requirement", str(requirements), "--editable", str(ROOT)])

    _once(home, requirements.read_text("utf-8"), make)
    return _pytest(_python(home), "tests/training", _seeded(seed))


def in_coverage(seed: int) -> tuple[bool, str]:
    """The tests of what must not fail, and which of its branches none of them took."""
    _call([sys.executable, "-m", "coverage", "erase"])
    passed, closing = _pytest(
        Path(sys.executable), *_COVERED_BY, _seeded(seed), under=("coverage", "run", "-m"),
        INVOLUTE_ZIP=_extension(),
    )  # fmt: skip
    _call([sys.executable, "-m", "coverage", "combine", "--quiet"])
    report = [sys.executable, "-m", "coverage", "report"]
    told = subprocess.run(report, cwd=ROOT, capture_output=True, text=True, check=False).stdout
    print(told, flush=True)
    total = next((line.split()[-1] for line in told.splitlines() if "TOTAL" in line), "none")
    return passed, f"{total} of lines and branches; {closing}"


_COVERED_BY = (
    *(f"tests/engine/test_{name}.py" for name in ("formats", "damaged_drawings", "exchange")),
    "tests/command",
    *(f"tests/blender/test_{name}.py" for name in ("state", "series", "splicing", "sequence")),
)
ON_REQUEST = ("coverage",)
RUNS: dict[str, Callable[[int], tuple[bool, str]]] = {
    "main": in_this_environment,
    "4.5": lambda seed: in_blender("4.5", "4.5.15", "3.11"),
    "5.2": lambda seed: in_blender("5.2", "5.2.3", "3.13"),
    "fast": in_fast,
    "torch": in_torch,
    "coverage": in_coverage,
}


def _pytest(
    python: Path, *what: str, under: Sequence[str] = (), **environment: str
) -> tuple[bool, str]:
    """Run tests, shown as they run; whether all passed, and pytest's closing line.

    under: arguments of Python that run pytest in something else.
    """
    env = {k: v for k, v in os.environ.items() if k not in ("VIRTUAL_ENV", "PYTHONPATH")}
    command = [
        str(python),
        "-m",
        *under,
        "pytest",
        *what,
        "--durations=5",
        "-p",
        "no:cacheprovider",
    ]
    process = subprocess.Popen(
        command, cwd=ROOT, env={**env, **environment}, text=True, errors="replace",
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    closing = "no closing line: it broke off"
    for line in process.stdout:
        print(line, end="", flush=True)
        if " in " in line and any(w in line for w in ("passed", "failed", "error", "skipped")):
            closing = line.strip().strip("= ")
    code = process.wait()
    # Blender may stumble while it shuts down, after the last test has passed.
    return code == 0, closing if code == 0 else f"{closing}; exit code {code}"


@cache
def _extension() -> str:
    """The zip for this machine, built once a run."""
    folder = ROOT / "build" / "tests"
    shutil.rmtree(folder, ignore_errors=True)
    _check([sys.executable, str(ROOT / "package.py"), "--platform", "host", "-o", str(folder)])
    return str(next(folder.glob("*.zip")))


def _once(home: Path, content: str, make: Callable[[], None]) -> None:
    """Make an environment unless it is there with this content."""
    stamp = home / "made-from.txt"
    if not stamp.exists() or stamp.read_text("utf-8") != content:
        make()
        stamp.write_text(content, "utf-8")


def _interpreter(version: str) -> str:
    """A Python of this version: this one, the path's, pyenv's; else the version, for uv to get."""
    pyenv = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
    candidates = [
        sys.executable,
        shutil.which(f"python{version}"),
        *(str(p / "bin" / "python") for p in sorted(pyenv.glob(f"{version}.*"))),
    ]
    ask = "import sys; print(*sys.version_info[:2], sep='.')"
    for candidate in filter(None, candidates):
        told = subprocess.run([candidate, "-c", ask], capture_output=True, text=True, check=False)
        if told.stdout.strip() == version:
            return candidate
    return version


def _seeded(seed: int) -> str:
    return f"--hypothesis-seed={seed}"


def _uv() -> list[str]:
    found = os.environ.get("UV") or shutil.which("uv")  # uv tells those that it runs
    return [found] if found else [sys.executable, "-m", "uv"]


def _python(home: Path) -> Path:
    return home / ("Scripts/python.exe" if os.name == "nt" else "bin/python")


def _call(command: list[str]) -> int:
    print("$", " ".join(command), flush=True)
    return subprocess.run(command, cwd=ROOT, stdin=subprocess.DEVNULL, check=False).returncode


def _check(command: list[str]) -> None:
    if code := _call(command):
        raise SystemExit(f"That failed with exit code {code}.")


if __name__ == "__main__":
    raise SystemExit(main())
