"""Doubtful bundles of pencil strokes are reviewed like junctions: one line or two."""

from __future__ import annotations

import numpy as np
import pytest

from .test_pencil_lines import lines_of, trace

APART = 9  # px between two strokes that may be one line or two
ROUGH = ((30, 80, 330, 84), (60, 84, 320, 81), (30, 87, 200, 87), (200, 86, 330, 88))
PAIR = ((120, 130, 120, 220), (120 + APART, 130, 120 + APART, 220))


@pytest.fixture
def traced(bpy, part, tmp_path):
    return trace(bpy, part, tmp_path, (*ROUGH, *PAIR))


def shown_in(bpy, part):
    return part("operators.view.view_state").shown_in(bpy.context)


def the_pair(bpy, part):
    """The question about the two upright strokes."""
    bundles = shown_in(bpy, part).trace.drawing.bundles
    return min(bundles, key=lambda b: np.hypot(b.position[0] - 124, b.position[1] - 175))


def upright(part, data):
    """Numbers of the lines between the two strokes, or on them."""
    curves = lines_of(part, data)
    size = [np.ptp(p, axis=0) for p in np.split(curves.point("position"), curves.offsets[1:-1])]
    return [k for k, (x, _, z) in enumerate(size) if z > 3 * x and z > 0.4]


def answer(bpy, part, one):
    asked = the_pair(bpy, part)
    number = next(k for k, way in enumerate(asked.alternatives) if bool(way.pairs) == one)
    return bpy.ops.involute.reroute(junction=asked.index, alternative=number)


def test_bundles_stand_in_the_list_beside_the_junctions(bpy, part, traced):
    shown = shown_in(bpy, part)
    asked = the_pair(bpy, part)
    assert np.isfinite(shown.table.positions[asked.index]).all()
    assert asked.index in shown.table.listed(degree=2).tolist()
    assert asked.index not in shown.table.listed(degree=3).tolist()
    drawing = shown.trace.drawing
    corners = len(drawing.corners)
    assert len(shown.table) == len(drawing.junctions) + corners + len(drawing.bundles)
    assert shown.table.count == len(shown.table) - corners
    bpy.ops.involute.go_to_junction(junction=asked.index, move_view=False)
    assert shown_in(bpy, part).junction.strokes == asked.strokes
    words = part("operators.view.junction_words")
    said = [words.in_words(shown.trace.drawing, asked, way.pairs) for way in asked.alternatives]
    assert sorted(said) == ["One line", "Two lines"]


@pytest.mark.parametrize("one", [True, False])
def test_a_card_makes_one_line_or_two(bpy, part, traced, one):
    for joined in (not one, one):
        assert answer(bpy, part, joined) == {"FINISHED"}
        assert len(upright(part, traced)) == (1 if joined else 2)
    asked = the_pair(bpy, part)
    assert asked.locked
    assert shown_in(bpy, part).junction.strokes == asked.strokes  # it stays the current one
    assert bpy.ops.involute.lock(junction=asked.index) == {"FINISHED"}
    assert not the_pair(bpy, part).locked


def test_other_strokes_are_not_touched(bpy, part, traced):
    curves = lines_of(part, traced)
    far = [k for k in range(len(curves)) if k not in upright(part, traced)]
    assert far
    cels = part("operators.grease_pencil.cels")
    column = part("operators.grease_pencil.core.stroke_arrays").column
    cel = traced.layers["Black"].frames[0].drawing
    mine = np.isin(np.arange(len(curves)), far)
    cels.set_points(cel, "of_the_artist", column("FLOAT", np.repeat(mine, curves.sizes)))
    one = not the_pair(bpy, part).pairs
    pencil = lines_of(part, traced, "Pencil").point("position")
    traced.layers["Pencil"].lock = True
    answer(bpy, part, one)
    curves = lines_of(part, traced)
    marked = [p.all() for p in np.split(curves.point("of_the_artist"), curves.offsets[1:-1])]
    assert sum(marked) == len(far)
    assert not set(np.flatnonzero(marked)) & set(upright(part, traced))
    np.testing.assert_array_equal(lines_of(part, traced, "Pencil").point("position"), pencil)
    # The pencil strokes know their lines, which have other numbers now.
    known = lines_of(part, traced, "Pencil").mark("involute_line")
    assert set(known[known > 0]) <= set(curves.mark(".involute_half"))
    drawing = shown_in(bpy, part).trace.drawing
    np.testing.assert_array_equal(known, drawing.line_of_pencil)
    # Further decisions find all strokes.
    shown = shown_in(bpy, part)
    if drawing.junctions:
        bpy.ops.involute.reroute(junction=0, alternative=len(drawing.place(0).alternatives) - 1)
    assert len(shown.halves) == len(drawing.strokes)


def test_a_moved_line_stays_moved(bpy, part, traced):
    far = next(k for k in range(99) if k not in upright(part, traced))
    cel = traced.layers["Black"].frames[0].drawing
    places = lines_of(part, traced)
    inside = slice(*places.offsets[far : far + 2])
    cel.strokes[far].points[0].position.z += 0.05
    moved = lines_of(part, traced).point("position")[inside].copy()
    answer(bpy, part, not the_pair(bpy, part).pairs)
    curves = lines_of(part, traced)
    there = np.split(curves.point("position"), curves.offsets[1:-1])
    assert any(p.shape == moved.shape and np.allclose(p, moved) for p in there)


def test_a_locked_layer_is_left_alone(bpy, part, traced):
    before = len(lines_of(part, traced))
    traced.layers["Black"].lock = True
    with pytest.raises(RuntimeError, match="locked"):
        answer(bpy, part, not the_pair(bpy, part).pairs)
    assert len(lines_of(part, traced)) == before
    assert not the_pair(bpy, part).locked


@pytest.mark.parametrize("one", [True, False])
def test_answers_are_saved_and_opened(bpy, part, traced, tmp_path, one):
    answer(bpy, part, one)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "kept.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "kept.blend"))
    part("operators.grease_pencil.stored_trace")._decoded.clear()
    asked = the_pair(bpy, part)
    assert asked.locked
    assert bool(asked.pairs) == one
    data = bpy.context.active_object.data
    answer(bpy, part, not one)
    assert len(upright(part, data)) == (2 if one else 1)


@pytest.mark.parametrize("one", [True, False])
def test_another_trace_keeps_the_answers(bpy, part, traced, one):
    answer(bpy, part, one)
    assert bpy.ops.involute.trace_again(smoothing=0.9) == {"FINISHED"}
    assert len(upright(part, traced)) == (1 if one else 2)
    assert the_pair(bpy, part).locked


def test_answers_are_undone(bpy, part, traced):
    bpy.ops.ed.undo_push(message="Traced")
    was = bool(the_pair(bpy, part).pairs)
    answer(bpy, part, not was)
    bpy.ops.ed.undo_push(message="Answered")
    bpy.ops.ed.undo()
    data = bpy.context.active_object.data
    assert len(upright(part, data)) == (1 if was else 2)
    assert not the_pair(bpy, part).locked
    bpy.ops.ed.redo()
    data = bpy.context.active_object.data
    assert len(upright(part, data)) == (2 if was else 1)
    assert the_pair(bpy, part).locked


def test_answers_are_undone_in_edit_mode(bpy, part, traced, tmp_path):
    was = bool(the_pair(bpy, part).pairs)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.ed.undo_push(message="In Edit Mode")
    answer(bpy, part, not was)
    bpy.ops.ed.undo_push(message="Answered")
    bpy.ops.ed.undo()
    data = bpy.context.active_object.data
    assert len(upright(part, data)) == (1 if was else 2)
    assert not the_pair(bpy, part).locked
    answer(bpy, part, not was)
    assert len(upright(part, data)) == (2 if was else 1)
    bpy.ops.ed.undo_push(message="Answered")
    bpy.ops.ed.undo()
    bpy.ops.object.mode_set(mode="OBJECT")
    # What undo brought back is saved with its bundles.
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "undone.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "undone.blend"))
    assert not the_pair(bpy, part).locked
    assert bool(the_pair(bpy, part).pairs) == was


def test_copies_are_answered_apart(bpy, part, traced):
    was = bool(the_pair(bpy, part).pairs)
    obj = bpy.context.active_object
    copy = obj.copy()
    copy.data = obj.data.copy()
    bpy.context.collection.objects.link(copy)
    for layer in obj.data.layers:  # and a copy of the keyframe
        layer.frames.copy(1, 10)
    answer(bpy, part, not was)
    assert len(upright(part, obj.data)) == (2 if was else 1)
    assert len(upright(part, copy.data)) == (1 if was else 2)
    bpy.context.scene.frame_set(10)
    assert not the_pair(bpy, part).locked
    bpy.context.scene.frame_set(1)
    bpy.context.view_layer.objects.active = copy
    bpy.context.window_manager.involute_view.key = 0
    assert not the_pair(bpy, part).locked


def test_sure_ones_are_accepted_with_the_junctions(bpy, part, traced):
    before = len(upright(part, traced))
    open_ones = sum(not b.locked for b in shown_in(bpy, part).trace.drawing.bundles)
    bpy.ops.involute.accept(probability=0.0)
    assert open_ones
    assert all(b.locked for b in shown_in(bpy, part).trace.drawing.bundles)
    assert len(upright(part, traced)) == before


def test_the_review_asks_for_them_and_counts_on(bpy, part, traced):
    review = part("operators.junctions.review")
    shown, asked = shown_in(bpy, part), the_pair(bpy, part)
    left = review.open_doubts(shown, ()).tolist()
    doubtful = shown.trace.drawing.doubtful
    assert sorted(left) == sorted(doubtful)
    before = shown.trace.drawing
    answer(bpy, part, not asked.pairs)
    now = shown_in(bpy, part)
    assert (
        asked.index not in review.open_doubts(now, ()).tolist()
        or now.trace.drawing.asked(asked.index).strokes != asked.strokes
    )
    numbers = [asked.index, *range(len(before.junctions)), -1]
    found = review._numbers_now(numbers, before, now.trace.drawing)
    assert now.trace.drawing.asked(found[0]).strokes == asked.strokes
    assert found[-1] == -1
    for number, there in zip(numbers[1:], found[1:-1], strict=False):
        if there >= 0:
            places = [
                d.asked(n).position for d, n in ((before, number), (now.trace.drawing, there))
            ]
            assert np.hypot(*np.subtract(*places)) < 8


def test_cards_show_one_line_and_two(bpy, part, traced):
    geometry = part("ui.overlay.overlay_geometry")
    drawing, asked = shown_in(bpy, part).trace.drawing, the_pair(bpy, part)
    one, two = (geometry.routes(drawing, asked, pairs) for pairs in ((asked.strokes,), ()))
    assert [len(one), len(two)] == [1, 2]
    assert abs(np.median(one[0].points[:, 0]) - 124.5) < 2
    assert len({route.color for route in two}) == 2
    for pairs in ((asked.strokes,), ()):
        for route in geometry.sketch(drawing, asked, pairs):
            assert np.abs(route.points).max() <= 1.01
    apart = geometry.sketch(drawing, asked, ())
    assert abs(np.median(apart[0].points[:, 0]) - np.median(apart[1].points[:, 0])) > 0.15
    assert geometry.labels(drawing, asked) == []


def test_rings_of_bundles_are_small_until_they_are_worth_a_look(bpy, part, traced):
    geometry, colors = part("ui.overlay.overlay_geometry"), part("ui.overlay.colors")
    table = shown_in(bpy, part).table
    made = geometry.rings(table, 4.0, (colors.SURE, colors.DOUBTFUL, colors.LOCKED))
    seen = np.flatnonzero(np.isfinite(table.positions[:, 0]))
    points = made.points.reshape(len(seen), -1, 2)
    radii = np.linalg.norm(points - table.positions[seen, None], axis=2).max(1)
    minor = (table.degree[seen] == 2) & ~table.doubtful[seen] & ~table.locked[seen]
    assert minor.any()
    assert (radii[minor] < 2).all()
    assert (radii[~minor] > 3.9).all()


def test_frames_of_a_sequence_are_answered_apart(bpy, part, tmp_path):
    part("engine.scan")  # brings OpenCV
    import cv2

    for number in (1, 2):
        page = np.full((240, 360), 255, np.uint8)
        for x, y, right, low in (*ROUGH, *PAIR):
            cv2.line(page, (x + number, y), (right + number, low), 0, 2, cv2.LINE_AA)
        cv2.imwrite(str(tmp_path / f"run_{number:03}.png"), page)
    options = {"provider": "classical", "solids": False, "drawing": "rough", "jobs": 1}
    assert bpy.ops.involute.trace_sequence(directory=str(tmp_path), **options) == {"FINISHED"}
    state, data = part("operators.grease_pencil.state"), bpy.context.active_object.data
    before = state.doubtful_frames(data)
    bpy.context.scene.frame_set(2)
    was = bool(the_pair(bpy, part).pairs)
    answer(bpy, part, not was)
    assert the_pair(bpy, part).locked
    assert bool(the_pair(bpy, part).pairs) != was
    after = state.doubtful_frames(data)
    assert after.keys() == before.keys()
    assert after[1] == before[1]
    bpy.context.scene.frame_set(1)
    assert not the_pair(bpy, part).locked
    assert bool(the_pair(bpy, part).pairs) == was
