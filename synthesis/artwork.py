"""Strokes and fills of artwork in SVG, in painting order, curves flattened.

Reads what icon sets and clip art use: groups, transforms, presentation attributes and styles,
paths with all commands, basic shapes, <use>. No text, no CSS selectors, no clipping.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np

Array = np.ndarray

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")
_TRANSFORM = re.compile(r"(\w+)\s*\(([^)]*)\)")
_COMMAND = re.compile(r"([MmLlHhVvCcSsQqTtAaZz])([^MmLlHhVvCcSsQqTtAaZz]*)")
_FLAGS = re.compile(r"\s*,?\s*([01])")
_INHERITED = ("fill", "stroke", "stroke-width", "visibility", "fill-opacity", "stroke-opacity")
_SKIPPED = {"defs", "clipPath", "mask", "symbol", "pattern", "marker", "metadata", "text", "filter"}


@dataclass(frozen=True)
class Shape:
    """One painted shape: its subpaths (N, 2) in user units, and how it is painted.

    width: of the stroke, user units; 0 = not stroked. fill: its colour, or None.
    """

    subpaths: list[Array]
    width: float
    fill: str | None


def read_svg(text: str, tolerance: float) -> list[Shape]:
    """All shapes of a document in painting order; curves stray at most tolerance (user units).

    Raises:
        ElementTree.ParseError, ValueError: not SVG, or a path that makes no sense.
    """
    root = ElementTree.fromstring(text)
    by_id = {name: e for e in root.iter() if (name := e.get("id"))}
    style = {"fill": "black", "stroke": "none", "stroke-width": "1"}
    return list(_walk(root, np.eye(3), style, by_id, tolerance))


def _walk(
    element: ElementTree.Element,
    matrix: Array,
    style: dict[str, str],
    by_id: dict[str, ElementTree.Element],
    tolerance: float,
    depth: int = 0,
) -> Iterator[Shape]:
    tag = element.tag.rpartition("}")[2] if isinstance(element.tag, str) else ""
    if tag in _SKIPPED or depth > 30:
        return
    own = dict(element.attrib)
    for part in own.get("style", "").split(";"):
        name, _, value = part.partition(":")
        own[name.strip()] = value.strip()
    if own.get("display") == "none" or _number(own.get("opacity", "1")) < 0.05:
        return
    style = style | {k: own[k] for k in _INHERITED if k in own and own[k] != "inherit"}
    matrix = matrix @ _matrix(own.get("transform", ""))
    if tag == "use":
        target = by_id.get((own.get("href") or _xlink(element)).lstrip("#"))
        if target is not None:
            shift = np.eye(3)
            shift[:2, 2] = _number(own.get("x", "0")), _number(own.get("y", "0"))
            yield from _walk(target, matrix @ shift, style, by_id, tolerance, depth + 1)
        return
    scale = float(np.sqrt(abs(np.linalg.det(matrix[:2, :2]))))
    data = _path_of(tag, own)
    if data and scale > 0:
        subpaths = [
            (p @ matrix[:2, :2].T + matrix[:2, 2]).astype(np.float64)
            for p in flatten(data, tolerance / scale)
        ]
        if style.get("visibility") != "hidden" and subpaths:
            stroked = _painted(style["stroke"], style.get("stroke-opacity"))
            filled = _painted(style["fill"], style.get("fill-opacity"))
            width = _number(style["stroke-width"]) * scale if stroked else 0.0
            if stroked or filled:
                yield Shape(subpaths, width, style["fill"] if filled else None)
    for child in element:
        yield from _walk(child, matrix, style, by_id, tolerance, depth + 1)


def _xlink(element: ElementTree.Element) -> str:
    return element.get("{http://www.w3.org/1999/xlink}href", "")


def _painted(paint: str, opacity: str | None) -> bool:
    return paint not in ("none", "transparent", "") and _number(opacity or "1") > 0.3


def _number(text: str) -> float:
    found = _NUMBER.search(text)
    return float(found.group()) if found else 0.0


def _numbers(text: str) -> list[float]:
    return [float(n) for n in _NUMBER.findall(text)]


def _matrix(text: str) -> Array:
    """The product of a transform list as a 3x3 matrix."""
    total = np.eye(3)
    for name, arguments in _TRANSFORM.findall(text):
        v = _numbers(arguments)
        m = np.eye(3)
        if name == "matrix" and len(v) == 6:
            m[:2] = np.array(v).reshape(3, 2).T
        elif name == "translate" and v:
            m[:2, 2] = v[0], v[1] if len(v) > 1 else 0
        elif name == "scale" and v:
            m[0, 0], m[1, 1] = v[0], v[-1]
        elif name == "rotate" and v:
            c, s = np.cos(np.deg2rad(v[0])), np.sin(np.deg2rad(v[0]))
            m[:2, :2] = [[c, -s], [s, c]]
            if len(v) == 3:
                center = np.array(v[1:])
                m[:2, 2] = center - m[:2, :2] @ center
        elif name in ("skewX", "skewY") and v:
            m[(0, 1) if name == "skewX" else (1, 0)] = np.tan(np.deg2rad(v[0]))
        total = total @ m
    return total


def _path_of(tag: str, a: dict[str, str]) -> str:
    """The path data that draws a basic shape."""

    def n(name: str) -> float:
        return _number(a.get(name, "0"))

    if tag == "path":
        return a.get("d", "")
    if tag == "line":
        return f"M{n('x1')} {n('y1')}L{n('x2')} {n('y2')}"
    if tag in ("polyline", "polygon"):
        return f"M{a.get('points', '')}" + ("Z" if tag == "polygon" else "")
    if tag in ("circle", "ellipse"):
        rx, ry = (n("r"), n("r")) if tag == "circle" else (n("rx"), n("ry"))
        x, y = n("cx"), n("cy")
        arc = f"A{rx} {ry} 0 1 1"
        return f"M{x - rx} {y}{arc} {x + rx} {y}{arc} {x - rx} {y}Z" if rx and ry else ""
    if tag == "rect":
        x, y, w, h = n("x"), n("y"), n("width"), n("height")
        rx = min(n("rx") or n("ry"), w / 2)
        ry = min(n("ry") or n("rx"), h / 2)
        if not (rx and ry):
            return f"M{x} {y}H{x + w}V{y + h}H{x}Z"
        arc = f"A{rx} {ry} 0 0 1"
        return (
            f"M{x + rx} {y}H{x + w - rx}{arc} {x + w} {y + ry}V{y + h - ry}"
            f"{arc} {x + w - rx} {y + h}H{x + rx}{arc} {x} {y + h - ry}V{y + ry}{arc} {x + rx} {y}Z"
        )
    return ""


def _arguments(command: str, text: str) -> Array:
    """The numbers of a path command, one row per repetition; arc flags need no separators."""
    size = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7}[command]
    if command != "A":
        values = _numbers(text)
    else:
        values, at = [], 0
        while found := (_FLAGS if len(values) % 7 in (3, 4) else _NUMBER).search(text, at):
            values.append(float(found.group(1) if len(values) % 7 in (3, 4) else found.group()))
            at = found.end()
    count = len(values) // size
    return np.array(values[: count * size]).reshape(count, size)


def flatten(data: str, tolerance: float) -> list[Array]:
    """The subpaths of path data as (N, 2) polylines; closed ones repeat their first point."""
    done: list[Array] = []
    pieces: list[Array] = []
    at = start = np.zeros(2)
    handle: Array | None = None  # last control point, for S and T
    before = ""

    def finish() -> None:
        if pieces:
            done.append(np.concatenate(pieces))
        pieces.clear()

    for letter, text in _COMMAND.findall(data):
        command, relative = letter.upper(), letter.islower()
        if command == "Z":
            if pieces and np.abs(start - at).max() > 1e-9:
                pieces.append(start[None])
            finish()
            at, before = start, "Z"
            continue
        for k, row in enumerate(_arguments(command, text)):
            base = at if relative else np.zeros(2)
            if command == "M" and k == 0:
                finish()
                at = start = base + row
                pieces.append(at[None])
                before = "M"
                continue
            if not pieces:
                start = at
                pieces.append(at[None])
            if command == "H":
                end = np.array([row[0] + base[0], at[1]])
            elif command == "V":
                end = np.array([at[0], row[0] + base[1]])
            else:
                end = row[-2:] + base
            if command in "CSQT":
                inner = (row[:-2].reshape(-1, 2) + base) if len(row) > 2 else np.zeros((0, 2))
                if command in "ST":
                    kin = "CS" if command == "S" else "QT"
                    mirrored = 2 * at - handle if before in kin and handle is not None else at
                    inner = np.vstack([mirrored[None], inner])
                handle = inner[-1]
                pieces.append(_curve(np.vstack([at[None], inner, end[None]]), tolerance))
            elif command == "A":
                pieces.append(_arc(at, row, end, tolerance))
            else:
                pieces.append(end[None])
            at, before = end, command
    finish()
    return [p for p in done if len(p) > 1]


def _curve(control: Array, tolerance: float) -> Array:
    """A quadratic or cubic Bezier without its first point."""
    degree = len(control) - 1
    bend = np.abs(np.diff(control, 2, axis=0)).max()
    count = int(np.clip(np.ceil(np.sqrt(degree * (degree - 1) / 8 * bend / tolerance)), 1, 200))
    t = np.linspace(0, 1, count + 1)[1:, None]
    points = control[None]
    for _ in range(degree):  # de Casteljau
        points = points[:, :-1] * (1 - t[:, None]) + points[:, 1:] * t[:, None]
    return points[:, 0]


def _arc(start: Array, row: Array, end: Array, tolerance: float) -> Array:
    """An elliptical arc without its first point (SVG 2, appendix B.2.4)."""
    rx, ry, turn, large, sweep = np.abs(row[0]), np.abs(row[1]), np.deg2rad(row[2]), *row[3:5]
    if rx < 1e-12 or ry < 1e-12 or np.allclose(start, end):
        return end[None]
    rotate = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    x, y = rotate @ (start - end) / 2
    grow = np.sqrt(max(1.0, (x / rx) ** 2 + (y / ry) ** 2))
    rx, ry = rx * grow, ry * grow
    down = (rx * y) ** 2 + (ry * x) ** 2
    factor = np.sqrt(max(0.0, (rx * ry) ** 2 / down - 1)) * (-1 if large == sweep else 1)
    local = factor * np.array([rx * y / ry, -ry * x / rx])
    center = rotate.T @ local + (start + end) / 2
    first = np.arctan2((y - local[1]) / ry, (x - local[0]) / rx)
    last = np.arctan2((-y - local[1]) / ry, (-x - local[0]) / rx)
    if sweep and last < first:
        last += 2 * np.pi
    elif not sweep and last > first:
        last -= 2 * np.pi
    step = 2 * np.arccos(max(0.5, 1 - tolerance / max(rx, ry)))
    count = max(2, int(np.ceil(abs(last - first) / step)))
    t = np.linspace(first, last, count + 1)[1:]
    points = np.stack([rx * np.cos(t), ry * np.sin(t)], 1) @ rotate + center
    points[-1] = end
    return points
