"""Sequences in Blender: keyframes of one object, holds, failures, what changed, what plays."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest


def make_pages(part, folder: Path, numbers: list[int]) -> Path:
    part("engine.scan")  # brings OpenCV
    import cv2

    folder.mkdir(exist_ok=True)
    for number in numbers:
        page = np.full((120, 160, 3), 245, np.uint8)
        cv2.line(page, (20 + number, 20), (130, 30 + number), (20, 20, 20), 3, cv2.LINE_AA)
        if number % 2:  # a red line in every other drawing
            cv2.line(page, (20, 100), (130, 70), (30, 30, 210), 3, cv2.LINE_AA)
        cv2.imwrite(str(folder / f"run_{number:03}.png"), page)
    return folder


def keyframes(obj) -> dict[str, list[tuple[int, int]]]:
    """Layer -> (frame, number of strokes) of each keyframe."""
    return {
        layer.name: [(key.frame_number, len(key.drawing.strokes)) for key in layer.frames]
        for layer in obj.data.layers
    }


@pytest.fixture
def quick(bpy):
    """Trace with what is fastest; the settings are not what is tested."""

    def trace(**options):
        options = {"provider": "classical", "router": "geometric", "jobs": 2} | options
        assert bpy.ops.involute.trace_sequence(**options) == {"FINISHED"}
        return bpy.context.active_object

    return trace


def test_a_folder_becomes_keyframes_and_gaps_are_holds(bpy, part, quick, tmp_path):
    folder = make_pages(part, tmp_path / "walk", [1, 2, 3, 6])
    obj = quick(directory=str(folder))
    assert obj.name == "walk"
    found = keyframes(obj)
    assert [frame for frame, _ in found["Black"]] == [1, 2, 3, 6]
    assert all(count for _, count in found["Black"])
    # Red is not held over drawings that have none.
    assert [(frame, bool(count)) for frame, count in found["Red"]] == [
        (1, True),
        (2, False),
        (3, True),
        (6, False),
    ]
    state = part("operators.grease_pencil.state")
    assert len({state.keys_at(obj.data, frame)[0] for frame in (1, 2, 3, 6)}) == 4


def test_start_and_step(bpy, part, quick, tmp_path):
    folder = make_pages(part, tmp_path / "walk", [3, 4, 6])
    obj = quick(directory=str(folder), own_start=True, start=101, step=2)
    assert part("operators.tracing.scan_behind").paper_of(obj) is not None
    assert [frame for frame, _ in keyframes(obj)["Black"]] == [101, 103, 107]


def test_a_failed_frame_is_skipped_and_all_failed_change_nothing(bpy, part, quick, tmp_path):
    folder = make_pages(part, tmp_path / "walk", [1, 2, 3])
    (folder / "run_002.png").write_text("torn page")
    assert [frame for frame, _ in keyframes(quick(directory=str(folder)))["Black"]] == [1, 3]
    count = len(bpy.data.objects)
    for file in folder.iterdir():
        file.write_text("torn page")
    with pytest.raises(RuntimeError, match="None of the frames"):
        bpy.ops.involute.trace_sequence(directory=str(folder))
    with pytest.raises(RuntimeError, match="no folder"):
        bpy.ops.involute.trace_sequence(directory=str(folder / "none"))
    assert len(bpy.data.objects) == count


def test_only_changed_drawings_are_written_again(bpy, part, quick, tmp_path):
    folder = make_pages(part, tmp_path / "walk", [1, 2, 3])
    obj = quick(directory=str(folder))
    for frame in (1, 2):  # the artist has been at work
        key = obj.data.layers["Black"].get_frame_at(frame)
        key.drawing.strokes[0].points[0].position = (9, 9, 9)
    make_pages(part, folder, [4])
    (folder / "run_002.png").write_bytes((folder / "run_003.png").read_bytes())
    assert quick(directory=str(folder), resume=True) == obj
    assert [frame for frame, _ in keyframes(obj)["Black"]] == [1, 2, 3, 4]
    first = [
        tuple(obj.data.layers["Black"].get_frame_at(frame).drawing.strokes[0].points[0].position)
        for frame in (1, 2)
    ]
    assert first[0] == (9, 9, 9)
    assert first[1] != (9, 9, 9)


def test_an_empty_that_plays_a_sequence(bpy, part, quick, tmp_path):
    folder = make_pages(part, tmp_path / "walk", [1, 2, 3, 4, 5])
    image = bpy.data.images.load(str(folder / "run_001.png"))
    image.source = "SEQUENCE"
    empty = bpy.data.objects.new("Roll", None)
    empty.empty_display_type, empty.data = "IMAGE", image
    empty.location = (1, 2, 3)
    user = empty.image_user
    user.frame_start, user.frame_duration, user.frame_offset = 11, 3, 1
    bpy.context.scene.collection.objects.link(empty)
    bpy.context.view_layer.objects.active = empty
    bpy.context.view_layer.update()
    obj = quick()
    assert [frame for frame, _ in keyframes(obj)["Black"]] == [11, 12, 13]
    assert tuple(obj.matrix_world.translation) == (1, 2, 3)
    behind = part("operators.tracing.scan_behind")  # its strokes stand out on it
    assert behind.scan_of(obj) == empty
    assert empty.use_empty_image_alpha
    assert behind.paper_of(obj) is not None


def test_an_empty_that_plays_a_movie(bpy, part, quick, tmp_path):
    part("engine.scan")
    import cv2

    path = tmp_path / "clip.avi"
    movie = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"MJPG"), 12, (160, 120))
    if not movie.isOpened():
        pytest.skip("this OpenCV can't write movies")
    for number in range(4):
        page = np.full((120, 160, 3), 245, np.uint8)
        cv2.line(page, (20, 20 + 20 * number), (130, 20 + 20 * number), (20, 20, 20), 4)
        movie.write(page)
    movie.release()
    image = bpy.data.images.load(str(path))
    assert image.source == "MOVIE"
    empty = bpy.data.objects.new("Clip", None)
    empty.empty_display_type, empty.data = "IMAGE", image
    empty.image_user.frame_duration = 4
    bpy.context.scene.collection.objects.link(empty)
    bpy.context.view_layer.objects.active = empty
    obj = quick()
    frames = obj.data.layers["Black"].frames
    assert [key.frame_number for key in frames] == [1, 2, 3, 4]
    heights = [
        max(key.drawing.strokes, key=lambda s: len(s.points)).points[0].position[1]
        for key in frames
    ]
    assert heights == sorted(heights, reverse=True)


def test_the_file_browsers_choice_becomes_keyframes(bpy, part, tmp_path):
    """File > Import: all numbered drawings of the folder, or those that were chosen."""
    folder = make_pages(part, tmp_path / "walk", [1, 2, 3])
    options = {"provider": "classical", "router": "geometric", "jobs": 1}
    first = sorted(folder.iterdir())[0]
    chosen = [{"name": first.name}]
    bpy.ops.involute.import_sequence(directory=str(folder), files=chosen, **options)
    assert keyframes(bpy.context.active_object)["Black"] == [(1, 1), (2, 1), (3, 1)]
    two = [{"name": path.name} for path in sorted(folder.iterdir())[1:]]
    bpy.ops.involute.import_sequence(directory=str(folder), files=two, **options)
    assert len(keyframes(bpy.context.active_object)["Black"]) == 2
    with pytest.raises(RuntimeError, match="no folder"):
        bpy.ops.involute.import_sequence(directory=str(folder / "none"), **options)


def test_the_job_leaves_the_caller_free(part, tmp_path):
    """What the window does with its timer: look in now and then while processes work."""
    folder = make_pages(part, tmp_path / "walk", [1, 2, 3])
    frames = part("operators.sequences.playing").frames_of_files(folder)
    settings = part("engine").Settings(provider="classical", router="geometric")
    job = part("operators.sequences.sequence_job").SequenceJob(
        frames, settings, jobs=2, parts=tmp_path / "parts", follow=True
    )
    job.start()
    results = []
    for _ in range(600):
        alive = job.running
        results += job.results()
        if not alive:
            break
        time.sleep(0.1)
    assert [frame for frame, _, _ in results] == [1, 2, 3]
    assert job.fraction == 1.0
    assert not job.problem
