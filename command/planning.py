"""What to trace into what: images go to files or into a folder, under names that never collide."""

from __future__ import annotations

import os
import unicodedata
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from hashlib import blake2b
from pathlib import Path

from ..engine.errors import InvoluteError
from ..engine.formats import Format, either, format_of
from ..engine.formats.whole_file import why_not

_LONGEST = 240  # bytes of a title; 255 with suffix, and room for its receipt


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
class PlannedPage:
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
    kind = format_of(path, formats)
    if kind and not path.is_dir():
        if chosen:
            raise InvoluteError("Give --format only with a folder as output.")
        kind.check()
        return Target(path, (kind,), True)
    known = {f.name: f for f in formats}
    if path.suffix and not path.is_dir() and not chosen:
        raise InvoluteError(
            f"Can't write {path.name}; choose a name that ends in "
            f"{either(f.suffix for f in formats)}, or a folder."
        )
    names = [n.strip().lower().lstrip(".") for n in (chosen or formats[0].name).split(",")]
    for name in names:
        if name not in known:
            raise InvoluteError(f"There is no format {name!r}; choose from {', '.join(known)}.")
        known[name].check()
    return Target(path, tuple(known[name] for name in dict.fromkeys(names)), False)


def pages(sources: Sequence[tuple[Path, int]], target: Target) -> list[PlannedPage]:
    """One entry a page, with outputs that never collide.

    A name depends on the image's own name alone, unless several would get the same: then all of
    them take their suffix into their names, and where that is not enough, a few letters that
    stand for their folder and full name. So no drawing gets the name that another one had.

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
    if target.is_file and not target.shared:
        named = [[target.formats[0].stem(target.path)]] * len(sources)
    else:
        named = [_names(path, target.formats) for path, _ in sources]
    folder = target.path.parent if target.is_file else target.path
    found = []
    for (path, _), titles in zip(sources, _distinct(named, sources), strict=True):
        for page, title in enumerate(titles):
            outputs = tuple(folder / f"{title}{f.suffix}" for f in target.formats)
            outputs = (target.path,) if target.shared else outputs
            found.append(PlannedPage(path, page, title, outputs))
    return found


def _distinct(
    named: Sequence[Sequence[str]], sources: Sequence[tuple[Path, int]]
) -> list[list[str]]:
    """The titles of all pages of each image; each image takes the first of its names that serves.

    Raises:
        InvoluteError: there is none.
    """
    level = [0] * len(named)
    while True:
        titles = [
            _titles(names[at], count)
            for names, at, (_, count) in zip(named, level, sources, strict=True)
        ]
        times = Counter(folded(title) for all_of_one in titles for title in all_of_one)
        clash = [any(times[folded(t)] > 1 for t in all_of_one) for all_of_one in titles]
        if not any(clash):
            return titles
        for index, clashes in enumerate(clash):
            if clashes and level[index] + 1 == len(named[index]):
                raise InvoluteError(
                    f"Drawings would get the same name {titles[index][0]}; rename an image."
                )
            level[index] += clashes


def _names(path: Path, formats: Sequence[Format]) -> list[str]:
    """What the drawings of an image may be called, the simplest first."""
    stem, suffix = path.stem, path.suffix.lstrip(".")
    plain = [f"{path.parent.name}/{path.name}", str(path.absolute())]
    marks = [blake2b(os.fsencode(text), digest_size=3).hexdigest() for text in plain]
    with_suffix = f"{stem}-{suffix}" if suffix else stem
    names = [stem, with_suffix, *(f"{with_suffix}-{mark}" for mark in marks)]
    # page.plot.png may not become page.plot.svg, which is another format.
    return names[any(format_of(stem + f.suffix) not in (f, None) for f in formats) :]


def _titles(name: str, count: int) -> list[str]:
    digits = len(str(count))
    titles = [name] if count == 1 else [f"{name}-{page + 1:0{digits}d}" for page in range(count)]
    return [_short_enough(title) for title in titles]


def folded(title: str) -> str:
    """Equal for names that some file system takes for the same."""
    return unicodedata.normalize("NFC", title).casefold()


def _short_enough(title: str) -> str:
    """The title, cut where the names of its files would be longer than file systems take."""
    if len(os.fsencode(title)) <= _LONGEST:
        return title
    mark = blake2b(os.fsencode(title), digest_size=3).hexdigest()
    kept = title
    while len(os.fsencode(kept)) > _LONGEST - len(mark) - 1:
        kept = kept[:-1]
    return f"{kept}-{mark}"


def make_folder(folder: Path) -> Path:
    """Make a folder, with those above it, unless it is there.

    Raises:
        InvoluteError: it can't be made.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InvoluteError(f"Can't make the folder {folder}: {why_not(error)}.") from None
    return folder
