"""Builds the extension: `python package.py`, one zip per platform with its three wheels.

`python package.py --repository FOLDER` makes a folder of them that Blender installs and updates
from: any web server can hand it out.

The wheels come from `pip download`, pinned by the hashes in wheels.txt, into the ignored folder
wheels/. `--runtime onnxruntime` adds ONNX Runtime, which traces in less than half the time, for
both Pythons of the supported Blenders; the zip is then 56 MB larger. The same sources give the
same bytes. Standard library only, so that it also runs by path.
"""

from __future__ import annotations

import argparse
import hashlib
import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent
WHEELS = ROOT / "wheels"
SHIPPED = ("LICENSE", "__init__.py", "command", "engine", "operators", "ui")
PLATFORMS = {  # Blender's name: (part of the OpenCV wheel's file name, pip's --platform)
    "linux-x64": ("manylinux_2_28_x86_64", "manylinux_2_28_x86_64"),
    "linux-arm64": ("manylinux_2_28_aarch64", "manylinux_2_28_aarch64"),
    "windows-x64": ("win_amd64", "win_amd64"),
    "macos-arm64": ("macosx_13_0_arm64", "macosx_13_0_arm64"),
    "macos-x64": ("macosx_14_0_x86_64", "macosx_14_0_x86_64"),
}
PYTHONS = ("3.11", "3.13")  # of Blender 4.5 to 5.0, and of 5.1 on
RUNTIMES = {  # name: (its version, part of its wheel's file name for each platform that has one)
    "onnxruntime": (
        "1.32.0",
        {
            "linux-x64": "manylinux_2_28_x86_64",
            "linux-arm64": "manylinux_2_28_aarch64",
            "windows-x64": "win_amd64",
            "macos-arm64": "macosx_14_0_arm64",
        },
    )
}
_EPOCH = (2026, 1, 1, 0, 0, 0)  # one date for all files: the zip is reproducible


def build(platform: str, output: Path, runtime: str | None = None, website: str = "") -> Path:
    """Build the zip for one platform, with a faster runtime if one is named; return its path.

    The website of whoever publishes it goes into the manifest.

    Raises:
        SystemExit: a wheel can't be had.
    """
    manifest = (ROOT / "blender_manifest.toml").read_text("utf-8")
    if website:
        manifest = manifest.replace("\ntype = ", f"\nwebsite = {json.dumps(website)}\ntype = ", 1)
    parsed = tomllib.loads(manifest)
    wheels = [Path(w) for w in parsed["wheels"] if _fits(Path(w).name, platform)]
    fetch(platform, [w.name for w in wheels])
    if runtime:
        wheels += fetch_runtime(runtime, platform)
    manifest = _replace_list(manifest, "platforms", [platform])
    manifest = _replace_list(manifest, "wheels", [f"./{w.as_posix()}" for w in wheels])
    output.mkdir(parents=True, exist_ok=True)
    what = "-".join(filter(None, (platform.replace("-", "_"), runtime)))
    path = output / f"{parsed['id']}-{parsed['version']}-{what}.zip"
    with zipfile.ZipFile(path, "w") as archive:
        _add(archive, "blender_manifest.toml", manifest.encode("utf-8"))
        for file in sorted(_shipped_files()):
            _add(archive, file.relative_to(ROOT).as_posix(), file.read_bytes())
        for wheel in wheels:
            _add(archive, wheel.as_posix(), (ROOT / wheel).read_bytes())
    return path


def fetch(platform: str, names: list[str]) -> None:
    """Bring the wheels into wheels/ and check their hashes.

    Raises:
        SystemExit: a wheel can't be had, or is not the one that was pinned.
    """
    _download(names, "wheels.txt", ["abi3", "none"], PYTHONS[0], PLATFORMS[platform][1])


def fetch_runtime(runtime: str, platform: str) -> list[Path]:
    """Bring a runtime's wheels, one for each Python, into wheels/; their paths in the zip.

    Raises:
        SystemExit: there are none for that platform, or as `fetch`.
    """
    release, tags = RUNTIMES[runtime]
    if platform not in tags:
        raise SystemExit(f"There is no {runtime} {release} for {platform}; leave out --runtime.")
    found = []
    for python in PYTHONS:
        abi = f"cp{python.replace('.', '')}"
        name = f"{runtime}-{release}-{abi}-{abi}-{tags[platform]}.whl"
        _download([name], f"wheels-{runtime}.txt", [abi], python, tags[platform])
        found.append(Path("wheels") / name)
    return found


def _download(names: list[str], pins: str, abis: list[str], python: str, tag: str) -> None:
    """Have the wheels of a list of pins in wheels/, and check their hashes."""
    if not all((WHEELS / name).exists() for name in names):
        command = [*_pip(), "download", "--quiet", "--no-deps", "--require-hashes"]
        command += ["--only-binary=:all:", "--implementation=cp", *(f"--abi={a}" for a in abis)]
        command += [f"--python-version={python}", f"--platform={tag}"]
        command += [f"--dest={WHEELS}", f"--requirement={ROOT / pins}"]
        if subprocess.run(command).returncode:
            raise SystemExit(f"pip could not download {', '.join(names)}.")
    pinned = set(re.findall(r"sha256:([0-9a-f]{64})", (ROOT / pins).read_text("utf-8")))
    for name in names:
        if hashlib.sha256((WHEELS / name).read_bytes()).hexdigest() not in pinned:
            raise SystemExit(f"{name} is not the file that {pins} pins; delete it and retry.")


def validate(path: Path) -> None:
    """Let Blender's own checker judge the zip; needs the `bpy` package, which brings it."""
    _blender_extension("validate", str(path))


def list_repository(folder: Path) -> None:
    """Have Blender list the newest zips of a folder: index.json, and index.html to drop them from.

    What is not of this version goes to the folder `older` in it, out of the list, and so does the
    earlier of two zips for one platform: of two Blender would take any. Needs the `bpy` package.
    """
    parsed = tomllib.loads((ROOT / "blender_manifest.toml").read_text("utf-8"))
    newest: dict[str, Path] = {}
    zips = sorted(folder.glob(f"{parsed['id']}-*.zip"), key=lambda path: path.stat().st_mtime)
    for path in zips:
        _, version, platform, *_ = path.stem.split("-")
        if version == parsed["version"]:
            newest[platform] = path
    for path in set(zips) - set(newest.values()):
        (folder / "older").mkdir(exist_ok=True)
        path.replace(folder / "older" / path.name)
    _blender_extension("server-generate", f"--repo-dir={folder}", "--html")


def _blender_extension(*words: str) -> None:
    """What `blender --command extension` does, by the script that the `bpy` package brings."""
    spec = importlib.util.find_spec("bpy")
    if spec is None or not spec.submodule_search_locations:
        raise SystemExit("That needs bpy: install the extra 'blender', or use --no-validate.")
    found = Path(spec.submodule_search_locations[0]).glob(
        "*/scripts/addons_core/bl_pkg/cli/blender_ext.py"
    )
    if subprocess.run([sys.executable, str(next(found)), *words]).returncode:
        raise SystemExit(f"Blender's {words[0]} failed; see above.")


def host_platform() -> str:
    """Blender's name for the platform this runs on."""
    import platform as machine

    system = {"linux": "linux", "win32": "windows", "darwin": "macos"}[sys.platform]
    arm = machine.machine().lower() in {"arm64", "aarch64"}
    return f"{system}-{'arm64' if arm else 'x64'}"


def main(argv: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="package.py", description=__doc__)
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "dist", help="folder for zips")
    parser.add_argument(
        "--platform",
        nargs="+",
        choices=[*PLATFORMS, "host"],
        default=list(PLATFORMS),
        metavar="NAME",
        help="default: all of " + ", ".join(PLATFORMS) + "; host = this machine's",
    )
    parser.add_argument("--runtime", choices=list(RUNTIMES), help="add a faster runtime")
    parser.add_argument(
        "--repository",
        type=Path,
        metavar="FOLDER",
        help="put the zips there instead, and list them so that Blender installs from it",
    )
    parser.add_argument(
        "--website", default="", metavar="URL", help="where users find help: it goes into the zips"
    )
    parser.add_argument("--no-validate", action="store_true", help="don't run Blender's checker")
    options = parser.parse_args(argv)
    output = options.repository or options.output
    for name in options.platform:
        path = build(
            host_platform() if name == "host" else name, output, options.runtime, options.website
        )
        if not options.no_validate:
            validate(path)
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
        print(f"{path}  {path.stat().st_size / 1e6:.1f} MB  sha256 {digest}")
    if options.repository:
        list_repository(output)
    return 0


def _fits(wheel: str, platform: str) -> bool:
    return wheel.endswith("-any.whl") or wheel.endswith(f"-{PLATFORMS[platform][0]}.whl")


def _replace_list(manifest: str, key: str, values: list[str]) -> str:
    """The manifest with another list under one key, comments and order kept."""
    quoted = ", ".join(f'"{value}"' for value in values)
    text = f"{key} = [{quoted}]"
    changed, count = re.subn(rf"^{key} = \[.*?\]$", text, manifest, flags=re.M | re.S)
    if count != 1:
        raise SystemExit(f"blender_manifest.toml must have exactly one list {key!r}.")
    return changed


def _shipped_files() -> Iterator[Path]:
    for part in SHIPPED:
        path = ROOT / part
        files = path.rglob("*") if path.is_dir() else [path]
        yield from (f for f in files if f.is_file() and not _is_cache(f.relative_to(ROOT)))


def _is_cache(file: Path) -> bool:
    """Whether a tool left it there: in __pycache__, .ruff_cache and the like."""
    return any(part == "__pycache__" or part.startswith(".") for part in file.parts)


def _add(archive: zipfile.ZipFile, name: str, content: bytes) -> None:
    info = zipfile.ZipInfo(name, _EPOCH)
    info.external_attr = 0o644 << 16
    # Wheels are zips already.
    info.compress_type = zipfile.ZIP_STORED if name.endswith(".whl") else zipfile.ZIP_DEFLATED
    archive.writestr(info, content)


def _pip() -> list[str]:
    if importlib.util.find_spec("pip"):
        return [sys.executable, "-m", "pip"]
    if pip := shutil.which("pip"):
        return [pip]
    if uv := os.environ.get("UV") or shutil.which("uv"):
        return [uv, "tool", "run", "pip"]
    raise SystemExit("Fetching the wheels needs pip: install it, or put them in wheels/.")


if __name__ == "__main__":
    raise SystemExit(main())
