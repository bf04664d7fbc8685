"""The overlay is drawn, and a redraw without change makes nothing anew."""

from __future__ import annotations

import numpy as np
import pytest

from .example_drawings import grid
from .test_grease_pencil import make

_SIZE = 640, 480


@pytest.fixture
def draw(bpy, part):
    """Draw the overlay of the scene from the front; gives (H, W, 4) uint8."""
    if bpy.app.version < (5, 2, 0):
        pytest.skip("this Blender draws in windows only")
    import gpu

    try:
        gpu.init()
    except (RuntimeError, SystemError) as problem:
        pytest.skip(f"no OpenGL here: {problem}")
    overlay = part("ui.overlay.overlay")
    area = next(a for a in bpy.context.screen.areas if a.type == "VIEW_3D")
    region = next(r for r in area.regions if r.type == "WINDOW")
    surface = gpu.types.GPUOffScreen(*_SIZE)

    def run() -> np.ndarray:
        with bpy.context.temp_override(area=area, region=region), surface.bind():
            view = area.spaces.active.region_3d
            frame = gpu.state.active_framebuffer_get()
            frame.clear(color=(0.0, 0.0, 0.0, 0.0))
            with gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
                gpu.matrix.load_matrix(view.view_matrix)
                gpu.matrix.load_projection_matrix(view.window_matrix)
                overlay.draw_rings_and_routes()
            overlay.draw_labels()
            pixels = frame.read_color(0, 0, *_SIZE, 4, 0, "UBYTE")
            pixels.dimensions = _SIZE[0] * _SIZE[1] * 4
            return np.array(pixels, np.uint8).reshape(_SIZE[1], _SIZE[0], 4)

    yield run
    surface.free()


def test_a_redraw_without_change_makes_nothing(bpy, part, draw):
    obj, _ = make(bpy, part, grid(part, 3))
    bpy.context.view_layer.objects.active = obj
    bpy.ops.involute.step_junction(direction="NEXT")
    bpy.context.window_manager.involute_view.doubtful_only = False
    bpy.ops.involute.step_junction(direction="NEXT")
    view = bpy.context.window_manager.involute_view
    view.choosing = True
    kept = part("ui.overlay.drawn_batches")._kept
    kept.clear()
    first = draw()
    assert first[..., 3].any()
    made = dict(kept)
    assert {key[0] for key in made} == {"rings", "routes", "letters", "disc", "cards"}
    np.testing.assert_array_equal(draw(), first)
    assert {key: id(value) for key, value in kept.items()} == {k: id(v) for k, v in made.items()}
    view.preview = 1
    draw()
    assert len(kept) == len(made) + 2  # the lines and the cards with the one that is pointed at
    view.show_overlay = False
    assert not draw()[..., 3].any()


def test_a_part_is_drawn_and_goes(bpy, part, draw, tmp_path):
    """Also where the junction overlay is off; and nothing is made anew in a redraw."""
    part("engine.scan")  # brings OpenCV
    import cv2

    paper = np.full((120, 160), 245, np.uint8)
    cv2.line(paper, (10, 60), (150, 60), 20, 4, cv2.LINE_AA)
    cv2.circle(paper, (80, 90), 20, 20, cv2.FILLED)
    cv2.imwrite(str(tmp_path / "page.png"), paper)
    empty = bpy.data.objects.new("Reference", None)
    empty.empty_display_type, empty.data = (
        "IMAGE",
        bpy.data.images.load(str(tmp_path / "page.png")),
    )
    bpy.context.collection.objects.link(empty)
    bpy.context.view_layer.objects.active = empty
    bpy.context.window_manager.involute_view.show_overlay = False
    assert not draw()[..., 3].any()
    try:
        assert bpy.ops.involute.try_part(box=(0, 0, 160, 120)) == {"FINISHED"}
        kept = part("ui.overlay.drawn_batches")._kept
        kept.clear()
        first = draw()
        seen = first[first[..., 3] > 0].astype(int)
        assert (np.ptp(seen[:, :3], axis=1) > 60).any()  # a stroke in its color
        (made,) = kept.values()
        np.testing.assert_array_equal(draw(), first)
        assert [id(one) for one in kept.values()] == [id(made)]
        bpy.ops.involute.drop_part()
        assert not draw()[..., 3].any()
    finally:
        bpy.context.window_manager.involute_view.show_overlay = True
        part("operators.tracing.part").show(None)
