"""What was made of pages, stage by stage: asked again with other settings, only the rest runs.

A stage's result depends on the picture and on the settings that it or an earlier stage reads; each
setting names the first such stage (`About.stage`). That is the key it is kept under. So a change of
*Specks* starts at the graph, and one of *Tolerance* makes the strokes anew and nothing else.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from hashlib import blake2b
from os import PathLike
from pathlib import Path
from threading import Lock
from typing import Any

import numpy as np

from .settings import STAGE_OF, STAGES, Settings
from .values import Array

_MOST = 512e6  # bytes; some ten pages of 1024 px with all their maps, or one A4 page at 300 dpi

Source = str | PathLike[str] | Array


class KeptStages:
    """The results of the last traces; give the same one to every `vectorize` that may profit.

    Several threads may use one. Nothing is written to disk.
    """

    def __init__(self, most: float = _MOST) -> None:
        """most: bytes of all that is kept; what was not asked for the longest goes first."""
        self._most = most
        self._size = 0.0
        self._made: OrderedDict[str, tuple[Any, float]] = OrderedDict()
        self._lock = Lock()

    def recall(self, key: str) -> Any | None:
        """What is kept under a key, or None."""
        with self._lock:
            if key not in self._made:
                return None
            self._made.move_to_end(key)
            return self._made[key][0]

    def keep(self, key: str, made: Any) -> None:
        """Keep the result of a stage; one that is larger than all that may be kept is not."""
        size = _bytes_of(made)
        if size > self._most:
            return
        with self._lock:
            self._size += size - self._made.pop(key, (None, 0.0))[1]
            self._made[key] = made, size
            while self._size > self._most:
                self._size -= self._made.popitem(last=False)[1][1]

    def clear(self) -> None:
        """Forget all, for the memory."""
        with self._lock:
            self._made.clear()
            self._size = 0.0


def keys(source: Source, page: int, settings: Settings, turn: bool = True) -> Mapping[str, str]:
    """Stage -> the key of its result for a picture.

    Args:
        source, page, settings, turn: as `vectorize` takes them.

    Raises:
        OSError: the picture can't be read.
    """
    key = f"{_content(source)} {page} {turn}"
    # What the first stages ask of a setting that belongs to a later one.
    key += f" {settings.provider == 'given'}"
    found = {}
    for stage in STAGES:
        own = {name: getattr(settings, name) for name, at in STAGE_OF.items() if at == stage}
        key = blake2b(f"{key} {stage} {sorted(own.items())}".encode(), digest_size=16).hexdigest()
        found[stage] = key
    return found


def _content(source: Source) -> str:
    content = blake2b(digest_size=16)
    if isinstance(source, np.ndarray):
        content.update(f"{source.dtype.str} {source.shape}".encode())
        content.update(np.ascontiguousarray(source).view(np.uint8).data)
    else:
        content.update(Path(source).suffix.lower().encode())
        content.update(Path(source).read_bytes())
    return content.hexdigest()


def _bytes_of(value: Any) -> float:
    """The memory that the arrays in a value take; what they share counts for each."""
    if isinstance(value, np.ndarray):
        return float(value.nbytes)
    if isinstance(value, tuple | list):
        return sum(map(_bytes_of, value))
    if is_dataclass(value):
        return sum(_bytes_of(getattr(value, field.name)) for field in fields(value))
    return 64.0
