"""Log-odds that two half-branches are one line, from their geometry and ink alone.

A log-linear model: the score of a pair is a weighted sum of its features, and the probability of
an involution is proportional to exp(sum of the scores of its pairs). It needs no network and is
the baseline that the network has to beat. `training/routing/geometric_fit.py` made the weights.
"""

from __future__ import annotations

import numpy as np

from ..graph.topology import lengths
from ..ink.pencil import neutral, pencil
from ..values import Array, PlanarGraph
from .features import FEATURES, half_features, pair_features, tint_gap

WEIGHTS = {
    "join": 1.80,
    "join, three": -0.25,
    "join, many": -0.09,
    "turn of lines": -0.82,
    "turn of lines over 0.2": 0.78,
    "turn of lines over 0.6": 1.37,
    "turn of lines over 1.3": -0.87,
    "turn of lines, many": -2.25,
    "turn of lines over 0.6, many": 1.92,
    "turn of curves": -1.26,
    "turn of curves over 0.2": -0.25,
    "turn of curves over 0.6": 1.16,
    "turn of curves over 1.3": -0.20,
    "turn of curves, many": 1.71,
    "turn of curves over 0.6, many": -1.78,
    "turn of chords": -1.36,
    "turn of chords over 0.2": -0.02,
    "turn of chords over 0.6": -0.11,
    "turn of chords over 1.3": 1.18,
    "turn of chords, many": 1.35,
    "turn of chords over 0.6, many": -1.38,
    "misfit, middle": -0.79,
    "misfit, far": -0.06,
    "opposite": 0.21,
    "opposite, many": -0.97,
    "short": -1.55,
    "width": -1.50,
    "strength": -1.00,
    "tint": -6.00,
}
_SHORT = 3.0  # pen widths; about what a junction hides of a branch at both of its ends
_WEIGHTS = np.array([WEIGHTS[name] for name in FEATURES])


def score(graph: PlanarGraph, pairs: Array) -> Array:
    """(K,) float32 log-odds of joining each of the (K, 2) pairs against ending both."""
    return (pair_features(graph, pairs) @ _WEIGHTS).astype(np.float32)


def tint_score(graph: PlanarGraph, pairs: Array) -> Array:
    """(K,) float32 the share of the score that other inks take away; 0 on a grey page.

    For scorers that see no colour: a blue line does not go on as a black one.
    """
    if graph.colors is None:
        return np.zeros(len(pairs), np.float32)
    return (WEIGHTS["tint"] * tint_gap(half_features(graph), *pairs.T)).astype(np.float32)


def medium_score(graph: PlanarGraph, pairs: Array) -> Array:
    """(K,) float32 the share of the score that another medium takes away; 0 where there is one.

    Pencil under ink is another line, as a blue one beside a black one is. Short branches don't
    count: what crosses them decides how strong they look.
    """
    length = lengths(graph)
    faint, ratio = pencil(graph, neutral(graph), length)
    if ratio == 1.0 or graph.widths is None:
        return np.zeros(len(pairs), np.float32)
    sure = length > _SHORT * float(np.median(graph.widths))
    a, b = (pairs >> 1).T
    other = (faint[a] != faint[b]) & sure[a] & sure[b]
    return (WEIGHTS["tint"] * other).astype(np.float32)
