"""Junctions as the user works on them: list, choose, join, separate, lock, ask again, pick."""

from __future__ import annotations

import numpy as np
import pytest

from .example_drawings import cross, grid, ring_and_lines
from .test_grease_pencil import make
from .test_splicing import assert_same, drawing_of, strokes_in


@pytest.fixture
def traced(bpy, part):
    """An active object with nine crossings."""
    obj, pixel_map = make(bpy, part, grid(part, 3))
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    return obj, pixel_map


@pytest.fixture
def view(bpy):
    """The window manager outlives files, and with it what tests before have looked at."""
    view = bpy.context.window_manager.involute_view
    view.junction = -1
    return view


def shown(bpy, part):
    return part("operators.view.view_state").shown_in(bpy.context)


def test_operators_need_a_traced_drawing(bpy):
    for name in ("reroute", "lock", "ask_again", "accept", "join", "separate", "step_junction"):
        assert not getattr(bpy.ops.involute, name).poll()


def test_reroute_applies_an_alternative_and_locks(bpy, part, traced):
    obj, pixel_map = traced
    ways = drawing_of(part, obj).junctions[4].alternatives
    assert bpy.ops.involute.reroute(junction=4, alternative=2) == {"FINISHED"}
    junction = drawing_of(part, obj).junctions[4]
    assert junction.pairs == ways[2].pairs
    assert junction.locked
    assert shown(bpy, part).junction.index == 4
    assert_same(strokes_in(part, obj, pixel_map), drawing_of(part, obj).strokes)
    with pytest.raises(RuntimeError, match="alternatives"):
        bpy.ops.involute.reroute(junction=4, alternative=99)
    with pytest.raises(RuntimeError, match="Choose a junction"):
        bpy.ops.involute.reroute(junction=99)


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT", "PAINT_GREASE_PENCIL"])
def test_choosing_works_in_every_mode(bpy, part, traced, mode):
    """Without a mouse, choosing is what Adjust Last Operation runs again."""
    obj, pixel_map = traced
    bpy.ops.object.mode_set(mode=mode)
    assert bpy.ops.involute.choose("EXEC_DEFAULT", junction=4, alternative=1) == {"FINISHED"}
    ways = drawing_of(part, obj).junctions[4].alternatives
    assert drawing_of(part, obj).junctions[4].pairs == ways[1].pairs
    bpy.ops.object.mode_set(mode="OBJECT")
    assert_same(strokes_in(part, obj, pixel_map), drawing_of(part, obj).strokes)


def test_join_and_separate_by_hand(bpy, part, traced):
    obj, pixel_map = traced
    first, second, third, fourth = drawing_of(part, obj).junctions[0].half_branches
    bpy.ops.involute.separate(junction=0)
    assert drawing_of(part, obj).junctions[0].pairs == ()
    bpy.ops.involute.join(first=third, second=first)
    assert drawing_of(part, obj).junctions[0].pairs == ((first, third),)
    bpy.ops.involute.join(first=first, second=second)
    assert drawing_of(part, obj).junctions[0].pairs == ((first, second),)
    bpy.ops.involute.join(first=third, second=fourth)
    assert drawing_of(part, obj).junctions[0].pairs == ((first, second), (third, fourth))
    bpy.ops.involute.separate(half=first)
    assert drawing_of(part, obj).junctions[0].pairs == ((third, fourth),)
    assert_same(strokes_in(part, obj, pixel_map), drawing_of(part, obj).strokes)
    elsewhere = drawing_of(part, obj).junctions[8].half_branches[0]
    with pytest.raises(RuntimeError, match="one junction"):
        bpy.ops.involute.join(first=first, second=elsewhere)


def test_lock_accept_and_ask_again(bpy, part, traced):
    obj, pixel_map = traced
    before = drawing_of(part, obj)
    bpy.ops.involute.lock(junction=3)
    assert drawing_of(part, obj).junctions[3].locked
    bpy.ops.involute.lock(junction=3)
    assert not drawing_of(part, obj).junctions[3].locked
    bpy.ops.involute.reroute(junction=2, alternative=1)
    chosen = drawing_of(part, obj).junctions[2].pairs
    bpy.ops.involute.ask_again()
    assert drawing_of(part, obj).junctions[2].pairs == chosen
    assert drawing_of(part, obj).junctions[5].pairs == before.junctions[5].pairs
    bpy.ops.involute.accept(probability=0)
    assert all(j.locked for j in drawing_of(part, obj).junctions)
    assert_same(strokes_in(part, obj, pixel_map), drawing_of(part, obj).strokes)


def test_list_filters_and_order(part):
    table = part("operators.view.junction_table").JunctionTable(
        positions=np.array([[5, 90], [50, 5], [10, 6], [40, 50]], np.float32),
        degree=np.array([3, 4, 3, 7]),
        doubt=np.array([0.05, 0.4, 0.2, 0.0], np.float32),
        locked=np.array([False, False, False, True]),
        cost=np.array([9.0, 2.0, 30.0, 0.0]),
        doubtful=np.array([True, False, True, False]),
    )
    assert table.listed("COST").tolist() == [2, 0, 1, 3]
    assert table.listed().tolist() == [1, 2, 0, 3]
    assert table.listed("PLACE").tolist() == [2, 1, 3, 0]
    assert table.listed("COST", doubtful=True).tolist() == [2, 0]
    assert table.listed(degree=3).tolist() == [2, 0]
    assert table.listed(degree=5).tolist() == [3]
    assert table.listed(unlocked=True).tolist() == [1, 2, 0]


def test_steps_go_through_the_list_and_move_the_view(bpy, part, traced, view):
    view.doubtful_only = False
    view.order = "PLACE"
    seen = []
    for _ in range(10):
        bpy.ops.involute.step_junction()
        seen.append(view.junction)
    assert seen[:9] == shown(bpy, part).listed.tolist()
    assert seen[9] == seen[0]
    bpy.ops.involute.step_junction(direction="PREVIOUS")
    assert view.junction == seen[8]


def test_two_drawings_do_not_touch_each_other(bpy, part, traced, view):
    first, pixel_map = traced
    second, other_map = make(bpy, part, cross(part))
    bpy.ops.involute.reroute(junction=1, alternative=1)
    bpy.context.view_layer.objects.active = second
    assert shown(bpy, part).junction is None  # the current junction is the other drawing's
    bpy.ops.involute.reroute(junction=0, alternative=1)
    assert_same(strokes_in(part, second, other_map), drawing_of(part, second).strokes)
    assert_same(strokes_in(part, first, pixel_map), drawing_of(part, first).strokes)


def test_frames_have_their_own_junctions(bpy, part, traced):
    obj, pixel_map = traced
    state = part("operators.grease_pencil.state")
    drawing = cross(part)
    part("operators.grease_pencil.writing").write(
        obj.data, 10, drawing, pixel_map, state.add(obj.data, drawing, pixel_map, "ten")
    )
    scene = bpy.context.scene
    for frame, count in ((1, 9), (9, 9), (10, 1), (50, 1)):
        scene.frame_set(frame)
        assert shown(bpy, part).table.count == count
    bpy.ops.involute.reroute(junction=0, alternative=1)
    assert len(drawing_of(part, obj, 10).strokes) != len(drawing.strokes)
    assert_same(strokes_in(part, obj, pixel_map, 1), drawing_of(part, obj, 1).strokes)


def test_files_of_a_newer_involute_are_left_alone(bpy, part, traced):
    obj, _ = traced
    obj.data["involute"]["version"] = 999
    assert not bpy.ops.involute.reroute.poll()
    bpy.data.images.new("Sketch", 40, 30)
    with pytest.raises(RuntimeError, match="A newer Involute") as told:
        bpy.ops.involute.trace(image="Sketch", target="ACTIVE")
    assert "Traceback" not in str(told.value)


def test_words(part):
    words = part("operators.view.junction_words")
    drawing = cross(part)
    junction = drawing.junctions[0]
    names = words.letters(drawing, junction)
    up, right, down, left = (
        next(h for h, letter in names.items() if letter == wanted) for wanted in "ABCD"
    )
    arrows = [words.arrow(words.angle(drawing, half)) for half in (up, right, down, left)]
    assert arrows == ["↑", "→", "↓", "←"]
    assert words.sentence(names, [(up, down), (left, right)]) == "A–C, B–D"
    assert words.sentence(names, [(up, down)]) == "A–C, B D end"


def test_picking_needs_no_gpu(part):
    picking = part("operators.view.picking")
    matrix = np.array([[0.1, 0, 0, 0], [0, 0.2, 0, 0], [0, 0, 0, 0], [0, 0, 0, 1.0]])
    points = np.array([[0, 0, 0], [5, 2.5, 0], [-5, 0, 1]])
    places = picking.project(points, matrix, 200, 100)
    np.testing.assert_allclose(places, [[100, 50], [150, 75], [50, 50]])
    assert picking.nearest(places, (148, 77), 10) == 1
    assert picking.nearest(places, (125, 60), 10) == -1
    behind = picking.project(points, np.diag([1, 1, 1, -1.0]), 200, 100)
    assert np.isnan(behind).all()
    assert picking.nearest(behind, (0, 0), 10) == -1
    assert picking.distance_to_line(places[[0, 2]], (75, 53)) == pytest.approx(3)
    assert picking.distance_to_line(behind, (75, 53)) == np.inf


def test_a_drag_joins_the_nearest_lines_that_meet(part):
    pair = part("operators.view.picking").nearest_pair
    vertex = np.array([0, 1, 0, 2, 1, 2])
    assert pair({0: 5.0, 1: 2.0}, {2: 1.0, 3: 0.5}, vertex) == (0, 2)
    assert pair({0: 5.0, 1: 2.0}, {2: 9.0, 4: 1.0}, vertex) == (1, 4)
    assert pair({0: 1.0}, {0: 1.0, 3: 0.5}, vertex) is None


@pytest.mark.parametrize("anchor", [(400, 300), (5, 5), (795, 595), (-500, 2000)])
@pytest.mark.parametrize("scale", [1.0, 2.0])
@pytest.mark.parametrize("count", [2, 6, 10])
def test_cards_stay_inside_what_nothing_covers(part, anchor, scale, count):
    """Sidebar on the right, toolbar on the left, two headers above, asset shelf below."""
    cards = part("operators.view.card_layout")
    made = (600, 0, 200, 600), (0, 0, 50, 600), (0, 560, 800, 40), (0, 520, 800, 40), (0, 0, 800, 9)
    free = cards.free_part((800, 600), [cards.Card(*cover) for cover in made])
    assert free == (50, 9, 550, 511)
    row, smaller = cards.layout(count, anchor, free, scale)
    assert len(set(row)) == count
    assert 0.4 * scale <= smaller <= scale
    assert all(c.x >= 50 and c.y >= 9 for c in row)
    assert all(c.x + c.width <= 600 and c.y + c.height <= 520 for c in row)
    assert [cards.card_at(row, c.x + 3, c.y + 3) for c in row] == list(range(count))
    assert cards.card_at(row, row[0].x - 2, row[0].y) == -1


def test_cards_leave_the_lines_to_be_seen(part):
    """Lines go up to both sides: the cards lie below, though there is room above."""
    cards = part("operators.view.card_layout")
    free = cards.Card(0, 0, 800, 600)
    along = np.linspace(0, 150, 40)
    up = np.concatenate([np.c_[400 + side * along, 300 + along] for side in (-1, 1)])
    row, _ = cards.layout(4, (400, 300), free, 1.0, up)
    assert all(card.y + card.height < 300 for card in row)
    down, _ = cards.layout(4, (400, 300), free, 1.0, np.c_[up[:, 0], 600 - up[:, 1]])
    assert all(card.y > 300 for card in down)


def test_overlay_geometry(part):
    geometry, colors = part("ui.overlay.overlay_geometry"), part("ui.overlay.colors")
    table = part("operators.view.junction_table").JunctionTable(
        np.array([[10, 10], [50, 40]], np.float32),
        np.array([3, 4]),
        np.array([0.0, 0.5], np.float32),
        np.array([False, False]),
        np.array([0.0, 1.0]),
        np.array([False, True]),
    )
    rings = geometry.rings(table, 4.0, (colors.SURE, colors.DOUBTFUL, colors.LOCKED))
    sides = len(rings.points) // 2
    radii = np.linalg.norm(rings.points - np.repeat(table.positions, sides, axis=0), axis=1)
    np.testing.assert_allclose(radii[:sides], 4.0, rtol=1e-5)
    np.testing.assert_allclose(radii[sides:], 8.0, rtol=1e-5)
    np.testing.assert_allclose(rings.colors[0, :3], colors.SURE, atol=1e-6)
    np.testing.assert_allclose(rings.colors[-1, :3], colors.DOUBTFUL, atol=1e-6)
    assert rings.edges.max() == len(rings.points) - 1

    drawing = cross(part)
    junction = drawing.junctions[0]
    routes = geometry.routes(drawing, junction, junction.pairs[:1])
    assert [route.joined for route in routes] == [True, False, False]
    middle = np.array(junction.position)
    assert np.linalg.norm(routes[0].points - middle, axis=1).min() < 1e-3


def test_sketches_show_short_lines_as_large_as_long_ones(part):
    """Else the card of a short and a long line that are joined shows nothing of the short one."""
    geometry, drawing = part("ui.overlay.overlay_geometry"), ring_and_lines(part)
    for junction in drawing.junctions:
        for way in junction.alternatives:
            for route in geometry.sketch(drawing, junction, way.pairs):
                away = np.linalg.norm(route.points, axis=1)
                middle = int(away.argmin())
                assert away[middle] < 1e-3
                arms = [away[middle:], away[: middle + 1]] if route.joined else [away]
                assert [arm.max() for arm in arms] == pytest.approx([1.0] * len(arms))


def test_overlay_and_panels_are_there(bpy, part, traced):
    for name in ("INVOLUTE_PT_trace", "INVOLUTE_PT_junctions", "INVOLUTE_PT_junction"):
        panel = getattr(bpy.types, name)
        assert panel.bl_category == "Involute"
    assert bpy.types.INVOLUTE_PT_junctions.poll(bpy.context)
    assert not bpy.types.INVOLUTE_PT_junction.poll(bpy.context)
    bpy.ops.involute.go_to_junction(junction=2)
    assert bpy.types.INVOLUTE_PT_junction.poll(bpy.context)
    assert len(part("ui.overlay.overlay")._handles) == 2
    keys = list(part("ui.keymap").items(bpy.context.window_manager.keyconfigs.addon))
    assert len(keys) == 4


def test_doubtful_keyframes_are_counted_and_found(bpy, part):
    state, writing = part("operators.grease_pencil.state"), part("operators.grease_pencil.writing")
    obj, pixel_map = make(bpy, part, grid(part, 3))
    bpy.context.view_layer.objects.active = obj
    for frame in (5, 9):
        key = state.add(obj.data, grid(part, 3), pixel_map, f"frame {frame}")
        writing.write(obj.data, frame, grid(part, 3), pixel_map, key)
    found = state.doubtful_frames(obj.data)
    assert list(found) == [1, 5, 9]
    count = len(drawing_of(part, obj).doubtful)
    assert set(found.values()) == {count}
    traces = obj.data["involute"]["traces"]
    for frame, doubts in ((1, 0), (5, 3), (9, 2)):
        traces[str(state.keys_at(obj.data, frame)[0])]["doubtful"] = doubts
    bpy.context.scene.frame_set(1)
    seen = []
    for _ in range(3):
        assert bpy.ops.involute.doubtful_frame(direction="NEXT") == {"FINISHED"}
        seen.append(bpy.context.scene.frame_current)
    assert seen == [5, 9, 5]
    assert bpy.ops.involute.go_to_frame(frame=9) == {"FINISHED"}
    assert bpy.context.scene.frame_current == 9
    assert bpy.ops.involute.go_to_frame(frame=5) == {"FINISHED"}
    traces[str(state.keys_at(obj.data, 9)[0])]["doubtful"] = 0
    assert bpy.ops.involute.doubtful_frame(direction="PREVIOUS") == {"CANCELLED"}
    bpy.ops.involute.accept(probability=0)  # what is decided is no doubt any more
    assert state.doubtful_frames(obj.data)[5] == 0
