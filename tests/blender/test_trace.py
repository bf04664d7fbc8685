"""Tracing in Blender: where strokes come from, where they land, and what happens when it fails."""

from __future__ import annotations

import math
import os
import runpy
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from .conftest import MODULE
from .test_splicing import drawing_of, strokes_in


@pytest.fixture
def scan(part, tmp_path) -> Path:
    """A page with two crossing lines and a solid blot."""
    return page(part, tmp_path / "page.png")


def page(part, path: Path, shift: int = 0) -> Path:
    part("engine.scan")  # brings OpenCV
    import cv2

    paper = np.full((200, 260), 245, np.uint8)
    cv2.line(paper, (20 + shift, 30), (240, 170), 20, 3, cv2.LINE_AA)
    cv2.line(paper, (30, 160), (230, 20 + shift), 20, 3, cv2.LINE_AA)
    cv2.ellipse(paper, (45, 95), (24, 34), 20, 0, 360, 20, -1, cv2.LINE_AA)
    cv2.imwrite(str(path), paper)
    return path


def everything(bpy) -> tuple[int, ...]:
    """How many things of each kind there are: what a failed trace must not change."""
    gp = sys.modules[f"{MODULE}.operators.grease_pencil.cels"].collection()
    data = bpy.data
    return tuple(map(len, (data.objects, data.materials, data.images, data.meshes, gp)))


def drawings(bpy):
    """All objects but the scans behind."""
    return [obj for obj in bpy.data.objects if obj.type != "EMPTY"]


def test_a_file_becomes_an_object(bpy, part, scan):
    assert bpy.ops.involute.trace(filepath=str(scan)) == {"FINISHED"}
    obj = bpy.context.active_object
    assert obj.name == "page"
    assert {layer.name for layer in obj.data.layers} == {"Solids", "Black"}
    drawing = drawing_of(part, obj)
    pixel_map = part("operators.grease_pencil.core.pixel_map").front_view((260, 200))
    found = strokes_in(part, obj, pixel_map)
    assert len(found) == len(drawing.strokes) + len(drawing.fills)
    points = np.concatenate([p for p, closed in found if not closed])
    corners = np.array([[20, 30], [240, 170], [30, 160], [230, 20]])
    assert np.linalg.norm(points[:, None] - corners, axis=2).min(0).max() < 8


def test_adjust_last_operation_traces_again(bpy, part, scan):
    bpy.ops.involute.trace(filepath=str(scan))
    assert bpy.context.active_object.data.layers.get("Solids")
    bpy.ops.involute.trace(filepath=str(scan), solids=False)
    assert not bpy.context.active_object.data.layers.get("Solids")


@pytest.mark.parametrize("size", [5.0, 0.3])
def test_strokes_lie_on_the_image_empty(bpy, part, scan, size):
    from mathutils import Euler, Matrix, Vector

    image = bpy.data.images.load(str(scan))
    empty = bpy.data.objects.new("Scan", None)
    empty.empty_display_type, empty.data = "IMAGE", image
    empty.empty_display_size = size
    empty.empty_image_offset = (-0.25, -0.75)
    empty.matrix_world = Matrix.LocRotScale(
        Vector((1, 2, 3)), Euler((1.2, 0.3, 2.0)), Vector((1.5, 1.5, 1.5))
    )
    bpy.context.scene.collection.objects.link(empty)
    bpy.context.view_layer.objects.active = empty
    assert bpy.ops.involute.trace() == {"FINISHED"}
    obj = bpy.context.active_object
    assert obj is not empty
    assert all(
        math.isclose(a, b, abs_tol=1e-6)
        for one, other in zip(obj.matrix_world, empty.matrix_world, strict=True)
        for a, b in zip(one, other, strict=True)
    )
    # The picture is `size` wide, since it is wider than tall; its own pixels per metre follow.
    pixel_map = part("operators.grease_pencil.core.pixel_map").on_empty(empty, (260, 200))
    width, height = size, size * 200 / 260
    corners = pixel_map.to_object(np.array([[0, 200], [260, 0]]))
    np.testing.assert_allclose(corners[0], (-0.25 * width, -0.75 * height, 0), atol=1e-6)
    np.testing.assert_allclose(corners[1], (0.75 * width, 0.25 * height, 0), atol=1e-6)
    lines = [p for p, closed in strokes_in(part, obj, pixel_map) if not closed]
    assert any(np.linalg.norm(p - (20, 30), axis=1).min() < 4 for p in lines)


@pytest.mark.parametrize("is_float", [False, True])
def test_an_image_in_memory_can_be_traced(bpy, part, is_float):
    image = bpy.data.images.new("Sketch", 120, 80, float_buffer=is_float)
    pixels = np.ones((80, 120, 4), np.float32)
    pixels[20:23, 10:110, :3] = 0.0  # rows count from below
    image.pixels.foreach_set(pixels.ravel())
    assert bpy.ops.involute.trace(image="Sketch") == {"FINISHED"}
    pixel_map = part("operators.grease_pencil.core.pixel_map").front_view((120, 80))
    found = [p for p, _ in strokes_in(part, bpy.context.active_object, pixel_map)]
    longest = max(found, key=lambda p: np.ptp(p[:, 0]))
    np.testing.assert_allclose(np.median(longest[:, 1]), 80 - 21.5, atol=0.6)


def test_an_empty_that_plays_a_sequence_gives_what_it_shows(bpy, part, tmp_path):
    for number in (1, 2):
        page(part, tmp_path / f"walk.{number:04}.png")
    image = bpy.data.images.load(str(tmp_path / "walk.0001.png"))
    image.source = "SEQUENCE"
    empty = bpy.data.objects.new("Walk", None)
    empty.empty_display_type, empty.data = "IMAGE", image
    empty.image_user.frame_start, empty.image_user.frame_duration = 1, 2
    empty.image_user.frame_current = 2
    source = part("operators.tracing.sources").from_image(image, empty)
    assert Path(source.picture).name == "walk.0002.png"


def test_files_become_an_object_each(bpy, part, tmp_path):
    for name in ("a", "b"):
        page(part, tmp_path / f"{name}.png")
    bpy.ops.involute.trace(directory=str(tmp_path), files=[{"name": "a.png"}, {"name": "b.png"}])
    assert sorted(o.name for o in drawings(bpy)) == ["a", "b"]


def test_active_object_takes_a_keyframe(bpy, part, scan):
    bpy.ops.involute.trace(filepath=str(scan))
    obj = bpy.context.active_object
    bpy.context.scene.frame_set(5)
    bpy.ops.involute.trace(filepath=str(scan), target="ACTIVE")
    assert len(drawings(bpy)) == 1
    assert [key.frame_number for key in obj.data.layers["Black"].frames] == [1, 5]


@pytest.mark.parametrize("trouble", ["missing", "text", "tiny", "truncated", "image", "nothing"])
def test_a_failed_trace_says_so_and_changes_nothing(bpy, part, scan, tmp_path, trouble):
    arguments = {"filepath": str(tmp_path / "bad.png")}
    if trouble == "text":
        (tmp_path / "bad.png").write_text("not a picture")
    elif trouble == "truncated":
        (tmp_path / "bad.png").write_bytes(scan.read_bytes()[:200])
    elif trouble == "tiny":
        import cv2

        cv2.imwrite(arguments["filepath"], np.zeros((1, 1), np.uint8))
    elif trouble == "image":
        arguments = {"image": "no such image"}
    elif trouble == "nothing":
        arguments = {}
    part("operators.grease_pencil.cels")
    before = everything(bpy)
    with pytest.raises(RuntimeError) as problem:
        bpy.ops.involute.trace(**arguments)
    sentence = str(problem.value).strip().removeprefix("Error: ")
    assert len(sentence.splitlines()) == 1
    assert sentence.endswith(".")
    assert everything(bpy) == before


def test_a_blank_page_is_a_blank_keyframe(bpy, part, tmp_path):
    import cv2

    cv2.imwrite(str(tmp_path / "blank.png"), np.full((100, 100), 250, np.uint8))
    assert bpy.ops.involute.trace(filepath=str(tmp_path / "blank.png")) == {"FINISHED"}
    assert not strokes_in(
        part,
        bpy.context.active_object,
        part("operators.grease_pencil.core.pixel_map").front_view((100, 100)),
    )


def test_one_failed_file_of_many_is_skipped(bpy, part, scan):
    (scan.parent / "bad.png").write_text("not a picture")
    files = [{"name": "bad.png"}, {"name": scan.name}]
    assert bpy.ops.involute.trace(directory=str(scan.parent), files=files) == {"FINISHED"}
    assert [o.name for o in drawings(bpy)] == ["page"]


def test_tracing_is_one_undo_step(bpy, scan):
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.involute.trace("EXEC_DEFAULT", True, filepath=str(scan))
    assert len(drawings(bpy)) == 1
    bpy.ops.ed.undo()
    assert len(bpy.data.objects) == 0
    bpy.ops.ed.redo()
    assert len(drawings(bpy)) == 1


def test_settings_of_the_engine_all_have_a_property(bpy, part):
    from dataclasses import fields

    settings = part("operators.tracing.trace_settings")
    properties = bpy.ops.involute.trace.get_rna_type().properties
    names = {field.name for field in fields(part("engine").Settings)}
    for name in names - {"align"}:  # found out page by page, never typed in
        assert properties[name].description
    ui = part("operators.tracing.settings_layout")
    assert {n for _, group in ui.GROUPS for n in group} == set(settings.NAMES)
    assert settings.engine_settings(bpy.context.scene.involute) == part("engine").Settings()


def test_import_operator_and_menus(bpy, part, scan):
    assert bpy.ops.involute.import_scan(filepath=str(scan)) == {"FINISHED"}
    assert len(drawings(bpy)) == 1
    with pytest.raises(RuntimeError, match="none"):
        bpy.ops.involute.import_scan(filepath=str(scan.parent / "none.png"))


def test_blend_file_holds_the_same_strokes_as_the_svg(bpy, part, scan, tmp_path):
    out = tmp_path / "out"
    run = part("operators.blender_command").run
    assert run(["trace", str(scan), "-o", str(out), "--format", "svg,blend"]) == 0
    strokes = part("engine").Drawing.load(out / "page.svg").strokes
    bpy.ops.wm.open_mainfile(filepath=str(out / "page.blend"))
    obj = bpy.data.objects["page"]
    gp = part("operators.grease_pencil.cels")
    pixel_map = part("operators.grease_pencil.core.pixel_map").front_view((260, 200))
    curves = gp.read(obj.data.layers["Black"].get_frame_at(1).drawing)
    assert len(curves) == len(strokes)
    points = pixel_map.to_pixels(curves.point("position"))
    np.testing.assert_allclose(points, np.concatenate([s.points for s in strokes]), atol=1e-3)
    radii = curves.point("radius") / pixel_map.unit
    np.testing.assert_allclose(radii, np.concatenate([s.widths for s in strokes]) / 2, atol=1e-3)
    assert bpy.context.scene.camera


def test_script_for_blender_without_a_window(bpy, scan, tmp_path):
    script = Path(__file__).parents[2] / "examples" / "trace_in_blender.py"
    main = runpy.run_path(str(script))["main"]
    (tmp_path / "bad.png").write_text("not a picture")
    out = tmp_path / "out"
    assert main([str(scan), "--output", str(out)]) == 0
    assert main([str(tmp_path / "bad.png"), "--output", str(out)]) == 1
    assert [file.name for file in out.iterdir()] == ["page.blend"]
    bpy.ops.wm.open_mainfile(filepath=str(out / "page.blend"))
    assert bpy.data.objects["page"].data["involute"]["version"] == 1


def test_defaults_of_the_preferences(bpy):
    preferences = bpy.context.preferences.addons[MODULE].preferences
    settings = bpy.context.scene.involute
    preferences.defaults.tolerance, settings.solids = 0.5, False
    preferences.defaults.ignore_inks = {"blue"}
    bpy.ops.involute.use_defaults()
    assert settings.tolerance == 0.5
    assert settings.solids
    assert settings.ignore_inks == {"blue"}
    preferences.defaults.property_unset("tolerance")
    preferences.defaults.property_unset("ignore_inks")


def test_command_fails_in_one_line(bpy, part, tmp_path, capfd):
    run = part("operators.blender_command").run
    assert run(["trace", str(tmp_path / "none.png"), "-o", str(tmp_path / "x.blend")]) != 0
    assert not (tmp_path / "x.blend").exists()


def test_enabling_is_light_and_disabling_leaves_nothing(archive, tmp_path):
    """In a process of its own: what enabling imports can't be told where tests have run."""
    script = f"""
import sys, time
sys.path.insert(0, {str(Path(__file__).parent)!r})
import bpy, addon_utils
from pathlib import Path
from conftest import MODULE, install
bpy.ops.wm.read_factory_settings(use_empty=True)
before = set(dir(bpy.types))
install(Path({str(archive)!r}), Path({str(tmp_path / "extensions")!r}))
assert hasattr(bpy.types, "INVOLUTE_OT_trace")
heavy = {{"cv2", "torch", "networkx"}} & set(sys.modules)
assert not heavy, heavy
addon_utils.disable(MODULE)
left = [n for n in set(dir(bpy.types)) - before if "involute" in n.lower()]
assert not left, left
assert not hasattr(bpy.types.Scene, "involute")
start = time.perf_counter()
addon_utils.enable(MODULE)
print("enabled again in", round(time.perf_counter() - start, 4), "s")
assert not {{"cv2", "torch", "networkx"}} & set(sys.modules)
"""
    environment = os.environ | {"BLENDER_USER_RESOURCES": str(tmp_path / "user")}
    done = subprocess.run(
        [sys.executable, "-c", script], env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    print(done.stdout.splitlines()[-1])


def test_an_svg_of_another_program_is_routed_anew(bpy, part, tmp_path):
    """Dropped or imported: its lines are taken as they are; nothing of it is left beside them."""
    path = tmp_path / "cross.svg"
    path.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 100">'
        '<path d="M 10 50 L 100 50 L 190 50" fill="none" stroke="#204080" stroke-width="3"/>'
        '<path d="M 100 10 L 100 90" fill="none" stroke="#204080" stroke-width="3"/></svg>'
    )
    assert ".svg" in part("ui.panels.menus").INVOLUTE_FH_scan.bl_file_extensions.split(";")
    before = {image.name for image in bpy.data.images}
    assert bpy.ops.involute.import_scan(filepath=str(path)) == {"FINISHED"}
    obj = bpy.context.active_object
    drawing = drawing_of(part, obj)
    assert (len(drawing.junctions), len(drawing.strokes)) == (1, 2)
    assert drawing.size == (200, 100)
    assert {image.name for image in bpy.data.images} - before == {"Involute Paper"}
    assert bpy.ops.involute.trace_again(even_width=True) == {"FINISHED"}


@pytest.mark.parametrize("word", [None, "--quiet"])
def test_without_a_window_each_page_is_told(bpy, scan, tmp_path, capfd, monkeypatch, word):
    """As the command line does; Blender prints reports only after all of it is over."""
    other = tmp_path / "missing.png"
    monkeypatch.setattr(sys, "argv", ["blender", "-b", *([word] if word else [])])
    files = [{"name": scan.name}, {"name": other.name}]
    assert bpy.ops.involute.trace(directory=str(tmp_path), files=files) == {"FINISHED"}
    said = [line for line in capfd.readouterr().err.splitlines() if line.startswith("involute: ")]
    if word:
        assert said == []
        return
    assert len(said) == 2
    assert said[0].startswith("involute: page: 2 strokes, 0 doubtful junctions, ")
    assert said[1].startswith("involute: missing: There is no file ")


def test_a_copied_file_is_traced_from_the_clipboard(bpy, part, scan, tmp_path):
    """What is copied in a file manager: addresses or paths; without a window there is no more."""
    paste = part("operators.tracing.paste")
    other = page(part, tmp_path / "with space.png")
    text = f"{scan}\n{other.as_uri()}\n{tmp_path / 'missing.png'}\nsome words\n"
    assert paste.copied_files(text) == (str(tmp_path), ["page.png", "with space.png"])
    with pytest.raises(part("engine").InvoluteError, match="sees no picture"):
        paste.copied_files("some words")
    with pytest.raises(RuntimeError, match="sees no picture"):
        bpy.ops.involute.paste()
    assert paste.pasted(bpy.context) is None
    assert {area.type for area in bpy.context.window.screen.areas} & {"VIEW_3D"}


def test_lettering_comes_to_a_layer_of_its_own(bpy, part, tmp_path):
    """And stays there when the picture is traced again."""
    part("engine.scan")
    import cv2

    paper = np.full((300, 400), 255, np.uint8)
    lines = ((30, 60), (370, 260)), ((60, 150), (72, 116)), ((72, 116), (84, 150))
    for a, b in (*lines, ((66, 138), (79, 138))):
        cv2.line(paper, a, b, 0, 3, cv2.LINE_AA)
    path = tmp_path / "letter.png"
    cv2.imwrite(str(path), paper)
    assert bpy.ops.involute.trace(filepath=str(path), small_parts=20.0) == {"FINISHED"}
    data = bpy.context.active_object.data
    cels = part("operators.grease_pencil.cels")

    def counts():
        return {layer.name: len(cels.read(cel)) for layer, cel in cels.cels_at(data, 1)}

    first = counts()
    assert set(first) == {"Black", "Small Black"}
    assert first["Black"] == 1
    assert bpy.ops.involute.trace_again(even_width=True) == {"FINISHED"}
    assert counts() == first
