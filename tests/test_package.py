"""What the extension ships."""

from __future__ import annotations

import ast
import re
import shutil
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
from involute import package


@pytest.fixture
def sources(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for part in package.SHIPPED:
        origin = package.ROOT / part
        copy = shutil.copytree if origin.is_dir() else shutil.copy
        copy(origin, tmp_path / part)
    monkeypatch.setattr(package, "ROOT", tmp_path)
    return tmp_path


def test_caches_of_tools_are_not_shipped(sources: Path) -> None:
    before = set(package._shipped_files())
    for folder in (".ruff_cache", "__pycache__"):
        cache = sources / "engine" / "graph" / folder
        cache.mkdir(exist_ok=True)
        (cache / "left").write_text("behind")
    assert set(package._shipped_files()) == before
    assert sources / "engine" / "weights" / "centerline.onnx" in before


def test_every_file_that_is_shipped_is_needed() -> None:
    files = set(package._shipped_files())
    reached: set[Path] = set()
    # Blender imports the package; worker.py is started by its path.
    waiting = [package.ROOT / "__init__.py", package.ROOT / "command" / "worker.py"]
    while waiting:
        file = waiting.pop()
        if file not in reached:
            reached.add(file)
            waiting += [target for target in _imported(file) if target in files]
    sources = "\n".join(file.read_text("utf-8") for file in reached)
    for file in files - reached:
        named = f'"{file.name}"' in sources
        assert named or file.name == "LICENSE" or file.name.endswith("MODEL_CARD.md"), file


def _imported(file: Path) -> Iterator[Path]:
    """The project's files that a source may import, at its top or later."""
    text = file.read_text("utf-8")
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom) and node.level:
            folder = file.parents[node.level - 1]
            base = folder.joinpath(*(node.module or "").split("."))
            yield from _module(base)
            for name in node.names:
                yield from _module(base / name.name)
    # Lazy imports go by name: import_module(f".{name}"), _module("command.batch").
    for name in re.findall(r'"\.?([a-z_.]+)"', text):
        for folder in (file.parent, package.ROOT):
            yield from _module(folder.joinpath(*name.split(".")))


def _module(base: Path) -> Iterator[Path]:
    yield base.with_suffix(".py")
    yield base / "__init__.py"


def test_every_wheel_that_is_shipped_is_imported() -> None:
    wheels = tomllib.loads((package.ROOT / "blender_manifest.toml").read_text("utf-8"))["wheels"]
    code = "\n".join(f.read_text("utf-8") for f in package._shipped_files() if f.suffix == ".py")
    modules = {
        "networkx": "networkx",
        "opencv_contrib_python_headless": "cv2",
        "svgelements": "svgelements",
    }
    for wheel in wheels:
        name = modules[Path(wheel).name.split("-")[0]]
        assert re.search(rf"^ *(import|from) {name}\b", code, re.M)
    for platform in package.PLATFORMS:
        assert sum(package._fits(Path(w).name, platform) for w in wheels) == 3


def test_a_runtime_has_a_pinned_wheel_for_both_pythons_wherever_it_exists() -> None:
    for name, (release, tags) in package.RUNTIMES.items():
        pins = (package.ROOT / f"wheels-{name}.txt").read_text("utf-8")
        assert f"{name}=={release} " in pins
        assert len(re.findall("sha256:", pins)) == len(package.PYTHONS) * len(tags)
        extra = tomllib.loads((package.ROOT / "pyproject.toml").read_text("utf-8"))
        assert f"{name}=={release}" in extra["project"]["optional-dependencies"]["fast"]
        assert set(tags) < set(package.PLATFORMS)


def test_a_platform_without_the_runtime_is_said() -> None:
    with pytest.raises(SystemExit, match="no onnxruntime"):
        package.fetch_runtime("onnxruntime", "macos-x64")
