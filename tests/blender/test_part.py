"""Settings are tried on a part of a page: it is seen over the scan, and nothing of it is kept."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest


@pytest.fixture
def scan(part, tmp_path) -> Path:
    """A cross in the left half, a line with a small one beside it in the right half."""
    part("engine.scan")  # brings OpenCV
    import cv2

    paper = np.full((200, 400), 245, np.uint8)
    cv2.line(paper, (20, 30), (180, 170), 20, 3, cv2.LINE_AA)
    cv2.line(paper, (20, 170), (180, 30), 20, 3, cv2.LINE_AA)
    cv2.line(paper, (230, 60), (380, 60), 20, 3, cv2.LINE_AA)
    cv2.line(paper, (290, 100), (305, 100), 20, 3, cv2.LINE_AA)
    cv2.imwrite(str(tmp_path / "page.png"), paper)
    return tmp_path / "page.png"


@pytest.fixture
def empty(bpy, scan):
    """An image Empty, as an artist puts a reference into the scene."""
    obj = bpy.data.objects.new("Reference", None)
    obj.empty_display_type = "IMAGE"
    obj.data = bpy.data.images.load(str(scan))
    bpy.context.collection.objects.link(obj)
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    bpy.context.view_layer.update()
    return obj


@pytest.fixture
def parts(bpy, part):
    module = part("operators.tracing.part")
    module.show(None)
    yield module
    module.show(None)


RIGHT = (210, 20, 400, 140)


def names(bpy) -> set[str]:
    """Everything in the file, but for what Blender makes by itself."""
    kinds = ("objects", "images", "materials", "collections", "texts")
    gp = "grease_pencils_v3" if hasattr(bpy.data, "grease_pencils_v3") else "grease_pencils"
    return {f"{kind} {one.name}" for kind in (*kinds, gp) for one in getattr(bpy.data, kind)}


def test_a_part_of_an_image_empty(bpy, parts, empty):
    before, settings = names(bpy), bpy.context.scene.involute
    assert bpy.ops.involute.try_part(box=RIGHT) == {"FINISHED"}
    shown = parts.current()
    assert (shown.box, shown.around) == (RIGHT, (186, 0, 400, 164))
    lengths = sorted(np.linalg.norm(s.points[-1] - s.points[0]) for s in shown.drawing.strokes)
    assert lengths[-1] == pytest.approx(150, abs=4)  # the margin of the left half is in there, too
    longest = max(shown.drawing.strokes, key=lambda s: np.ptp(s.points[:, 0]))
    np.testing.assert_allclose(longest.points[:, 1] + shown.around[1], 60, atol=1.0)
    assert names(bpy) == before
    # A setting is changed: the same part, without being asked for its place again.
    settings.min_length = 8.0
    assert bpy.ops.involute.try_part() == {"FINISHED"}
    changed = parts.current()
    assert changed.crop is shown.crop
    assert len(changed.drawing.strokes) < len(shown.drawing.strokes)
    assert changed.drawing.settings.min_length == 8.0
    assert bpy.ops.involute.drop_part() == {"FINISHED"}
    assert parts.current() is None
    assert names(bpy) == before
    with pytest.raises(RuntimeError, match="Drag a box"):
        bpy.ops.involute.try_part()


def test_a_part_of_a_traced_drawing_and_of_pixels_in_memory(bpy, parts, scan):
    bpy.ops.involute.trace(filepath=str(scan), place="FRONT")
    obj = bpy.context.active_object
    assert parts.page_of(bpy.context).name == obj.name
    assert bpy.ops.involute.try_part(box=RIGHT) == {"FINISHED"}
    of_file = parts.current().drawing
    image = bpy.data.images.new("painted", 64, 48, alpha=True)
    pixels = np.ones((48, 64, 4), np.float32)
    pixels[20:23, 8:56, :3] = 0.0  # rows from the bottom
    image.pixels.foreach_set(pixels.ravel())
    painted = bpy.data.objects.new("Painted", None)
    painted.empty_display_type, painted.data = "IMAGE", image
    bpy.context.collection.objects.link(painted)
    bpy.context.view_layer.objects.active = painted
    assert bpy.ops.involute.try_part(box=(0, 0, 64, 48)) == {"FINISHED"}
    (line,) = parts.current().drawing.strokes
    np.testing.assert_allclose(line.points[:, 1], 48 - 21.5, atol=0.7)
    assert len(of_file.strokes) >= 2


def test_it_goes_when_the_page_is_traced(bpy, parts, empty):
    bpy.ops.involute.try_part(box=RIGHT)
    bpy.ops.involute.trace()
    assert parts.current() is None
    bpy.ops.involute.try_part(box=RIGHT)
    bpy.ops.involute.trace_again(smoothing=0.9)
    assert parts.current() is None


def test_it_goes_with_its_object(bpy, parts, empty):
    bpy.ops.involute.try_part(box=RIGHT)
    empty.hide_set(True)
    assert parts.current() is None
    empty.hide_set(False)
    assert parts.current() is not None
    bpy.data.objects.remove(empty)
    assert parts.current() is None
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    assert parts.shown is None


def test_it_is_seen_where_its_picture_is(bpy, parts, empty, scan):
    """Not over another frame of what plays, nor over another keyframe."""
    bpy.ops.involute.try_part(box=RIGHT)
    bpy.context.scene.frame_set(5)
    assert parts.current() is not None  # a still picture is the same at every frame
    lies = parts.page_of(bpy.context).pixel_map
    page = parts.Page(empty.name, (400, 200), lies, frame=5)  # of what plays
    assert page.is_seen
    bpy.context.scene.frame_set(6)
    assert not page.is_seen
    bpy.ops.involute.trace(filepath=str(scan))
    bpy.ops.involute.try_part(box=RIGHT)
    assert parts.current() is not None
    bpy.context.scene.frame_set(2)  # before the keyframe
    assert parts.current() is None
    with pytest.raises(RuntimeError, match="Drag a box"):
        bpy.ops.involute.try_part()


def test_what_is_kept_lies_where_it_was_shown(bpy, part, parts, empty):
    empty.location, empty.rotation_euler = (1.0, 2.0, 3.0), (0.3, 0.2, 0.1)
    bpy.context.view_layer.update()
    bpy.ops.involute.try_part(box=RIGHT)
    assert bpy.ops.involute.keep_part() == {"FINISHED"}
    kept = bpy.context.active_object
    bpy.context.view_layer.objects.active = empty
    bpy.ops.involute.trace()  # the whole page, on its Empty
    whole = bpy.context.active_object
    bpy.context.view_layer.update()
    gp = part("operators.grease_pencil.cels")

    def places(obj):
        cels = [cel for _, cel in gp.cels_at(obj.data, 1)]
        found = np.concatenate([gp.read(cel).point("position") for cel in cels])
        matrix = np.array(obj.matrix_world)
        return found @ matrix[:3, :3].T + matrix[:3, 3]

    pixel = float(empty.empty_display_size) / 400  # of the longer side
    away = np.linalg.norm(places(kept)[:, None] - places(whole)[None], axis=2).min(1)
    assert np.median(away) < 2 * pixel  # what the margin cuts off ends elsewhere


def test_what_cannot_be_tried_is_said(bpy, part, parts, empty, tmp_path):
    with pytest.raises(RuntimeError, match="Drag a box"):
        bpy.ops.involute.try_part(box=(500, 10, 600, 90))
    assert parts.current() is None
    page = parts.page_of(bpy.context)
    other = parts.Part(parts.Page(page.name, (300, 200), page.pixel_map), RIGHT)
    error = part("engine").InvoluteError
    with pytest.raises(error, match="as large as"):
        other.read(page.source())
    with pytest.raises(error, match="SVG"):
        other.read(part("operators.tracing.sources").Source("page", "page.svg"))
    bpy.context.view_layer.objects.active = None
    assert not bpy.ops.involute.choose_part.poll()


def test_pieces_end_at_the_border(part):
    shapes = part("ui.overlay.part_shapes")
    line = np.array([(-10.0, 5.0), (30.0, 5.0), (30.0, 40.0)])
    sides = np.array([(0.0, 1.0), (0.0, 3.0), (1.0, 0.0)])
    low, high = np.array((0.0, 0.0)), np.array((20.0, 20.0))
    pieces, along = shapes.clipped(line, sides, low, high)
    np.testing.assert_allclose(pieces, [[(0, 5), (20, 5)]])
    np.testing.assert_allclose(along, [[(0, 1.5), (0, 2.5)]])
    square = np.array([(-10, -10), (10, -10), (10, 10), (-10, 10)], np.float32)
    np.testing.assert_allclose(
        sorted(shapes.cut_off(square, (0, 0, 20, 20)).tolist()),
        [(0, 0), (0, 10), (10, 0), (10, 10)],
    )
    assert len(shapes.cut_off(square, (50, 50, 60, 60))) == 0
