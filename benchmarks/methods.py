"""Every way to trace a page that the benchmarks compare, by name."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from .judged_pages import picture
from .metrics import read_svg, scaled

Method = Callable[[Path], list[np.ndarray]]


def _involute(**settings: Any) -> Method:
    def trace(image: Path) -> list[np.ndarray]:
        from involute.engine import Settings, vectorize

        # By way of the file: what is judged is what a user gets.
        with TemporaryDirectory() as folder:
            path = Path(folder) / "drawing.svg"
            vectorize(image, Settings(**settings)).save(path)
            return read_svg(path)

    return trace


def _rival(module: str) -> Method:
    def trace(image: Path) -> list[np.ndarray]:
        import importlib

        strokes = importlib.import_module(f"benchmarks.rivals.{module}").trace(image)
        height, width = picture(image).shape
        return scaled(strokes, (width, height))

    return trace


# Each takes the path of a scan and gives polylines (N, 2) at a long side of 1024 px.
METHODS: dict[str, Method] = {
    "involute": _involute(),
    "involute, geometric routing": _involute(router="geometric"),
    "involute, no network": _involute(provider="classical", router="geometric"),
    "skeleton + greedy": _rival("greedy"),
    "nijiGPen's method": _rival("nijigpen"),
    "autotrace": _rival("autotrace"),
}
