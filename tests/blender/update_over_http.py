"""Run by test_repository.py in a Blender of its own:

    update_over_http.py URL SECOND FOLDER SCRATCH

Installs from URL, which serves FOLDER, opens a traced file, and while a trace is running updates to
what lies in SECOND.
"""

from __future__ import annotations

import importlib
import shutil
import sys
from pathlib import Path

import bpy

url, second, folder, scratch = sys.argv[1], *map(Path, sys.argv[2:])
MODULE = "bl_ext.studio.involute"


def part(name: str):
    return importlib.import_module(f"{MODULE}.{name}")


def version() -> str:
    manifest = Path(sys.modules[MODULE].__file__).with_name("blender_manifest.toml")
    lines = manifest.read_text("utf-8").splitlines()
    return next(line.split('"')[1] for line in lines if line.startswith("version = "))


def drawing_in(obj: bpy.types.Object):
    state = part("operators.grease_pencil.state")
    return state.load(obj.data, state.keys_at(obj.data, 1)[0], 1).drawing


def picture(name: str, size: int) -> Path:
    import cv2
    import numpy as np

    page = np.full((size, size), 255, np.uint8)
    for start in range(40, size - 40, 200):
        cv2.line(page, (20, start), (size - 20, size - start), 0, 3, cv2.LINE_AA)
        cv2.line(page, (start, 20), (size - start - 30, size - 20), 0, 3, cv2.LINE_AA)
    cv2.imwrite(str(scratch / name), page)
    return scratch / name


bpy.ops.wm.read_factory_settings(use_empty=True)
preferences = bpy.context.preferences
preferences.system.use_online_access = True
repositories = preferences.extensions.repos
studio = repositories.new(name="Studio", module="studio", remote_url=url)
studio.use_sync_on_startup = False
index = list(repositories).index(studio)
assert bpy.ops.extensions.repo_sync(repo_index=index) == {"FINISHED"}
bpy.ops.extensions.package_install(repo_index=index, pkg_id="involute", enable_on_install=True)
first = sys.modules[MODULE]
assert version() != "99.0.0"

# A file that is open, with a junction that the artist has decided.
bpy.ops.involute.trace(filepath=str(picture("small.png", 240)))
obj = bpy.context.active_object
assert bpy.ops.involute.reroute(junction=0, alternative=1) == {"FINISHED"}
bpy.ops.wm.save_as_mainfile(filepath=str(scratch / "open.blend"))
decided = drawing_in(obj)
assert decided.junctions[0].locked

# A trace of a large page that is running.
job, trace_job = part("operators.job"), part("operators.tracing.trace_job")
sources = part("operators.tracing.sources").from_files([str(picture("large.png", 2000))])
running = job.current = trace_job.TraceJob(sources, part("engine").Settings())
running.start()
while running.fraction == 0 and running.running:
    pass
assert running.running

for path in folder.glob("*.zip"):
    path.unlink()
shutil.copytree(second, folder, dirs_exist_ok=True)
assert bpy.ops.extensions.repo_sync(repo_index=index) == {"FINISHED"}
assert bpy.ops.extensions.package_upgrade_all() == {"FINISHED"}

assert not running.running
assert running.cancelled
assert running.problem == ""
assert sys.modules[MODULE] is not first
assert version() == "99.0.0"
assert MODULE in preferences.addons

# The open file is there, and goes on with the new version: look, decide, trace, save, open.
obj = bpy.context.active_object
after = drawing_in(obj)
assert after.junctions[0].pairs == decided.junctions[0].pairs
assert len(after.strokes) == len(decided.strokes)
assert bpy.ops.involute.reroute(junction=0, alternative=0) == {"FINISHED"}
assert drawing_in(obj).junctions[0].pairs != decided.junctions[0].pairs
bpy.ops.involute.trace(filepath=str(scratch / "small.png"))
bpy.ops.wm.save_mainfile()
bpy.ops.wm.open_mainfile(filepath=str(scratch / "open.blend"))
assert sum(obj.type == "GREASEPENCIL" for obj in bpy.data.objects) == 2
print("ALL WELL")
