"""Values that fall into two clusters, and where they part."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..values import Array

_BROADER = 3.0  # times as wide as the other: a second pen
_MIDDLE = 0.25  # of the way from mean to mean: there a value is neither
_OWN, _BETWEEN = 0.1, 0.15  # of the lines: what each pen has at least; what is neither, at most


@dataclass(frozen=True)
class Split:
    """level: the largest value of the lower cluster; low, high: the mean of either;
    share: of all, what the smaller of them has; between: of all, what is neither clearly."""

    level: float
    low: float
    high: float
    share: float
    between: float


def best_split(values: Array, weight: Array) -> Split | None:
    """The split that leaves the least variance on both sides (Otsu 1979); None for one value.

    Args:
        values: (N,) and weight: (N,) how much each counts, > 0.
    """
    order = np.argsort(values, kind="stable")
    value, weight = values[order], weight[order]
    if len(value) < 2 or value[0] == value[-1]:
        return None
    below, mass = np.cumsum(weight), np.cumsum(weight * value)
    above = below[-1] - below[:-1]
    lower, upper = mass[:-1] / below[:-1], (mass[-1] - mass[:-1]) / above
    at = int((below[:-1] * above * (upper - lower) ** 2).argmax())
    low, high = float(lower[at]), float(upper[at])
    edge = (1 - _MIDDLE) / 2 * (high - low)
    between = weight[(value > low + edge) & (value < high - edge)].sum()
    return Split(
        level=float(value[at]),
        low=low,
        high=high,
        share=float(min(below[at], above[at]) / below[-1]),
        between=float(between / below[-1]),
    )


def finer_pen(widths: Array) -> Array:
    """The widths that are of the finer of two pens, all of them where there is one.

    Args:
        widths: (N,) px, > 0, of equal pieces of line.
    """
    if len(widths) < 2 or widths.max() < _BROADER * widths.min():
        return widths
    size = np.log(widths)
    split = best_split(size, np.ones(len(size)))
    if split is None or split.high - split.low <= np.log(_BROADER):
        return widths
    if split.share < _OWN or split.between > _BETWEEN:
        return widths
    return widths[size <= split.level]
