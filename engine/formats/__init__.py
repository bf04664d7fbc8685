"""Drawings on disk, chosen by how the name ends: SVG, JSON (keeps everything), PNG and others.

A format is declared once, as a `Format`: the command line, its help and the manual follow. What the
engine may not import (Blender) declares its format where it is, and hands it to `command.cli.main`.
"""

from __future__ import annotations

import stat
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
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

    suffix: such as ".svg", or ".plot.svg" for one of several kinds of SVG.
    about: what it is, for people; a phrase.
    endings: how a whole file ends, apart from blanks and zeros; one that was cut short does not.
    write: writes one drawing to a path.
    read: makes a drawing of a text and the file's name; None where it can't be read back.
    write_many: writes (name, drawing) pairs to one path; None where a file holds one drawing.
    write_sequence: writes a name and (frame, drawing) pairs, ascending, to one path, or None.
    needs: the library that writes it, where Involute comes without: (module, how pip calls it).
    """

    suffix: str
    about: str
    endings: tuple[bytes, ...]
    write: Callable[[Drawing, Path], None] | None = None
    read: Callable[[str, str], Drawing] | None = None
    write_many: Callable[[Sequence[tuple[str, Drawing]], Path], None] | None = None
    write_sequence: Callable[[str, Iterable[tuple[int, Drawing]], Path], None] | None = None
    needs: tuple[str, str] | None = None

    @property
    def name(self) -> str:
        """As `--format` takes it: svg."""
        return self.suffix.lstrip(".")

    def stem(self, path: Path) -> str:
        """The name of a file of this format without the suffix."""
        return path.name[: -len(self.suffix)]

    def check(self) -> None:
        """Make sure that the library it needs is there.

        Raises:
            InvoluteError: it is not.
        """
        if self.needs and find_spec(self.needs[0]) is None:
            raise InvoluteError(
                f"{self.suffix} needs the library {self.needs[0]}; install Involute with its extra "
                f"'exchange', or {self.needs[1]} with pip into the Python that runs it."
            )

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
    Format(
        suffix=".outline.svg",
        about="the shape of each stroke with its true varying width, for Illustrator and Inkscape; "
        "the center lines on a hidden layer",
        endings=(b"</svg>",),
        write=_later("svg_outline", "write"),
        read=_later("svg", "read"),
    ),
    Format(
        suffix=".plot.svg",
        about="for pen plotters: few long paths in a short order, no line twice, in mm",
        endings=(b"</svg>",),
        write=_later("svg_plot", "write"),
    ),
    Format(
        suffix=".dxf",
        about="polylines with widths, or splines, in layers by ink, in mm, for CAD programs",
        endings=(b"EOF",),
        write=_later("dxf", "write"),
        needs=("ezdxf", "ezdxf==1.4.5"),
    ),
    Format(
        suffix=".pdf",
        about="a page in the size of the paper, with true widths and layers; sequences as pages",
        endings=(b"%%EOF",),
        write=_later("pdf", "write"),
        write_sequence=_later("pdf", "write_sequence"),
        needs=("pypdf", "pypdf==7.1.0"),
    ),
    Format(
        suffix=".lottie.json",
        about="an animation for the web: a drawing draws itself, a sequence plays",
        endings=(b"}",),
        write=_later("lottie", "write"),
        write_sequence=_later("lottie", "write_sequence"),
    ),
    Format(
        suffix=".pli",
        about="a vector level of OpenToonz and Tahoma2D: lines with thickness, a style per ink",
        endings=(b"END",),
        write=_later("pli", "write"),
        write_sequence=_later("pli", "write_sequence"),
    ),
)


def format_of(path: str | PathLike[str], formats: Iterable[Format] = FORMATS) -> Format | None:
    """The format that a file's name ends with; of .plot.svg and .svg the longer one."""
    name = Path(path).name.lower()
    fitting = [f for f in formats if name.endswith(f.suffix) and name != f.suffix]
    return max(fitting, key=lambda f: len(f.suffix), default=None)


def save(drawing: Drawing, path: str | PathLike[str]) -> None:
    """Write a drawing in the format that the suffix names; nothing half-written is left behind.

    Raises:
        InvoluteError: an unknown suffix, or the file can't be written.
    """
    from .whole_file import whole_file

    path = Path(path)
    kind = format_of(path)
    if kind is None or kind.write is None:
        known = either(f.suffix for f in FORMATS if f.write)
        raise InvoluteError(f"Can't write {path.name}; choose a name that ends in {known}.")
    kind.check()
    with whole_file(path) as part:
        kind.write(drawing, part)


def load(path: str | PathLike[str]) -> Drawing:
    """Read a drawing from .json (everything) or from an .svg that Involute wrote (its strokes).

    Raises:
        InvoluteError: the file can't be read as a drawing.
    """
    path = Path(path)
    kind = format_of(path)
    if kind is None or kind.read is None:
        known = either(f.suffix for f in FORMATS if f.read)
        raise InvoluteError(f"{path.name} holds no drawing; choose a {known} file.")
    return kind.read(read_text(path), path.name)


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


__all__ = ["FORMATS", "Format", "either", "format_of", "load", "read_text", "save"]
