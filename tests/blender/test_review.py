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


def test_a_decision_is_kept_with_what_it_taught(bpy, part):
    """Asking around changes scores, alternatives and routing; the file has all of it."""
    obj, _ = make(bpy, part, grid(part, 4))
    bpy.context.view_layer.objects.active = obj
    changing = part("operators.grease_pencil.routing_change")
    state = part("operators.grease_pencil.state")
    key = state.keys_at(obj.data, 1)[0]

    def decide(drawing):
        new = drawing.reroute(5, drawing.junctions[5].alternatives[1].pairs)
        score = new.routing.pair_score.copy()
        score[:40] += 0.75
        return new.with_scores(score)

    trace = changing.change_routing(obj.data, 1, key, decide)
    part("operators.grease_pencil.stored_trace")._decoded.clear()
    found = state.load(obj.data, key, 1).drawing
    np.testing.assert_allclose(found.routing.pair_score, trace.drawing.routing.pair_score)
    np.testing.assert_allclose(found.doubts, trace.drawing.doubts, atol=1e-6)
    np.testing.assert_allclose(found.doubts, [j.doubt for j in found.junctions], atol=1e-9)


def test_junctions_that_look_alike_are_decided_alike(bpy, part):
    drawing = grid(part, 4)
    decided = part("operators.view.alike").decided_alike
    junction = drawing.junctions[5]
    ends = tuple(junction.pairs[:1])  # one of the two lines ends here, from both sides
    after = decided(drawing, 5, ends)
    assert after.routing.locked[:16].all()
    graph = drawing.graph
    along = np.array([0, 0])
    for place in after.junctions:
        assert len(place.pairs) == 1
        a, b = place.pairs[0]
        way = graph.vertices[graph.half_vertex[a ^ 1]] - graph.vertices[graph.half_vertex[b ^ 1]]
        along += np.abs(way) > 1
    assert sorted(along.tolist()) == [0, 16]  # all in the direction of the first
    locked = drawing.lock(3)
    assert decided(locked, 5, ends).junctions[3].pairs == drawing.junctions[3].pairs
    other = cross(part)
    assert part("operators.view.alike").alike(other, 0, other.junctions[0].pairs) == []


def test_what_is_enclosed_is_accepted(bpy, part):
    obj, _ = make(bpy, part, grid(part, 4))
    bpy.context.view_layer.objects.active = obj
    outline = [(20, 20), (80, 20), (80, 60), (20, 60)]  # junctions at 30, 50, 70 and 90
    path = [{"name": "", "loc": place, "time": 0.0} for place in outline]
    assert bpy.ops.involute.accept_inside(path=path) == {"FINISHED"}
    drawing = drawing_of(part, obj)
    places = [j.position for j in drawing.junctions if j.locked]
    assert sorted(places) == [(30, 30), (30, 50), (50, 30), (50, 50), (70, 30), (70, 50)]
    assert bpy.ops.involute.accept_inside(path=path) == {"CANCELLED"}
