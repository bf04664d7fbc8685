"""What to trace into what: images, folders and globs go to files or into a folder."""

from __future__ import annotations

import glob
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..engine.errors import InvoluteError

IMAGES = frozenset({".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp", ".bmp"})
FORMATS = ("svg", "json", "png", "blend")


@dataclass(frozen=True)
class Target:
    """Where the drawings go: one file, or a folder and the formats to write into it."""

    path: Path
    suffixes: tuple[str, ...]
    is_file: bool


@dataclass(frozen=True)
class Page:
    """One drawing to make: a page of an image, the name it goes by and the files it goes to."""

    source: Path
    page: int
    name: str
    outputs: tuple[Path, ...]


def target(output: str, formats: str | None) -> Target:
    """Understand OUT and --format.

    Raises:
        InvoluteError: they don't fit together.
    """
    path = Path(output)
    suffix = path.suffix.lower()
    if suffix.lstrip(".") in FORMATS and not path.is_dir():
        if formats:
            raise InvoluteError("Give --format only with a folder as output.")
        return Target(path, (suffix,), True)
    if suffix and not path.is_dir() and not formats:
        raise InvoluteError(
            f"Can't write {path.name}; choose a name that ends in .svg, .json, .png or .blend, "
            "or a folder."
        )
    names = [name.strip().lower().lstrip(".") for name in (formats or "svg").split(",")]
    unknown = [name for name in names if name not in FORMATS]
    if unknown:
        raise InvoluteError(f"There is no format {unknown[0]!r}; choose from {', '.join(FORMATS)}.")
    return Target(path, tuple(dict.fromkeys(f".{name}" for name in names)), False)


def images(inputs: Iterable[str]) -> Iterator[Path]:
    """The images that files, folders and globs stand for; missing files too, to be told later.

    Raises:
        InvoluteError: a folder or a glob without an image.
    """
    for text in inputs:
        path = Path(text)
        if path.is_dir():
            found = [p for p in path.iterdir() if p.suffix.lower() in IMAGES and p.is_file()]
        elif not path.exists() and glob.has_magic(text):
            found = [p for p in map(Path, glob.iglob(text, recursive=True)) if p.is_file()]
        else:
            yield path
            continue
        if not found:
            raise InvoluteError(f"There is no image in {text}; check the path.")
        yield from sorted(found, key=natural)


def natural(path: Path) -> list[tuple[int, int, str]]:
    """Sorts page2 before page10."""
    parts = re.split(r"(\d+)", str(path).lower())
    return [(0, int(p), "") if p.isdecimal() else (1, 0, p) for p in parts]


def pages(sources: Sequence[tuple[Path, int]], target: Target) -> list[Page]:
    """One entry a page, with outputs that never collide.

    Args:
        sources: images and their numbers of pages; an image named twice counts once.

    Raises:
        InvoluteError: several drawings for one file that can hold only one.
    """
    sources = list({path.absolute(): (path, count) for path, count in sources}.values())
    shared = target.is_file and target.suffixes == (".blend",)
    if target.is_file and len(sources) > 1 and not shared:
        raise InvoluteError(
            f"{len(sources)} images can't go into one {target.suffixes[0]}; "
            "give a folder as output, or a .blend."
        )
    alone = target.is_file and not shared
    stems = [target.path.stem if alone else path.stem for path, _ in sources]
    twice = Counter(stem.lower() for stem in stems)
    names: list[str] = []
    taken: set[str] = set()
    for (path, _), stem in zip(sources, stems, strict=True):
        name = stem if twice[stem.lower()] == 1 else f"{stem}-{path.suffix.lstrip('.')}"
        serial = 2
        base = name
        while name.lower() in taken:
            name, serial = f"{base}-{serial}", serial + 1
        taken.add(name.lower())
        names.append(name)
    folder = target.path.parent if target.is_file else target.path
    found = []
    for (path, count), name in zip(sources, names, strict=True):
        digits = len(str(count))
        for page in range(count):
            title = name if count == 1 else f"{name}-{page + 1:0{digits}d}"
            outputs = (
                (target.path,)
                if shared
                else tuple(folder / f"{title}{suffix}" for suffix in target.suffixes)
            )
            found.append(Page(path, page, title, outputs))
    return found


def make_folder(folder: Path) -> Path:
    """Make a folder, with those above it, unless it is there.

    Raises:
        InvoluteError: it can't be made.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InvoluteError(
            f"Can't make the folder {folder}: {error.strerror or error}; choose another."
        ) from None
    return folder
