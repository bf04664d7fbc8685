"""What the extension ships."""

from __future__ import annotations

import shutil
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
