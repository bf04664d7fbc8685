"""A system without what Blender's module needs: what is said, and that the rest is written."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
from involute.operators import system_libraries
from involute.operators.system_libraries import DRAWING, LINKED, cannot_load

ROOT = Path(system_libraries.__file__).resolve().parents[1]
LACKING = "libXrender.so.1: cannot open shared object file: No such file or directory"


def test_a_missing_library_is_named_with_its_package() -> None:
    said = cannot_load(ImportError(LACKING))
    assert "libXrender.so.1" in said
    assert "apt install" in said
    assert "libxrender1" in said
    assert "extra" not in said


def test_an_unknown_library_is_named_without_a_package() -> None:
    said = cannot_load(ImportError(LACKING.replace("libXrender.so.1", "libabc-2.so.7")))
    assert "libabc-2.so.7" in said
    assert "libxrender1" not in said


def test_a_missing_module_is_another_matter() -> None:
    assert "extra 'blender'" in cannot_load(ModuleNotFoundError("No module", name="bpy"))
    said = cannot_load(ImportError("DLL load failed while importing bpy: not found."))
    assert "DLL load failed while importing bpy" in said
    assert "extra" not in said


def test_the_list_for_apt_is_printed() -> None:
    command = [sys.executable, str(ROOT / "operators" / "system_libraries.py")]
    told = subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()
    assert told == [*LINKED.values(), *DRAWING]


def test_the_other_outputs_are_written(tmp_path: Path) -> None:
    picture = np.full((90, 120), 255, np.uint8)
    cv2.line(picture, (20, 20), (100, 70), 0, 3, cv2.LINE_AA)
    cv2.imwrite(str(tmp_path / "page.png"), picture)
    (tmp_path / "bpy.py").write_text(f"raise ImportError({LACKING!r})", "utf-8")
    command = [sys.executable, "-m", "involute", "trace", "page.png", "-o", "out"]
    command += ["--format", "blend,svg,json"]
    path = os.pathsep.join([str(tmp_path), *filter(None, sys.path)])
    environment = {**os.environ, "PYTHONPATH": path}
    done = subprocess.run(
        command, env=environment, cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 1
    assert "libXrender.so.1" in done.stderr
    assert "Traceback" not in done.stderr
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == ["page.json", "page.svg"]
