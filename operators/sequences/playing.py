"""The frames of a folder, of a movie, or of what an image Empty plays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import bpy

from ...engine import InvoluteError
from ...engine.formats.picture_kinds import SUFFIXES
from ...engine.sequence import Frame, number_frames, number_pages
from ..language import message


def frames_of_files(
    folder: Path, names: Sequence[str] = (), *, start: int | None = None, step: int = 1
) -> list[Frame]:
    """The numbered drawings of a folder: those named, else all.

    Raises:
        InvoluteError: there are none, or they are not of one sequence.
    """
    if not folder.is_dir():
        raise InvoluteError(message("There is no folder {path}; check the path.", path=folder))
    found = [folder / name for name in names] or [
        path for path in folder.iterdir() if path.suffix.lower() in SUFFIXES
    ]
    if not found:
        raise InvoluteError(
            message("There is no picture in {path}; choose another folder.", path=folder)
        )
    return number_frames(found, start=start, step=step)


def plays_frames(empty: bpy.types.Object | None) -> bool:
    """Whether an object is an Empty that shows an image sequence or a movie."""
    return (
        empty is not None
        and empty.type == "EMPTY"
        and isinstance(empty.data, bpy.types.Image)
        and empty.data.source in {"SEQUENCE", "MOVIE"}
    )


def frames_of_empty(
    empty: bpy.types.Object, *, start: int | None = None, step: int = 1
) -> list[Frame]:
    """What an Empty plays, each drawing at the frame at which it is shown.

    Args:
        start, step: other frames than those, as in `number_frames`.

    Raises:
        InvoluteError: the files are gone.
    """
    image, user = empty.data, empty.image_user
    path = Path(bpy.path.abspath(image.filepath, library=image.library))
    if image.source == "MOVIE":
        from ...engine.scan import page_count

        frames = number_pages(path, page_count(path))
    else:
        frames = _like(path)
    frames = [
        f for f in frames if f.number - user.frame_offset in range(1, user.frame_duration + 1)
    ]
    if not frames:
        raise InvoluteError(
            message("{name} plays no frame; set its Frames to more than 0.", name=empty.name)
        )
    if start is None and step == 1:
        shift = user.frame_start - 1 - user.frame_offset
        return [replace(f, frame=f.number + shift) for f in frames]
    origin = frames[0].number if start is None else start
    return [replace(f, frame=origin + (f.number - frames[0].number) * step) for f in frames]


def _like(path: Path) -> list[Frame]:
    """The files that are named as this one, but for the number."""
    stem = path.stem.rstrip("0123456789")
    if not path.parent.is_dir():
        raise InvoluteError(
            message("There is no folder {path}; find the images again.", path=path.parent)
        )
    found = [
        other
        for other in path.parent.iterdir()
        if other.suffix.lower() == path.suffix.lower()
        and other.stem.rstrip("0123456789") == stem
        and other.stem != stem
    ]
    if not found:
        raise InvoluteError(message("There is no file {path}; find the images again.", path=path))
    # The numbers as written: Blender plays by them.
    return sorted(
        (Frame(int(f.stem[len(stem) :]), int(f.stem[len(stem) :]), str(f)) for f in found),
        key=lambda f: f.number,
    )
