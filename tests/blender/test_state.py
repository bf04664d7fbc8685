"""What a data-block remembers of its traces: damaged, undone, joined, separated, it never lies.

Whatever happens, strokes stay; what no longer fits becomes one sentence.
"""

from __future__ import annotations

import contextlib
import secrets
import zlib

import numpy as np
import pytest

from .example_drawings import cross, grid
from .test_grease_pencil import curves_of, make
from .test_splicing import assert_same, cel_of, drawing_of, strokes_in


@pytest.fixture
def traced(bpy, part):
    """An active object with nine crossings, three of them rerouted."""
    obj, pixel_map = make(bpy, part, grid(part, 3))
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    for junction in (0, 4, 7):
        bpy.ops.involute.reroute(junction=junction, alternative=1)
    return obj, pixel_map


@pytest.fixture
def forget(part):
    """As after opening the file."""

    def run():
        part("operators.grease_pencil.stored_trace")._decoded.clear()
        part("operators.view.junction_table")._tables.clear()

    return run


def entry_of(obj):
    return next(iter(obj.data["involute"]["traces"].values()))


def put(entry, name, value):
    """Blender cuts bytes off at the first zero where they take the place of others."""
    if name in entry:
        del entry[name]
    entry[name] = value


DAMAGED = 80  # states in a run

# --- damage --------------------------------------------------------------------------------------


def no_involution(entry):
    raw = zlib.decompress(bytes(entry["routing"]))
    partner = np.frombuffer(raw, "<i4", 2 * 24).copy()
    partner[:6] = [2, 4, 0, 1, 5, 3]
    put(entry, "routing", zlib.compress(partner.tobytes() + raw[4 * 48 :]))


def rehashed(damage):
    """The same damage with a stamp that fits: as a program would write it that means it."""

    def run(entry):
        from hashlib import blake2b

        damage(entry)
        stamp = blake2b(entry["base"].encode() + bytes(entry["routing"]), digest_size=16)
        put(entry, "stamp", stamp.hexdigest())

    return run


def cut_short(name):
    return lambda entry: put(entry, name, bytes(entry[name])[: len(entry[name]) // 2])


def other(name, value):
    return lambda entry: put(entry, name, value)


def without(name):
    def run(entry):
        del entry[name]

    return run


DAMAGES = {
    "no involution": no_involution,
    "no involution, meant": rehashed(no_involution),
    "routing of another size": rehashed(other("routing", zlib.compress(b"\0" * 999))),
    "routing of no size": rehashed(other("routing", zlib.compress(b"\0" * 3))),
    "routing that swells": rehashed(other("routing", zlib.compress(b"\0" * 10_000_000))),
    "drawing cut short": cut_short("drawing"),
    "routing cut short": cut_short("routing"),
    "placement of NaN": other("placement", [float("nan")] * 9),
    "placement of zeros": other("placement", [0.0] * 9),
    "placement too short": other("placement", [1.0, 2.0]),
    **{f"no {n}": without(n) for n in ("drawing", "base", "stamp", "placement", "source")},
    **{f"a number as {n}": other(n, 5) for n in ("drawing", "routing", "stamp", "source")},
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_damaged_state_is_one_sentence(bpy, part, traced, forget, damage):
    obj, pixel_map = traced
    before = strokes_in(part, obj, pixel_map)
    mark = cel_of(obj).attributes[".involute_routing"]
    mark.data.foreach_set("value", np.zeros(len(mark.data), np.int32))
    for name in ("unmarked", "earlier"):
        del entry_of(obj)[name]
    DAMAGES[damage](entry_of(obj))
    forget()
    assert not bpy.ops.involute.reroute.poll()
    with pytest.raises(part("engine").InvoluteError, match="no junctions any more"):
        part("operators.view.view_state").shown_in(bpy.context)
    assert list(part("operators.view.view_state").traced_in(bpy.context)) == []
    assert not bpy.types.INVOLUTE_PT_junctions.poll(bpy.context)
    assert bpy.types.INVOLUTE_PT_summary.poll(bpy.context)
    for (points, _), (old, _) in zip(strokes_in(part, obj, pixel_map), before, strict=True):
        np.testing.assert_array_equal(points, old)


@pytest.mark.parametrize("name", ["unmarked", "earlier", "path", "page", "image", "doubtful"])
@pytest.mark.parametrize("odd", [7, -1.5, "text", b"\1", [1, 2], {"a": 5}], ids=repr)
def test_what_only_helps_may_be_damaged(bpy, part, traced, forget, name, odd):
    """Junctions are decided as ever, whatever became of the picture's name or of earlier ways."""
    obj, pixel_map = traced
    put(entry_of(obj), name, odd)
    forget()
    shown_in = part("operators.view.view_state").shown_in
    ways = shown_in(bpy.context).trace.drawing.junctions[0].alternatives
    for alternative in (1, 0):
        assert bpy.ops.involute.reroute(junction=0, alternative=alternative) == {"FINISHED"}
        forget()
        drawing = shown_in(bpy.context).trace.drawing
        assert drawing.junctions[0].pairs == ways[alternative].pairs
        assert len(strokes_in(part, obj, pixel_map)) == len(drawing.strokes)
    assert bpy.ops.involute.lock(junction=0) == {"FINISHED"}


def test_state_that_is_damaged_anyhow_loses_no_stroke(bpy, part, traced, forget):
    """Bytes and numbers of what is kept, changed at random: in words, or as if nothing were."""
    seed = secrets.randbits(32)
    print(f"seed {seed}")
    random = np.random.default_rng(seed)
    obj, pixel_map = traced
    kept = {name: as_plain(value) for name, value in entry_of(obj).items() if name != "earlier"}
    before = strokes_in(part, obj, pixel_map)
    view_state = part("operators.view.view_state")
    for count in range(DAMAGED):
        name = sorted(kept)[int(random.integers(len(kept)))]
        put(entry_of(obj), name, spoilt(kept[name], random))
        forget()
        try:
            if bpy.types.INVOLUTE_PT_junctions.poll(bpy.context):
                view_state.shown_in(bpy.context)
            list(view_state.traced_in(bpy.context))
            bpy.ops.involute.reroute.poll()
            bpy.types.INVOLUTE_PT_summary.poll(bpy.context)
        except Exception as error:
            raise AssertionError(f"seed {seed}, {count}: {name}") from error
        put(entry_of(obj), name, kept[name])
    forget()
    assert bpy.ops.involute.reroute.poll()
    for (points, _), (old, _) in zip(strokes_in(part, obj, pixel_map), before, strict=True):
        np.testing.assert_array_equal(points, old)


def as_plain(value):
    """A property as it can be written again."""
    return (
        value.to_dict()
        if hasattr(value, "to_dict")
        else (value.to_list() if hasattr(value, "to_list") else value)
    )


def spoilt(value, random):
    """A value of a property with something wrong in it."""
    if isinstance(value, bytes) and random.random() < 0.9:
        found = bytearray(value)
        at = int(random.integers(len(found)))
        if random.random() < 0.3:
            return bytes(found[:at])
        found[at : at + 3] = random.bytes(3)
        return bytes(found)
    if isinstance(value, list) and value and random.random() < 0.8:
        found = list(value)
        found[int(random.integers(len(found)))] = float(random.choice([np.nan, np.inf, 0.0, 1e30]))
        return found
    return [b"\1", 7, -1, 2.5, "text", "", [1, 2], {"a": 1}][int(random.integers(8))]


@pytest.mark.parametrize(
    "root", [1, 2.5, "text", [1, 2], {"a": 1}, {"version": 1, "traces": 5}, {"version": "x"}]
)
def test_a_damaged_property_takes_a_new_trace(bpy, part, traced, forget, root):
    obj, pixel_map = traced
    del obj.data["involute"]
    obj.data["involute"] = root
    forget()
    assert not bpy.ops.involute.lock.poll()
    state = part("operators.grease_pencil.state")
    key = state.add(obj.data, cross(part), pixel_map, "again")
    assert len(state.load(obj.data, key).drawing.junctions) == 1


@pytest.mark.parametrize("name", [".involute_trace", ".involute_half", ".involute_along"])
@pytest.mark.parametrize("how", ["gone", "float", "shuffled", "one", "odd"])
def test_damaged_marks_lose_no_stroke(bpy, part, traced, name, how):
    """Refused or done, the lines are as long afterwards."""
    obj, pixel_map = traced
    cel = cel_of(obj)
    attribute = cel.attributes[name]
    kind, domain, count = attribute.data_type, attribute.domain, len(attribute.data)
    values = np.zeros(count, np.float32 if kind == "FLOAT" else np.int32)
    attribute.data.foreach_get("value", values)
    random = np.random.default_rng(3)
    if how in ("gone", "float"):
        cel.attributes.remove(attribute)
        if how == "float":
            cel.attributes.new(name, "FLOAT_VECTOR", domain)
    else:
        if how == "shuffled":
            values = random.permutation(values)
        elif how == "one":
            values[:] = values[0]
        else:
            values[::3] = np.nan if kind == "FLOAT" else -(2**31)
        attribute.data.foreach_set("value", values)
    before = whole_length(part, obj, pixel_map)
    for junction in range(9):
        with contextlib.suppress(RuntimeError):  # refused in words
            bpy.ops.involute.reroute(junction=junction, alternative=3)
        assert whole_length(part, obj, pixel_map) > before - 3 * 4 * (junction + 1)


def whole_length(part, obj, pixel_map):
    lines = [points for points, _ in strokes_in(part, obj, pixel_map)]
    return sum(np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in lines)


# --- undo ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("mode", ["OBJECT", "EDIT", "PAINT_GREASE_PENCIL", "SCULPT_GREASE_PENCIL"])
def test_undo_takes_routing_and_strokes_back(bpy, part, traced, mode):
    obj, pixel_map = traced
    name = obj.name
    bpy.ops.object.mode_set(mode=mode)
    bpy.ops.ed.undo_push(message="start")
    start = drawing_of(part, obj).routing
    for junction, alternative in ((1, 1), (2, 2)):
        bpy.ops.involute.reroute(junction=junction, alternative=alternative)
        bpy.ops.ed.undo_push(message="reroute")
    bpy.ops.involute.lock(junction=5)
    bpy.ops.ed.undo_push(message="lock")

    def now():
        found = bpy.data.objects[name]
        drawing = drawing_of(part, found, frame=1)
        assert_same(strokes_in(part, found, pixel_map), drawing.strokes)
        return drawing

    assert now().junctions[5].locked
    bpy.ops.ed.undo()
    assert not now().junctions[5].locked
    assert now().junctions[2].locked
    bpy.ops.ed.undo()
    assert not now().junctions[2].locked
    assert now().junctions[1].locked
    bpy.ops.ed.undo()
    np.testing.assert_array_equal(now().routing.partner, start.partner)
    np.testing.assert_array_equal(now().routing.locked, start.locked)
    bpy.ops.ed.redo()
    assert now().junctions[1].locked
    bpy.ops.involute.reroute(junction=1, alternative=0)  # goes on from where undo has led
    assert now().junctions[1].pairs == now().junctions[1].alternatives[0].pairs
    assert not now().junctions[2].locked


@pytest.mark.parametrize("saved", [False, True])
def test_undo_back_into_edit_mode_brings_strokes_without_their_properties(
    bpy, part, traced, forget, tmp_path, saved
):
    """Blender loads the file of when Edit Mode was entered, and strokes of a later step."""
    obj, pixel_map = traced
    name = obj.name
    bpy.ops.ed.undo_push(message="start")
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.ed.undo_push(message="Toggle Edit Mode")
    bpy.ops.involute.reroute(junction=1, alternative=1)
    bpy.ops.ed.undo_push(message="reroute")
    wanted = drawing_of(part, obj, frame=1).routing.partner
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.ops.ed.undo_push(message="Toggle Edit Mode")
    bpy.data.objects[name].location.x += 1
    bpy.ops.ed.undo_push(message="Move")
    bpy.ops.ed.undo()
    bpy.ops.ed.undo()
    if saved:
        path = str(tmp_path / "undone.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.open_mainfile(filepath=path, load_ui=False)
        forget()
    obj = bpy.data.objects[name]
    drawing = drawing_of(part, obj, frame=1)
    np.testing.assert_array_equal(drawing.routing.partner, wanted)
    assert_same(strokes_in(part, obj, pixel_map), drawing.strokes)
    bpy.context.view_layer.objects.active = obj
    bpy.ops.involute.lock(junction=2)  # and it can be worked on
    assert drawing_of(part, obj, frame=1).junctions[2].locked


def test_undo_of_another_trace_in_edit_mode(bpy, part, traced):
    """What was stored of the trace before went with it; its strokes come back."""
    obj, pixel_map = traced
    name = obj.name
    state = part("operators.grease_pencil.state")
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.ed.undo_push(message="start")
    (key,) = state.keys_at(obj.data, 1)
    before = drawing_of(part, obj, frame=1)
    settings = part("engine").Settings(
        **{**before.settings.as_dict(), "smoothing": 0.9, "align": ()}
    )
    new = before.restroked(settings)
    part("operators.grease_pencil.retracing").retrace(obj.data, 1, key, new)
    bpy.ops.ed.undo_push(message="Trace Again")
    bpy.ops.ed.undo()
    obj = bpy.data.objects[name]
    assert state.keys_at(obj.data, 1) == [key]
    assert_same(strokes_in(part, obj, pixel_map), drawing_of(part, obj, frame=1).strokes)


def test_what_undo_took_back_is_saved(bpy, part, traced, forget, tmp_path):
    obj, pixel_map = traced
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.ed.undo_push(message="start")
    start = drawing_of(part, obj).routing.partner
    bpy.ops.involute.reroute(junction=1, alternative=1)
    bpy.ops.ed.undo_push(message="reroute")
    bpy.ops.ed.undo()
    path = str(tmp_path / "undone.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path, load_ui=False)
    forget()
    obj = bpy.data.objects["Ink"]
    np.testing.assert_array_equal(drawing_of(part, obj).routing.partner, start)
    assert_same(strokes_in(part, obj, pixel_map), drawing_of(part, obj).strokes)


@pytest.mark.parametrize(
    "root", ["text", {"version": 99, "traces": {}}, {"version": 1, "traces": 5}]
)
def test_what_cannot_be_read_is_saved_as_it_is(bpy, part, traced, forget, tmp_path, root):
    obj, pixel_map = traced
    before = strokes_in(part, obj, pixel_map)
    del obj.data["involute"]
    obj.data["involute"] = root
    forget()
    path = str(tmp_path / "odd.blend")
    assert bpy.ops.wm.save_as_mainfile(filepath=path) == {"FINISHED"}
    bpy.ops.wm.open_mainfile(filepath=path, load_ui=False)
    obj = bpy.data.objects["Ink"]
    kept = obj.data["involute"]
    assert (kept.to_dict() if hasattr(kept, "to_dict") else kept) == root
    for (points, _), (old, _) in zip(strokes_in(part, obj, pixel_map), before, strict=True):
        np.testing.assert_array_equal(points, old)


def test_what_a_stroke_still_needs_is_not_forgotten(bpy, part, traced):
    obj, _ = traced
    state = part("operators.grease_pencil.state")
    (key,) = state.keys_at(obj.data, 1)
    state.forget(obj.data, key)
    assert len(state.load(obj.data, key).drawing.junctions) == 9
    cel_of(obj).remove_strokes(indices=list(range(1, len(cel_of(obj).strokes))))
    state.forget(obj.data, key)
    assert state.load(obj.data, key).key == key
    cel_of(obj).remove_strokes()
    state.forget(obj.data, key)
    assert list(obj.data["involute"]["traces"].keys()) == []
    assert state.keys_at(obj.data, 1) == []


def test_damaged_doubts_count_as_none(bpy, part, traced, forget):
    obj, _ = traced
    state = part("operators.grease_pencil.state")
    count = entry_of(obj)["doubtful"]
    assert state.doubtful_frames(obj.data) == {1: count}
    put(entry_of(obj), "doubtful", "many")
    forget()
    assert state.doubtful_frames(obj.data) == {1: 0}
    del obj.data["involute"]
    assert state.doubtful_frames(obj.data) == {1: 0}


# --- objects that are moved, joined, separated ---------------------------------------------------


def select(bpy, *objects):
    for obj in bpy.context.view_layer.objects:
        obj.select_set(obj in objects)
    bpy.context.view_layer.objects.active = objects[0]


def shown(bpy, part):
    return part("operators.view.view_state").shown_in(bpy.context)


def reroute_and_compare(bpy, part, obj):
    """Strokes are where the drawing, mapped as the strokes say, has them; rerouted, too."""
    for alternative in (2, 0, 1):
        assert bpy.ops.involute.reroute(junction=0, alternative=alternative) == {"FINISHED"}
        found = shown(bpy, part)
        gp = part("operators.grease_pencil.cels")
        arrays = part("operators.grease_pencil.core.stroke_arrays")
        lines = []
        for _, cel in gp.cels_at(obj.data, 1):
            curves = gp.read(cel)
            points = found.pixel_map.to_pixels(curves.point("position"))
            for k in np.flatnonzero(curves.mark(arrays.TRACE) == found.trace.key):
                part_of = slice(curves.offsets[k], curves.offsets[k + 1])
                lines.append((points[part_of], bool(curves.curve("cyclic")[k])))
        assert_same(lines, found.trace.drawing.strokes)


def test_a_transform_that_is_applied_moves_junctions_along(bpy, part, traced):
    obj, _ = traced
    obj.location, obj.rotation_euler, obj.scale = (3, 1, -2), (0.3, 0.2, 1.1), (2.0, 2.0, 2.0)
    bpy.context.view_layer.update()
    before = shown(bpy, part).world_positions
    bpy.ops.object.transform_apply(location=True, rotation=True, scale=True)
    np.testing.assert_allclose(shown(bpy, part).world_positions, before, atol=1e-4)
    reroute_and_compare(bpy, part, obj)


def test_points_that_one_moves_leave_the_junctions_alone(bpy, part, traced):
    obj, _ = traced
    before = shown(bpy, part).world_positions
    places = cel_of(obj).attributes["position"]
    values = np.zeros(3 * len(places.data), np.float32)
    places.data.foreach_get("vector", values)
    values.reshape(-1, 3)[: len(values) // 9] += 0.4  # a third of all
    places.data.foreach_set("vector", values)
    np.testing.assert_array_equal(shown(bpy, part).world_positions, before)


def test_joined_objects_keep_their_junctions(bpy, part, traced, forget, tmp_path):
    first, _ = traced
    second, _ = make(bpy, part, cross(part))
    second.location, second.rotation_euler = (4, 0, 1), (0, 0, 0.5)
    select(bpy, second)
    bpy.context.view_layer.update()
    before = shown(bpy, part).world_positions
    select(bpy, first, second)
    bpy.ops.object.join()
    keys = part("operators.grease_pencil.state").keys_at(first.data, 1)
    assert len(keys) == 2
    view = bpy.context.window_manager.involute_view

    def look_at_the_smaller():
        view.key = keys[1]
        np.testing.assert_allclose(shown(bpy, part).world_positions, before, atol=1e-4)

    look_at_the_smaller()
    path = str(tmp_path / "joined.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path, load_ui=False)
    forget()
    select(bpy, bpy.data.objects["Ink"])
    look_at_the_smaller()
    view.key = keys[1]
    reroute_and_compare(bpy, part, bpy.data.objects["Ink"])


def test_copies_decided_apart_and_joined_keep_junctions(bpy, part, traced, forget):
    """Their strokes are of one trace, in two routings; either object remembers its own."""
    first, _ = traced
    bpy.ops.object.duplicate()
    second = bpy.context.active_object
    bpy.ops.involute.reroute(junction=2, alternative=1)
    bpy.ops.involute.reroute(junction=5, alternative=1)
    assert len(curves_of(part, second)) > len(curves_of(part, first))
    select(bpy, second, first)
    bpy.ops.object.join()
    forget()
    assert len(bpy.data.objects) == 1
    assert len(shown(bpy, part).trace.drawing.junctions) == 9
    assert bpy.types.INVOLUTE_PT_junctions.poll(bpy.context)
    assert bpy.ops.involute.lock(junction=1) == {"FINISHED"}


def test_separated_strokes_keep_their_junctions(bpy, part, traced, tmp_path):
    obj, _ = traced
    bpy.ops.object.mode_set(mode="EDIT")
    cel = cel_of(obj)
    chosen = np.zeros(len(curves_of(part, obj)), bool)
    chosen[:2] = True
    attribute = cel.attributes.get(".selection") or cel.attributes.new(
        ".selection", "BOOLEAN", "CURVE"
    )
    attribute.data.foreach_set("value", chosen)
    bpy.ops.grease_pencil.separate(mode="SELECTED")
    bpy.ops.object.mode_set(mode="OBJECT")
    (other,) = (o for o in bpy.data.objects if o.type == "GREASEPENCIL" and o != obj)
    select(bpy, other)
    table = shown(bpy, part).table
    assert 0 < np.isfinite(table.positions).all(axis=1).sum() < 9  # where its strokes are
    path = str(tmp_path / "separated.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    name = other.name
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    with bpy.data.libraries.load(path) as (_, into):
        into.objects = [name]
    (appended,) = into.objects
    assert part("operators.grease_pencil.state").keys_at(appended.data, 1)


# --- what can't be rerouted ----------------------------------------------------------------------


def test_locked_layers_are_left_alone(bpy, part, traced):
    obj, pixel_map = traced
    obj.data.layers["Black"].lock = True
    before = strokes_in(part, obj, pixel_map)
    with pytest.raises(RuntimeError, match="locked"):
        bpy.ops.involute.reroute(junction=1, alternative=1)
    assert not drawing_of(part, obj).junctions[1].locked
    assert len(strokes_in(part, obj, pixel_map)) == len(before)
    assert bpy.ops.involute.lock(junction=1) == {"FINISHED"}  # no stroke changes
    group = obj.data.layer_groups.new("Group")
    obj.data.layers.move_to_layer_group(obj.data.layers["Black"], group)
    obj.data.layers["Black"].lock, group.lock = False, True
    with pytest.raises(RuntimeError, match="locked"):
        bpy.ops.involute.reroute(junction=2, alternative=1)


def test_strokes_that_are_gone_are_said(bpy, part, traced):
    obj, _ = traced
    cel = cel_of(obj)
    cel.remove_strokes(indices=list(range(len(curves_of(part, obj)))))
    cel.add_strokes([3])
    column = part("operators.grease_pencil.cels").set_column
    column(cel, ".involute_trace", np.array([next(iter(map(int, obj.data["involute"]["traces"])))]))
    with pytest.raises(RuntimeError, match="joined by hand"):
        bpy.ops.involute.reroute(junction=1, alternative=1)
