"""Frames of a sequence take over what has not changed, however many processes trace them."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
from involute.command.sequence_tracing import trace_sequence
from involute.engine import Settings
from involute.engine.centerline import learned
from involute.engine.drawing import Drawing
from involute.engine.sequence.frames import Frame

pytestmark = pytest.mark.skipif(not learned.available(), reason="needs the centerline network")


def _frames(folder: Path, count: int) -> list[Frame]:
    """A held wheel, and an arm that moves."""
    found = []
    for number in range(count):
        page = np.full((300, 300), 250, np.uint8)
        cv2.circle(page, (80, 80), 50, 20, 3, cv2.LINE_AA)
        cv2.line(page, (20, 130), (130, 20), 20, 3, cv2.LINE_AA)
        cv2.line(page, (220, 220), (280, 230 + 3 * number), 20, 3, cv2.LINE_AA)
        noise = np.random.default_rng(1).normal(0, 2, page.shape)
        path = folder / f"frame_{number:03d}.png"
        cv2.imwrite(str(path), np.clip(page + noise, 0, 255).astype(np.uint8))
        found.append(Frame(number, number, str(path), 0))
    return found


def test_the_number_of_processes_makes_no_difference(tmp_path: Path) -> None:
    frames = _frames(tmp_path, 14)
    alone, several = (list(trace_sequence(frames, Settings(), jobs=jobs)) for jobs in (1, 2))
    assert [number for number, _ in alone] == [number for number, _ in several]
    for (_, one), (_, other) in zip(alone, several, strict=True):
        assert isinstance(one, Drawing)
        assert isinstance(other, Drawing)
        assert len(one.strokes) == len(other.strokes)
        for ours, theirs in zip(one.strokes, other.strokes, strict=True):
            np.testing.assert_array_equal(ours.points, theirs.points)
            np.testing.assert_array_equal(ours.widths, theirs.widths)
