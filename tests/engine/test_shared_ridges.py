"""Lines that share a ridge are told apart by the picture, and stay where they were seen."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from involute.engine.graph.continuations import SAMPLES
from involute.engine.graph.courses import WINDOW, Courses
from involute.engine.graph.limits import LIMITS
from involute.engine.graph.shared_ridges import told_apart


def outward_of(curves: np.ndarray) -> Courses:
    """What lies beyond both ends of each curve, straight on."""
    ends = curves[:, [0, -1]].reshape(-1, 2)
    ways = np.stack([curves[:, 0] - curves[:, 1], curves[:, -1] - curves[:, -2]], 1).reshape(-1, 2)
    ways /= np.hypot(*ways.T)[:, None]
    points = ends[:, None] + np.arange(WINDOW)[:, None] * ways[:, None]
    none = np.zeros(len(ends))
    weights = np.ones((len(ends), WINDOW))
    return Courses(none.astype(np.int32), points, weights, none + 0.5, points.mean(1), ways, none)


@pytest.mark.parametrize("bow", [0.0, 3.0, 6.0])
def test_a_line_that_meets_another_at_its_end_stays_on_its_ink(bow: float) -> None:
    t = np.linspace(0, 1, SAMPLES)
    long = np.stack([30 + 50 * t, 60 + bow * 4 * t * (1 - t)], 1)
    short = np.stack([84 - 6 * t, 60 + 0.6 * t**2], 1)
    seen = np.zeros((120, 140), np.float32)
    for line in (long, short):
        points = np.round(line * 16).astype(np.int32)
        cv2.polylines(seen, [points], False, 1.0, 1, cv2.LINE_8, 4)
    seen = cv2.GaussianBlur(seen, (0, 0), 0.8)
    curves = np.stack([long, short])
    through = np.array([[0, 1], [2, 3]])
    found = told_apart(curves, np.zeros(2, int), through, outward_of(curves), seen)
    assert np.hypot(*np.moveaxis(found - curves, -1, 0)).max() < LIMITS.shared_farthest
