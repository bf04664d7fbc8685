"""Trace the picture that is in the clipboard, or the picture file that was copied there."""

from __future__ import annotations

import re
from pathlib import Path

import bpy

from ...engine import InvoluteError
from ..language import message
from .file_choice import TRACED, Handing


class INVOLUTE_OT_paste(Handing, bpy.types.Operator):
    """Trace the picture, or the picture file, that is in the clipboard"""

    bl_idname = "involute.paste"
    bl_label = "Trace from Clipboard"
    bl_options = {"REGISTER"}  # the trace that it starts is the step to undo

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Take the picture; else the files that are named there."""
        try:
            image = pasted(context)
            if image is not None:
                return self.hand_to(bpy.ops.involute.trace, image=image.name)
            folder, names = copied_files(context.window_manager.clipboard)
        except InvoluteError as problem:
            self.report({"ERROR"}, message(problem))
            return {"CANCELLED"}
        files = [{"name": name} for name in names]
        return self.hand_to(bpy.ops.involute.trace, directory=folder, files=files)


def pasted(context: bpy.types.Context) -> bpy.types.Image | None:
    """A new image data-block of what is in the clipboard; None where Blender sees no picture.

    Blender pastes pictures in Image Editors only: an editor of the window is one for a moment,
    another than that which the artist is at, if there is any.
    """
    window = context.window
    if window is None:
        return None
    others = [area for area in window.screen.areas if area != context.area]
    area = min(others or [context.area], key=lambda one: one.width * one.height)
    kind, paste = area.ui_type, bpy.ops.image.clipboard_paste
    known = set(bpy.data.images)
    area.type = "IMAGE_EDITOR"
    try:
        with context.temp_override(window=window, area=area):
            if not paste.poll() or paste() != {"FINISHED"}:
                return None
    except RuntimeError:  # a picture of a kind that it can't read
        return None
    finally:
        area.ui_type = kind
    image = next((one for one in bpy.data.images if one not in known), None)
    if image is not None:
        image.pack()  # it has no file: so it is saved, and can be traced again
    return image


def copied_files(text: str) -> tuple[str, list[str]]:
    """The folder and names of the picture files that the text of a clipboard names.

    File managers copy paths, one a line, or addresses that begin with file://.

    Raises:
        InvoluteError: it names none.
    """
    paths = [_path_of(line.strip().strip('"')) for line in text.splitlines() if line.strip()]
    found = [path for path in paths if path.suffix.lower() in TRACED and path.is_file()]
    if not found:
        raise InvoluteError(
            "Blender sees no picture in the clipboard; save it as a file, and drop that on the "
            "viewport."
        )
    folder = found[0].parent
    return str(folder), [path.name for path in found if path.parent == folder]


def _path_of(line: str) -> Path:
    """The path that a line names; what Python has for addresses can open them, too, and nothing
    here is to be able to."""
    address = re.fullmatch(r"file:(?://[^/]*)?(/.*)", line, re.IGNORECASE)
    if not address:
        return Path(line)
    raw = re.sub(
        rb"%([0-9a-fA-F]{2})", lambda of: bytes.fromhex(of[1].decode()), address[1].encode()
    )
    path = raw.decode("utf-8", "surrogateescape")
    return Path(path[1:] if re.match(r"/[a-zA-Z]:", path) else path)  # of Windows: /C:/...


CLASSES = (INVOLUTE_OT_paste,)
