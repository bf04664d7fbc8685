"""Results as pictures: SVG written by hand, so that no plotting library is needed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from math import isfinite, log10
from re import compile as pattern

from .run_record import Record

_COLORS = ("#2a6fdb", "#e07b2a", "#3a9a5b", "#b0408f", "#7a6a55", "#c03a3a", "#4aa6b5", "#888888")
_SIZED = pattern(r"^(.*?),? *(\d+) px$")  # rows of a run over page sizes: "dense, thin, 1024 px"
_PANEL = 240, 190  # px of one panel
_COLUMNS = 4


def chart(record: Record) -> str:
    """A panel for every column of the figures: lines over the page's size where its rows have
    one, else bars."""
    columns = list(dict.fromkeys(name for row in record.figures.values() for name in row))
    panels = []
    for number, column in enumerate(columns):
        values = {row: v[column] for row, v in record.figures.items() if column in v}
        x, y = number % _COLUMNS * _PANEL[0], 40 + number // _COLUMNS * _PANEL[1]
        panel = _lines if all(_SIZED.match(row) for row in values) else _bars
        drawn = [_text(8, 16, column, "bold"), *panel(values)]
        panels.append(f'<g transform="translate({x} {y})">' + "".join(drawn) + "</g>")
    width = min(len(columns), _COLUMNS) * _PANEL[0]
    height = 40 + -(-len(columns) // _COLUMNS) * _PANEL[1]
    about = f"{record.run}, {record.commit}, {record.when}, weights {record.weights}"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
        f'font-family="sans-serif" font-size="10"><rect width="100%" height="100%" fill="white"/>\n'
        + "\n".join([_text(8, 22, about), *panels])
        + "\n</svg>\n"
    )


def _bars(values: Mapping[str, float]) -> list[str]:
    """A bar a row, the row's name on it."""
    most = max((v for v in values.values() if isfinite(v)), default=0) or 1
    step = min(22, (_PANEL[1] - 34) / max(1, len(values)))
    parts = []
    for number, (row, value) in enumerate(values.items()):
        top = 26 + number * step
        wide = max(0, 150 * value / most) if isfinite(value) else 150
        color = _COLORS[number % len(_COLORS)]
        parts.append(
            f'<rect x="8" y="{top:.1f}" width="{wide:.1f}" height="{0.8 * step:.1f}" '
            f'fill="{color}" fill-opacity=".45"/>'
        )
        parts.append(_text(11, top + 0.6 * step, f"{row}: {value:g}"))
    return parts


def _lines(values: Mapping[str, float]) -> list[str]:
    """A line a kind of page over the page's side, both axes logarithmic."""
    curves: dict[str, list[tuple[float, float]]] = {}
    for row, value in values.items():
        kind, _, side = row.removesuffix(" px").rpartition(", ")
        if value > 0 and isfinite(value):
            curves.setdefault(kind, []).append((log10(float(side)), log10(value)))
    points = [point for curve in curves.values() for point in curve]
    if not points:
        return []
    (left, right), (low, high) = (_span([p[k] for p in points]) for k in (0, 1))

    def at(x: float, y: float) -> str:
        across = 34 + 120 * (x - left) / (right - left)
        return f"{across:.1f},{160 - 130 * (y - low) / (high - low):.1f}"

    parts = [
        _text(2, 160, f"{10**low:.3g}"), _text(2, 36, f"{10**high:.3g}"),
        _text(30, 174, f"{10**left:.0f} px"), _text(130, 174, f"{10**right:.0f} px"),
        '<path d="M34 30V160H160" fill="none" stroke="#999"/>',
    ]  # fmt: skip
    for number, (kind, curve) in enumerate(curves.items()):
        color = _COLORS[number % len(_COLORS)]
        path = " ".join(at(*point) for point in sorted(curve))
        parts.append(f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="1.5"/>')
        parts.append(_text(164, 36 + 11 * number, kind, color=color, size=8))
    return parts


def _span(values: Sequence[float]) -> tuple[float, float]:
    """From least to most; never empty."""
    low, high = min(values), max(values)
    return (low, high) if high > low else (low - 0.5, high + 0.5)


def _text(
    x: float, y: float, text: str, weight: str = "normal", color: str = "#222", size: int = 10
) -> str:
    return (
        f'<text x="{x:.1f}" y="{y:.1f}" font-weight="{weight}" font-size="{size}" '
        f'fill="{color}">{escape(text)}</text>'
    )
