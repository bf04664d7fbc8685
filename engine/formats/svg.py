"""Drawings as SVG: one path per stroke in input pixels, areas and regions as filled paths below.

The strokes of an ink are a layer for Inkscape, and a group for everyone else. Reading back an SVG
of ours gives the same strokes to 1/1000 px; the widths and opacities along a stroke, which plain
SVG can't say, travel in data attributes. Only JSON keeps the junctions.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from ..drawing import Drawing
from ..errors import InvoluteError
from ..routing import with_corners
from ..settings import Settings
from ..soundness import UnsoundError, check_drawing
from ..strokes.small_parts import layers_of
from ..values import Array, PlanarGraph, Routing, Stroke
from .areas import REGIONS, SOLIDS, Area, area_layers
from .flatten import around, controls, outline, widths_along
from .whole_file import write_text

INKSCAPE = "http://www.inkscape.org/namespaces/inkscape"
_KINDS = {SOLIDS: "fill", REGIONS: "region"}  # how files have always called these areas
_NO_LINES = {"data-fill", "data-region", "data-outline", "data-pencil"}
# The transform makes simple readers look at the layer closely enough to see that it is hidden.
_HIDDEN = (
    ' id="pencil" display="none" transform="translate(0 0)" opacity="0.4" '
    'fill="none" stroke-linecap="round" stroke-linejoin="round"'
)
_FARTHEST = 1e7  # px from the page's corner
_COMMAND = re.compile(r"([MLCZ])([^MLCZ]*)")


def write(drawing: Drawing, path: Path) -> None:
    """Write a drawing to an SVG file."""
    write_text(dumps(drawing), path)


def dumps(drawing: Drawing) -> str:
    """The drawing as the text of an SVG file."""
    lines = [*opening(drawing), *below(drawing)]
    lines.append('<g id="strokes" fill="none" stroke-linecap="round" stroke-linejoin="round">')
    lines += center_lines(drawing)
    return "\n".join([*lines, "</g>", "</svg>", ""])


def opening(drawing: Drawing, unit: str = "", scale: float = 1.0) -> list[str]:
    """The first tag.

    Args:
        unit: that all numbers are in, "" = pixels of the input, and
        scale: how many of it make such a pixel.
    """
    width, height = (f"{side * scale:.10g}" for side in drawing.size)
    return [
        f'<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="{INKSCAPE}" '
        f'viewBox="0 0 {width} {height}" width="{width}{unit}" height="{height}{unit}">'
    ]


def below(drawing: Drawing) -> list[str]:
    """What lies below the strokes: the coloured regions between them, and the solid areas."""
    lines = []
    for name, areas in area_layers(drawing).items():
        lines += _areas(name, areas)
    if drawing.pencil:
        lines.append(layer("Pencil", _HIDDEN))
        lines += [_path(i, stroke, "pencil") for i, stroke in enumerate(drawing.pencil.strokes)]
        lines.append("</g>")
    return lines


def layer(name: str, attributes: str = "") -> str:
    """The tag that begins a layer of Inkscape."""
    return f'<g inkscape:groupmode="layer" inkscape:label="{name}"{attributes}>'


def center_lines(drawing: Drawing) -> list[str]:
    """A layer per ink with the paths of its strokes."""
    strokes, said_by = drawing.strokes, drawing.pencil_of
    lines = []
    for ink in layers_of(drawing):
        lines.append(layer(ink.name))
        lines += [_path(number, strokes[number], said_by=said_by(number)) for number in ink.numbers]
        lines.append("</g>")
    return lines


def read(text: str, name: str = "The file") -> Drawing:
    """Read an SVG of ours; every stroke becomes a line of its own, without junctions.

    Args:
        text: the SVG.
        name: what to call it in an error.

    Raises:
        InvoluteError: not an SVG, or one with other path commands than absolute M, L, C and Z.
    """
    try:
        if "<!ENTITY" in text:  # they can blow up a small file
            raise UnsoundError("it declares entities")
        root = ElementTree.fromstring(text)
        _, _, width, height = map(_number, root.get("viewBox", "").replace(",", " ").split())
        paths = list(root.iter("{http://www.w3.org/2000/svg}path"))
        fills = tuple(_rings(p.get("d", "")) for p in paths if "data-fill" in p.attrib)
        lines = [p for p in paths if not _NO_LINES & p.attrib.keys()]
        lines.sort(key=lambda p: _number(p.get("data-stroke", "0")))  # layers change the order
        strokes = tuple(_stroke(element.attrib, i) for i, element in enumerate(lines))
        size = (round(width), round(height))
        drawing = Drawing(*_unconnected(strokes), strokes, fills, size, Settings())
        check_drawing(drawing)
        return drawing
    except UnsoundError as error:
        raise _foreign(name, str(error)) from None
    except ElementTree.ParseError as error:
        raise _foreign(name, str(error)) from None
    except (ArithmeticError, ValueError):
        raise _foreign(name, "a path or a size in it can't be read") from None


def _foreign(name: str, why: str) -> InvoluteError:
    return InvoluteError(
        f"{name} isn't an SVG that Involute wrote ({why}); open its .json, or trace it, which "
        "joins the lines of any SVG anew."
    )


def _number(text: str) -> float:
    value = float(text)
    if not -_FARTHEST <= value <= _FARTHEST:
        raise UnsoundError("a number in it is out of range")
    return value


def _areas(name: str, areas: Sequence[Area]) -> list[str]:
    """A layer of filled paths; an area is the rings of its outline and its holes."""
    kind = _KINDS[name]
    paths = [
        f'<path data-{kind}="{i}" d="{rings(area)}" '
        f'fill="#{bytes(color).hex()}" fill-rule="evenodd"/>'
        for i, (area, color) in enumerate(areas)
    ]
    return [layer(name, f' id="{kind}s" stroke="none"'), *paths, "</g>"]


def rings(area: Sequence[Array]) -> str:
    """The path data of closed outlines, (N, 2) each."""
    return " ".join(polyline(ring) + " Z" for ring in area)


def _path(index: int, stroke: Stroke, kind: str = "stroke", said_by: Sequence[int] = ()) -> str:
    data = polyline(around(stroke)) if stroke.handles is None else _bezier(stroke)
    opacity, widths = stroke.opacity, stroke.widths
    parts = [
        f'<path data-{kind}="{index}" d="{data}" fill="none"',
        f'stroke="#{bytes(stroke.color).hex()}" stroke-width="{float(widths.mean()):.4g}"',
    ]
    if said_by:
        parts.append(f'data-said-by="{" ".join(map(str, said_by))}"')
    if stroke.closed:
        parts.append('data-closed="1"')
    if stroke.dash:
        mark, gap = stroke.dash
        drawn = max(mark - float(widths.mean()), 0.01)  # its round ends reach beyond it
        parts.append(f'stroke-dasharray="{drawn:.4g} {mark + gap - drawn:.4g}"')
        parts.append(f'data-dash="{_thousandths(np.array(stroke.dash))}"')
    if opacity.min() < 1:
        parts.append(f'stroke-opacity="{float(opacity.mean()):.3g}"')
        parts.append(f'data-opacity="{_thousandths(opacity)}"')
    return " ".join([*parts, f'data-widths="{_thousandths(widths)}"/>'])


def polyline(points: Array) -> str:
    """The path data of a line (N, 2)."""
    return _numbers("M%.10g,%.10g L" + "%.10g,%.10g " * (len(points) - 1), points)


def _bezier(stroke: Stroke) -> str:
    points = controls(stroke)
    return _numbers("M%.10g,%.10g C" + "%.10g,%.10g " * (len(points) - 1), points)


def _numbers(pattern: str, points: Array) -> str:
    # One format call for all numbers: a page has a million of them.
    return (pattern % tuple(np.round(points.astype(np.float64), 3).ravel().tolist())).rstrip()


def _thousandths(values: Array) -> str:
    numbers = np.round(values.astype(np.float64) * 1000).astype(np.int64)
    same = numbers[:1] if (numbers == numbers[0]).all() else numbers
    return " ".join(map(str, same.tolist()))


def _stroke(attributes: dict[str, str], index: int) -> Stroke:
    (points, handles), *more = _subpaths(attributes.get("d", ""))
    if more or len(points) < 2:
        raise UnsoundError(f"stroke {index} is not one line of two points or more")
    closed = "data-closed" in attributes
    if closed:
        if handles is not None:
            handles[0, 0] = handles[-1, 0]
            handles = handles[:-1]
        points = points[:-1]
    width = f"{_number(attributes.get('stroke-width', '1')) * 1000:.0f}"
    color = attributes.get("stroke", "#000000").lstrip("#")
    return Stroke(
        points=points,
        widths=_per_point(attributes.get("data-widths", width), len(points)),
        opacity=_per_point(attributes.get("data-opacity", "1000"), len(points)),
        closed=closed,
        color=tuple(bytes.fromhex(color if len(color) == 6 else "000000")),  # type: ignore[arg-type]
        branches=np.array([2 * index], np.int32),
        handles=handles,
        dash=_dash(attributes.get("data-dash")),
    )


def _dash(text: str | None) -> tuple[float, float] | None:
    if text is None:
        return None
    mark, gap = (_number(part) / 1000 for part in text.split())
    return mark, gap


def _floats(text: str) -> Array:
    values = np.array(text.split(), np.float64)
    if not (np.abs(values) <= _FARTHEST).all():
        raise UnsoundError("a number in it is out of range")
    return values.astype(np.float32)


def _per_point(text: str, count: int) -> Array:
    values = _floats(text) / 1000
    if len(values) not in (1, count):
        raise UnsoundError("widths or opacities are not as many as points")
    return np.ascontiguousarray(np.broadcast_to(values, count))


def _rings(data: str) -> tuple[Array, ...]:
    return tuple(points for points, _ in _subpaths(data))


def _subpaths(data: str) -> list[tuple[Array, Array | None]]:
    """The lines of a path's data: points and, when it has curves, Bezier handles."""
    if not data or _COMMAND.sub("", data).strip():
        raise UnsoundError("a path has other commands than M, L, C and Z")
    found: list[tuple[Array, Array | None]] = []
    runs: list[Array] = []

    def finish() -> None:
        if not runs:
            return
        points = np.concatenate([runs[0], *(run[:, 2] for run in runs[1:])])
        handles = np.stack([points, points], axis=1)
        low = len(runs[0]) - 1
        for run in runs[1:]:
            high = low + len(run)
            handles[low:high, 1], handles[low + 1 : high + 1, 0] = run[:, 0], run[:, 1]
            low = high
        curved = any(not np.array_equal(run[:, 1], run[:, 2]) for run in runs[1:])
        found.append((points, handles if curved else None))
        runs.clear()

    for command, text in _COMMAND.findall(data):
        values = _floats(text.replace(",", " "))
        if command != "Z" and (not values.size or (command != "M" and not runs)):
            raise UnsoundError("a path does not begin with a point")
        if command == "M":
            finish()
            runs.append(values.reshape(-1, 2))
        elif command == "L":
            ends = values.reshape(-1, 2)
            starts = np.concatenate(
                [(runs[-1][-1:] if len(runs) == 1 else runs[-1][-1:, 2]), ends[:-1]]
            )
            runs.append(np.stack([starts, ends, ends], axis=1))
        elif command == "C":
            runs.append(values.reshape(-1, 3, 2))
    finish()
    return found


def _unconnected(strokes: tuple[Stroke, ...]) -> tuple[PlanarGraph, Routing]:
    """A graph in which every stroke is one branch that meets no other."""
    lines = [outline(stroke) for stroke in strokes]
    if not lines:
        graph = PlanarGraph.empty()
    else:
        closed = np.array([stroke.closed for stroke in strokes])
        last = np.cumsum(np.where(closed, 1, 2)) - 1
        ends = np.stack([np.where(closed, last, last - 1), last], axis=1)
        graph = PlanarGraph(
            vertices=np.concatenate(
                [line[:1] if c else line[[0, -1]] for line, c in zip(lines, closed, strict=True)]
            ),
            points=np.concatenate(lines),
            offsets=np.concatenate([[0], np.cumsum([len(line) for line in lines])]).astype(
                np.int32
            ),
            ends=ends.astype(np.int32),
            widths=np.concatenate([widths_along(stroke) for stroke in strokes]),
        )
    partner = np.arange(2 * graph.branch_count, dtype=np.int32)
    loop = np.flatnonzero(graph.degrees[graph.half_vertex] == 2)
    partner[loop] = loop ^ 1
    no_pairs = np.zeros((0, 2), np.int32)
    routing = Routing(partner, no_pairs, np.zeros(0, np.float32), (), np.zeros(0, bool))
    return graph, with_corners(routing, graph)
