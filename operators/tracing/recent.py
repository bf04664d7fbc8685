"""What was traced last, so that Adjust Last Operation repeats only what a setting touches."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import asdict
from hashlib import blake2b
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...engine import KeptStages, Settings
from .sources import Source

if TYPE_CHECKING:
    from ...engine import Drawing

_MAX_KEPT = 12  # drawings; a page of 1,000 strokes takes 2 MB
KEPT_STAGES = KeptStages(256e6)  # bytes; five pages of 1024 px
"""What `vectorize` made last, stage by stage: a changed setting runs only what it touches."""
_kept: OrderedDict[tuple[str, str], Drawing] = OrderedDict()


def recall(source: Source, settings: Settings) -> Drawing | None:
    """The drawing of this very picture, with strokes as the settings want them; None = trace it."""
    drawing = _kept.get(_key(source, settings))
    if drawing is None:
        return None
    return drawing if drawing.settings == settings else drawing.restroked(settings)


def remember(source: Source, settings: Settings, drawing: Drawing) -> None:
    """Keep a drawing that was traced just now."""
    key = _key(source, settings)
    _kept[key] = drawing
    _kept.move_to_end(key)
    while len(_kept) > _MAX_KEPT:
        _kept.popitem(last=False)


def _key(source: Source, settings: Settings) -> tuple[str, str]:
    """The picture's content, and all settings but those of the last stage."""
    from ...engine.drawing import STROKE_SETTINGS

    content = blake2b(digest_size=16)
    if isinstance(source.picture, np.ndarray):
        content.update(repr(source.picture.shape).encode())
        content.update(np.ascontiguousarray(source.picture).tobytes())
    else:
        try:
            content.update(Path(source.picture).read_bytes())
        except OSError:  # tracing will say so
            content.update(source.picture.encode("utf-8", "surrogateescape"))
    values = {n: v for n, v in asdict(settings).items() if n not in STROKE_SETTINGS}
    return f"{content.hexdigest()} {source.page}", repr(sorted(values.items()))
