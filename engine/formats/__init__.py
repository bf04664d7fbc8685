"""Drawings on disk, chosen by suffix: SVG, JSON (keeps everything) and a PNG preview.

A format is declared once, as a `Format`: the command line, its help and the manual follow. What the
engine may not import (Blender) declares its format where it is, and hands it to `command.cli.main`.
"""

from __future__ import annotations

import stat
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from importlib import import_module
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import InvoluteError

if TYPE_CHECKING:
    from ..drawing import Drawing


_LARGEST = 2**29  # bytes of a file; the drawing of a page of 8192 px has some 2**24


@dataclass(frozen=True, kw_only=True)
class Format:
    """One kind of file for drawings.

    suffix: such as ".svg".
    about: what it is, for people; a phrase.
    endings: how a whole file ends, apart from blanks and zeros; one that was cut short does not.
    write: writes one drawing to a path.
    read: makes a drawing of a text and the file's name; None where it can't be read back.
    write_many: writes (name, drawing) pairs to one path; None where a file holds one drawing.
    write_sequence: writes a name and (frame, drawing) pairs, ascending, to one path, or None.
    """

    suffix: str
    about: str
    endings: tuple[bytes, ...]
    write: Callable[[Drawing, Path], None] | None = None
    read: Callable[[str, str], Drawing] | None = None
    write_many: Callable[[Sequence[tuple[str, Drawing]], Path], None] | None = None
    write_sequence: Callable[[str, Iterable[tuple[int, Drawing]], Path], None] | None = None

    @property
    def name(self) -> str:
        """As `--format` takes it: svg."""
        return self.suffix.lstrip(".")

    def save(self, drawing: Drawing, name: str, path: Path) -> None:
        """Write one drawing, which goes by that name, to a path."""
        if self.write:
            self.write(drawing, path)
        elif self.write_many:
            self.write_many([(name, drawing)], path)


def _later(module: str, function: str) -> Callable[..., Any]:
    """A function of this package; its module, with all of OpenCV, is imported when it is called."""

    def call(*arguments: Any) -> Any:
        return getattr(import_module(f".{module}", __name__), function)(*arguments)

    return call


FORMATS = (
    Format(
        suffix=".svg",
        about="a path per stroke, for every vector program",
        endings=(b"</svg>",),
        write=_later("svg", "write"),
        read=_later("svg", "read"),
    ),
    Format(
        suffix=".json",
        about="everything, junctions and their alternatives too, for Involute and Python",
        endings=(b"}",),
        write=_later("drawing_json", "write"),
        read=_later("drawing_json", "read"),
    ),
    Format(
        suffix=".png",
        about="a picture to look at: each stroke in its own color, junctions ringed",
        endings=(b"IEND\xaeB`\x82",),
        write=_later("png", "write"),
    ),
)


def save(drawing: Drawing, path: str | PathLike[str]) -> None:
    """Write a drawing in the format that the suffix names; nothing half-written is left behind.

    Raises:
        InvoluteError: an unknown suffix, or the file can't be written.
    """
    from .whole_file import whole_file

    path = Path(path)
    known = {f.suffix: f.write for f in FORMATS if f.write}
    writer = known.get(path.suffix.lower())
    if writer is None:
        raise InvoluteError(f"Can't write {path.name}; choose a name that ends in {either(known)}.")
    with whole_file(path) as part:
        writer(drawing, part)


def load(path: str | PathLike[str]) -> Drawing:
    """Read a drawing from .json (everything) or from an .svg that Involute wrote (its strokes).

    Raises:
        InvoluteError: the file can't be read as a drawing.
    """
    path = Path(path)
    known = {f.suffix: f.read for f in FORMATS if f.read}
    reader = known.get(path.suffix.lower())
    if reader is None:
        raise InvoluteError(f"{path.name} holds no drawing; choose a {either(known)} file.")
    return reader(read_text(path), path.name)


def read_text(path: Path) -> str:
    """The text of a file, if it is one and no larger than a drawing can be.

    Raises:
        InvoluteError: it can't be read.
    """
    try:
        found = path.stat()
        if not stat.S_ISREG(found.st_mode):
            raise InvoluteError(f"{path} is no file; check the path.")
        if found.st_size > _LARGEST:
            raise InvoluteError(f"{path.name} is larger than any drawing; trace the picture again.")
        return path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise InvoluteError(f"There is no file {path}; check the path.") from None
    except UnicodeDecodeError:
        raise InvoluteError(f"{path.name} is damaged or isn't text; trace it again.") from None
    except OSError as error:
        raise InvoluteError(f"Can't read {path}: {error.strerror or error}.") from None


def either(names: Iterable[str]) -> str:
    """Names as a sentence lists them: .svg, .json or .png."""
    *others, last = names
    return f"{', '.join(others)} or {last}" if others else last


__all__ = ["FORMATS", "Format", "either", "load", "read_text", "save"]
