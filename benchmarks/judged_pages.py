"""The pages to judge on: their pictures, their true strokes, and what they were drawn with."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .metrics import read_svg

DATA = Path(__file__).parent / "data"


@dataclass(frozen=True)
class JudgedPage:
    """One drawing of the benchmark.

    image: the page as scanned; truth: its SVG, one path per pen stroke.
    medium: pen, pencil, charcoal...; paper: white, paper, aged or shadow.
    """

    name: str
    image: Path
    truth: Path
    medium: str
    paper: str

    def true_strokes(self) -> list[np.ndarray]:
        """Polylines (N, 2), scaled to a long side of 1024 px."""
        return read_svg(self.truth)


def picture(path: Path) -> np.ndarray:
    """A picture in grey, (H, W) uint8.

    Raises:
        ValueError: there is none, or none that can be read.
    """
    import cv2

    found = cv2.imread(str(path), cv2.IMREAD_GRAYSCALE)
    if found is None:
        raise ValueError(f"{path} is no picture.")
    return found


def pages(folder: Path = DATA) -> list[JudgedPage]:
    """All pages of a folder that has a `manifest.json`, by name.

    Raises:
        FileNotFoundError: there is no manifest in the folder.
    """
    entries = json.loads((folder / "manifest.json").read_text("utf-8"))
    result = []
    for entry in entries:
        medium, *_, paper = (part.strip() for part in entry["style"].split(","))
        stem = folder / entry["name"]
        image, truth = stem.with_suffix(".jpg"), stem.with_suffix(".svg")
        image = image if image.exists() else stem.with_suffix(".png")
        result.append(JudgedPage(entry["name"], image, truth, medium, paper))
    return sorted(result, key=lambda page: page.name)
