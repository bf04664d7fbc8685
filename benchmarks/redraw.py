"""What the overlay adds to an idle redraw, in a Blender with a window.

    blender --factory-startup -P benchmarks/redraw.py -- ZIP SCAN [JSON]

Installs the extension's ZIP for this session, traces the SCAN, looks at its most doubtful junction
and redraws. Prints milliseconds of processor time of the draw handlers, those of OpenGL apart.
(Without a graphics card it draws in there.) "again" is the same a second time at once, since
drawing in software leaves nothing in the processor's caches. "redraw" is a whole one, wall time.
Standalone: nothing of the project can be imported in that Blender.
"""

from __future__ import annotations

import json
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from statistics import median
from types import ModuleType, SimpleNamespace
from typing import Any

import bpy
import gpu

_REPOSITORY = "involute_redraw"
_REDRAWS = 8
_STATES = ("no junction", "a junction", "its cards")
_PARTS = ("handlers", "opengl", "handlers again", "opengl again")


def main(archive: str, scan: str, result: str = "") -> None:
    """Trace, then measure each state of the overlay."""
    _install(archive)
    bpy.ops.involute.trace("EXEC_DEFAULT", filepath=scan)
    _show(bpy.context.active_object)
    clock = _Clock()
    view = bpy.context.window_manager.involute_view
    shown = _module("operators.view.view_state").shown_in(bpy.context)
    rows: dict[str, Any] = {
        "junctions": len(shown.table),
        "strokes": len(shown.trace.drawing.strokes),
    }
    view.show_overlay = False
    rows["without the overlay"] = {"redraw": _redraws()}
    view.show_overlay = True
    for state in _STATES:
        if state != "no junction":
            bpy.ops.involute.step_junction(direction="NEXT")
        view.choosing = state == "its cards"
        _redraws(2)  # what is made once
        clock.reset()
        redraw = _redraws()
        rows[state] = {name: clock.milliseconds(name) for name in _PARTS} | {"redraw": redraw}
    print(json.dumps(rows, indent=1))
    if result:
        Path(result).write_text(json.dumps(rows), "utf-8")


def _module(name: str) -> ModuleType:
    return sys.modules[f"bl_ext.{_REPOSITORY}.involute.{name}"]


def _install(archive: str) -> None:
    repository = bpy.context.preferences.extensions.repos.new(
        name=_REPOSITORY, module=_REPOSITORY, custom_directory=tempfile.mkdtemp()
    )
    bpy.ops.extensions.package_install_files(
        filepath=archive, repo=repository.module, enable_on_install=True
    )


def _show(obj: bpy.types.Object) -> None:
    """The whole drawing from the front, in the largest viewport."""
    area = max(
        (a for a in bpy.context.screen.areas if a.type == "VIEW_3D"),
        key=lambda a: a.width * a.height,
    )
    for other in bpy.context.selected_objects:
        other.select_set(other == obj)
    region = next(r for r in area.regions if r.type == "WINDOW")
    with bpy.context.temp_override(area=area, region=region):
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_selected()


class _Clock:
    """Seconds of this thread in the draw handlers, and in OpenGL within them."""

    def __init__(self) -> None:
        self.reset()
        self._again = ""
        overlay = _module("ui.overlay.overlay")
        overlay.unregister()
        for draw, when in (
            (overlay.draw_rings_and_routes, "POST_VIEW"),
            (overlay.draw_labels, "POST_PIXEL"),
        ):
            handle = bpy.types.SpaceView3D.draw_handler_add(
                self._twice(overlay, draw), (), "WINDOW", when
            )
            overlay._handles.append(handle)
        for module in (overlay, _module("ui.overlay.cards")):
            module.kept = self._with_timed_batches(module.kept)

    def reset(self) -> None:
        self._seconds = dict.fromkeys(_PARTS, 0.0)

    def milliseconds(self, name: str) -> float:
        """Per redraw; what OpenGL took is no part of the handlers' time."""
        seconds = self._seconds[name]
        if name.startswith("handlers"):
            seconds -= self._seconds[name.replace("handlers", "opengl")]
        return 1e3 * seconds / _REDRAWS

    def _twice(self, overlay: ModuleType, draw: Callable[[], None]) -> Callable[[], None]:
        run = self._timed("handlers", draw)

        def run_twice() -> None:
            seen = dict(overlay._seen)
            run()
            overlay._seen.update(seen)  # the labels take it
            self._again = " again"
            run()
            self._again = ""

        return run_twice

    def _timed(self, name: str, work: Callable) -> Callable:
        def run(*arguments: object) -> None:
            start = time.thread_time()
            work(*arguments)
            self._seconds[name + self._again] += time.thread_time() - start

        return run

    def _with_timed_batches(self, kept: Callable) -> Callable:
        def timed(made: Any) -> Any:
            if isinstance(made, gpu.types.GPUBatch):
                return SimpleNamespace(draw=self._timed("opengl", made.draw))
            if isinstance(made, (list, tuple)):
                return type(made)(map(timed, made))
            if hasattr(made, "areas"):
                return replace(made, areas=timed(made.areas), lines=timed(made.lines))
            return made

        return lambda key, make: timed(kept(key, make))


def _redraws(count: int = _REDRAWS) -> float:
    """Milliseconds of wall time of one redraw of the window, the median."""
    times = []
    for _ in range(count):
        start = time.perf_counter()
        bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)
        times.append(time.perf_counter() - start)
    return 1e3 * median(times)


def _go() -> None:
    try:
        main(*sys.argv[sys.argv.index("--") + 1 :])
    finally:
        bpy.ops.wm.quit_blender()


if __name__ == "__main__":
    bpy.context.preferences.view.show_splash = False
    bpy.app.timers.register(_go, first_interval=1.0)  # when the window is there
