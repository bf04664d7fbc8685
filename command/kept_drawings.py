"""The drawings that are kept so that only changed frames are traced again, and for how long."""

from __future__ import annotations

import os
import re
import shutil
import time
from contextlib import suppress
from hashlib import blake2b
from pathlib import Path

_DAYS = 60.0  # without use, after which drawings go
_MOST = 2e9  # bytes of all folders; above that the longest unused go first
_IN_USE = 1.0  # day; what was used since then stays in any case
_OURS = re.compile(r"[0-9a-f]{16}")


def folder_for(cache: Path, images: Path) -> Path:
    """Where in a cache the drawings of a folder of images (or of a movie) are kept."""
    return cache / blake2b(str(images.absolute()).encode("utf-8"), digest_size=8).hexdigest()


def tidy(cache: Path, used: Path) -> None:
    """Note that a folder of the cache is used now, and remove what was not used for long.

    Nothing else in the cache is touched, and what can't be removed stays: never raises.
    """
    with suppress(OSError):
        used.mkdir(parents=True, exist_ok=True)
        os.utime(used)
    with suppress(OSError):
        now = time.time()
        folders = [f for f in cache.iterdir() if _OURS.fullmatch(f.name) and f.is_dir()]
        age = {folder: (now - folder.stat().st_mtime) / 86400 for folder in folders}
        total = 0
        for folder in sorted(folders, key=age.__getitem__):
            total += sum(file.stat().st_size for file in folder.rglob("*") if file.is_file())
            if age[folder] > _IN_USE and (age[folder] > _DAYS or total > _MOST):
                shutil.rmtree(folder, ignore_errors=True)
