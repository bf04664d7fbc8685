"""Strokes followed from frame to frame: right pairs, steady order, steady direction."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from involute.engine.ink.known_inks import with_known_inks
from involute.engine.sequence.follow import follow, reverse
from involute.engine.sequence.stroke_matching import match_strokes
from involute.engine.values import Stroke

BLACK, BLUE = (0, 0, 0), (20, 60, 200)


def stroke(points, closed=False, color=BLACK):
    points = np.asarray(points, np.float32)
    ones = np.ones(len(points), np.float32)
    return Stroke(points, ones * 3, ones, closed, color, np.arange(2, dtype=np.int32) * 2)


def drawing(rng, count, size=800):
    """Random smooth strokes, every third closed."""
    strokes = []
    for k in range(count):
        t = np.linspace(0, 2 * np.pi, 40, endpoint=k % 3 != 0)
        middle, radius = rng.uniform(0, size, 2), rng.uniform(20, 150, 2)
        wobble = 1 + 0.3 * np.cos(t + 1) + rng.uniform(0.1, 0.3) * np.cos(2 * t + 2)
        shape = np.stack([np.cos(t * (1 if k % 3 == 0 else 0.4)), np.sin(t)], 1)
        points = middle + radius * shape * wobble[:, None]
        strokes.append(stroke(points, closed=k % 3 == 0))
    return strokes


def redrawn(rng, strokes, angle=0.0, shift=(0, 0), jitter=0.0):
    """The same strokes turned, moved, shaken; in a random order, direction and start."""
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    order = rng.permutation(len(strokes))
    out = []
    for k in order:
        s = strokes[k]
        points = (s.points - 400) @ turn + 400 + shift + rng.normal(0, jitter, 2)
        s = replace(s, points=points.astype(np.float32))
        if s.closed:
            s = replace(s, points=np.roll(s.points, rng.integers(len(points)), axis=0))
        out.append(reverse(s) if rng.random() < 0.5 else s)
    return out, order


@pytest.mark.parametrize(
    ("angle", "shift", "jitter"),
    [
        (0, (0, 0), 0),
        (0.05, (6, -4), 3),
        (0.25, (0, 0), 2),
        (0, (250, 120), 2),
        (-0.15, (80, 30), 4),
    ],
)
def test_strokes_are_followed_through_motion(angle, shift, jitter):
    rng = np.random.default_rng(5)
    old = drawing(rng, 45)
    new, order = redrawn(rng, old, angle, shift, jitter)
    matches = match_strokes(old, new)
    right = order[matches.new] == matches.old
    assert len(right) >= 43
    assert right.mean() > 0.97
    for before, after in zip(old, follow(old, new), strict=True):
        assert np.hypot(*(before.points.mean(0) - after.points.mean(0) + shift)) < 200
        assert before.closed == after.closed


@given(st.integers(0, 10_000), st.integers(1, 30))
@settings(max_examples=25, deadline=None)
def test_a_still_drawing_gets_its_order_direction_and_start_back(seed, count):
    rng = np.random.default_rng(seed)
    old = drawing(rng, count)
    new, _ = redrawn(rng, old)
    for before, after in zip(old, follow(old, new), strict=True):
        gap = np.hypot(*(before.points - after.points).T)
        assert gap.max() < 3  # nearly symmetric shapes fit more than one way


@given(st.integers(0, 10_000))
@settings(max_examples=15, deadline=None)
def test_every_stroke_is_kept_whatever_appears_or_goes(seed):
    rng = np.random.default_rng(seed)
    old = drawing(rng, int(rng.integers(0, 20)))
    new = drawing(rng, int(rng.integers(0, 20)))
    out = follow(old, new) if old and new else tuple(new)

    def shapes(strokes):
        return sorted(np.sort(s.points, axis=0).tobytes() for s in strokes)

    assert shapes(out) == shapes(new)


def test_a_vanished_stroke_leaves_its_number_to_a_newcomer():
    lines = [stroke([[0, y], [100, y], [200, y]]) for y in (0, 40, 80, 120)]
    newcomer = stroke([[400, 300], [420, 500]])
    out = follow(lines, [lines[3], newcomer, lines[0], lines[2]])
    assert [s is t for s, t in zip(out, [lines[0], newcomer, lines[2], lines[3]], strict=True)] == [
        True
    ] * 4


def test_an_ink_is_never_taken_for_another():
    black, blue = stroke([[0, 0], [90, 0]]), stroke([[0, 4], [90, 4]], color=BLUE)
    matches = match_strokes([black, blue], [replace(blue, points=black.points), black])
    assert list(zip(matches.old, matches.new, strict=True)) == [(0, 1), (1, 0)]


def test_parallel_lines_move_together_not_to_the_next_one():
    old = [stroke([[x, 0], [x, 200]]) for x in range(0, 200, 10)]
    new = [stroke([[x + 7, 3], [x + 7, 203]]) for x in range(0, 200, 10)]
    matches = match_strokes(old, new)
    assert (matches.old == matches.new).all()
    assert len(matches.old) == len(old)


def test_reversing_twice_changes_nothing():
    one = replace(stroke([[0, 0], [5, 1], [9, 4]]), handles=np.arange(12.0).reshape(3, 2, 2))
    twice = reverse(reverse(one))
    for name in ("points", "widths", "branches", "handles"):
        assert (getattr(twice, name) == getattr(one, name)).all()


@pytest.mark.parametrize(
    ("shade", "ink"),
    [
        ((1, 1, 57), (0, 0, 178)),
        ((30, 30, 34), (0, 0, 0)),
        ((160, 160, 160), None),
        ((150, 10, 10), (200, 20, 20)),
        ((20, 120, 30), None),
    ],
)
def test_a_shade_of_a_known_ink_is_that_ink(shade, ink):
    inks = [(0, 0, 0), (0, 0, 178), (200, 20, 20)]
    line = stroke([[0, 90], [90, 90]], color=shade)
    assert with_known_inks([line], inks)[0].color == (ink or shade)
    assert inks[3:] == ([] if ink else [shade])
