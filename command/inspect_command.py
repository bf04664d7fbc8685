"""`involute inspect`: what is in a drawing, and what would be traced in a scan."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..engine import runtimes
from ..engine.errors import InvoluteError
from ..engine.formats import format_of, load
from ..engine.settings import Settings
from ..engine.values import Bundle, Junction

if TYPE_CHECKING:
    from ..engine.drawing import Drawing
    from ..engine.values import Stroke


def about(path: Path) -> Iterator[str]:
    """Lines for people about a drawing or an image.

    Raises:
        InvoluteError: it can't be read.
    """
    kind = format_of(path)
    if kind and kind.read:
        return _about_drawing(load(path))
    return _about_scan(path)


def _about_drawing(drawing: Drawing) -> Iterator[str]:
    import numpy as np

    widths = np.concatenate([s.widths for s in drawing.strokes] or [np.zeros(1)])
    low, middle, high = np.percentile(widths, (5, 50, 95))
    by_ink: dict[tuple[int, int, int], list[Stroke]] = {}
    for stroke in drawing.strokes:
        by_ink.setdefault(stroke.color, []).append(stroke)
    yield f"size       {drawing.size[0]} x {drawing.size[1]} px"
    yield f"strokes    {len(drawing.strokes)}, {sum(s.closed for s in drawing.strokes)} closed"
    yield f"points     {sum(len(s.points) for s in drawing.strokes)}"
    yield f"widths     {middle:.1f} px (5 % under {low:.1f}, 5 % over {high:.1f})"
    yield f"inks       {len(by_ink)}"
    for color, strokes in sorted(by_ink.items(), key=lambda item: -len(item[1])):
        pen = float(np.median(np.concatenate([stroke.widths for stroke in strokes])))
        yield f"           #{bytes(color).hex()}  pen {pen:.1f} px, {len(strokes)} strokes"
    yield f"fills      {len(drawing.fills)}"
    if drawing.fidelity:
        lost, invented = drawing.fidelity.lost, drawing.fidelity.invented
        yield f"fidelity   {lost:.2%} of the ink lost, {invented:.2%} of the strokes off the ink"
    for sentence in (*drawing.notes, *drawing.warnings):
        yield f"           {sentence}"
    yield f"branches   {drawing.graph.branch_count}"
    bundles = len(drawing.doubtful_bundles)
    yield f"junctions  {len(drawing.junctions)}, {len(drawing.doubtful) - bundles} doubtful"
    if drawing.bundles:
        yield f"bundles    {len(drawing.bundles)}, {bundles} doubtful"
    if not drawing.junctions and not drawing.bundles:
        return
    yield ""
    yield " junction        x        y  degree  doubt  joined (next best)"
    doubtful = set(drawing.doubtful)
    both: list[Junction | Bundle] = [*drawing.junctions, *drawing.bundles]
    order = [*drawing.doubtful, *(one.index for one in both if one.index not in doubtful)]
    for junction in map(drawing.asked, order):
        said = _pairs if isinstance(junction, Junction) else _lines
        x, y = junction.position
        others = [a for a in junction.alternatives if a.pairs != junction.pairs]
        second = f"({said(others[0].pairs)}: {others[0].probability:.0%})" if others else ""
        state = "lock " if junction.locked else f"{junction.doubt:5.0%}"
        yield (
            f"{junction.index:9d} {x:8.1f} {y:8.1f} {junction.degree:7d}  {state}  "
            f"{said(junction.pairs)} {second}"
        )


def _pairs(pairs: Sequence[tuple[int, int]]) -> str:
    return " ".join(f"{a}-{b}" for a, b in pairs) or "none"


def _lines(pairs: Sequence[tuple[int, int]]) -> str:
    return "one line" if pairs else "two lines"


def _about_scan(path: Path) -> Iterator[str]:
    from ..engine.scan import page_count, read_scan

    scan, count = read_scan(path, Settings()), page_count(path)
    yield f"size       {scan.size[0]} x {scan.size[1]} px" + (
        f", {count} pages" if count > 1 else ""
    )
    yield f"pen        {scan.pen_width * scan.scale:.1f} px wide"
    yield f"worked at  {scan.ink.shape[1]} x {scan.ink.shape[0]} px"
    yield f"ink        {float(scan.ink.mean()):.1%} of the page"
    yield f"color      {'no' if scan.color is None else 'yes'}"


def about_runtimes() -> Iterator[str]:
    """Lines for people about what runs the networks here, and how fast.

    Raises:
        InvoluteError: the weights are missing or damaged, or `runtimes.chosen`.
    """
    from ..engine import weights
    from ..engine.centerline import learned
    from ..engine.centerline.backends import INPUT

    if not learned.available():
        raise InvoluteError(
            "The weights of the centerline network are missing; reinstall Involute."
        )
    used, content = runtimes.chosen(), weights.read(learned.WEIGHTS)
    for runtime in runtimes.here():
        cpu, wall = runtimes.seconds(runtime, content, INPUT)
        yield (
            f"{runtime.label:13} {runtime.version:11} {cpu:5.2f} processor seconds a megapixel, "
            f"{wall:5.2f} s" + (", used" if runtime is used else "")
        )
    if len(runtimes.here()) == 1:
        yield "With ONNX Runtime (pip install onnxruntime) it would take less than half."
