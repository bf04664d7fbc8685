"""How opaque and how wide the strokes come out."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from involute.engine import Settings, vectorize

FAST = {"provider": "classical", "router": "geometric"}


def page(grain=0.0):
    """Thin lines that cross, of ink, or of pencil with that much grain; (H, W) uint8."""
    ink = np.zeros((240, 320), np.uint8)
    for y in (60, 120, 180):
        cv2.line(ink, (20, y), (300, y + 20), 255, 3, cv2.LINE_AA)
    cv2.line(ink, (160, 20), (170, 220), 255, 3, cv2.LINE_AA)
    dark = ink / 255.0
    rough = np.random.default_rng(0).normal(0, 1, ink.shape)
    rough = cv2.GaussianBlur(rough, (0, 0), 1.2)
    dark *= np.clip(1 - grain * np.maximum(rough / rough.std() + 0.5, 0), 0.1, 1)
    return np.uint8(np.round(255 * (1 - 0.9 * dark)))


def opacities(picture, **changes):
    return [stroke.opacity for stroke in vectorize(picture, Settings(**FAST, **changes)).strokes]


def test_thin_ink_is_opaque_and_a_crossing_shows_no_dot():
    for values in opacities(page()):
        assert (values == 1).all()


def test_pencil_is_as_strong_as_it_was_drawn():
    drawn = np.concatenate(opacities(page(grain=0.3)))
    assert drawn.min() < 0.98
    assert np.median(drawn) > 0.5
    assert (np.concatenate(opacities(page(grain=0.3), opacity="solid")) == 1).all()


def test_a_stroke_has_one_opacity_unless_it_fades():
    for values in opacities(page(), opacity="drawn"):
        assert np.ptp(values) == 0
    # Half of a line is faint, beside others that are not.
    picture = page()
    picture[100:150, 180:] = 255 - (255 - picture[100:150, 180:]) // 3
    drawn = opacities(picture, opacity="drawn", inks=False)  # with inks, it is pencil
    fading = [values for values in drawn if np.ptp(values) > 0.2]
    assert len(fading) == 1


@pytest.mark.parametrize("scale", [0.5, 3.0])
def test_widths_can_be_scaled_and_the_check_takes_no_notice(scale):
    plain, scaled = (vectorize(page(), Settings(**FAST, width_scale=k)) for k in (1.0, scale))
    for one, other in zip(plain.strokes, scaled.strokes, strict=True):
        np.testing.assert_allclose(other.widths, scale * one.widths, rtol=1e-5)
    assert scaled.fidelity.lost == pytest.approx(plain.fidelity.lost, abs=1e-3)


def test_a_stroke_can_have_one_width():
    drawing = vectorize(page(), Settings(**FAST, even_width=True))
    assert all(np.ptp(stroke.widths) < 1e-5 for stroke in drawing.strokes)
    changed = drawing.junctions[0]
    rerouted = drawing.reroute(changed.index, ())
    assert all(np.ptp(stroke.widths) < 1e-5 for stroke in rerouted.strokes)
