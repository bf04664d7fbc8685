"""A trace that is waited for: whatever the artist or Blender does meanwhile, nothing gets stuck."""

from __future__ import annotations

import threading
from pathlib import Path

import numpy as np
import pytest

from .example_drawings import cross
from .test_grease_pencil import make
from .test_splicing import drawing_of


@pytest.fixture
def scan(tmp_path: Path) -> Path:
    import cv2

    page = np.full((120, 160), 250, np.uint8)
    cv2.line(page, (10, 20), (150, 100), 10, 3, cv2.LINE_AA)
    cv2.line(page, (10, 100), (150, 20), 10, 3, cv2.LINE_AA)
    cv2.imwrite(str(tmp_path / "lines.png"), page)
    return tmp_path / "lines.png"


@pytest.fixture
def running(part):
    """A job that runs until it is cancelled."""
    job = part("operators.job")

    class Endless(job.Job):
        def __init__(self):
            super().__init__("")
            self.ended = threading.Event()

        def work(self):
            while not self.cancelled:
                threading.Event().wait(0.01)
            self.ended.set()

    job.current = endless = Endless()
    endless.start()
    yield endless
    endless.cancel()
    job.current = None


def test_opening_a_file_ends_the_trace(bpy, part, running):
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    assert part("operators.job").current is None
    assert running.ended.wait(5)


def test_disabling_the_extension_ends_the_trace(part, running):
    background = part("operators.tracing.background")
    background.unregister()
    background.register()
    assert part("operators.job").current is None
    assert running.ended.wait(5)


@pytest.mark.parametrize("mode", ["EDIT", "PAINT_GREASE_PENCIL"])
def test_nobody_is_thrown_out_of_a_mode(bpy, part, scan, mode):
    obj, _ = make(bpy, part, cross(part))
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode=mode)
    before = bpy.context.mode
    assert bpy.ops.involute.trace(filepath=str(scan), show_scan=False) == {"FINISHED"}
    assert bpy.context.mode == before
    assert bpy.context.active_object == obj
    assert len(drawing_of(part, bpy.data.objects["lines"]).junctions) == 1


def test_a_drawing_is_not_lost_with_its_camera(bpy, part, scan):
    """The camera was there when the trace began."""
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera
    trace_job = part("operators.tracing.trace_job")
    work = trace_job.TraceJob.work

    def and_then_the_camera_goes(self):
        work(self)
        bpy.context.scene.camera = None

    trace_job.TraceJob.work = and_then_the_camera_goes
    try:
        assert bpy.ops.involute.trace(filepath=str(scan), place="CAMERA") == {"FINISHED"}
    finally:
        trace_job.TraceJob.work = work
    assert bpy.data.objects["lines"].matrix_world.to_translation().length == 0


def test_only_the_strokes_are_made_again(bpy, part, scan):
    """Adjust Last Operation with another smoothing: the same as a trace with it, at once."""
    recent = part("operators.tracing.recent").PAGES
    recent._kept.clear()
    bpy.ops.involute.trace(filepath=str(scan))
    (first,) = recent._kept.values()
    for settings in ({"smoothing": 0.9}, {"curve": "bezier"}, {"tolerance": 3.0}, {}):
        bpy.ops.involute.trace(filepath=str(scan), **settings)
        assert list(recent._kept.values()) == [first]
        found = drawing_of(part, bpy.context.active_object)
        wanted = part("engine").vectorize(str(scan), part("engine").Settings(**settings))
        assert len(found.strokes) == len(wanted.strokes)
        for stroke, other in zip(found.strokes, wanted.strokes, strict=True):
            # Where lines end is looked up in smoothed lines, too: that much may differ.
            np.testing.assert_allclose(stroke.points, other.points, atol=0.01)
    bpy.ops.involute.trace(filepath=str(scan), solids=False)
    assert len(recent._kept) == 2


def test_the_scan_lies_behind_its_strokes(bpy, part, scan):
    """Paled, on paper that hides what stands behind; both exactly where the page is."""
    behind = part("operators.tracing.scan_behind")
    maps = part("operators.grease_pencil.core.pixel_map")
    bpy.ops.involute.trace(filepath=str(scan))
    obj = bpy.data.objects["lines"]
    empty, paper = behind.scan_of(obj), behind.paper_of(obj)
    assert empty.use_empty_image_alpha
    assert 0 < empty.color[3] < 1
    assert not paper.use_empty_image_alpha
    bpy.context.view_layer.update()
    corners = np.array([[0, 0], [160, 0], [160, 120]])
    front = maps.front_view((160, 120)).to_object(corners)
    depths = []
    for one in (empty, paper):
        assert one.parent == obj
        assert one.hide_select
        width, height = one.data.size
        own = maps.on_empty(one, (width, height)).to_object(corners * (width / 160, height / 120))
        places = np.c_[own, np.ones(3)] @ np.array(one.matrix_world).T
        np.testing.assert_allclose(places[:, [0, 2]], front[:, [0, 2]], atol=1e-5)
        depths.append(places[:, 1])
    assert (depths[0] > 0).all()
    assert (depths[0] < depths[1]).all()
    assert (depths[1] < 0.01).all()
    bpy.ops.involute.trace(filepath=str(scan), show_scan=False)
    assert behind.scan_of(bpy.context.active_object) is None
    assert behind.paper_of(bpy.context.active_object) is None


def test_a_camera_sees_what_it_saw(bpy, part, scan):
    """What the artist has behind a drawing that fills the camera's view is not covered."""
    behind = part("operators.tracing.scan_behind")
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    bpy.context.collection.objects.link(camera)
    bpy.context.scene.camera = camera
    bpy.ops.involute.trace(filepath=str(scan), place="CAMERA")
    assert behind.scan_of(bpy.context.active_object) is not None
    assert behind.paper_of(bpy.context.active_object) is None


def test_an_empty_that_is_traced_is_paled(bpy, part, scan):
    behind = part("operators.tracing.scan_behind")
    empty = bpy.data.objects.new("Reference", None)
    empty.empty_display_type, empty.data = "IMAGE", bpy.data.images.load(str(scan))
    empty.rotation_euler = (1.2, 0.1, 0.4)
    bpy.context.collection.objects.link(empty)
    bpy.context.view_layer.objects.active = empty
    bpy.context.view_layer.update()
    bpy.ops.involute.trace()
    obj = bpy.context.active_object
    assert behind.scan_of(obj) == empty
    assert behind.paper_of(obj).parent == obj
    assert empty.use_empty_image_alpha
    pale = empty.color[3]
    assert pale < 0.5
    empty.color[3] = 0.8  # by the slider
    bpy.context.view_layer.objects.active = empty
    bpy.ops.involute.trace()
    assert empty.color[3] == pytest.approx(0.8)
    assert len([one for one in bpy.data.images if "Paper" in one.name]) == 1


def test_a_drawing_stands_before_what_is_there(bpy, part, scan):
    bpy.ops.mesh.primitive_cube_add(size=2, location=(0, 0, 0))
    bpy.context.view_layer.update()
    bpy.ops.involute.trace(filepath=str(scan))
    assert bpy.data.objects["lines"].location.y == pytest.approx(-1.1)


def test_what_is_asked_for_nowhere_is_the_sidebars(bpy, part):
    """A drop, File > Import and the context menu call without settings.

    Blender's Python module invokes nothing: an operator that is executed stands in.
    """
    settings = part("operators.tracing.trace_settings")
    found = {}

    class INVOLUTE_OT_test_asked(  # noqa: N801
        settings.PlacingOptions, settings.TraceOptions, bpy.types.Operator
    ):
        bl_idname, bl_label = "involute.test_asked", "Test"

        def execute(self, context):
            settings.take_from_sidebar(self, context)
            found.update(settings.as_values(self), show_scan=self.show_scan)
            return {"FINISHED"}

    bpy.utils.register_class(INVOLUTE_OT_test_asked)
    try:
        sidebar = bpy.context.scene.involute
        sidebar.solids, sidebar.smoothing, sidebar.show_scan = False, 0.75, False
        bpy.ops.involute.test_asked()
        assert (found["solids"], found["smoothing"], found["show_scan"]) == (False, 0.75, False)
        bpy.ops.involute.test_asked(smoothing=0.1)
        assert (found["solids"], found["smoothing"]) == (False, 0.1)
        bpy.ops.involute.test_asked()
        assert found["smoothing"] == 0.75  # not what the last call was given
    finally:
        bpy.utils.unregister_class(INVOLUTE_OT_test_asked)


def test_new_scenes_begin_with_the_defaults_of_the_preferences(bpy, part):
    defaults = bpy.context.preferences.addons["bl_ext.involute_tests.involute"].preferences.defaults
    defaults.smoothing = 0.62
    try:
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        assert bpy.context.scene.involute.smoothing == pytest.approx(0.62)
        bpy.ops.scene.new(type="EMPTY")
        bpy.context.view_layer.update()
        assert bpy.context.scene.involute.smoothing == pytest.approx(0.62)
        bpy.context.scene.involute.smoothing = 0.2
        bpy.context.view_layer.update()
        assert bpy.context.scene.involute.smoothing == pytest.approx(0.2)
    finally:
        defaults.property_unset("smoothing")


def test_no_file_chosen_is_said(bpy, tmp_path):
    with pytest.raises(RuntimeError, match="Choose one picture file"):
        bpy.ops.involute.import_scan(filepath=str(tmp_path) + "/")


def test_presets_set_every_setting(bpy, part):
    use_preset, settings = part("operators.tracing.use_preset"), part("engine.settings")
    trace_settings = part("operators.tracing.trace_settings")
    for name, (_, _, wanted) in use_preset.PRESETS.items():
        bpy.context.scene.involute.pen_width = 33.0
        assert bpy.ops.involute.use_preset(preset=name) == {"FINISHED"}
        chosen = trace_settings.engine_settings(bpy.context.scene.involute)
        assert chosen == settings.Settings(**wanted)
