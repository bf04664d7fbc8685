"""What the built extension weighs and what it costs to enable: standard library and bpy only.

    python benchmarks/extension.py ZIP [--python PYTHON ...] [--repeat N]

Every PYTHON has bpy; in each the zip is installed into a folder of its own and enabled, in a new
process each time; the least of the runs counts. Seconds on the clock, and of processor time in
brackets, which other work on the machine does not change much:

    install     enabling it for the first time: Blender unpacks the wheels, Python compiles
    enable      what any later start of Blender spends on it
    loading     what the first trace of a small drawing takes more than the second: OpenCV, the
                engine and both networks
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import subprocess
import sys
import tempfile
import time
import zipfile
from collections.abc import Sequence
from pathlib import Path

REPOSITORY = "involute_speed"
MODULE = f"bl_ext.{REPOSITORY}.involute"


def main(argv: Sequence[str] | None = None) -> dict[str, dict[str, float]]:
    """The command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("zip", type=Path)
    parser.add_argument("--python", nargs="+", default=[sys.executable])
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--inside", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args(argv)
    if options.inside:
        print(json.dumps(measure(options.zip.absolute())))
        return {}
    for line in contents(options.zip):
        print(line)
    print()
    figures = {"zip": {"MB": options.zip.stat().st_size / 1e6}}
    for python in options.python:
        command = [python, __file__, "--inside", str(options.zip)]
        runs = []
        for _ in range(options.repeat):
            done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
            runs.append(json.loads(done.stdout.splitlines()[-1]))
        least = {
            name: [min(run[name][k] for run in runs) for k in (0, 1)]
            for name in ("install", "enable", "loading")
        }
        told = ", ".join(f"{name} {a:.3f} s ({b:.3f})" for name, (a, b) in least.items())
        print(f"Blender {runs[0]['version']}: {told}; {runs[0]['early'] or 'none'} loaded early")
        figures[f"Blender {runs[0]['version']}"] = {k: wall for k, (wall, _) in least.items()}
    return figures


def contents(path: Path) -> list[str]:
    """Files and MB in the zip, part by part."""
    parts: dict[str, list[int]] = {}
    with zipfile.ZipFile(path) as archive:
        for info in archive.infolist():
            name = info.filename if "weights/" in info.filename else info.filename.split("/")[0]
            name = Path(info.filename).name if name == "wheels" else name
            part = parts.setdefault(name, [0, 0])
            part[0] += 1
            part[1] += info.compress_size
    lines = [f"{size / 1e6:8.2f} MB {count:4d}  {name}" for name, (count, size) in parts.items()]
    total = sum(count for count, _ in parts.values())
    return [*lines, f"{path.stat().st_size / 1e6:8.2f} MB {total:4d}  {path.name}"]


def measure(archive: Path) -> dict[str, object]:
    """Install, enable once more as at a start of Blender, and trace twice; in this process."""
    os.environ["BLENDER_USER_RESOURCES"] = tempfile.mkdtemp(prefix="involute-blender-")
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    repository = bpy.context.preferences.extensions.repos.new(
        name=REPOSITORY, module=REPOSITORY, custom_directory=tempfile.mkdtemp()
    )
    bpy.ops.extensions.package_install_files(
        filepath=str(archive), repo=repository.module, enable_on_install=False
    )
    import addon_utils  # there only once bpy is

    found: dict[str, object] = {"version": bpy.app.version_string}
    sys.dont_write_bytecode = False
    found["install"] = _seconds(lambda: addon_utils.enable(MODULE))
    heavy = ("cv2", "networkx", f"{MODULE}.engine.pipeline")
    found["early"] = [name for name in heavy if name in sys.modules]
    sys.modules[MODULE].unregister()
    for name in [name for name in sys.modules if name.startswith(MODULE)]:
        del sys.modules[name]
    found["enable"] = _seconds(lambda: importlib.import_module(MODULE).register())

    picture = Path(tempfile.mkdtemp()) / "drawing.png"
    _draw(picture)
    first, second = (
        _seconds(lambda: bpy.ops.involute.trace(filepath=str(picture))) for _ in range(2)
    )
    found["loading"] = [a - b for a, b in zip(first, second, strict=True)]
    return found


def _seconds(work) -> list[float]:
    """On the clock, and of processor time."""
    wall, cpu = time.perf_counter(), time.process_time()
    work()
    return [time.perf_counter() - wall, time.process_time() - cpu]


def _draw(path: Path) -> None:
    """A page of 256 px with a cross, by Blender itself."""
    import bpy
    import numpy as np

    page = np.ones((256, 256, 4), np.float32)
    page[126:130, 40:216, :3] = page[40:216, 126:130, :3] = 0.0
    image = bpy.data.images.new("page", 256, 256)
    image.pixels.foreach_set(page.ravel())
    image.filepath_raw, image.file_format = str(path), "PNG"
    image.save()


if __name__ == "__main__":
    main()
