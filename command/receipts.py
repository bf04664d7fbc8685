"""What was done before: a receipt for each drawing, which knows the very files that were made.

A receipt lies in a hidden folder beside the outputs. It is written before the outputs move into
their place, so that there is no moment in which a file of ours could pass for someone else's, and
it holds a digest of each file, so that a file that was edited since is never taken for ours.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Collection, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from enum import Enum
from functools import cache, lru_cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from ..engine import runtimes, weights
from ..engine.formats import Format
from ..engine.formats.whole_file import whole_file, write_text
from ..engine.settings import Settings

FOLDER = ".involute"  # beside the outputs
_REMEMBERED = 4  # makings of one file; two programs may be at it at once
_LIBRARIES = ("numpy", "opencv-contrib-python-headless", "networkx")  # they compute the drawings
_TAIL = 64  # bytes at the end of a file that show whether it is whole


class Standing(Enum):
    """How an output stands to what is to be made."""

    FREE = "not there, cut short, or made by us of something else"
    DONE = "made of the same, by the same program"
    SETTLED = "made by us of the same, and edited by someone since"
    EDITED = "made by us of something else, and edited by someone since"
    FOREIGN = "not made by us"


ALL = frozenset(Standing) - {Standing.DONE}
"""What `--overwrite` replaces."""


@dataclass(frozen=True)
class Receipt:
    """What was made of one drawing.

    made: name of a file -> digest of its bytes -> key of what it was made of, the newest last.
    report: the figures of the newest.
    """

    made: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    report: Mapping[str, Any] = field(default_factory=dict)


def path_for(output: Path, page: str = "") -> Path:
    """Where the receipt of an output lies.

    Args:
        output: a file that the drawing goes to; those of other formats share the receipt.
        page: the drawing's name, where many go to one file.
    """
    name = f"{output.name}-{page}" if page else output.stem
    if len(os.fsencode(name)) > 240:
        name = hashlib.blake2b(os.fsencode(name), digest_size=16).hexdigest()
    return output.parent / FOLDER / f"{name}.json"


def read(path: Path) -> Receipt:
    """A receipt; an empty one when there is none, or none that can be read."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        made = {
            str(name): {str(digest): str(key) for digest, key in digests.items()}
            for name, digests in content["made"].items()
        }
        return Receipt(made, dict(content["report"]))
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return Receipt()


def standing(output: Path, kind: Format, receipt: Receipt, key: str) -> Standing:
    """How an output stands to what has this key; what can't be read isn't known to be ours."""
    try:
        if not output.is_file():
            return Standing.FOREIGN if output.exists() else Standing.FREE
        made, found = receipt.made.get(output.name, {}), digest(output)
        whole = _is_whole(output, kind)
    except FileNotFoundError:
        return Standing.FREE
    except OSError:
        return Standing.FOREIGN
    if found in made:
        return Standing.DONE if made[found] == key else Standing.FREE
    if not made:
        return Standing.FOREIGN
    if not whole:
        return Standing.FREE
    newest = list(made.values())[-1]
    return Standing.SETTLED if newest == key else Standing.EDITED


def to_be_made(found: Standing, over: Collection[Standing]) -> bool:
    """Whether an output is to be made; `over` = what it may replace besides files of ours."""
    return found is Standing.FREE or found in over


def note(path: Path, key: str, files: Mapping[str, Path], report: Mapping[str, Any]) -> None:
    """Write down that files with these bytes are ours; call it before they get their names.

    Args:
        path: of the receipt.
        key: of what they were made of.
        files: final name -> file with the bytes.

    Raises:
        InvoluteError: the receipt can't be written.
    """
    before = read(path)
    made = {name: dict(digests) for name, digests in before.made.items()}
    for name, file in files.items():
        digests, found = made.setdefault(name, {}), digest(file)
        digests.pop(found, None)
        digests[found] = key
        made[name] = dict(list(digests.items())[-_REMEMBERED:])
    path.parent.mkdir(exist_ok=True)
    with whole_file(path) as part:
        write_text(json.dumps({"made": made, "report": dict(report)}), part)


def digest(file: Path) -> str:
    """The hash of a file's bytes.

    Raises:
        OSError: it can't be read.
    """
    found = hashlib.blake2b(digest_size=16)
    with open(file, "rb") as stream:
        while block := stream.read(1 << 20):
            found.update(block)
    return found.hexdigest()


def fingerprint(source: str, page: int, settings: Settings) -> str:
    """The key of a drawing; other image bytes, settings, program or weights make another one.

    Raises:
        OSError: the image can't be read.
    """
    info = os.stat(source)
    image = _content(source, info.st_size, info.st_mtime_ns, info.st_ctime_ns)
    found = hashlib.blake2b(image.encode(), digest_size=16)
    recipe = [settings.as_dict(), page, program()]
    found.update(json.dumps(recipe, sort_keys=True).encode())
    return found.hexdigest()


def forget_images() -> None:
    """Images may have changed since the last run."""
    _content.cache_clear()


@lru_cache(4096)
def _content(source: str, size: int, changed: int, status: int) -> str:
    """The hash of an image; remembered for a run: the images of a movie are in one file."""
    return digest(Path(source))


@cache
def program() -> str:
    """The hash of what makes the drawings: all sources and weights, the libraries' versions, and
    what runs the networks, by which they differ in the last digits.

    Raises:
        InvoluteError: INVOLUTE_RUNTIME asks for a runtime that isn't here.
    """
    folder = Path(weights.__file__).resolve().parents[1]
    files = [*folder.rglob("*.py"), *(weights.FOLDER / name for name in weights.names())]
    found = hashlib.blake2b(digest_size=16)
    for file in sorted(files):
        content = hashlib.blake2b(file.read_bytes()).hexdigest()
        found.update(f"{file.relative_to(folder).as_posix()} {content}\n".encode())
    for name in _LIBRARIES:
        with suppress(PackageNotFoundError):
            found.update(f"{name} {version(name)}\n".encode())
    runtime = runtimes.chosen()
    found.update(f"{runtime.name} {runtime.version}\n".encode())
    return found.hexdigest()


def _is_whole(file: Path, kind: Format) -> bool:
    """Whether a file ends as its format does; one that was cut short does not."""
    with open(file, "rb") as stream:
        stream.seek(max(0, os.fstat(stream.fileno()).st_size - _TAIL))
        return stream.read().rstrip(b"\0 \t\r\n").endswith(kind.endings)
