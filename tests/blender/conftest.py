"""The extension as users get it: these tests install the built zip, never the source tree.

INVOLUTE_ZIP names a zip that is built already; without it one is built for this machine. The same
tests run in every supported Blender (bpy and pytest are all that their environment needs).
"""

from __future__ import annotations

import importlib
import importlib.util
import os
import sys
import tempfile
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).resolve().parents[2]
REPOSITORY = "involute_tests"
MODULE = f"bl_ext.{REPOSITORY}.involute"

# Before bpy is imported: nothing may touch the user's own Blender folders.
os.environ["BLENDER_USER_RESOURCES"] = tempfile.mkdtemp(prefix="involute-blender-")
pytest.importorskip("bpy", reason="needs Blender's Python module")


def _zip() -> Path:
    if given := os.environ.get("INVOLUTE_ZIP"):
        return Path(given)
    spec = importlib.util.spec_from_file_location("involute_package", ROOT / "package.py")
    package = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(package)
    return package.build(package.host_platform(), Path(tempfile.mkdtemp()))


def install(archive: Path, folder: Path) -> None:
    """Install and enable the zip in this process's Blender."""
    import bpy

    repository = bpy.context.preferences.extensions.repos.new(
        name=REPOSITORY, module=REPOSITORY, custom_directory=str(folder)
    )
    assert repository.module == REPOSITORY
    bpy.ops.extensions.package_install_files(
        filepath=str(archive), repo=REPOSITORY, enable_on_install=True
    )
    if MODULE not in sys.modules:  # seen in 4.5 on a busy machine: installed, but not enabled
        import addon_utils

        addon_utils.enable(MODULE, default_set=True)


@pytest.fixture(scope="session")
def archive() -> Path:
    return _zip()


@pytest.fixture(scope="session")
def extension(archive: Path, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    """The enabled extension's package."""
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    install(archive, tmp_path_factory.mktemp("extensions"))
    return sys.modules[MODULE]


@pytest.fixture
def part(extension: ModuleType):
    """Import a module of the installed extension: part("operators.grease_pencil.state")."""
    return lambda name: importlib.import_module(f"{MODULE}.{name}")


@pytest.fixture
def bpy(extension: ModuleType):
    """Blender with the extension and an empty scene."""
    import bpy

    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    return bpy
