"""Rerouting joins and splits the strokes that are there, and nothing else."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
import pytest

from .example_drawings import cross, grid, ring_and_lines
from .test_grease_pencil import curves_of, make, with_handles


def strokes_in(part, obj, pixel_map, frame=1):
    """Every stroke of all layers as (points in pixels, closed), in any order and direction."""
    gp = part("operators.grease_pencil.cels")
    found = []
    for _, cel in gp.cels_at(obj.data, frame):
        curves = gp.read(cel)
        points = pixel_map.to_pixels(curves.point("position"))
        for k in range(len(curves)):
            found.append(
                (points[curves.offsets[k] : curves.offsets[k + 1]], bool(curves.curve("cyclic")[k]))
            )
    return found


def assert_same(found, strokes):
    """The same strokes; order does not matter."""

    def name(points, closed):
        return (closed, *np.round(np.concatenate([points[0], points[-1], points.sum(0)]), 0))

    assert len(found) == len(strokes)
    found = sorted(found, key=lambda f: name(*f))
    strokes = sorted(strokes, key=lambda s: name(s.points.astype(float), s.closed))
    for (points, closed), stroke in zip(found, strokes, strict=True):
        assert closed == stroke.closed
        np.testing.assert_allclose(points, stroke.points, atol=2e-3)


def change(part, obj, how, frame=1):
    state = part("operators.grease_pencil.state")
    changing = part("operators.grease_pencil.routing_change")
    key = state.keys_at(obj.data, frame)[0]
    return changing.change_routing(obj.data, frame, key, how)


def check_rerouted(part, obj, pixel_map, wanted):
    """Reroute junctions {index: pairs}; the strokes must be the engine's. Returns them."""

    def reroute(d):
        for index, pairs in wanted.items():
            d = d.reroute(index, pairs)
        return d

    change(part, obj, reroute)
    found, strokes = strokes_in(part, obj, pixel_map), drawing_of(part, obj).strokes
    assert len(found) == len(strokes)
    for stroke in strokes:
        assert min(apart(points, stroke, closed) for points, closed in found) < 1.5
    return found


def drawing_of(part, obj, frame=1):
    state = part("operators.grease_pencil.state")
    return state.load(obj.data, state.keys_at(obj.data, frame)[0], frame).drawing


def cel_of(obj, layer="Black", frame=1):
    return obj.data.layers[layer].get_frame_at(frame).drawing


def move(cel, which, shift):
    """Move some points of a cel, as an artist would."""
    places = np.zeros(3 * len(cel.attributes["position"].data), np.float32)
    cel.attributes["position"].data.foreach_get("vector", places)
    places = places.reshape(-1, 3)
    places[which] += shift
    cel.attributes["position"].data.foreach_set("vector", places.ravel())


def test_state_travels_with_the_data(bpy, part):
    drawing = cross(part)
    obj, _ = make(bpy, part, drawing)
    again = drawing_of(part, obj)
    assert_same([(s.points, s.closed) for s in again.strokes], drawing.strokes)
    part("operators.grease_pencil.stored_trace")._decoded.clear()
    again = drawing_of(part, obj)
    assert_same([(s.points, s.closed) for s in again.strokes], drawing.strokes)
    assert again.junctions[0].alternatives == drawing.junctions[0].alternatives


@pytest.mark.parametrize("seed", range(6))
def test_untouched_strokes_always_equal_the_engines(bpy, part, seed):
    """Any sequence of reroutes, then their inverses."""
    drawing = grid(part, 4)
    obj, pixel_map = make(bpy, part, drawing)
    random = np.random.default_rng(seed)
    first = {j.index: j.pairs for j in drawing.junctions}
    for _ in range(8):
        junction = drawing.junctions[random.integers(len(drawing.junctions))]
        pairs = junction.alternatives[random.integers(len(junction.alternatives))].pairs
        change(part, obj, lambda d, j=junction.index, p=pairs: d.reroute(j, p))
        assert_same(strokes_in(part, obj, pixel_map), drawing_of(part, obj).strokes)
    for index, pairs in first.items():
        change(part, obj, lambda d, j=index, p=pairs: d.reroute(j, p))
    assert_same(strokes_in(part, obj, pixel_map), drawing.strokes)


@pytest.mark.parametrize("seed", range(4))
def test_touched_strokes_follow_the_engines(bpy, part, seed):
    """Spliced piece by piece, strokes take the same ways as those that the engine walks anew."""
    drawing = ring_and_lines(part)
    obj, pixel_map = make(bpy, part, drawing)
    move(cel_of(obj), slice(None), (1e-3, 0, 0))  # 0.15 px: all have been touched
    random = np.random.default_rng(seed)
    for _ in range(10):
        junction = drawing.junctions[random.integers(len(drawing.junctions))]
        pairs = junction.alternatives[random.integers(len(junction.alternatives))].pairs
        change(part, obj, lambda d, j=junction.index, p=pairs: d.reroute(j, p))
        found, strokes = strokes_in(part, obj, pixel_map), drawing_of(part, obj).strokes
        assert len(found) == len(strokes)
        assert sorted(closed for _, closed in found) == sorted(s.closed for s in strokes)
        for stroke in strokes:
            assert min(apart(points, stroke, closed) for points, closed in found) < 1.5


@pytest.mark.parametrize("touched", [False, True])
def test_strokes_that_run_the_other_way_are_found_again(bpy, part, touched):
    """As in a sequence, where strokes take the direction that they had on the frame before."""
    drawing = ring_and_lines(part)
    obj, pixel_map = make(bpy, part, replace(drawing, strokes=tuple(map(turned, drawing.strokes))))
    if touched:
        move(cel_of(obj), slice(None), (1e-3, 0, 0))
    whole = {j.index: j.pairs for j in drawing.junctions}
    for pairs in ({0: (), 2: ()}, whole, {1: (), 4: ()}, whole, {3: (), 0: ()}):
        part("operators.grease_pencil.stored_trace")._decoded.clear()
        check_rerouted(part, obj, pixel_map, pairs)


@pytest.mark.parametrize("forget", [False, True])
@pytest.mark.parametrize("touched", [False, True])
@pytest.mark.parametrize("seed", range(3))
def test_closed_strokes_that_start_elsewhere_are_found_again(bpy, part, seed, touched, forget):
    """As in a sequence, where a closed stroke starts where it did on the frame before."""
    random = np.random.default_rng(seed)
    drawing = ring_and_lines(part)
    strokes = [rolled(s, random.integers(len(s.points))) for s in drawing.strokes]
    strokes = [turned(s) if random.random() < 0.5 else s for s in strokes]
    obj, pixel_map = make(bpy, part, replace(drawing, strokes=tuple(strokes)))
    if touched:
        move(cel_of(obj), slice(None), (1e-3, 0, 0))
    before = [(points.copy(), closed) for points, closed in strokes_in(part, obj, pixel_map)]
    whole = {j.index: j.pairs for j in drawing.junctions}
    for number in range(10):
        if forget:  # as after saving and opening again
            part("operators.grease_pencil.stored_trace")._decoded.clear()
        junction = drawing.junctions[random.integers(len(drawing.junctions))]
        pairs = junction.alternatives[random.integers(len(junction.alternatives))].pairs
        wanted = whole if number % 3 == 2 else {junction.index: pairs}
        found = check_rerouted(part, obj, pixel_map, wanted)
        if wanted is whole and not touched:  # even the starting points are the old ones
            for points, closed in before:
                assert any(c == closed and same_points(p, points) for p, c in found)


def same_points(a, b):
    return len(a) == len(b) and np.abs(a - b).max() < 2e-3


def rolled(stroke, by):
    """The same stroke; a closed one starts that many points farther on."""
    if not stroke.closed:
        return stroke
    return replace(
        stroke,
        points=np.roll(stroke.points, -by, axis=0),
        widths=np.roll(stroke.widths, -by),
        opacity=np.roll(stroke.opacity, -by),
    )


def turned(stroke):
    """The same stroke walked the other way."""
    return replace(
        stroke,
        points=stroke.points[::-1].copy(),
        widths=stroke.widths[::-1].copy(),
        opacity=stroke.opacity[::-1].copy(),
        branches=(stroke.branches[::-1] ^ 1).copy(),
    )


def apart(points, stroke, closed):
    """The largest distance between a Grease Pencil stroke and an engine stroke, px."""
    if closed != stroke.closed:
        return np.inf

    def dense(p):
        p = np.concatenate([p, p[:1]]) if closed else p
        along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(p, axis=0), axis=1))])
        at = np.arange(0, along[-1], 0.5)
        return np.stack([np.interp(at, along, p[:, k]) for k in (0, 1)], 1)

    a, b = dense(points), dense(stroke.points)
    between = np.linalg.norm(a[:, None] - b[None], axis=2)
    return max(between.min(0).max(), between.min(1).max())


def test_many_junctions_change_at_once(bpy, part):
    drawing = grid(part, 4)
    obj, pixel_map = make(bpy, part, drawing)

    def shuffle(d):
        random = np.random.default_rng(4)
        for junction in d.junctions:
            d = d.reroute(junction.index, junction.alternatives[random.integers(5)].pairs)
        return d

    change(part, obj, shuffle)
    assert_same(strokes_in(part, obj, pixel_map), drawing_of(part, obj).strokes)
    change(part, obj, lambda d: d.reroute(0, ()).ask_again())
    assert_same(strokes_in(part, obj, pixel_map), drawing_of(part, obj).strokes)


def test_strokes_elsewhere_are_left_alone(bpy, part):
    obj, _ = make(bpy, part, cross(part))
    cel = cel_of(obj)
    cel.add_strokes([4])  # drawn by hand
    curves = part("operators.grease_pencil.core.stroke_arrays")
    change(part, obj, lambda d: d.reroute(0, ()))
    after = curves_of(part, obj)
    assert len(after) == 6  # two lines became four; circle and hand-drawn stroke
    assert np.count_nonzero(after.curve(curves.TRACE) == 0) == 1
    assert after.sizes[-1] == 4


def test_moved_points_and_looks_survive_split_and_join(bpy, part):
    drawing = cross(part)
    obj, pixel_map = make(bpy, part, drawing)
    cel = cel_of(obj)
    curves = curves_of(part, obj)
    part("operators.grease_pencil.cels").set_column(cel, "material_index", np.array([0, 3, 0]))
    shifted = curves.offsets[1] + 2
    move(cel, shifted, (0.0, 0.25, 0.1))
    radius = curves.point("radius").astype(np.float32)
    radius[shifted] = 0.5
    cel.attributes["radius"].data.foreach_set("value", radius)
    kept = curves_of(part, obj).point("position")[shifted]

    def has_the_point():
        now = curves_of(part, obj)
        near = np.flatnonzero(np.abs(now.point("position") - kept).max(1) < 1e-6)
        assert len(near) == 1
        assert now.point("radius")[near[0]] == pytest.approx(0.5)
        stroke = np.searchsorted(now.offsets, near[0], "right") - 1
        assert now.curve("material_index")[stroke] == 3

    pairs = drawing.junctions[0].pairs
    change(part, obj, lambda d: d.reroute(0, ()))
    assert len(curves_of(part, obj)) == 5
    has_the_point()
    change(part, obj, lambda d: d.reroute(0, pairs))
    assert len(curves_of(part, obj)) == 3
    has_the_point()
    for points, closed in strokes_in(part, obj, pixel_map):
        if not closed:  # whole lines again: nothing doubled, nothing lost
            assert np.linalg.norm(points[0] - points[-1]) > 250
            assert (np.linalg.norm(np.diff(points, axis=0), axis=1) > 0).all()


def test_vertex_weights_survive_split_and_join(bpy, part):
    """Painted weights follow their points, also on a hidden layer and beside a second group."""
    drawing = cross(part)
    obj, _ = make(bpy, part, drawing)
    cel, curves = cel_of(obj), curves_of(part, obj)
    shade = (curves.point("position")[:, 0] / 3 + 0.4).astype(np.float32)  # 0.0 .. 0.9
    for name, weights in (("Arm", shade), ("Tip", np.where(shade > 0.6, 0.5, 0.0))):
        obj.vertex_groups.new(name=name)
        inside = np.flatnonzero(weights > 0)
        cel.set_vertex_weights(
            vertex_group_name=name,
            indices=inside.tolist(),
            weights=weights[inside].tolist(),
            assign_mode="REPLACE",
        )
    obj.data.layers["Black"].hide = True
    before = [len(kind) for kind in (bpy.data.scenes, bpy.data.objects, bpy.data.node_groups)]

    def check(count):
        gp = part("operators.grease_pencil.cels")
        cels = [gp.read(cel) for _, cel in gp.cels_at(obj.data, 1)]
        (now,) = part("operators.grease_pencil.vertex_weights").with_weights(obj.data, 1, cels)
        assert len(now) == count
        places = now.point("position")[:, 0] / 3 + 0.4
        np.testing.assert_allclose(now.point("vertex group Arm"), places, atol=2e-3)
        tip = now.point("vertex group Tip")
        assert tip[places > 0.7].min() == pytest.approx(0.5)
        assert tip[places < 0.5].max() == 0

    check(3)
    change(part, obj, lambda d: d.reroute(0, ()))
    check(5)
    change(part, obj, lambda d: d.reroute(0, drawing.junctions[0].pairs))
    check(3)
    after = [len(kind) for kind in (bpy.data.scenes, bpy.data.objects, bpy.data.node_groups)]
    assert after == before


def test_subdivided_strokes_split_where_the_junction_was(bpy, part):
    drawing = cross(part)
    obj, pixel_map = make(bpy, part, drawing)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.grease_pencil.select_all(action="SELECT")
    bpy.ops.grease_pencil.stroke_subdivide(number_cuts=2)
    bpy.ops.object.mode_set(mode="OBJECT")
    before = len(curves_of(part, obj).point("radius"))
    change(part, obj, lambda d: d.reroute(0, ()))
    junction = np.array(drawing.junctions[0].position)
    ends = [p[[0, -1]] for p, closed in strokes_in(part, obj, pixel_map) if not closed]
    assert len(ends) == 4
    assert all(np.linalg.norm(e - junction, axis=1).min() < 0.5 for e in ends)
    assert abs(len(curves_of(part, obj).point("radius")) - before) <= 4


def test_deleted_points_stay_deleted(bpy, part):
    drawing = cross(part)
    obj, pixel_map = make(bpy, part, drawing)
    cel, curves = cel_of(obj), curves_of(part, obj)
    # The first line loses its last third.
    keep = [int(curves.sizes[0] * 2 / 3), *curves.sizes[1:].tolist()]
    cel.resize_strokes(sizes=keep)
    length = np.linalg.norm(np.diff(strokes_in(part, obj, pixel_map)[0][0][[0, -1]], axis=0))
    change(part, obj, lambda d: d.reroute(0, ()))
    pairs = drawing.junctions[0].pairs
    change(part, obj, lambda d: d.reroute(0, pairs))
    found = strokes_in(part, obj, pixel_map)
    assert len(found) == 3
    lengths = [np.linalg.norm(p[0] - p[-1]) for p, closed in found if not closed]
    assert min(abs(v - length) for v in lengths) < 1.0


def test_deleted_stroke_leaves_the_others(bpy, part):
    drawing = cross(part)
    obj, _ = make(bpy, part, drawing)
    cel_of(obj).remove_strokes(indices=[0])
    change(part, obj, lambda d: d.reroute(0, ()))
    assert len(curves_of(part, obj)) == 3
    change(part, obj, lambda d: d.reroute(0, drawing.junctions[0].pairs))
    assert len(curves_of(part, obj)) == 2


def test_scrambled_stroke_is_refused_and_nothing_changes(bpy, part):
    drawing = cross(part)
    obj, _ = make(bpy, part, drawing)
    cel, curves = cel_of(obj), part("operators.grease_pencil.core.stroke_arrays")
    attribute = cel.attributes[curves.ALONG]
    along = np.zeros(len(attribute.data), np.float32)
    attribute.data.foreach_get("value", along)
    along[1:6] = along[[4, 1, 5, 2, 3]]
    attribute.data.foreach_set("value", along)
    before, stamp = (
        curves_of(part, obj),
        part("operators.grease_pencil.state")
        .load(obj.data, part("operators.grease_pencil.state").keys_at(obj.data, 1)[0])
        .stamp,
    )
    with pytest.raises(part("engine").InvoluteError, match="can't be told"):
        change(part, obj, lambda d: d.reroute(0, ()))
    after = curves_of(part, obj)
    np.testing.assert_array_equal(after.point("position"), before.point("position"))
    state = part("operators.grease_pencil.state")
    assert state.load(obj.data, state.keys_at(obj.data, 1)[0]).stamp == stamp


def test_bezier_strokes_split_on_the_curve(bpy, part):
    drawing = cross(part)
    drawing = replace(drawing, strokes=tuple(map(with_handles, drawing.strokes)))
    obj, _ = make(bpy, part, drawing)
    move(cel_of(obj), [1], (0, 0.1, 0))
    change(part, obj, lambda d: d.reroute(0, ()))
    curves = curves_of(part, obj)
    assert len(curves) == 5
    assert np.count_nonzero(curves.curve("curve_type") == 2) >= 3  # the others are the engine's


def test_copied_keyframes_go_their_own_ways(bpy, part):
    drawing = cross(part)
    obj, pixel_map = make(bpy, part, drawing)
    layer = obj.data.layers["Black"]
    layer.frames.copy(1, 9)
    change(part, obj, lambda d: d.reroute(0, ()), frame=9)
    assert len(drawing_of(part, obj, 9).strokes) == 5
    assert_same(strokes_in(part, obj, pixel_map, 9), drawing_of(part, obj, 9).strokes)
    assert_same(strokes_in(part, obj, pixel_map, 1), drawing_of(part, obj, 1).strokes)
    assert_same(strokes_in(part, obj, pixel_map, 1), drawing.strokes)


def test_undo_and_redo_ten_steps(bpy, part):
    drawing = grid(part, 3)
    obj, pixel_map = make(bpy, part, drawing)
    name = obj.name
    bpy.ops.ed.undo_push(message="start")
    counts = [len(drawing.strokes)]
    for step in range(10):
        junction = drawing.junctions[step % len(drawing.junctions)]
        pairs = junction.alternatives[1 + step % 3].pairs
        change(part, bpy.data.objects[name], lambda d, j=junction.index, p=pairs: d.reroute(j, p))
        bpy.ops.ed.undo_push(message=f"reroute {step}")
        counts.append(len(drawing_of(part, bpy.data.objects[name]).strokes))

    def check(count):
        obj = bpy.data.objects[name]
        assert len(drawing_of(part, obj).strokes) == count
        assert_same(strokes_in(part, obj, pixel_map), drawing_of(part, obj).strokes)

    for count in counts[-2::-1]:
        bpy.ops.ed.undo()
        check(count)
    for count in counts[1:]:
        bpy.ops.ed.redo()
        check(count)


def test_save_reopen_append_duplicate(bpy, part, tmp_path):
    drawing = grid(part, 3)
    obj, pixel_map = make(bpy, part, drawing)
    change(part, obj, lambda d: d.reroute(0, ()))
    copy = obj.copy()
    copy.data = obj.data.copy()
    bpy.context.scene.collection.objects.link(copy)
    change(part, copy, lambda d: d.reroute(1, ()))
    assert len(drawing_of(part, obj).strokes) + 2 == len(drawing_of(part, copy).strokes)
    path = str(tmp_path / "saved.blend")
    names = obj.name, copy.name
    bpy.ops.wm.save_as_mainfile(filepath=path)

    def check():
        for name in names:
            found = bpy.data.objects[name]
            part("operators.grease_pencil.stored_trace")._decoded.clear()
            change(part, found, lambda d: d.reroute(4, ()))
            assert_same(strokes_in(part, found, pixel_map), drawing_of(part, found).strokes)

    bpy.ops.wm.open_mainfile(filepath=path)
    check()
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    with bpy.data.libraries.load(path) as (_, into):
        into.objects = list(names)
    for found in into.objects:
        bpy.context.scene.collection.objects.link(found)
    check()
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    with bpy.data.libraries.load(path, link=True) as (_, into):
        into.objects = list(names)
    with pytest.raises(part("engine").InvoluteError, match="linked"):
        change(part, into.objects[0], lambda d: d.reroute(4, ()))


def test_five_hundred_strokes_reroute_at_once(bpy, part):
    drawing = grid(part, 20)
    for junction in drawing.junctions[::2][:120]:
        drawing = drawing.reroute(junction.index, ())
    obj, _ = make(bpy, part, drawing)
    assert len(drawing.strokes) > 250
    change(part, obj, lambda d: d.reroute(1, ()))
    start = time.process_time()
    change(part, obj, lambda d: d.reroute(3, ()))
    print(f"reroute among {len(drawing.strokes)}: {time.process_time() - start:.4f} s of CPU")
