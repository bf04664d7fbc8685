"""Artwork in SVG becomes strokes: shapes, curves, transforms, and what fills hide."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("shapely")

from involute.synthesis.artwork import flatten, read_svg
from involute.synthesis.rebuild import drawing


def svg(body: str) -> str:
    return f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">{body}</svg>'


def test_commands_absolute_relative_and_packed():
    (absolute,) = flatten("M10 10L20 10H30V20C30 25 25 30 20 30S10 25 10 20Z", 0.01)
    (relative,) = flatten("m10,10 10,0h10v10c0,5-5,10-10,10s-10-5-10-10z", 0.01)
    np.testing.assert_allclose(absolute, relative, atol=1e-9)
    np.testing.assert_allclose(absolute[0], absolute[-1])


def test_arc_flags_need_no_space():
    (packed,) = flatten("M0 5a5 5 0 0110 0", 0.001)
    (spaced,) = flatten("M0 5 A 5 5 0 0 1 10 5", 0.001)
    np.testing.assert_allclose(packed, spaced)
    np.testing.assert_allclose(np.hypot(packed[:, 0] - 5, packed[:, 1] - 5), 5, atol=1e-6)
    assert packed[len(packed) // 2, 1] < 5  # sweep 1 turns clockwise, with y down: over the top


@pytest.mark.parametrize("tolerance", [0.5, 0.05])
def test_curves_stay_within_the_tolerance(tolerance):
    (points,) = flatten("M0 0C0 40 60 40 60 0", tolerance)
    t = np.linspace(0, 1, 2000)[:, None]
    true = 3 * (1 - t) ** 2 * t * (0, 40) + 3 * (1 - t) * t**2 * (60, 40) + t**3 * (60, 0)
    a, d = points[:-1], np.diff(points, axis=0)
    along = ((true[:, None] - a) * d).sum(-1) / (d**2).sum(-1)
    nearest = a + np.clip(along, 0, 1)[..., None] * d
    assert np.hypot(*np.moveaxis(true[:, None] - nearest, -1, 0)).min(1).max() <= tolerance


def test_transforms_and_styles_pass_down():
    body = """<g transform="translate(10 20) scale(2)" style="stroke:red;stroke-width:3">
        <line x1="1" y1="1" x2="5" y2="1" fill="none"/></g><text>no</text>"""
    (shape,) = read_svg(svg(body), 0.1)
    assert shape.width == pytest.approx(6)
    assert shape.fill is None
    np.testing.assert_allclose(shape.subpaths[0], [(12, 22), (20, 22)])


def test_a_later_fill_hides_a_stroke():
    lines = '<path d="M0 50H100M0 0V100" stroke="black" fill="none"/>'
    cover = '<rect x="40" y="30" width="20" height="40" fill="white"/>'
    assert len(drawing(svg(lines))) == 2
    assert len(drawing(svg(lines + cover))) == 3
    assert len(drawing(svg(cover + lines))) == 2


def test_nothing_stroked_is_no_drawing():
    assert drawing(svg('<rect width="5" height="5"/>')) == []
