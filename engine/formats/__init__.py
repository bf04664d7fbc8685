"""Drawings on disk, chosen by suffix: SVG, JSON (keeps everything) and a PNG preview."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import InvoluteError

if TYPE_CHECKING:
    from ..drawing import Drawing

SUFFIXES = (".svg", ".json", ".png")


def save(drawing: Drawing, path: str | PathLike[str]) -> None:
    """Write a drawing in the format that the suffix names; nothing half-written is left behind.

    Raises:
        InvoluteError: an unknown suffix, or the file can't be written.
    """
    from . import drawing_json, png, svg
    from .whole_file import whole_file

    path = Path(path)
    writers = {".svg": svg.write, ".json": drawing_json.write, ".png": png.write}
    writer = writers.get(path.suffix.lower())
    if writer is None:
        raise InvoluteError(f"Can't write {path.name}; choose a name that ends in {_endings()}.")
    with whole_file(path) as part:
        writer(drawing, part)


def load(path: str | PathLike[str]) -> Drawing:
    """Read a drawing from .json (everything) or from an .svg that Involute wrote (its strokes).

    Raises:
        InvoluteError: the file can't be read as a drawing.
    """
    from . import drawing_json, svg

    path = Path(path)
    readers = {".svg": svg.read, ".json": drawing_json.read}
    reader = readers.get(path.suffix.lower())
    if reader is None:
        raise InvoluteError(f"{path.name} holds no drawing; choose a .json or .svg file.")
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise InvoluteError(f"There is no file {path}; check the path.") from None
    except UnicodeDecodeError:
        raise InvoluteError(f"{path.name} is damaged or isn't text; trace it again.") from None
    except OSError as error:
        raise InvoluteError(f"Can't read {path}: {error.strerror or error}.") from None
    return reader(text, path.name)


def _endings() -> str:
    return ", ".join(SUFFIXES[:-1]) + " or " + SUFFIXES[-1]


__all__ = ["SUFFIXES", "load", "save"]
