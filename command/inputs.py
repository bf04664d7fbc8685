"""What is read: the images that files, folders and globs stand for, and that none is written."""

from __future__ import annotations

import glob
import os
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from ..engine.errors import InvoluteError
from ..engine.formats.picture_kinds import SUFFIXES, why_left_out

_NAMED = 6  # files that a message names
_SILENT = {".svg", ".json", ".blend", ".blend1", ".db", ".ini"}  # ours, Blender's, and systems'


@dataclass(frozen=True)
class Found:
    """Images to trace, and what else lies in the folders: (path, why it is left out)."""

    images: tuple[Path, ...]
    left_out: tuple[tuple[Path, str], ...] = ()

    def about_left_out(self) -> str | None:
        """One line about what is left out, or None."""
        reasons: dict[str, list[str]] = {}
        for path, why in self.left_out:
            reasons.setdefault(why, []).append(path.name)
        if not reasons:
            return None
        return "left out: " + "; ".join(
            f"{_listed(names)} ({why})" for why, names in reasons.items()
        )


def find(inputs: Iterable[str]) -> Found:
    """The images that files, folders and globs stand for; missing files too, to be told later.

    Raises:
        InvoluteError: a folder or a glob without an image, or one that can't be read.
    """
    images: list[Path] = []
    left_out: list[tuple[Path, str]] = []
    for text in inputs:
        if not text:
            raise InvoluteError("The name of an input is empty; give a file or a folder.")
        path = Path(text)
        with _told(text):
            if path.is_dir():
                found, others = _in_folder(path)
                left_out += others
            elif not path.exists() and glob.has_magic(text):
                matches = map(Path, glob.iglob(text, recursive=True))
                found = _each_once(path for path in matches if path.is_file())
            else:
                found = None
        if found is None:
            images.append(path)
            continue
        if not found:
            about = Found((), tuple(left_out)).about_left_out()
            raise InvoluteError(
                f"There is no image in {text}; check the path" + (f" ({about})." if about else ".")
            )
        images += sorted(found, key=natural)
    return Found(tuple(images), tuple(left_out))


@contextmanager
def _told(text: str) -> Iterator[None]:
    """Say why a folder can't be looked into."""
    try:
        yield
    except (OSError, ValueError, re.error) as error:
        why = getattr(error, "strerror", None) or error
        raise InvoluteError(f"Can't read {text}: {why}.") from None


def _in_folder(folder: Path) -> tuple[list[Path], list[tuple[Path, str]]]:
    found: list[Path] = []
    others: list[tuple[Path, str]] = []
    for path in sorted(folder.iterdir(), key=natural):
        if path.name.startswith(".") or path.suffix.lower() in _SILENT or path.is_dir():
            continue
        why = why_left_out(path)
        if path.suffix.lower() in SUFFIXES and not path.is_file():
            why = "a link to nowhere" if path.is_symlink() else "not a file"
        if why:
            others.append((path, why))
        else:
            found.append(path)
    return found, others


def _each_once(paths: Iterable[Path]) -> list[Path]:
    """The paths without those that only lead round a link to a folder above.

    A link to a picture is a picture of its own: a drawing that a sequence holds.
    """
    shortest_first = sorted(paths, key=lambda path: len(path.parts))
    place = {folder: os.path.realpath(folder) for folder in {p.parent for p in shortest_first}}
    found: dict[tuple[str, str], Path] = {}
    for path in shortest_first:
        found.setdefault((place[path.parent], path.name), path)
    return list(found.values())


def natural(path: Path) -> list[tuple[int, int, str]]:
    """Sorts page2 before page10."""
    parts = re.split(r"(\d+)", str(path).lower())
    # More digits than Python reads as one number are no number of a page.
    return [(0, int(p), "") if p.isdecimal() and len(p) < 1000 else (1, 0, p) for p in parts]


class Inputs:
    """Files that are read, and so are never written, by whatever name or link."""

    def __init__(self, paths: Iterable[str | os.PathLike[str]]) -> None:
        self._known = {file for path in paths for file in _identity(path)}

    def __contains__(self, path: str | os.PathLike[str]) -> bool:
        return any(file in self._known for file in _identity(path))

    @staticmethod
    def refusal(path: str | os.PathLike[str]) -> str:
        """What to say instead of writing there."""
        return f"{os.fspath(path)} is itself an image to trace; choose another place to write to."


def _identity(path: str | os.PathLike[str]) -> Iterator[tuple[int, int]]:
    """The file that a path leads to, whatever it is called, and the link itself where it is one."""
    for look in (os.stat, os.lstat):
        with suppress(OSError, ValueError):
            found = look(path)
            yield found.st_dev, found.st_ino


def _listed(names: list[str]) -> str:
    more = len(names) - _NAMED
    return ", ".join(names[:_NAMED]) + (f" and {more} more" if more > 0 else "")
