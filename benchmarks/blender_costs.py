"""What the Blender side costs: `python -m benchmarks.blender_costs` (needs bpy) prints a table.

CPU time of this process, the median of several runs, on drawings traced from woven pages. Where
there is a display and a `blender`, what the overlay adds to a redraw is measured there, too.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import bpy
import cv2
import numpy as np
from involute import package
from involute.engine import Drawing, Settings, Stroke, vectorize
from involute.operators.grease_pencil import routing_change, state, writing
from involute.operators.grease_pencil.core.pixel_map import front_view
from involute.operators.grease_pencil.retracing import retrace
from involute.operators.tracing.part import Page, Part
from involute.operators.tracing.recent import PARTS
from involute.operators.tracing.sources import Source
from involute.operators.tracing.trace import new_object
from involute.operators.tracing.try_part import PartJob
from involute.operators.view.junction_table import JunctionTable
from involute.ui.overlay import colors, overlay_geometry, stroke_overlay

from .run_record import Figures

_RUNS = 7
_HEADLESS = 4  # rows that need no window
_ROOT = Path(__file__).resolve().parents[1]


Row = tuple[str, float, float]


def main(argv: Sequence[str] | None = None) -> Figures:
    """Print milliseconds of CPU beside what they are allowed to be."""
    argparse.ArgumentParser(description=__doc__.splitlines()[0]).parse_args(argv)
    told, rows = report()
    print(told)
    return {what: {"ms": milliseconds, "at most": limit} for what, milliseconds, limit in rows}


def seconds_of_an_artist(argv: Sequence[str] | None = None) -> Figures:
    """What is waited for while reviewing and adjusting: `python -m benchmarks run artist`."""
    argparse.ArgumentParser(description="Waits of an artist.").parse_args(argv)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    rows = [
        colors_unchanged(1000),
        review_step(1000),
        smoothing_changed(1000),
        part_tried(320, anew=True),
        part_tried(320, anew=False),
    ]
    print(table(rows))
    return {what: {"ms": milliseconds, "at most": limit} for what, milliseconds, limit in rows}


def in_window(argv: Sequence[str] | None = None) -> Figures:
    """The overlay in an idle redraw alone: `python -m benchmarks run redraw`.

    Raises:
        ValueError: there is no display, or no Blender.
    """
    argparse.ArgumentParser(description="The overlay in an idle redraw.").parse_args(argv)
    if not (rows := redraw()):
        raise ValueError("The run redraw needs a display and `blender` on the path.")
    print("\n".join(f"{what:40} {milliseconds:8.2f} ms" for what, milliseconds, _ in rows))
    return {what: {"ms": milliseconds, "at most": limit} for what, milliseconds, limit in rows}


def report() -> tuple[str, list[Row]]:
    """The table as text, and its rows."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    rows = [write_ten_thousand(), reroute_among(500), overlay_of(2000), look_up(125), *redraw()]
    told = table(rows)
    if len(rows) == _HEADLESS:
        told += "\nidle redraw: not measured, there is no display or no blender"
    return told, rows


def table(rows: Sequence[Row]) -> str:
    """Rows as text."""
    lines = [f"{what:58} {milliseconds:8.2f} {limit:8.0f}" for what, milliseconds, limit in rows]
    return "\n".join([f"{'what':58} {'ms':>8} {'at most':>8}", *lines])


def write_ten_thousand() -> Row:
    """10,000 strokes of 50 points into Grease Pencil."""
    random = np.random.default_rng(0)
    lines = random.uniform(0, 1000, (10_000, 50, 2)).astype(np.float32)
    full = np.ones(50, np.float32)
    none = np.zeros(0, np.int32)
    strokes = tuple(Stroke(line, 2 * full, full, False, (0, 0, 0), none) for line in lines)
    blank = vectorize(np.ones((64, 64)), Settings(provider="classical", router="geometric"))
    drawing = Drawing(blank.graph, blank.routing, strokes, (), (1000, 1000), blank.settings)

    def write() -> None:
        data = new_object("Many").data
        writing.write(data, 1, drawing, front_view(drawing.size), 1)

    return "write 10,000 strokes of 50 points", _milliseconds(write), 200


def reroute_among(strokes: int) -> Row:
    """One reroute in a drawing of many strokes: engine, Grease Pencil and stored state."""
    drawing, data, key = cut_up(strokes)
    junctions = iter(drawing.junctions)

    def reroute() -> None:
        junction = next(j for j in junctions if len(j.alternatives) > 2)
        pairs = next(a.pairs for a in junction.alternatives if a.pairs != junction.pairs)
        routing_change.change_routing(data, 1, key, lambda d: d.reroute(junction.index, pairs))

    reroute()
    return f"reroute one junction of {len(drawing.strokes)} strokes", _milliseconds(reroute), 30


def overlay_of(junctions: int) -> Row:
    """The rings of all junctions, made anew."""
    drawing = woven(int(np.ceil(np.sqrt(junctions))))
    place, scale = front_view(drawing.size), (colors.SURE, colors.DOUBTFUL, colors.LOCKED)
    _ = drawing.junctions  # found when the drawing was traced

    def rebuild() -> None:
        shape = overlay_geometry.rings(JunctionTable.of(drawing), 4.0, scale)
        place.to_object(shape.points)

    return f"overlay of {len(drawing.junctions)} junctions", _milliseconds(rebuild), 20


def look_up(junctions: int) -> Row:
    """What a redraw looks up when nothing changed."""
    drawing = woven(int(np.ceil(np.sqrt(junctions))))
    data, _ = written(drawing, "still")

    def redraw() -> None:
        (found,) = state.keys_at(data, 1)
        state.load(data, found)

    redraw()
    return f"look-ups of a redraw, {len(drawing.junctions)} junctions", _milliseconds(redraw), 1


def colors_unchanged(strokes: int) -> Row:
    """What a redraw of strokes in colours looks at, to find that nothing changed."""
    drawing, data, _ = cut_up(strokes)
    state.load(data, state.keys_at(data, 1)[0])

    def redraw() -> None:
        stroke_overlay.content_of(data, 1)

    what = f"{len(drawing.strokes)} strokes in colors, a redraw without change"
    return what, _milliseconds(redraw), 5


def review_step(junctions: int) -> Row:
    """Decide a junction, ask again around it, and find the next: what a key of a review does."""
    drawing = woven(int(np.ceil(np.sqrt(junctions))))
    data, key = written(drawing, "woven")
    trace = state.load(data, key)
    listed = iter(np.argsort(-trace.drawing.costs).tolist())

    def step() -> None:
        nonlocal key
        index = next(listed)
        here = state.load(data, key).drawing
        pairs = here.place(index).alternatives[1].pairs
        after = routing_change.change_routing(
            data, 1, key, lambda d: d.reroute(index, pairs).ask_around(d)
        )
        key = after.key
        halves = state.halves_at(data, 1, key)
        JunctionTable.of(after.drawing, halves).listed("COST", doubtful=True, unlocked=True)

    step()
    return f"a step of a review among {len(drawing.junctions)} junctions", _milliseconds(step), 50


def smoothing_changed(strokes: int) -> Row:
    """Another *Smoothing*: strokes made anew, decisions and changes carried, all written."""
    drawing, data, key = cut_up(strokes)
    values = iter(np.linspace(0.31, 0.9, _RUNS + 1))

    def change() -> None:
        nonlocal key
        settings = replace(drawing.settings, smoothing=float(next(values)))
        key = retrace(data, 1, key, drawing.restroked(settings)).key

    change()
    return f"smoothing of {len(drawing.strokes)} strokes changed", _milliseconds(change), 300


def part_tried(side: int, *, anew: bool) -> Row:
    """A part of a scan traced with other settings: anew, or from where *Specks* acts on."""
    path = _ROOT / "examples" / "hippopotamus.jpg"
    height, width = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE).shape
    size = width, height
    left, top = size[0] * 5 // 8, size[1] // 2
    page = Page("", size, front_view(size))
    part = Part(page, (left, top, left + side, top + side))
    source = Source("part", str(path))
    specks = iter(np.linspace(1.0 if anew else 1.05, 3.0, _RUNS + 1, endpoint=False))

    def trace() -> None:
        if anew:
            PARTS.stages.clear()
        job = PartJob(part, source, Settings(min_length=float(next(specks))))
        job.run()
        assert job.results[0].drawing is not None, job.results[0].problem

    trace()
    what = f"a part of {side} px, " + ("for the first time" if anew else "other Specks")
    return what, _milliseconds(trace), 1000


def cut_up(strokes: int) -> tuple[Drawing, bpy.types.ID, int]:
    """A woven page whose lines end at junctions until there are that many; its data and key."""
    drawing = woven(24)
    ends = iter(np.random.default_rng(0).permutation(len(drawing.junctions)).tolist())
    while len(drawing.strokes) < strokes:
        drawing = drawing.reroute(next(ends), ())
    return drawing, *written(drawing, "cut up")


def written(drawing: Drawing, name: str) -> tuple[bpy.types.ID, int]:
    """A new data-block with the drawing in it, and its key."""
    data, place = new_object(name).data, front_view(drawing.size)
    key = state.add(data, drawing, place, name)
    writing.write(data, 1, drawing, place, key)
    return data, key


def redraw() -> list[Row]:
    """What the overlay adds to an idle redraw of a real scan, without OpenGL: see `redraw.py`."""
    blender = shutil.which("blender")
    if blender is None or not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        return []
    with TemporaryDirectory() as temporary:
        archive = package.build(package.host_platform(), Path(temporary))
        result = Path(temporary, "redraw.json")
        files = archive, _ROOT / "examples" / "hippopotamus.jpg", result
        script = ["-P", _ROOT / "benchmarks" / "redraw.py", "--", *files]
        subprocess.run(
            [blender, "--factory-startup", *map(str, script)], check=True, capture_output=True
        )
        states = json.loads(result.read_text("utf-8"))
    return [
        (f"idle redraw, {state}", states[state]["handlers again"], 1)
        for state in ("no junction", "a junction", "its cards")
    ]


def woven(lines: int) -> Drawing:
    """A page of wavy lines both ways, traced: about lines * lines crossings."""
    side = 30 * (lines + 1)
    paper = np.full((side, side), 255, np.uint8)
    t = np.arange(side)
    for k in range(1, lines + 1):
        wave = 30 * k + 4 * np.sin(t / 40 + k)
        for curve in (np.stack([t, wave], 1), np.stack([wave, t], 1)):
            points = np.round(curve * 16).astype(np.int32).reshape(-1, 1, 2)
            cv2.polylines(paper, [points], False, 0, 3, cv2.LINE_AA, 4)
    return vectorize(paper, Settings(provider="classical", router="geometric"))


def _milliseconds(work: Callable[[], None]) -> float:
    times = []
    for _ in range(_RUNS):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    return 1e3 * float(np.median(times))


if __name__ == "__main__":
    main()
