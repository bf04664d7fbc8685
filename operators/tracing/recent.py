"""What was traced last, so that what is traced again repeats only what a setting touches."""

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


class Recent:
    """The last drawings of some pictures.

    stages: what `vectorize` made of them, stage by stage: a changed setting runs only what it
        touches.
    """

    def __init__(self, most: float) -> None:
        """most: bytes of all stages that are kept."""
        self.stages = KeptStages(most)
        self._kept: OrderedDict[tuple[str, str], Drawing] = OrderedDict()

    def recall(self, source: Source, settings: Settings) -> Drawing | None:
        """The drawing of this very picture, its strokes as the settings want them; None = trace
        it."""
        drawing = self._kept.get(_key(source, settings))
        if drawing is None:
            return None
        return drawing if drawing.settings == settings else drawing.restroked(settings)

    def remember(self, source: Source, settings: Settings, drawing: Drawing) -> None:
        """Keep a drawing that was traced just now."""
        key = _key(source, settings)
        self._kept[key] = drawing
        self._kept.move_to_end(key)
        while len(self._kept) > _MAX_KEPT:
            self._kept.popitem(last=False)


PAGES = Recent(256e6)  # five pages of 1024 px
PARTS = Recent(64e6)  # of pages, that settings are tried on; they must not drive out the pages


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
