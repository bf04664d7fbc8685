"""Drawings -> a .blend file, for the command line; the file that is open is left behind."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING

from ..engine.formats import Format

if TYPE_CHECKING:
    import bpy

    from ..engine import Drawing


_COMPRESSED_END = b"\xb1\xea\x92\x8f"  # of the table of Zstandard frames


def write(drawings: Sequence[tuple[str, Drawing]], path: str | PathLike[str]) -> None:
    """Write one Grease Pencil object per drawing, with a camera that shows the first.

    Args:
        drawings: names and drawings.
        path: the .blend file, made or overwritten.

    Raises:
        InvoluteError: Blender's Python module can't be loaded.
        OSError: the file can't be written.
    """
    scene = _empty_scene()
    for name, drawing in drawings:
        title = _as_text(name)
        _put(_object(scene, title, drawing), scene.frame_current, drawing, title)
    _save(path)


def write_sequence(
    name: str, frames: Iterable[tuple[int, Drawing]], path: str | PathLike[str]
) -> None:
    """Write one Grease Pencil object with a keyframe per drawing, with a camera and frame range.

    Args:
        name: of the object.
        frames: frame numbers, ascending, and drawings; asked for one at a time.
        path: the .blend file, made or overwritten.

    Raises:
        InvoluteError: as for `write`; or there is no frame at all.
    """
    scene, name = _empty_scene(), _as_text(name)
    obj = None
    for frame, drawing in frames:
        if obj is None:
            obj = _object(scene, name, drawing)
            scene.frame_start = scene.frame_current = frame
        _put(obj, frame, drawing, f"{name} {frame}", alone=True)
        scene.frame_end = frame
    if obj is None:
        from ..engine import InvoluteError

        raise InvoluteError("No frame could be traced; there is nothing to write.")
    _save(path)


def _empty_scene() -> bpy.types.Scene:
    """A fresh scene; preferences stay: this may run inside Blender, with the extension enabled."""
    from ..command import stopping
    from ..engine import InvoluteError
    from . import system_libraries

    with stopping.held():
        try:
            import bpy
        except ImportError as error:
            raise InvoluteError(system_libraries.cannot_load(error)) from error
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True, load_ui=False)
    return bpy.context.scene


def _object(scene: bpy.types.Scene, name: str, drawing: Drawing) -> bpy.types.Object:
    """A new Grease Pencil object in the scene; the first one gets the camera."""
    import bpy

    from .tracing.trace import new_object

    obj = new_object(name)
    scene.collection.objects.link(obj)
    if scene.camera is None:
        scene.camera = _camera_on(drawing.size)
        scene.collection.objects.link(scene.camera)
        _frame_size(scene.render, drawing.size)
        scene.view_settings.view_transform = "Standard"  # ink stays as black as it was
        obj.select_set(True)
        bpy.context.view_layer.objects.active = obj
    return obj


def _put(
    obj: bpy.types.Object, frame: int, drawing: Drawing, source: str, *, alone: bool = False
) -> None:
    from .grease_pencil import state, writing
    from .grease_pencil.core.pixel_map import front_view

    pixel_map = front_view(drawing.size)
    key = state.add(obj.data, drawing, pixel_map, source)
    writing.write(obj.data, frame, drawing, pixel_map, key, alone=alone)


def _as_text(name: str) -> str:
    """A file's name as Blender takes names: what is not text becomes a question mark."""
    return os.fsencode(name).decode("utf-8", "replace")


def _save(path: str | PathLike[str]) -> None:
    import bpy

    from ..command import stopping

    target = Path(fspath(path)).absolute()
    target.unlink(missing_ok=True)  # of a file that is there Blender would keep a copy beside it
    try:
        with _quiet(), stopping.held():
            bpy.ops.wm.save_as_mainfile(
                filepath=str(target), check_existing=False, copy=True, compress=True
            )
    except RuntimeError as error:
        # As any other writer tells it: whoever moves the file into its place knows its name.
        raise _as_os_error(str(error)) from error
    # Blender says that all went well though the disk was full in the middle of it.
    if not target.exists() or not target.read_bytes().endswith(_COMPRESSED_END):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep Blender's own "Saved copy as" off the terminal: it names the temporary file."""
    if sys.stdout is not None:
        sys.stdout.flush()
    kept = os.dup(1)
    with open(os.devnull, "wb") as nowhere:
        os.dup2(nowhere.fileno(), 1)
    try:
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)


def _camera_on(size: tuple[int, int]) -> object:
    """An orthographic camera that just holds a drawing of that size in the front view."""
    import bpy

    width, height = size
    camera = bpy.data.cameras.new("Camera")
    camera.type = "ORTHO"
    camera.ortho_scale = 2.0 * max(1.0, width / height)
    obj = bpy.data.objects.new("Camera", camera)
    obj.location, obj.rotation_euler = (0.0, -5.0, 0.0), (1.5707963267948966, 0.0, 0.0)
    return obj


def _frame_size(render: object, size: tuple[int, int]) -> None:
    """Renders come out in the scan's own size, as far as Blender allows."""
    shrink = min(1.0, 16384 / max(size))
    render.resolution_x, render.resolution_y = (max(4, round(side * shrink)) for side in size)
    render.resolution_percentage = 100


def _as_os_error(said: str) -> OSError:
    """What Blender says of a file that it can't write, as the system would have said it."""
    lines = said.strip().splitlines() or ["unknown reason"]
    for number in (errno.ENOSPC, errno.EACCES, errno.EROFS, errno.EDQUOT, errno.EFBIG):
        if os.strerror(number) in said:
            return OSError(number, os.strerror(number))
    return OSError(errno.EIO, lines[-1].removeprefix("Error: ").rstrip("."))


BLEND = Format(
    suffix=".blend",
    about="Grease Pencil strokes in a Blender file; holds many drawings, and sequences",
    endings=(_COMPRESSED_END, b"ENDB"),
    write_many=write,
    write_sequence=write_sequence,
)
