"""Cutting with a swipe, joining over a gap, routing along a path: strokes and state together."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from .example_drawings import cross, draw, grid, planar_graph, ring_and_lines
from .test_grease_pencil import make
from .test_splicing import assert_same, cel_of, drawing_of, move, strokes_in


def path(*places):
    return [{"name": "", "loc": place, "time": 0.0} for place in places]


def two_lines(part, **settings):
    """Two lines in a row with a gap, 60 to 75, and one below."""
    vertices = [(20, 50), (60, 50), (75, 52), (140, 52), (20, 120), (140, 120)]

    def inner(a, b):
        a, b = np.array(vertices[a], float), np.array(vertices[b], float)
        return a + np.linspace(0, 1, 40)[1:-1, None] * (b - a)

    branches = [(a, b, inner(a, b)) for a, b in ((0, 1), (2, 3), (4, 5))]
    return draw(part, planar_graph(part, vertices, branches), (160, 160), **settings)


@pytest.fixture
def forget(part):
    """As after opening the file."""

    def run():
        part("operators.grease_pencil.stored_trace")._decoded.clear()
        part("operators.view.junction_table")._tables.clear()

    return run


def ready(bpy, part, drawing):
    obj, pixel_map = make(bpy, part, drawing)
    bpy.context.view_layer.objects.active = obj
    return obj, pixel_map


@pytest.mark.parametrize("curve", ["polyline", "bezier"])
@pytest.mark.parametrize("example", [cross, ring_and_lines, two_lines])
def test_a_swipe_cuts_what_it_crosses(bpy, part, forget, example, curve):
    obj, pixel_map = ready(bpy, part, example(part, curve=curve))
    before = drawing_of(part, obj)
    stroke = max(before.strokes, key=lambda s: len(s.points))
    a, b = stroke.points[:2].astype(float)
    middle, way = (a + b) / 2, (b - a) / np.linalg.norm(b - a)
    across = np.array([-way[1], way[0]])
    swipe = path(tuple(middle - 4 * across), tuple(middle + 4 * across))
    if np.hypot(*(a - middle)) < 8 and not stroke.closed:
        middle = stroke.points[len(stroke.points) // 2].astype(float)
        swipe = path(tuple(middle - 5.2 * across), tuple(middle + 5.2 * across))
    assert bpy.ops.involute.cut(path=swipe) == {"FINISHED"}
    forget()
    after = drawing_of(part, obj)
    assert len(after.strokes) == len(before.strokes) + (not stroke.closed)
    assert after.routing.locked.sum() == 1
    assert_same(strokes_in(part, obj, pixel_map), after.strokes)
    whole = [np.linalg.norm(np.diff(s.points, axis=0), axis=1).sum() for s in after.strokes]
    assert sum(whole) > 0.98 * sum(
        np.linalg.norm(np.diff(s.points, axis=0), axis=1).sum() for s in before.strokes
    )


def test_a_swipe_over_several_strokes_cuts_all(bpy, part):
    obj, pixel_map = ready(bpy, part, grid(part, 4))
    count = len(drawing_of(part, obj).strokes)
    assert bpy.ops.involute.cut(path=path((20, 5), (20, 105))) == {"FINISHED"}
    after = drawing_of(part, obj)
    assert len(after.strokes) == count + 4
    assert_same(strokes_in(part, obj, pixel_map), after.strokes)
    assert bpy.ops.involute.cut(path=path((1, 1), (2, 2))) == {"CANCELLED"}


def test_what_the_artist_did_to_a_stroke_survives_the_cut(bpy, part):
    obj, pixel_map = ready(bpy, part, two_lines(part))
    cel = cel_of(obj)
    move(cel, slice(0, 2), (0.0, 0.0, 0.3))  # the first stroke, off its line
    part("operators.grease_pencil.cels").set_column(cel, "mine", np.arange(1, 4, dtype=np.int32))
    up = 0.3 / pixel_map.unit
    assert bpy.ops.involute.cut(path=path((40, 45 - up), (40, 55 - up))) == {"FINISHED"}
    found = strokes_in(part, obj, pixel_map)
    assert len(found) == 4
    moved = [points for points, _ in found if points[:, 1].max() < 40]
    assert len(moved) == 2
    for points in moved:
        np.testing.assert_allclose(points[:, 1], 50 - up, atol=0.1)
    np.testing.assert_allclose(sorted(p[0] for q in moved for p in q), (20, 40, 40, 60), atol=0.6)
    mine = part("operators.grease_pencil.cels").read_column(cel_of(obj), "mine")
    assert sorted(mine.tolist()) == [1, 1, 2, 3]


def test_two_ends_are_joined_over_a_gap(bpy, part, forget):
    obj, pixel_map = ready(bpy, part, two_lines(part))
    before = drawing_of(part, obj)
    vertex = before.graph.vertices[before.graph.half_vertex]
    a, b = (int(np.argmin(np.hypot(*(vertex - end).T))) for end in ((60, 50), (75, 52)))
    assert bpy.ops.involute.join(first=a, second=b) == {"FINISHED"}
    forget()
    after = drawing_of(part, obj)
    assert len(after.strokes) == 2
    assert after.corners[-1].locked
    assert_same(strokes_in(part, obj, pixel_map), after.strokes)
    with pytest.raises(RuntimeError, match="two ends"):
        bpy.ops.involute.join(first=0, second=0)


def test_undo_takes_a_cut_back_in_every_mode(bpy, part, forget):
    """Undo in Edit Mode brings strokes back, but no ID properties: strokes say what they are in."""
    obj, pixel_map = ready(bpy, part, grid(part, 3))
    data = obj.data
    gp = part("operators.grease_pencil.cels")
    marks = [gp.read(cel_of(obj))]
    stages = [drawing_of(part, obj)]
    bpy.ops.involute.cut(path=path((20, 5), (20, 85)))
    marks.append(gp.read(cel_of(obj)))
    stages.append(drawing_of(part, obj))
    bpy.ops.involute.reroute(junction=4, alternative=1)
    bpy.ops.involute.cut(path=path((5, 40), (85, 40)))
    for curves, stage in zip(reversed(marks), reversed(stages), strict=True):
        cel = cel_of(obj)
        cel.remove_strokes()
        gp.append(cel, curves)
        forget()
        drawing = drawing_of(part, obj)
        np.testing.assert_array_equal(drawing.routing.partner, stage.routing.partner)
        np.testing.assert_array_equal(drawing.routing.locked, stage.routing.locked)
        assert_same(strokes_in(part, obj, pixel_map), drawing.strokes)
    assert bpy.ops.involute.cut(path=path((5, 60), (85, 60))) == {"FINISHED"}
    forget()
    assert_same(strokes_in(part, obj, pixel_map), drawing_of(part, obj).strokes)
    assert data == obj.data


def test_asking_again_is_kept_in_few_bytes(bpy, part, forget):
    obj, _ = ready(bpy, part, grid(part, 4))
    bpy.ops.involute.reroute(junction=5, alternative=1)
    bpy.ops.involute.cut(path=path((20, 5), (20, 105)))
    bpy.ops.involute.ask_again()
    asked = drawing_of(part, obj)
    base = next(iter(obj.data["involute"]["traces"].values()))["base"]
    forget()
    found = drawing_of(part, obj)
    np.testing.assert_array_equal(found.routing.partner, asked.routing.partner)
    np.testing.assert_allclose(found.routing.pair_score, asked.routing.pair_score, rtol=1e-4)
    for one, other in zip(found.junctions, asked.junctions, strict=True):
        assert one.alternatives[0].pairs == other.alternatives[0].pairs
        assert one.doubt == pytest.approx(other.doubt, abs=1e-3)
    assert next(iter(obj.data["involute"]["traces"].values()))["base"] == base


def test_damaged_cuts_are_one_sentence(bpy, part, forget):
    import zlib
    from hashlib import blake2b

    obj, _ = ready(bpy, part, grid(part, 3))
    bpy.ops.involute.cut(path=path((20, 5), (20, 85)))
    entry = next(iter(obj.data["involute"]["traces"].values()))
    told = bytes(entry["routing"])
    raw = bytearray(zlib.decompress(told[1:]))
    for at, value in ((0, 2**31 - 1), (0, -1), (4, 9), (12, 2**30), (12, 0), (16, 5)):
        wrong = raw.copy()
        wrong[at : at + 4] = int(value).to_bytes(4, "little", signed=True)
        blob = b"+" + zlib.compress(bytes(wrong))
        del entry["routing"]
        entry["routing"] = blob
        for name in ("unmarked", "earlier"):
            if name in entry:
                del entry[name]
        stamp = blake2b(entry["base"].encode() + blob, digest_size=16).hexdigest()
        entry["stamp"] = stamp
        mark = cel_of(obj).attributes[".involute_routing"]
        mark.data.foreach_set("value", np.zeros(len(mark.data), np.int32))
        forget()
        with pytest.raises(part("engine").InvoluteError, match="no junctions any more"):
            part("operators.view.view_state").shown_in(bpy.context)


# --- along a path --------------------------------------------------------------------------------


def test_one_stroke_follows_a_scribble(bpy, part):
    obj, pixel_map = ready(bpy, part, grid(part, 5))
    scribble = path((52, 10), (49, 30), (51, 48), (70, 52), (92, 49), (90, 70), (90, 110))
    assert bpy.ops.involute.route_along(path=scribble, radius=6) == {"FINISHED"}
    after = drawing_of(part, obj)
    assert_same(strokes_in(part, obj, pixel_map), after.strokes)
    along = [
        s
        for s in after.strokes
        if all(np.hypot(*(s.points - p).T).min() < 4 for p in ((50, 50), (70, 50), (90, 70)))
    ]
    assert len(along) == 1
    passed = [j for j in after.junctions if j.locked]
    assert len(passed) >= 4
    for junction in passed:  # the other two lines of a crossing that was turned through
        assert len(junction.pairs) <= 2
    nothing = bpy.ops.involute.route_along(path=path((5, 5), (1, 1)), radius=3)
    assert nothing == {"CANCELLED"}


def test_others_are_decided_around_it(part):
    """Turned through a crossing, the two that are left go on in each other if that is best."""
    drawing = grid(part, 3)
    junction = drawing.junctions[4]
    a, b, c, d = junction.half_branches
    straight = dict((*junction.pairs, *(pair[::-1] for pair in junction.pairs)))
    other = next(h for h in (b, c, d) if h != straight[a])
    after = drawing.reroute_along([a ^ 1, other])
    pairs = after.junctions[4].pairs
    assert tuple(sorted((a, other))) in pairs
    assert after.junctions[4].locked
    with pytest.raises(part("engine").InvoluteError, match="follow each other"):
        drawing.reroute_along([a])
    with pytest.raises(part("engine").InvoluteError, match="one other only"):
        part("engine.routing").around(np.array([a, b, c, d]), drawing.routing, {(a, b), (a, c)})


def test_paths_are_matched_to_walks(part):
    followed = part("operators.view.following").followed
    graph = grid(part, 4).graph
    rng = np.random.default_rng(5)
    for row in (30.0, 50.0, 70.0, 90.0):
        x = np.linspace(12, 108, 60)
        line = np.stack([x, row + rng.normal(0, 1.0, len(x))], 1)
        halves = followed(graph, line, 5.0)
        assert len(halves) == 5
        for one, after in pairwise(halves):
            assert graph.half_vertex[one ^ 1] == graph.half_vertex[after]
        ends = graph.vertices[[graph.half_vertex[halves[0]], graph.half_vertex[halves[-1] ^ 1]]]
        assert (np.abs(ends[:, 1] - row) < 1).all()
        assert ends[0, 0] < ends[1, 0]
    assert followed(graph, np.array([[0.0, 0.0], [3.0, 0.0]]), 2.0) == []
    assert followed(graph, np.array([[50.0, 40.0]]), 2.0) == []


def test_a_swipe_on_the_screen_is_one_on_the_page(part):
    """Unprojecting is the way back of projecting, for any view of any plane."""
    picking = part("operators.view.picking")
    rng = np.random.default_rng(2)
    for _ in range(20):
        plane = rng.normal(size=(3, 3))
        matrix = np.eye(4)
        matrix[:3] = rng.normal(size=(3, 4))
        matrix[3] = (0.1, 0.2, 0.1, 5.0)
        page = rng.uniform(-1, 1, (6, 2))
        places = page @ plane[:2] + plane[2]
        seen = picking.project(places, matrix, 800, 600)
        found = picking.unproject(seen, matrix, plane, 800, 600)
        np.testing.assert_allclose(found, page, atol=1e-6)


# --- pen lifts -----------------------------------------------------------------------------------


def box(part):
    """A box of one line, its corners places where the pen may have been lifted."""
    corners = [(30, 30), (130, 30), (130, 100), (30, 100)]
    branches = []
    for k, start in enumerate(corners):
        a, b = np.array(start, float), np.array(corners[(k + 1) % 4], float)
        branches.append((k, (k + 1) % 4, a + np.linspace(0, 1, 40)[1:-1, None] * (b - a)))
    graph = planar_graph(part, corners, branches)
    clues = np.zeros((4, 8), np.float32)
    clues[:, 0] = 0.9  # what the corner by itself says: the line goes on
    return draw(part, replace(graph, clues=clues), (160, 160))


def test_pen_lifts_act_on_a_finished_drawing(bpy, part, forget):
    obj, pixel_map = ready(bpy, part, box(part))
    assert len(drawing_of(part, obj).strokes) == 1
    assert bpy.ops.involute.pen_lifts(bias=1.0) == {"FINISHED"}
    forget()
    assert len(drawing_of(part, obj).strokes) == 4
    assert_same(strokes_in(part, obj, pixel_map), drawing_of(part, obj).strokes)
    assert obj.involute_pen_lifts == pytest.approx(1.0)
    obj.involute_pen_lifts = -1.0
    assert obj.involute_pen_lifts == -1.0
    assert len(strokes_in(part, obj, pixel_map)) == 1
    assert bpy.ops.involute.cut(path=path((80, 20), (80, 40))) == {"FINISHED"}
    obj.involute_pen_lifts = 1.0  # what was cut by hand stays
    assert len(drawing_of(part, obj).strokes) == 5
    obj.involute_pen_lifts = -1.0
    (stroke,) = drawing_of(part, obj).strokes
    assert not stroke.closed
    assert_same(strokes_in(part, obj, pixel_map), [stroke])
    obj.data.layers["Black"].lock = True
    obj.involute_pen_lifts = 1.0  # says that the layer is locked
    assert len(drawing_of(part, obj).strokes) == 1


def test_pen_lifts_need_corners(bpy, part):
    ready(bpy, part, cross(part))
    with pytest.raises(RuntimeError, match="looked for corners"):
        bpy.ops.involute.pen_lifts(bias=0.5)


def test_what_a_gesture_can_not_do_is_told(bpy, part):
    """As a report, not as a traceback over the drawing."""
    obj, _ = ready(bpy, part, two_lines(part))
    told = []
    gesture = SimpleNamespace(report=lambda kind, said: told.append((kind, said)))
    do = part("operators.junctions.path_gesture").PathGesture.do
    before = len(drawing_of(part, obj).strokes)
    assert do(gesture, bpy.ops.involute.join, first=0, second=0) == {"CANCELLED"}
    ((kind, said),) = told
    assert kind == {"ERROR"}
    assert "Error" not in said
    assert said.endswith(".")
    assert do(gesture, bpy.ops.involute.cut, path=path((80, 110), (80, 130))) == {"FINISHED"}
    assert len(drawing_of(part, obj).strokes) == before + 1
