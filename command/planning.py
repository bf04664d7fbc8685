"""What to trace into what: images, folders and globs go to files or into a folder."""

from __future__ import annotations

import glob
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..engine.errors import InvoluteError
from ..engine.formats import Format, either

IMAGES = frozenset({".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp", ".bmp"})


@dataclass(frozen=True)
class Target:
    """Where the drawings go: one file, or a folder and the formats to write into it."""

    path: Path
    formats: tuple[Format, ...]
    is_file: bool

    @property
    def shared(self) -> bool:
        """Whether all drawings go into one file."""
        return self.is_file and self.formats[0].write_many is not None


@dataclass(frozen=True)
class Page:
    """One drawing to make: a page of an image, the name it goes by and the files it goes to."""

    source: Path
    page: int
    name: str
    outputs: tuple[Path, ...]


def target(output: str, chosen: str | None, formats: Sequence[Format]) -> Target:
    """Understand OUT and --format.

    Args:
        output: a file or a folder.
        chosen: names of formats with commas between, or None.
        formats: all that there are; the first is the default.

    Raises:
        InvoluteError: they don't fit together.
    """
    path = Path(output)
    suffix = path.suffix.lower()
    known = {f.name: f for f in formats}
    if suffix.lstrip(".") in known and not path.is_dir():
        if chosen:
            raise InvoluteError("Give --format only with a folder as output.")
        return Target(path, (known[suffix.lstrip(".")],), True)
    if suffix and not path.is_dir() and not chosen:
        raise InvoluteError(
            f"Can't write {path.name}; choose a name that ends in "
            f"{either(f.suffix for f in formats)}, or a folder."
        )
    names = [n.strip().lower().lstrip(".") for n in (chosen or formats[0].name).split(",")]
    for name in names:
        if name not in known:
            raise InvoluteError(f"There is no format {name!r}; choose from {', '.join(known)}.")
    return Target(path, tuple(known[name] for name in dict.fromkeys(names)), False)


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
    if target.is_file and len(sources) > 1 and not target.shared:
        raise InvoluteError(
            f"{len(sources)} images can't go into one {target.formats[0].suffix}; "
            "give a folder as output, or a .blend."
        )
    alone = target.is_file and not target.shared
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
                if target.shared
                else tuple(folder / f"{title}{f.suffix}" for f in target.formats)
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
