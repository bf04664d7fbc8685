"""Frame numbers from names: gaps are holds, chunks land where the whole would."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from involute.engine import InvoluteError
from involute.engine.scan.image_file import page_count, read_image
from involute.engine.sequence.frames import FrameRange, number_frames, number_pages


def frames_of(paths, **options):
    return [f.frame for f in number_frames(paths, **options)]


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        (["a_0002.png", "a_0001.png", "a_0010.png"], [1, 2, 10]),
        (["shot12_a1.png", "shot12_a3.png"], [1, 3]),
        (["12.tif", "9.tif"], [9, 12]),
        (["run.png", "jump.png"], [1, 2]),
        (["walk_5.png"], [5]),
        (["IMG_20261123_101533.jpg", "IMG_20261123_094102.jpg"], [1, 2]),
        (["Scan 7 (1).png", "Scan 7 (2).png"], [1, 2]),
    ],
)
def test_numbers_come_from_the_names(names, expected):
    assert frames_of(names) == expected


def test_times_of_day_are_counted_in_their_order():
    paths = number_frames(["IMG_20261123_101533.jpg", "IMG_20261123_094102.jpg"])
    assert [f.path for f in paths] == ["IMG_20261123_094102.jpg", "IMG_20261123_101533.jpg"]


def test_start_and_step_keep_gaps_as_holds():
    names = ["a3.png", "a4.png", "a7.png"]
    assert frames_of(names, start=1) == [1, 2, 5]
    assert frames_of(names, step=2) == [3, 5, 11]
    assert frames_of(names, start=100, step=2) == [100, 102, 108]


@pytest.mark.parametrize(
    "names",
    [
        ["a_1.png", "b_1.png"],
        ["a_1.png", "a_01.png"],
        ["a_1.png", "notes.png"],
        ["c1_001.png", "c1_002.png", "c2_001.png"],
    ],
)
def test_files_of_two_sequences_are_refused_in_one_sentence(names):
    with pytest.raises(InvoluteError, match=r"one sequence\.$"):
        number_frames(names)


@given(
    st.sets(st.integers(0, 500), min_size=1, max_size=40),
    st.integers(1, 4),
    st.integers(-50, 50) | st.none(),
    st.integers(1, 30),
)
def test_chunks_land_where_the_whole_sequence_would(numbers, step, start, size):
    names = [f"take2_{n:04d}.png" for n in numbers]
    whole = number_frames(names, start=start, step=step)
    chunks = [
        frame
        for low in range(0, 501, size)
        for frame in number_frames(
            names, start=start, step=step, frames=FrameRange.parse(f"{low}-{low + size - 1}")
        )
    ]
    assert chunks == whole


@pytest.mark.parametrize(
    ("text", "inside", "outside"),
    [
        ("101-103", [101, 103], [100, 104]),
        ("1-9:2,20", [1, 9, 20], [2, 10, 21]),
        (" 7 ", [7], [6, 8]),
    ],
)
def test_frame_ranges(text, inside, outside):
    chosen = FrameRange.parse(text)
    assert all(n in chosen for n in inside)
    assert not any(n in chosen for n in outside)


@pytest.mark.parametrize("text", ["", "a-b", "9-1", "1-5:0", "1--3", "1,,2"])
def test_unreadable_ranges(text):
    with pytest.raises(InvoluteError, match="write for example"):
        FrameRange.parse(text)


def test_pages_of_one_file():
    assert [(f.page, f.frame) for f in number_pages("all.tif", 3, start=10, step=2)] == [
        (0, 10),
        (1, 12),
        (2, 14),
    ]


def test_a_movies_images_are_its_frames(tmp_path):
    path = tmp_path / "clip.avi"
    movie = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"MJPG"), 12, (96, 64))
    if not movie.isOpened():
        pytest.skip("this OpenCV can't write movies")
    for level in (40, 120, 200):
        movie.write(np.full((64, 96, 3), level, np.uint8))
    movie.release()
    assert page_count(path) == 3
    assert [round(float(read_image(path, k).mean()), -1) for k in (2, 0, 1)] == [200, 40, 120]
    with pytest.raises(InvoluteError, match="no image 4"):
        read_image(path, 3)
    (tmp_path / "bad.mp4").write_text("not a movie")
    with pytest.raises(InvoluteError, match="not a movie"):
        page_count(tmp_path / "bad.mp4")
