"""The images of a movie clip, by number, as if they were the pages of one file."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike, fspath
from pathlib import Path

import cv2

from ..errors import InvoluteError
from ..values import Array

SUFFIXES = frozenset({".avi", ".m4v", ".mkv", ".mov", ".mp4", ".mpg", ".ogv", ".webm"})


_MOST = 1_000_000  # images; as many as a timeline has frames


def is_movie(path: str | PathLike[str]) -> bool:
    return Path(path).suffix.lower() in SUFFIXES


def image_count(path: str | PathLike[str]) -> int:
    """How many images a clip has, as its header says.

    Raises:
        InvoluteError: it can't be read as a movie.
    """
    with _opened(path) as clip:
        count = clip.get(cv2.CAP_PROP_FRAME_COUNT)
    if not count >= 1:  # some clips don't say, or say what is no number
        return 1
    if count > _MOST:
        raise InvoluteError(f"{Path(path).name} says it has {count:.0f} images; it is damaged.")
    return int(count)


def read_image(path: str | PathLike[str], index: int) -> Array:
    """One image of a clip, (H, W, 3) uint8 BGR.

    Raises:
        InvoluteError: it can't be read as a movie, or has no such image.
    """
    with _opened(path) as clip:
        if index:
            clip.set(cv2.CAP_PROP_POS_FRAMES, index)
        there, picture = clip.read()
    if not there:
        raise InvoluteError(f"{Path(path).name} has no image {index + 1} that can be read.")
    return picture


@contextmanager
def _opened(path: str | PathLike[str]) -> Iterator[cv2.VideoCapture]:
    if not Path(path).is_file():
        raise InvoluteError(f"There is no file {path}; check the path.")
    clip = cv2.VideoCapture(fspath(path))
    try:
        if not clip.isOpened():
            raise InvoluteError(f"{Path(path).name} is not a movie that can be read.")
        yield clip
    finally:
        clip.release()
