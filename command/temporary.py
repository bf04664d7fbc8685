"""Folders for what exists only while the program runs; those of killed runs are cleared away."""

from __future__ import annotations

import os
import re
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ..engine.errors import InvoluteError

_NAME = re.compile(r"involute-(\d+)-\w+")


@contextmanager
def temporary_folder() -> Iterator[Path]:
    """A folder that only its owner may enter, gone with the block.

    Raises:
        InvoluteError: there is no place for it.
    """
    try:
        _clear_abandoned(Path(tempfile.gettempdir()))
        folder = tempfile.TemporaryDirectory(
            prefix=f"involute-{os.getpid()}-", ignore_cleanup_errors=True
        )
    except OSError as error:
        raise InvoluteError(
            f"There is no place for temporary files ({error.strerror or error}); "
            "set TMPDIR to a folder that can be written."
        ) from None
    with folder as path:
        yield Path(path)


def _clear_abandoned(place: Path) -> None:
    """Remove folders of ours whose process is gone."""
    if os.name != "posix":
        return
    with suppress(OSError):
        for entry in os.scandir(place):
            match = _NAME.fullmatch(entry.name)
            with suppress(OSError):
                if match and _is_ours(entry) and not _is_running(int(match[1])):
                    shutil.rmtree(entry.path, ignore_errors=True)


def _is_ours(entry: os.DirEntry[str]) -> bool:
    found = entry.stat(follow_symlinks=False)
    return entry.is_dir(follow_symlinks=False) and found.st_uid == os.getuid()


def _is_running(process: int) -> bool:
    try:
        os.kill(process, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except OSError:
        pass
    return True
