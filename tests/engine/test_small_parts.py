"""Lettering and fragments come to layers of their own."""

from __future__ import annotations

import cv2
import numpy as np
from involute.engine import Settings, vectorize
from involute.engine.formats import svg
from involute.engine.strokes.small_parts import layers_of, small_strokes

FAST = {"provider": "classical", "router": "geometric"}


def page() -> np.ndarray:
    """A drawn cross of long lines, and a small A of three lines beside it."""
    paper = np.full((300, 400), 255, np.uint8)
    for a, b in (((30, 60), (370, 260)), ((40, 270), (360, 40))):
        cv2.line(paper, a, b, 0, 3, cv2.LINE_AA)
    for a, b in (((60, 150), (72, 116)), ((72, 116), (84, 150)), ((66, 138), (79, 138))):
        cv2.line(paper, a, b, 0, 3, cv2.LINE_AA)
    return paper


def test_small_parts_come_to_layers_of_their_own():
    whole = vectorize(page(), Settings(**FAST))
    assert [layer.name for layer in layers_of(whole)] == ["Black"]
    drawing = vectorize(page(), Settings(**FAST, small_parts=20.0))
    assert len(drawing.strokes) == len(whole.strokes)
    drawn, small = layers_of(drawing)
    assert (drawn.name, small.name) == ("Black", "Small Black")
    assert len(drawn.numbers) == 2
    places = np.concatenate([drawing.strokes[n].points for n in small.numbers])
    assert places.min() > 55
    assert places.max() < 155
    assert set(np.flatnonzero(small_strokes(drawing)).tolist()) == set(small.numbers)
    assert 'label="Small Black"' in svg.dumps(drawing)


def test_what_a_routing_changes_does_not_change_what_is_small():
    """A cut line is two strokes of one part; only what hangs on nothing else is small."""
    drawing = vectorize(page(), Settings(**FAST, small_parts=20.0))
    cross = max(drawing.junctions, key=lambda j: j.degree)
    cut = drawing.reroute(cross.index, ())
    assert len(cut.strokes) > len(drawing.strokes)
    assert len(layers_of(cut)[0].numbers) == 4
