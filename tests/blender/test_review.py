"""What a wrong answer costs, and the review that goes by it."""

from __future__ import annotations

import numpy as np
import pytest

from .example_drawings import cross, grid
from .test_grease_pencil import make
from .test_splicing import drawing_of


def test_lengths_are_those_from_a_half_branch_to_the_end_of_its_stroke(part):
    drawing = cross(part)  # two lines through one junction, and a circle
    beyond = part("engine.routing.cost").lengths_beyond(drawing.graph, drawing.strokes)
    (junction,) = drawing.junctions
    for a, b in junction.pairs:
        stroke = next(s for s in drawing.strokes if a in s.branches or b in s.branches)
        whole = np.linalg.norm(np.diff(stroke.points, axis=0), axis=1).sum()
        assert beyond[a] + beyond[b] == pytest.approx(whole, rel=0.02)
        assert beyond[a ^ 1] == pytest.approx(beyond[a] + beyond[b])  # from its loose end inward


def test_where_more_depends_on_it_costs_more(part):
    drawing = cross(part)
    (cost,) = drawing.costs
    junction = drawing.junctions[0]
    (other,) = [way.pairs for way in junction.alternatives if way.pairs != junction.pairs][:1]
    (ended,) = set(junction.pairs) - set(other)  # one line goes on, the other becomes two
    beyond = part("engine.routing.cost").lengths_beyond(drawing.graph, drawing.strokes)
    assert cost == pytest.approx(junction.doubt * min(beyond[list(ended)]))
    assert cost > 0
    assert drawing.lock(0).costs.tolist() == [0.0]


def test_a_review_asks_for_what_is_open(bpy, part):
    obj, _ = make(bpy, part, grid(part, 3))
    bpy.context.view_layer.objects.active = obj
    review = part("operators.junctions.review")
    view_state = part("operators.view.view_state")

    def left(passed=()):
        return review.open_doubts(view_state.shown_in(bpy.context), passed).tolist()

    table = view_state.shown_in(bpy.context).table
    assert sorted(left()) == np.flatnonzero(table.doubtful).tolist()
    costs = table.cost[left()]
    assert (np.diff(costs) <= 0).all()
    if left():
        first = left()[0]
        bpy.ops.involute.reroute(junction=first, alternative=0)
        assert first not in left()
        assert drawing_of(part, obj).junctions[first].locked
    assert left(passed=left()) == []
    with pytest.raises(RuntimeError, match="3D viewport"):
        bpy.ops.involute.review("EXEC_DEFAULT")


def test_strokes_that_meet_have_colors_of_their_own(part):
    lines = part("ui.overlay.stroke_lines")
    drawing = grid(part, 4)
    numbers = lines.color_numbers(drawing, 6)
    assert len(numbers) == len(drawing.strokes)
    vertex = drawing.graph.half_vertex
    for junction in drawing.junctions:
        met = [
            numbers[int(s.branches[0]) + 1]
            for s in drawing.strokes
            if np.isin(drawing.graph.ends[s.branches >> 1], vertex[junction.half_branches[0]]).any()
        ]
        assert len(set(met)) == len(met)


@pytest.mark.parametrize("curve", ["polyline", "bezier"])
def test_colored_lines_lie_on_the_strokes(bpy, part, curve):
    obj, _ = make(bpy, part, cross(part, curve=curve))
    gp, lines = part("operators.grease_pencil.cels"), part("ui.overlay.stroke_lines")
    key = part("operators.grease_pencil.state").keys_at(obj.data, 1)[0]
    drawing = drawing_of(part, obj)
    shapes = [gp.read_shapes(cel) for _, cel in gp.cels_at(obj.data, 1)]
    palette = part("ui.overlay.colors").STROKES
    made = lines.stroke_lines(shapes, key, lines.color_numbers(drawing, 6), palette)
    assert len(made.ends) == 2 * sum(not s.closed for s in drawing.strokes)
    sides = made.points[made.edges]
    drawn = np.linalg.norm(np.diff(sides, axis=1), axis=2).sum()
    pixel = part("operators.grease_pencil.core.pixel_map").front_view(drawing.size).unit
    wanted = sum(
        np.linalg.norm(
            np.diff(np.r_[s.points, s.points[:1]] if s.closed else s.points, axis=0), axis=1
        ).sum()
        for s in drawing.strokes
    )
    assert drawn / pixel == pytest.approx(wanted, rel=0.06)  # of a curve and its anchors
    assert len({tuple(color) for color in made.colors.round(3).tolist()}) == 3
    nothing = lines.stroke_lines([], key, {}, palette)
    assert len(nothing.points) == len(nothing.edges) == 0
