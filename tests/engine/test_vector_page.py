"""Drawings that are vectors already: their lines are cut where they meet, and routed anew."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from involute.engine import Drawing, InvoluteError, Settings, vectorize
from involute.engine.graph.from_lines import graph_of_lines
from involute.engine.soundness import check_drawing, check_graph
from shapely import LineString, MultiLineString

ILLUSTRATOR = """<?xml version="1.0" encoding="utf-8"?>
<svg xmlns="http://www.w3.org/2000/svg" width="200mm" height="100mm" viewBox="0 0 400 200">
<style type="text/css">.st0{fill:none;stroke:#102030;stroke-width:4;}
.st1{fill:none;stroke:#C02020;stroke-width:3;}</style>
<g transform="translate(10,10)">
<path class="st0" d="M0 90 L180 90"/><path class="st0" d="M180.5 90 h199.5"/>
<line class="st0" x1="180" y1="10" x2="180" y2="180"/>
<path class="st1" d="M20 20 C80 0 120 60 170 30 S300 20 370 150"/>
<circle class="st0" cx="300" cy="90" r="40"/>
<polyline class="st0" points="60,91 60,150 90,170"/></g>
<path d="M20,180 h20 v10 h-20 z" fill="black"/><rect width="400" height="200" fill="none"/></svg>"""
PX = 200 / 25.4 * 96 / 400  # of a page at 96 dpi, in a unit of the view box


def svg(tmp_path, body: str, head: str = 'viewBox="0 0 200 200"') -> Drawing:
    place = tmp_path / "other.svg"
    text = body if body.startswith("<?xml") else (
        f'<svg xmlns="http://www.w3.org/2000/svg" {head}><g fill="none" stroke="#000" '
        f'stroke-width="3">{body}</g></svg>'
    )  # fmt: skip
    place.write_text(text, "utf-8")
    return vectorize(place)


def test_an_illustrator_trace_is_cleaned_up(tmp_path):
    drawing = svg(tmp_path, ILLUSTRATOR)
    check_drawing(drawing)
    assert drawing.size == (756, 378)
    assert drawing.dpi == 96
    # Both halves of the level line are one stroke, straight through the upright one.
    level = max(
        (s for s in drawing.strokes if s.color == (16, 32, 48)),
        key=lambda s: np.ptp(s.points[:, 0]),
    )
    assert np.ptp(level.points[:, 0]) == pytest.approx(380 * PX, rel=0.01)
    assert len(drawing.strokes) == 5
    assert sum(s.closed for s in drawing.strokes) == 1
    for one in drawing.strokes:
        width = (3 if one.color == (192, 32, 32) else 4) * PX
        np.testing.assert_allclose(one.widths, width, rtol=0.05)
    degrees = sorted(j.degree for j in drawing.junctions)
    assert degrees == [3, *[4] * 7]
    crossing = min(
        drawing.junctions, key=lambda j: np.hypot(*np.subtract(j.position, (190 * PX, 100 * PX)))
    )
    assert crossing.position == pytest.approx((190 * PX, 100 * PX), abs=1)
    assert len(drawing.fills) == 1


def test_a_cleaned_drawing_can_be_rerouted_and_kept(tmp_path):
    drawing = svg(tmp_path, ILLUSTRATOR)
    other = drawing.junctions[0].alternatives[1]
    changed = drawing.reroute(0, other.pairs)
    changed.save(tmp_path / "page.json")
    assert len(Drawing.load(tmp_path / "page.json").strokes) == len(changed.strokes)


def test_pieces_that_meet_become_one_stroke(tmp_path):
    drawing = svg(tmp_path, "".join(f'<path d="M{x} 50 h20.6"/>' for x in range(20, 160, 20)))
    (one,) = drawing.strokes
    assert np.ptp(one.points[:, 0]) == pytest.approx(140.6, abs=1)


def test_ends_that_stop_short_or_reach_past_a_line_end_on_it(tmp_path):
    drawing = svg(
        tmp_path, '<path d="M20 50 h160"/><path d="M60 52 v80"/><path d="M120 48.5 v80"/>'
    )
    assert [j.degree for j in drawing.junctions] == [3, 3]
    assert len(drawing.strokes) == 3
    for junction, x in zip(
        sorted(drawing.junctions, key=lambda j: j.position), (60, 120), strict=True
    ):
        assert junction.position == pytest.approx((x, 50), abs=1.2)


def test_a_line_drawn_twice_is_one_stroke(tmp_path):
    drawing = svg(tmp_path, '<path d="M20 50 h160"/><path d="M180 50.2 h-160"/>')
    assert len(drawing.strokes) == 1


def test_a_line_that_crosses_itself_runs_through(tmp_path):
    drawing = svg(tmp_path, '<path d="M20 100 C220 0 220 200 20 60"/>')
    assert len(drawing.strokes) == len(drawing.junctions) == 1


def test_shapes_without_lines_are_traced_as_a_picture(tmp_path):
    text = (
        '<?xml version="1.0"?><svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 100">'
        '<path d="M20 48 h160 v4 h-160 z"/><path d="M98 20 h4 v60 h-4 z" fill="#000"/></svg>'
    )
    place = tmp_path / "outlines.svg"
    place.write_text(text)
    drawing = vectorize(place, Settings(provider="classical", router="geometric"))
    check_drawing(drawing)
    assert drawing.size == (200, 100)
    assert len(drawing.strokes) == 2
    for one in drawing.strokes:
        assert one.widths.mean() == pytest.approx(4, abs=0.6)
    assert drawing.junctions[0].position == pytest.approx((100, 50), abs=1)


def test_our_own_svg_can_be_routed_again(tmp_path):
    drawing = svg(tmp_path, ILLUSTRATOR)
    drawing.save(tmp_path / "ours.svg")
    again = vectorize(tmp_path / "ours.svg")
    assert len(again.strokes) == len(drawing.strokes)
    assert len(again.junctions) == len(drawing.junctions)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("<svg", "isn't an SVG that can be read"),
        ("no svg", "isn't an SVG that can be read"),
        ('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"/>', "no line in"),
        ('<!DOCTYPE s [<!ENTITY a "b">]><svg xmlns="http://www.w3.org/2000/svg"/>', "entities"),
    ],
)
def test_what_holds_no_lines_is_said(text, says, tmp_path):
    (tmp_path / "other.svg").write_text(text)
    with pytest.raises(InvoluteError, match=says):
        vectorize(tmp_path / "other.svg")


@settings(max_examples=50, deadline=None)
@given(
    st.lists(st.lists(st.tuples(*[st.integers(0, 60)] * 2), min_size=2, max_size=5), max_size=8),
    st.floats(0.2, 8),
)
@example([[(10, 1), (0, 5), (5, 54)]] * 2, 1.0)  # rounding made crossings all along both
def test_any_lines_make_a_sound_graph_that_covers_them(lines, width):
    lines = [np.array(line, np.float64) for line in lines]
    count = len(lines)
    graph = graph_of_lines(
        lines, np.full(count, width), np.ones(count), np.zeros((count, 3), np.uint8)
    )
    check_graph(graph)
    reach = 6 * max(width, 1)  # as far as what vanishes in the vertex of a sharp angle
    drawn = MultiLineString([line for line in lines if np.ptp(line, axis=0).any()])
    found = [LineString(graph.branch(b)) for b in range(graph.branch_count)]
    for piece in found:
        assert piece.difference(drawn.buffer(reach)).length < 1e-6
    if drawn.length > 4 * reach and found:
        assert drawn.difference(MultiLineString(found).buffer(reach)).length < 0.5 * drawn.length


def test_what_lacks_a_size_takes_that_of_its_lines(tmp_path):
    drawing = svg(tmp_path, '<path d="M20 50 h160"/>', head='width="0" height="0"')
    assert drawing.size == (180, 50)


def test_dpi_travels_with_the_drawing(tmp_path):
    drawing = replace(svg(tmp_path, '<path d="M20 50 h160"/>'), dpi=600.0)
    drawing.save(tmp_path / "page.json")
    assert Drawing.load(tmp_path / "page.json").dpi == 600.0
