"""Files that are either whole or not there: written beside their place, then moved into it."""

from __future__ import annotations

import errno
import filecmp
import os
import platform
import re
import secrets
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from hashlib import blake2b
from os import PathLike
from pathlib import Path

from ..errors import InvoluteError

_REASONS = {
    errno.EACCES: "you may not write there; choose another folder",
    errno.EPERM: "you may not write there; choose another folder",
    errno.EROFS: "that place is read-only; choose another folder",
    errno.ENOSPC: "the disk is full; make room or choose another disk",
    errno.EDQUOT: "your disk quota is used up; make room or choose another disk",
    errno.EFBIG: "files of that size are not allowed there; choose another disk",
    errno.EEXIST: "a file of that name is in the way; choose another name",
    errno.ENOENT: "its folder doesn't exist; make it first",
    errno.ENOTDIR: "its folder is a file; choose another folder",
    errno.EISDIR: "a folder of that name is in the way; choose another name",
    errno.EINVAL: "what stands there is no file; choose another name",
    errno.ENAMETOOLONG: "its name is too long; choose a shorter one",
    errno.ELOOP: "links there lead in a circle; choose another folder",
}
_PART = re.compile(r"\.(\w{8})-(\w{8})-(\d+)-\w{16}\.part(\.\w+)?@?")
_HOST = blake2b(platform.node().encode("utf-8", "replace"), digest_size=4).hexdigest()
_ABANDONED = 86400.0  # s; no drawing takes a day to write


def why_not(error: OSError) -> str:
    """Why something can't be written, and what to do about it; half a sentence."""
    return _REASONS.get(error.errno or 0, error.strerror or str(error))


@contextmanager
def whole_file(path: str | PathLike[str]) -> Iterator[Path]:
    """Give a temporary path to write to; move it to `path` only when all went well.

    Raises:
        InvoluteError: the file can't be written; what stood at `path` before is still there.
    """
    with whole_files([path]) as (part,):
        yield part


@contextmanager
def whole_files(
    paths: Iterable[str | PathLike[str]],
    before_moving: Callable[[Sequence[Path]], None] | None = None,
) -> Iterator[list[Path]]:
    """The same for several files that belong together; none is moved before all are written.

    Args:
        paths: where the files go.
        before_moving: called with the temporary files when they are on the disk; what it raises
            leaves everything as it was. A file that has the very bytes already is not replaced.

    Raises:
        InvoluteError: one can't be written.
    """
    places = [Path(path) for path in paths]
    parts: list[Path] = []
    try:
        for place in places:
            parts.append(_new_part(place))
        yield list(parts)
        for part in parts:
            _reach_disk(part)
        if before_moving:
            before_moving(parts)
        for part, place in zip(parts, places, strict=True):
            if not (before_moving and _same(part, place)):
                os.replace(part, place)
    except OSError as error:
        reason = why_not(error)
        at = dict(zip(map(str, parts), places, strict=False)).get(str(error.filename), places[0])
        raise InvoluteError(f"Can't write {at}: {reason}.") from error
    finally:
        for part in parts:
            with suppress(OSError):
                part.unlink(missing_ok=True)


def remove_leftovers(outputs: Iterable[Path]) -> None:
    """Remove temporary files of these very outputs that killed processes have left."""
    folders: dict[Path, set[str]] = {}
    for output in outputs:
        folders.setdefault(output.parent, set()).add(_short(output.name))
    for folder, names in folders.items():
        with suppress(OSError):
            for entry in os.scandir(folder):
                match = _PART.fullmatch(entry.name)
                if match and match[1] in names and _is_abandoned(entry, match[2], int(match[3])):
                    os.unlink(entry.path)


def write_text(text: str, path: Path) -> None:
    """Write text as UTF-8."""
    write_bytes(text.encode("utf-8", "surrogateescape"), path)


def write_bytes(data: bytes, path: Path) -> None:
    """Write bytes."""
    with open(path, "wb") as file:
        file.write(data)


def _new_part(path: Path) -> Path:
    """An empty file beside a path, under a name that nobody can guess and no link can hold."""
    if path.is_dir() and not path.is_symlink():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
    if path.exists() and not path.is_file():  # a device or a pipe would become a file
        raise OSError(errno.EINVAL, os.strerror(errno.EINVAL))
    # The suffix stays: some writers choose their format by it.
    name = f".{_short(path.name)}-{_HOST}-{os.getpid()}-{secrets.token_hex(8)}.part{path.suffix}"
    part = path.with_name(name)
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_NOFOLLOW", 0)
    os.close(os.open(part, flags, 0o666))
    return part


def _short(name: str) -> str:
    return blake2b(os.fsencode(name), digest_size=4).hexdigest()


def _reach_disk(part: Path) -> None:
    with open(part, "r+b") as file:
        os.fsync(file.fileno())
        if not os.fstat(file.fileno()).st_size:  # a writer of another program that gave up
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def _same(part: Path, path: Path) -> bool:
    return path.is_file() and not path.is_symlink() and filecmp.cmp(part, path, shallow=False)


def _is_abandoned(entry: os.DirEntry[str], host: str, process: int) -> bool:
    """Whether the process that was writing a temporary file is gone."""
    if host == _HOST and os.name == "posix" and process != os.getpid():
        try:
            os.kill(process, 0)
        except ProcessLookupError:
            return True
        except OSError:
            pass
    return time.time() - entry.stat(follow_symlinks=False).st_mtime > _ABANDONED
